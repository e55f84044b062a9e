// SPDX-License-Identifier: GPL-3.0-or-later
// Shells of decks that fold, meet, change their thickness, turn at their supports or carry beams: frames of strips against beam theory.
#include "fold_frames.hpp"

namespace hilo::test::import_folds_test {
namespace {

using namespace fold_frames;
class ImportFolds : public Folds {};

TEST_F(ImportFolds, ACornerIsStiffAndNoMore) {
  Frame f;
  f.strip(0, 0, 10, 0), f.strip(10, 0, 10, 10);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 10);
  constexpr double F = 1e-3, a = 10, b = 10;
  const Vec3 way = tip(f.deck(sets, "ROOT,1,6\n", f.load(10, 10, 1, F)));
  expect_said("2 nodes of folds");
  EXPECT_NEAR(way.x() / (F * (b * b * b / (3 * EI) + b * b * a / EI + a / EA + b / kGA)), 1, 1e-3);
  EXPECT_NEAR(way.z() / (F * b * a * a / (2 * EI)), -1, 1e-3);
  for (const int ranks : {2, 3})
    EXPECT_LT((tip(f.deck(sets, "ROOT,1,6\n", f.load(10, 10, 1, F)), "", ranks) - way).norm(), 1e-7 * way.norm());
}

// Small motions: the modes of a linear region have its folds.  Vibrations too, free and held.
TEST_F(ImportFolds, AFoldIsAsStiffInALinearRegion) {
  Frame f;
  f.strip(0, 0, 10, 0), f.strip(10, 0, 10, 10), f.strip(10, 0, 15, 0);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 10);
  const std::string deck = f.deck(sets, "ROOT,1,6\n", f.load(10, 10, 1, 1e-3));
  const Vec3 way = tip(deck);
  const auto first_modes = [&](const std::string& mesh, bool free) {
    std::string scene = test::text_of(place / "run.toml");
    scene.replace(scene.find("[time]\nanalysis = \"static\""), 26,
                  fmt::format("[time]\nanalysis = \"modes\"\nmodes = {}\n", free ? 10 : 4));
    if (free) scene.erase(scene.find("[[motion]]"), scene.find("[[load]]") - scene.find("[[motion]]"));
    scene.erase(scene.find("[[load]]"), scene.find("[time]") - scene.find("[[load]]"));
    place.write("modes.toml", scene);
    succeeded(place.run("hilo-solve --quiet modes.toml " + mesh + " -o modes.h5"), scene);
    const auto all = Store::open(place / "modes.h5").read<double>("/history/mode");
    std::vector<double> out;
    for (size_t k = all.size() / 10 - 3; k < all.size() / 10; ++k) out.push_back(all[10 * k]);
    return out;
  };
  const auto held = first_modes("out.h5", false), free = first_modes("out.h5", true);
  ASSERT_EQ(place.run("hilo-tag out.h5 --rest linear -o tags.h5").exit, 0);
  for (const int ranks : {1, 2}) {
    succeeded(place.run(test::for_ranks + fmt::format(" mpirun -n {} hilo-solve --quiet run.toml tags.h5 -o run.h5", ranks)));
    const auto x = Store::open(place / "run.h5").read<double>("/history/probe/TIP");
    const size_t n = x.size() - 9;
    EXPECT_LT((Vec3(x[n] - x[0], x[n + 1] - x[1], x[n + 2] - x[2]) - way).norm(), 1e-5 * way.norm());
  }
  const auto of_modes = first_modes("tags.h5", false), of_free = first_modes("tags.h5", true);
  for (size_t k = 0; k < held.size(); ++k) EXPECT_NEAR(of_modes[k] / held[k], 1, 1e-5);
  for (size_t k = 0; k < free.size(); ++k) EXPECT_NEAR(of_free[k] / free[k], 1, 1e-5);
}

