// SPDX-License-Identifier: GPL-3.0-or-later
// Folds at which regions of several fidelities meet, and nodes of linear regions of shells that beams, hinges, moments and joints act on:
// beside beam theory, and beside the same scene with all of it nonlinear.
#include "fold_frames.hpp"

namespace hilo::test::mixed_folds_test {
namespace {

using namespace fold_frames;

class MixedFolds : public Folds {
 protected:
  struct Run {
    std::vector<double> probe, energy, momentum;
    std::string said;
  };
  /// `scene` with the mesh out.h5, tagged as it says.
  Run solved(const std::string& scene, const std::string& by, int ranks = 1) {
    place.write("mixed.toml", scene);
    if (!by.empty()) {
      EXPECT_EQ(place.run("hilo-tag --quiet out.h5 " + by + " -o tags.h5").exit, 0) << by;
    }
    const auto ran = succeeded(
        place.run(fmt::format("{}hilo-solve --quiet mixed.toml {} -o run.h5",
                              ranks > 1 ? test::for_ranks + fmt::format(" mpirun -n {} ", ranks) : "", by.empty() ? "out.h5" : "tags.h5")));
    const Store run = Store::open(place / "run.h5");
    const auto of = [&](const char* array) { return run.has(array) ? run.read<double>(array) : std::vector<double>{}; };
    return {of("/history/probe/p"), of("/history/energy"), of("/history/momentum"), ran.err};
  }
  std::string said;  // by the last of these

  /// Frequencies above those of a rigid body [Hz].
  std::vector<double> frequencies(const std::string& scene, const std::string& by) {
    place.write("modes.toml", scene + "[time]\nanalysis = \"modes\"\nmodes = 12\n");
    EXPECT_EQ(place.run("hilo-tag --quiet out.h5 " + by + " -o tags.h5").exit, 0) << by;
    const auto ran = place.run("hilo-solve modes.toml tags.h5 -o modes.h5");
    said = ran.err;
    EXPECT_EQ(ran.exit, 0) << by << ": " << ran.err;
    if (ran.exit != 0) return std::vector<double>(6, 0.0);
    const auto all = Store::open(place / "modes.h5").read<double>("/history/mode");
    std::vector<double> out;
    for (size_t k = 0; k < all.size() / 10; ++k)
      if (all[10 * k] > 0.1) out.push_back(all[10 * k]);
    if (!out.empty()) out.resize(6);  // six of a rigid body, some of them twice
    return out;
  }
};

// Small loads: the answer is that of all nonlinear, to the square of the turn, 1e-6.
TEST_F(MixedFolds, AreAsStiffAsNonlinearOnes) {
  Frame f;
  f.step = 2.5;
  f.strip(0, 0, 10, 0, "A"), f.strip(10, 0, 10, 10, "B"), f.strip(10, 0, 15, 0, "C");
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 10);
  const std::string deck = f.deck(sets, "ROOT,1,6\n", f.load(10, 10, 1, 1e-4));
  const Vec3 way = tip(deck);
  for (const char* mix : {"--linear A", "--linear B", "--linear A --linear C"}) {
    tags = mix;
    EXPECT_LT((tip(deck) - way).norm(), 1e-5 * way.norm()) << mix;
  }
  EXPECT_LT((tip(deck, "", 3) - way).norm(), 1e-5 * way.norm()) << "on three ranks";
}

// With its first leg rigid the other bends as a cantilever, and with its second the first as under a force and a moment.
TEST_F(MixedFolds, ARigidLegBendsTheLinearOneAlone) {
  Frame f;
  f.strip(0, 0, 10, 0, "A"), f.strip(10, 0, 10, 10, "B");
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 10);
  constexpr double F = 1e-4, L = 10;
  const std::string deck = f.deck(sets, "ROOT,1,6\n", f.load(10, 10, 1, F));
  tags = "--rigid A --linear B";
  EXPECT_NEAR(tip(deck).x() / (F * (L * L * L / (3 * EI) + L / kGA)), 1, 1e-3);
  tags = "--rigid B --linear A";
  const Vec3 way = tip(deck);
  EXPECT_NEAR(way.x() / (F * (L * L * L / EI + L / EA)), 1, 1e-3);
  EXPECT_NEAR(way.z() / (F * L * L * L / (2 * EI)), -1, 1e-3);
}