// Of n shells between clamps the bent share is 4/n^2 too small, and from a clamp to a free end exact: mid-side nodes do not help.
TEST_F(ImportFolds, ShortRowsBendTooLittleAndAreToldOf) {
  constexpr double q = 1e-5, L = 10, bends = q * L * L * L * L / EI;
  for (const int n : {2, 4, 8}) {
    Frame f;
    f.step = L / n;
    f.strip(0, 0, L, 0);
    const std::string ends = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=END\n" + f.nodes_at(L, 0);
    const std::string pressed = fmt::format("1,3,1e-30\n*DLOAD\nPLATE,P,{}\n", q);
    const auto way = [&](double x, const char* supports) {
      return tip(f.deck(ends + "*NSET, NSET=TIP\n" + f.nodes_at(x, 0), supports, pressed)).z();
    };
    const double between = way(5, "ROOT,1,6\nEND,1,6\n");
    EXPECT_NEAR(between / (bends / 384), n == 2 ? 0 : 1 - 4. / (n * n), 2e-3) << n;
    const std::string told = fmt::format(
        "warning: {} shells stand in rows of less than 8 from a fold or clamp to the next; the shortest has {}, "
        "at ({:.4g}, 0.5, 0): so few {} (",
        n, n, L / n / 2, n == 2 ? "hardly bend" : "bend up to 25 % too little");
    EXPECT_EQ(err.find(told) != std::string::npos, n < 8) << told << err;
    EXPECT_NEAR(way(L, "ROOT,1,6\n") / (bends / 8), 1, 1e-3) << n;
    EXPECT_EQ(err.find("stand in rows"), std::string::npos) << err;
  }
  // an angle of two quadratic shells, each as four: two between the clamp and the fold, and two to the free edge
  imported_deck(
      "angle.inp",
      "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,.5,0,0\n6,1,.5,0\n7,.5,1,0\n8,0,.5,0\n9,1,0,1\n10,1,1,1\n11,1,0,.5\n12,1,.5,1\n"
      "13,1,1,.5\n*ELEMENT, TYPE=S8R, ELSET=E\n1,1,2,3,4,5,6,7,8\n2,2,9,10,3,11,12,13,6\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,.3\n"
      "*SHELL SECTION, ELSET=E, MATERIAL=M\n.01\n*BOUNDARY\n1,1,6\n4,1,6\n8,1,6\n",
      "--thicken");
  expect_said("warning: 4 shells stand in rows of less than 8 from a fold or clamp to the next; the shortest has 2");
}

TEST_F(ImportFolds, ATeeSharesItsMoment) {
  Frame f;
  f.strip(-10, 0, 0, 0), f.strip(0, 0, 10, 0), f.strip(0, 0, 0, 10);
  const std::string sets =
      "*NSET, NSET=ROOT\n" + f.nodes_at(-10, 0) + "*NSET, NSET=ROOT\n" + f.nodes_at(10, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(0, 10);
  constexpr double F = 1e-3, a = 10, b = 10;
  const Vec3 way = tip(f.deck(sets, "ROOT,1,6\n", f.load(0, 10, 1, F)));
  const double turn = 4 * EI / a * (1 + 3 * EI / (kGA * a * a)) / (1 + 12 * EI / (kGA * a * a));  // moment of one half for a unit turn
  EXPECT_NEAR(way.x() / (F * (b * b * b / (3 * EI) + b * b / (2 * turn) + a / (2 * EA) + b / kGA)), 1, 1e-3);
}

TEST_F(ImportFolds, HingesLetTheStripTurn) {
  Frame f;
  f.strip(0, 0, 10, 0);
  const std::string sets =
      "*NSET, NSET=A\n" + f.nodes_at(0, 0) + "*NSET, NSET=B\n" + f.nodes_at(10, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(5, 0);
  constexpr double F = 1e-3, L = 10;
  const double want = F * (L * L * L / (48 * EI) + L / (4 * kGA));
  EXPECT_NEAR(tip(f.deck(sets, "A,1,3\nB,2,3\n", f.load(5, 0, 3, F))).z() / want, 1, 3e-3);
  EXPECT_NEAR(tip(f.deck(sets, "A,1,4\nA,6\nB,2,4\nB,6\n", f.load(5, 0, 3, F))).z() / want, 1, 3e-3) << "no turn but about the hinge";
}

TEST_F(ImportFolds, AMomentBendsTheStrip) {
  Frame f;
  f.strip(0, 0, 10, 0);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 0);
  constexpr double M = 1e-3, L = 10;
  EXPECT_NEAR(tip(f.deck(sets, "ROOT,1,6\n", f.load(10, 0, 5, M))).z() / (M * L * L / (2 * EI)), -1, 1e-3);
  tip(f.deck(sets, "ROOT,1,6\n", f.load(10, 0, 6, M) + f.load(10, 0, 3, M)), "");
  expect_said("a moment about the normal of a shell, which does not resist it");
}

// Half a radian and more, the strip saddles: its pairs lean across, and a small part of each moment is about them, which nothing resists.
TEST_F(ImportFolds, AMomentTurnsAStripThatSaddles) {
  Frame f;
  f.across = 4;
  f.strip(0, 0, 5, 0);
  const std::string sets = "*NSET, NSET=TIP\n" + f.nodes_at(5, 0) + "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0);
  for (const double angle : {0.5, 1.0}) {
    std::string deck = f.deck(sets, "ROOT,1,6\n", f.load(5, 0, 5, -EI * angle / 5));
    deck.replace(deck.find(",0.\n*DENSITY"), 3, ",.3");
    const Vec3 u = tip(deck);
    const auto along = [](double a) { return 5 * (1 - std::cos(a)) / a; };
    std::printf("%.1f rad: %.4f of a beam's\n", angle, u.z() / along(angle));
    EXPECT_LT(u.z(), 1.003 * along(angle)) << "a beam that contracts freely";
    EXPECT_GT(u.z(), along(0.91 * angle)) << "a plate that does not";
  }
}

TEST_F(ImportFolds, AStepOfThicknessKeepsTheMiddle) {
  Frame f;
  f.strip(0, 0, 5, 0, "THICK"), f.strip(5, 0, 10, 0);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 0);
  constexpr double F = 1e-3, L = 5;
  // root half eight times as stiff: F at its end and F L as a moment there
  const double root = F * L * L * L / (3 * 8 * EI) + F * L * L * L / (2 * 8 * EI), turn = F * L * L / (2 * 8 * EI) + F * L * L / (8 * EI);
  EXPECT_NEAR(tip(f.deck(sets, "ROOT,1,6\n", f.load(10, 0, 3, F))).z() / (root + turn * L + F * L * L * L / (3 * EI) + F * L / kGA * 1.5),
              1, 2e-3);
  EXPECT_NEAR(tip(f.deck(sets, "ROOT,1,6\n", f.load(10, 0, 1, 1e3))).x() / (1e3 * L / EA * 1.5), 1, 1e-3);
}

TEST_F(ImportFolds, AStiffenerBelowThePlateBendsWithIt) {
  Frame f;
  f.across = 2;
  f.strip(0, 0, 10, 0);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 0);
  std::string beams = "*ELEMENT, TYPE=B31, ELSET=RIB\n";
  for (int i = 0; i < 20; ++i) beams += fmt::format("{},{},{}\n", 1000 + i, f.station(i / 2., 0) + 1, f.station(i / 2. + 0.5, 0) + 1);
  const double b = 0.1, h = 0.2, off = -0.15;  // n1 is z: the rib hangs below
  const std::string rib = fmt::format("*BEAM SECTION, ELSET=RIB, MATERIAL=M, SECTION=RECT, OFFSET1={}\n{},{}\n0,0,1\n", off / h, h, b);
  constexpr double M = 1e-3, L = 10;
  const double A = b * h, I = b * h * h * h / 12, whole = EI + E * I + E * A * t / (A + t) * off * off;
  // far from its end, where the moment of the plate's middle node spreads, the panel bends as one
  const Vec3 way = tip(f.deck(sets + beams, "ROOT,1,6\n", f.load(10, 0, 5, M), rib));
  EXPECT_NEAR(way.z() / (M * L * L / (2 * whole)), -1, 0.02);
}