// A node of a solid does not turn: three rows.  A rigid body does: a clamp, and 20 shells between clamps bend by 1 % too little.
TEST_F(MixedFolds, AnEdgeOnSolidsOfAnotherFidelityIsAHinge) {
  constexpr double bends = 1e-3 * 1000 / (48 * EI), shears = 1e-3 * 10 / (4 * kGA);
  for (const char* mix : {"--linear BLOCK", "--linear PLATE"}) {
    tags = mix;
    EXPECT_NEAR(tip(strip_between_blocks()).z() / (bends + shears), 1, 3e-3) << mix;
  }
  tags = "--linear PLATE --rigid BLOCK";
  EXPECT_NEAR(tip(strip_between_blocks()).z() / (0.99 * bends / 4 + shears), 1, 3e-3);
  expect_said("4 nodes where shells stand on rigid solids are clamps");
}

/// Three plates 1 x 1 that meet along y, with so many cells along it and across.
std::string tee(int along, int across) {
  return fmt::format(
      "Point(1) = {{0, 0, 0}}; Point(2) = {{0, 1, 0}}; Line(1) = {{1, 2}}; Transfinite Curve{{1}} = {0};\n"
      "a[] = Extrude {{-1, 0, 0}} {{ Curve{{1}}; Layers{{{1}}}; Recombine; }};\n"
      "b[] = Extrude {{1, 0, 0}} {{ Curve{{1}}; Layers{{{1}}}; Recombine; }};\n"
      "c[] = Extrude {{0, 0, 1}} {{ Curve{{1}}; Layers{{{1}}}; Recombine; }};\n"
      "Physical Surface(\"left\") = {{a[1]}}; Physical Surface(\"right\") = {{b[1]}}; Physical Surface(\"up\") = {{c[1]}};\n"
      "Physical Curve(\"top\") = {{c[0]}};\n",
      along + 1, across);
}
std::string of_rubber(double E) {
  return fmt::format("[material.rubber]\nE = {}\nnu = 0.0\ndensity = 1000\n[region.\"*\"]\nmaterial = \"rubber\"\n", E);
}