// A rib along the middle resists the turn about the normal, which the shells do not: sideways the panel is a beam, however fine.
TEST_F(ImportFolds, ARibBracesNoPlateSideways) {
  constexpr double b = 0.05, h = 0.2, L = 10, A = t + b * h, I = t / 12 + h * b * b * b / 12;
  Frame f;
  f.across = 2, f.step = L / 48;
  f.strip(0, 0, L, 0);
  std::string beams = "*ELEMENT, TYPE=B31, ELSET=RIB\n", all = "*NSET, NSET=ALL, GENERATE\n1,147,1\n";
  const auto middle = [&](int i) { return f.station(f.step * i, 0) + 1; };
  for (int i = 0; i < 48; ++i) beams += fmt::format("{},{},{}\n", 1000 + i, middle(i), middle(i + 1));
  const std::string rib = fmt::format("*BEAM SECTION, ELSET=RIB, MATERIAL=M, SECTION=RECT\n{},{}\n0,0,1\n", h, b),
                    sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + all + beams, flat = "ROOT,1,6\nALL,3,3\n";
  const auto solved = [&](const std::string& loads, const std::string& procedure) {
    place.write("deck.inp", f.deck(sets, flat, loads, rib, procedure));
    imported("deck.inp", "--thicken --units mm-t-s --scene-out scene.toml");
    return succeeded(place.run("hilo-solve scene.toml -o run.h5"));
  };
  const auto first = [&](const char* list) {
    const auto all_of = Store::open(place / "run.h5").read<double>(list);
    const auto wide = Store::open(place / "run.h5").shape(list)[1];
    return all_of[static_cast<size_t>(wide)];
  };
  const std::string loads = f.load(L, 0, 1, -1);
  const double euler = M_PI * M_PI * E * I / (4 * L * L), shear = 1 + euler * 1.2 / (E / 2 * A);
  solved(loads, "*BUCKLE\n1\n");
  EXPECT_NEAR(first("/history/buckling") / (euler / shear), 1, 0.01);
  const std::string modal = f.deck(sets, flat, "", rib, "*FREQUENCY\n1\n");
  place.write("deck.inp", modal.substr(0, modal.find("*CLOAD")) + "*END STEP\n");
  imported("deck.inp", "--thicken --units mm-t-s --scene-out scene.toml");
  succeeded(place.run("hilo-solve scene.toml -o run.h5"));
  EXPECT_NEAR(first("/history/mode") / (0.55959 * std::sqrt(E * I / (1000 * A)) / (L * L)), 1, 0.015);
  solved(f.load(L, 0, 1, -1.3 * euler), "*STATIC\n");
  std::string scene = test::text_of(place / "scene.toml");
  const std::string analysis = "analysis = \"static\"";
  ASSERT_NE(scene.find(analysis), std::string::npos) << scene;
  place.write("path.toml", scene.replace(scene.find(analysis), analysis.size(), "analysis = \"path\"\nsteps = 6"));
  const auto ran = place.run("hilo-solve path.toml out.h5 -o run.h5");
  const std::string lost = "stability is lost at ";
  const size_t at = (ran.out + ran.err).find(lost);
  ASSERT_NE(at, std::string::npos) << ran.out << ran.err;
  EXPECT_NEAR(1.3 * std::stod((ran.out + ran.err).substr(at + lost.size())) * shear, 1, 0.01);
}

TEST_F(ImportFolds, AnEdgeOnASolidIsAHinge) {
  const Vec3 way = tip(strip_between_blocks());
  expect_said("4 nodes of shells are nodes of solids too, which do not turn: hinges");
  EXPECT_NEAR(way.z() / (1e-3 * (1000 / (48 * EI) + 10 / (4 * kGA))), 1, 3e-3);
}

// As CalculiX has it: a positive P pushes along the normal of the element.
TEST_F(ImportFolds, APressurePushesAlongTheNormal) {
  Frame f;
  f.strip(0, 0, 10, 0);
  const std::string sets = "*NSET, NSET=ROOT\n" + f.nodes_at(0, 0) + "*NSET, NSET=TIP\n" + f.nodes_at(10, 0);
  constexpr double q = 1e-5, L = 10, want = q * (L * L * L * L / (8 * EI) + L * L / (2 * kGA));
  const std::string pressed = f.load(10, 0, 3, 1e-30) + fmt::format("*DLOAD\nPLATE,P,{}\n", q);
  EXPECT_NEAR(tip(f.deck(sets, "ROOT,1,6\n", pressed)).z() / want, 1, 3e-3);
  const std::string surfaces = "*SURFACE, NAME=UP\nPLATE,SPOS\n*SURFACE, NAME=DOWN\nPLATE,S1\n";
  const auto on = [&](const char* surface) { return f.load(10, 0, 3, 1e-30) + fmt::format("*DSLOAD\n{},P,{}\n", surface, q); };
  EXPECT_NEAR(tip(f.deck(sets + surfaces, "ROOT,1,6\n", on("UP"))).z() / want, -1, 3e-3) << "onto a face";
  EXPECT_NEAR(tip(f.deck(sets + surfaces, "ROOT,1,6\n", on("DOWN"))).z() / want, 1, 3e-3);
  EXPECT_NEAR(tip(f.deck(
                      sets, "ROOT,1,6\n", pressed,
                      "*NODAL THICKNESS\nROOT,.2\nTIP,.2\n" +
                          [&] {
                            std::string lines;
                            for (const auto& [at, node] : f.number) lines += fmt::format("{},.2\n{},.2\n", node, node + 1);
                            return lines;
                          }()))
                      .z() /
                  (q * (L * L * L * L / (8 * 8 * EI) + L * L / (4 * kGA))),
              1, 3e-3);
}

// Four plates, simply supported by each other, of three half waves by symmetry: k = 4, the value of textbooks.
TEST_F(ImportFolds, ASquareTubeBuckles) {
  imported_deck("tube.geo",
                "Point(1) = {0, 0, 0}; Point(2) = {0, .2, 0}; Point(3) = {0, .2, .2}; Point(4) = {0, 0, .2};\n"
                "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Transfinite Curve{1:4} = 9;\n"
                "s() = Extrude {.3, 0, 0} { Curve{1:4}; Layers{12}; Recombine; };\n"
                "Physical Surface(\"tube\") = {s(1), s(5), s(9), s(13)};\n"
                "Physical Curve(\"middle\") = {1:4}; Physical Curve(\"end\") = {s(0), s(4), s(8), s(12)};\n",
                "--thickness 0.002");
  EXPECT_EQ(err.find("share no node"), std::string::npos) << err;
  place.write("tube.toml",
              "[material.steel]\nE = 2.1e11\nnu = 0.0\ndensity = 7850\n[region.tube]\nmaterial = \"steel\"\n"
              "[[motion]]\nkind = \"fixed\"\nname = \"middle\"\non = \"middle\"\ncomponents = [\"x\"]\n"
              "[[motion]]\nkind = \"fixed\"\nname = \"end\"\non = \"end\"\ncomponents = [\"y\", \"z\"]\n"
              "[[load]]\nkind = \"traction\"\nname = \"press\"\non = \"end\"\ntraction = [-8e7, 0, 0]\n"
              "[time]\nanalysis = \"path\"\nsteps = 4\n");
  const auto ran = succeeded(place.run("hilo-solve tube.toml out.h5 -o run.h5"));
  const std::string lost = "stability is lost at ";
  const size_t at = (ran.out + ran.err).find(lost);
  ASSERT_NE(at, std::string::npos) << ran.out << ran.err;
  const double stress = 8e7 * std::stod((ran.out + ran.err).substr(at + lost.size()));
  const double slenderness = 0.002 / 0.2, want = 4 * M_PI * M_PI * 2.1e11 / 12 * slenderness * slenderness;
  std::printf("buckles at %.4f of k = 4\n", stress / want);
  EXPECT_NEAR(stress / want, 1, 6e-3);
}