// Vibrations between interfaces stop at 40 modes: 1e-5 of the frequencies here.
TEST_F(MixedFolds, VibrateAsNonlinearOnes) {
  imported_deck("tee.geo", tee(3, 3), "--thickness 0.05");
  const auto all = frequencies(of_rubber(2e7), "--rest nonlinear");
  for (const char* mix : {"--linear left", "--linear up --linear left"}) {
    const auto mixed = frequencies(of_rubber(2e7), mix);
    ASSERT_EQ(mixed.size(), all.size());
    for (size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(mixed[k] / all[k], 1, 1e-4) << mix << ", " << k;
  }
}

// Of 37 nodes of the fold, which turn alike and not as they each like: stiffer, and by little.
TEST_F(MixedFolds, OfManyNodesMoveByPolynomials) {
  imported_deck("tee.geo", tee(36, 2), "--thickness 0.05");
  const auto all = frequencies(of_rubber(2e7), "--rest nonlinear"), mixed = frequencies(of_rubber(2e7), "--linear up");
  expect_words(said, "up: linear, it meets other shells at 37 nodes of folds: they move together by polynomials of the fifth degree");
  ASSERT_EQ(mixed.size(), all.size());
  for (size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(mixed[k] / all[k], 1 + 5e-4, 6e-4) << k;
}

// More than half a turn: what the fold carries turns with the mean axes of the linear plates.
TEST_F(MixedFolds, KeepEnergyAndMomentaAtAnyTurn) {
  imported_deck("tee.geo", tee(3, 3), "--thickness 0.05");
  const auto scene = [](double E, const char* way, double end) {
    return of_rubber(E) + fmt::format("[[initial]]\non = [\"up\"]\nvelocity = [{}]\nspin = [3, 2, 5]\nabout = [0, 0, 0]\n", way) +
           "[[initial]]\non = [\"left\", \"right\"]\nvelocity = [0, 1, 0]\nspin = [3, 2, 5]\nabout = [0, 0, 0]\n"
           "[[probe]]\nname = \"p\"\non = \"top\"\n" +
           fmt::format("[time]\nend = {}\nstep = 0.02\n", end);
  };
  for (const char* mix : {"--linear left --linear up", "--linear right --rigid left"}) {
    const Run r = solved(scene(2e8, "0.1, 1, 0.2", 0.6), mix);
    const size_t n = r.energy.size() / 6;
    ASSERT_GT(n, 10u);
    double strained = 0;
    for (size_t i = 1; i < n; ++i) {
      EXPECT_NEAR((r.energy[6 * i] + r.energy[6 * i + 1]) / (r.energy[0] + r.energy[1]), 1, 1e-10) << mix;
      for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(r.momentum[6 * i + k], r.momentum[k], 1e-9 * std::abs(r.momentum[1])) << mix;
      strained = std::max(strained, r.energy[6 * i + 1]);
    }
    EXPECT_GT(strained, 1e-5 * r.energy[0]) << mix;
  }
  const Run one = solved(scene(2e8, "0.1, 1, 0.2", 0.04), "--linear left"),
            two = solved(scene(2e8, "0.1, 1, 0.2", 0.04), "--linear left", 2);
  ASSERT_EQ(one.probe.size(), two.probe.size());
  for (size_t k = 0; k < one.probe.size(); k += 9) EXPECT_NEAR(one.probe[k], two.probe[k], 1e-8) << "on two ranks";
  // thrown as one, stiff plates bend by rho w^2 L^5/(8 E h^2/12), 0.6 mm; what linear strains leave out is the square of it by L, 1e-6
  const Run all = solved(scene(2e10, "0, 1, 0", 0.6), ""), mixed = solved(scene(2e10, "0, 1, 0", 0.6), "--linear left --linear up");
  ASSERT_EQ(all.probe.size(), mixed.probe.size());
  for (size_t k = 3; k > 0; --k)
    EXPECT_NEAR(mixed.probe[mixed.probe.size() - 6 - k], all.probe[all.probe.size() - 6 - k], 1e-5) << "positions at the end";
}

/// An L of two plates with a node of six unknowns in the flat of the first, `node_8`, and the fold, `block_14`, in its middle.
std::string angle() {
  std::map<std::array<int, 3>, int> number;
  std::string nodes = "*NODE\n", cells[2];
  const auto node = [&](int x, int y, int z) {
    const auto [it, fresh] = number.try_emplace({x, y, z}, static_cast<int>(number.size()) + 1);
    if (fresh) nodes += fmt::format("{},{},{},{}\n", it->second, x / 4., y / 4., z / 4.);
    return it->second;
  };
  int n = 0;
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < (side ? 3 : 4); ++i)
      for (int j = 0; j < 2; ++j) {
        const auto at = [&](int a, int b) { return side ? node(4, b, a) : node(a, b, 0); };
        const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        cells[side] += fmt::format("{},{},{},{},{}\n", ++n, a, b, c, d);
      }
  return nodes + "*ELEMENT, TYPE=S4, ELSET=A\n" + cells[0] + "*ELEMENT, TYPE=S4, ELSET=B\n" + cells[1] +
         fmt::format("*NSET, NSET=ROOT\n{},{},{}\n*NSET, NSET=MID\n{}\n", node(0, 0, 0), node(0, 1, 0), node(0, 2, 0), node(2, 1, 0)) +
         "*MATERIAL, NAME=M\n*ELASTIC\n2e9,.3\n*DENSITY\n1000\n*SHELL SECTION, ELSET=A, MATERIAL=M\n.01\n"
         "*SHELL SECTION, ELSET=B, MATERIAL=M\n.015\n*BOUNDARY\nROOT,1,6\n*STEP\n*STATIC\n*CLOAD\nMID,4,1e-9\n*END STEP\n";
}

// An arm on a joint, pulled by a spring.  All modes up to 1e5 Hz, so that the shock of the start has its answer: 0.2 % of the way of the
// joint after 0.015 s.
TEST_F(MixedFolds, JointsOfEveryKindActOnNodesOfLinearShells) {
  imported_deck("angle.inp", angle(), "--thicken --scene-out angle.toml");
  std::string scene = test::text_of(place / "angle.toml");
  scene.erase(scene.find("[time]"));
  for (size_t at = 0; (at = scene.find("material = \"M\"\n", at)) != scene.npos;) scene.insert(at += 15, "modes = 60\nup_to = 1e5\n");
  struct Kind {
    const char *name, *keys;
  };
  const Kind kinds[] = {{"fixed", ""},
                        {"spherical", ""},
                        {"revolute", "axis = [1, 0.5, 0]"},
                        {"cylindrical", "axis = [1, 0, 0.3]"},
                        {"prismatic", "axis = [1, 0.2, 0]"},
                        {"universal", "axis = [0, 0, 1]\nx = [1, 0, 0]"},
                        {"constant-velocity", "axis = [0, 0, 1]\naxis_b = [0, 0, 1]"},
                        {"screw", "axis = [0.3, 0, 1]\npitch = 0.1"},
                        {"planar", "axis = [0, 0, 1]"},
                        {"in-plane", "axis = [0, 0, 1]"},
                        {"in-line", "axis = [0, 0, 1]"}};
  bool turn = false;
  for (const auto& [name, keys] : kinds) {
    const bool of_fold = std::exchange(turn, !turn);
    const double x = of_fold ? 1 : 0.5;
    const char* on = of_fold ? "block_14" : "node_8";
    const std::string with =
        scene + fmt::format(
                    "[[body]]\nname = \"arm\"\nmass = 0.3\ncom = [{0}, 0.25, 0.2]\ninertia = [0.004, 0.004, 0.003]\n"
                    "[[joint]]\nkind = \"{1}\"\nname = \"j\"\na = \"{2}\"\nb = \"arm\"\nat = [{3}, 0.25, 0]\n{4}\n"
                    "[[spring]]\nkind = \"axial\"\nname = \"s\"\nb = \"arm\"\nat_a = [{3}, 0.3, 0.5]\nat_b = [{0}, 0.25, 0.25]\n"
                    "stiffness = 20\nlength = 0.1\n[[probe]]\nname = \"p\"\non = \"{2}\"\n[time]\nend = 0.015\nstep = 0.001\n",
                    x + 0.1, name, on, x, keys);
    const Run all = solved(with, ""), mixed = solved(with, "--linear A");
    ASSERT_EQ(all.probe.size(), mixed.probe.size()) << name;
    double most = 0, off = 0;
    for (size_t k = 0; k < all.probe.size(); k += 9)
      for (size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(all.probe[k + c] - all.probe[c])),
        off = std::max(off, std::abs(mixed.probe[k + c] - all.probe[k + c]));
    std::printf("%s at %s: moves %.2g m, off by %.1e of it\n", name, on, most, off / most);
    EXPECT_LT(off, 2e-3 * most) << name;
  }
}

// Beams, moments and hinges on the nodes of a linear plate: the closed forms of ImportFolds.
TEST_F(MixedFolds, BeamsMomentsAndHingesActOnNodesOfLinearShells) {
  tags = "--linear PLATE";
  constexpr double M = 1e-4, L = 10;
  Frame strip;
  strip.strip(0, 0, L, 0);
  const std::string ends = "*NSET, NSET=ROOT\n" + strip.nodes_at(0, 0) + "*NSET, NSET=END\n" + strip.nodes_at(L, 0);
  const std::string at_end = ends + "*NSET, NSET=TIP\n" + strip.nodes_at(L, 0),
                    in_middle = ends + "*NSET, NSET=TIP\n" + strip.nodes_at(5, 0);
  EXPECT_NEAR(tip(strip.deck(at_end, "ROOT,1,6\n", strip.load(L, 0, 5, M))).z() / (M * L * L / (2 * EI)), -1, 1e-3);
  // between hinges about y; the strip does not stretch yet
  const double sags = M * (L * L * L / (48 * EI) + L / (4 * kGA));
  EXPECT_NEAR(tip(strip.deck(in_middle, "ROOT,1,4\nROOT,6\nEND,1,4\nEND,6\n", strip.load(5, 0, 3, M))).z() / sags, 1, 3e-3);

  Frame f;
  f.across = 2;
  f.strip(0, 0, L, 0);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(L, 0);
  std::string beams = "*ELEMENT, TYPE=B31, ELSET=RIB\n";
  for (int i = 0; i < 20; ++i) beams += fmt::format("{},{},{}\n", 1000 + i, f.station(i / 2., 0) + 1, f.station(i / 2. + 0.5, 0) + 1);
  const std::string rib = "*BEAM SECTION, ELSET=RIB, MATERIAL=M, SECTION=RECT, OFFSET1=-.75\n.2,.1\n0,0,1\n";
  const std::string deck = f.deck(sets + beams, "ROOT,1,6\n", f.load(L, 0, 5, M), rib);
  const Vec3 linear = tip(deck);
  tags.clear();
  const Vec3 nonlinear = tip(deck);
  EXPECT_LT((linear - nonlinear).norm(), 1e-4 * nonlinear.norm());
}

}  // namespace
}  // namespace hilo::test::mixed_folds_test