/// Three plates 1 x 1 that meet along y.
const std::string tee =
    "Point(1) = {0, 0, 0}; Point(2) = {0, 1, 0}; Line(1) = {1, 2}; Transfinite Curve{1} = 5;\n"
    "a[] = Extrude {-1, 0, 0} { Curve{1}; Layers{4}; Recombine; };\n"
    "b[] = Extrude {1, 0, 0} { Curve{1}; Layers{4}; Recombine; };\n"
    "c[] = Extrude {0, 0, 1} { Curve{1}; Layers{4}; Recombine; };\n"
    "Physical Surface(\"left\") = {a[1]}; Physical Surface(\"right\") = {b[1]}; Physical Surface(\"up\") = {c[1]};\n"
    "Physical Curve(\"side\") = {a[0]}; Physical Curve(\"top\") = {c[0]};\n"
    "Physical Curve(\"front\") = {a[2], b[2], c[2]}; Physical Curve(\"back\") = {a[3], b[3], c[3]};\n";
const std::string rubber = "[material.rubber]\nE = 2e7\nnu = 0.0\ndensity = 1000\n[region.\"*\"]\nmaterial = \"rubber\"\n";

TEST_F(ImportFolds, ComponentsOfALineAreHeldOnceAndTheirReactionIsWhole) {
  EXPECT_EQ(imported_deck("tee.geo", tee, "--thickness 0.05").block_name.size(), 5u);
  place.write("pull.toml", rubber +
                               "[[motion]]\nkind = \"fixed\"\nname = \"front\"\non = \"front\"\ncomponents = [\"y\", \"z\"]\n"
                               "[[motion]]\nkind = \"fixed\"\nname = \"side\"\non = \"side\"\ncomponents = [\"x\"]\n"
                               "[[load]]\nkind = \"traction\"\nname = \"pull\"\non = \"back\"\ntraction = [0, 1000, 0]\n"
                               "[[probe]]\nname = \"back\"\non = \"back\"\n[time]\nanalysis = \"static\"\n");
  for (const int ranks : {1, 3}) {
    succeeded(place.run(test::for_ranks + fmt::format(" mpirun -n {} hilo-solve --quiet pull.toml out.h5 -o run.h5", ranks)));
    const Store run = Store::open(place / "run.h5");
    const auto x = run.read<double>("/history/probe/back"), f = run.read<double>("/history/motion/front");
    EXPECT_NEAR((x[x.size() - 8] - x[1]) / (1000 / 2e7), 1, 1e-3);
    EXPECT_NEAR(f[f.size() - 5] / -150, 1, 1e-6) << "1000 Pa on three strips of 0.05 m^2";
  }
}

TEST_F(ImportFolds, AThrownTeeKeepsItsEnergyAndMomenta) {
  imported_deck("tee.geo", tee, "--thickness 0.05");
  place.write("throw.toml", rubber +
                                "[[initial]]\non = [\"up\"]\nvelocity = [2, 0, 3]\nspin = [3, 2, 5]\nabout = [0, 0, 0]\n"
                                "[[initial]]\non = [\"left\", \"right\"]\nvelocity = [0, 1, 0]\n[[probe]]\nname = \"top\"\non = \"top\"\n"
                                "[time]\nend = 0.2\nstep = 0.01\n");
  const auto end = [&](const std::string& command) {
    succeeded(place.run(command + " -o run.h5"));
    const Store run = Store::open(place / "run.h5");
    const auto E = run.read<double>("/history/energy"), p = run.read<double>("/history/momentum"),
               x = run.read<double>("/history/probe/top");
    const size_t n = E.size() / 6;
    for (size_t i = 1; i < n; ++i) {
      EXPECT_NEAR((E[6 * i] + E[6 * i + 1]) / (E[0] + E[1]), 1, 1e-10);
      for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(p[6 * i + k], p[k], 1e-9 * std::abs(p[2]));
    }
    EXPECT_GT(*std::max_element(E.begin() + 1, E.end()), 0);
    return Vec3(x[x.size() - 9], x[x.size() - 8], x[x.size() - 7]);
  };
  end("hilo-solve --quiet throw.toml out.h5");
  const Vec3 one = end("hilo-solve --quiet throw.toml out.h5 --set time.end=0.03");
  EXPECT_LT((end(test::for_ranks + " mpirun -n 2 hilo-solve --quiet throw.toml out.h5 --set time.end=0.03") - one).norm(), 1e-8);
}

// A block by its name, on one rank and on two: the force on it is what holds the plates.
// Two legs of one region that another region joins by its folds.
TEST_F(ImportFolds, WhatBlocksJoinIsNoLoosePiece) {
  Frame f;
  f.strip(0, 0, 0, 1, "LEGS"), f.strip(0, 1, 1, 1, "ROOF"), f.strip(1, 1, 1, 0, "LEGS");
  imported_deck("deck.inp", f.deck("*NSET, NSET=ROOT\n" + f.nodes_at(0, 0), "ROOT,1,6\n", f.load(1, 0, 3, 1.0)),
                "--thicken --scene-out scene.toml");
  const auto ran = succeeded(place.run("hilo-tag out.h5 --linear '*' -o tags.h5"));
  EXPECT_EQ(ran.err.find("pieces"), std::string::npos) << ran.err;
}

TEST_F(ImportFolds, ABlockHasAName) {
  imported_deck("tee.geo", tee, "--thickness 0.05");
  const std::string scene = rubber +
                            "[[motion]]\nkind = \"fixed\"\nname = \"side\"\non = \"side\"\n[time]\nanalysis = \"static\"\n"
                            "[[load]]\nkind = \"force\"\nname = \"f\"\nforce = [0, 0, 0.01]\non = ";
  place.write("f.toml", scene + "\"block_2\"\n[[probe]]\nname = \"p\"\non = \"block_2\"\n");
  for (const char* launcher : {"", "mpirun -n 2 "}) {
    succeeded(place.run("export " + test::for_ranks + "\n" + launcher + "hilo-solve --quiet f.toml out.h5 -o run.h5"));
    const Store run = Store::open(place / "run.h5");
    const auto x = run.read<double>("/history/probe/p"), f = run.read<double>("/history/motion/side");
    EXPECT_LT((Vec3(x[0], x[1], x[2]) - Vec3(0, 1, 0)).norm(), 1e-12) << "node 2 of the mesh";
    EXPECT_GT(x[x.size() - 7], 0);
    EXPECT_NEAR(f[f.size() - 4], -0.01, 1e-8);
  }
  place.write("w.toml", scene + "\"block_99\"\n");
  expect_end(place.run("hilo-solve --quiet w.toml out.h5 -o w.h5"), 2, "no region, set or body \"block_99\"");
}

// One of three linear regions that are one body moves at the start: it took the whole body along.
TEST_F(ImportFolds, APartOfALinearBodyHasAVelocityOfItsOwn) {
  imported_deck("tee.geo", tee, "--thickness 0.05");
  ASSERT_EQ(place.run("hilo-tag out.h5 --rest linear -o tags.h5").exit, 0);
  place.write("part.toml", rubber + "[[initial]]\non = [\"up\"]\nvelocity = [0, 0, 1]\n[time]\nend = 0.01\nstep = 0.01\n");
  succeeded(place.run("hilo-solve --quiet part.toml tags.h5 -o run.h5"));
  EXPECT_NEAR(Store::open(place / "run.h5").read<double>("/history/momentum")[2], 50, 1e-9);
}

}  // namespace
}  // namespace hilo::test::import_folds_test
