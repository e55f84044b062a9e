// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that are tied though their meshes do not match: patch tests, momenta in free flight, and closed forms.
#include <numbers>

#include "verify/contact/collision.hpp"
#include "verify/ties/tied_blocks.hpp"

namespace hilo::test::ties_test {
namespace {

using Map = std::function<Vec3(const Vec3&)>;

/// A bar that rings, held at one end.
std::string rings(const std::string& guide) {
  return solid(2e11, 0, 8000) + tie() + held("Azmin") + guide + "[time]\nanalysis = \"modes\"\nmodes = 3\n";
}

/// Two blocks of 1 x 1 x .5 m, one on the other.
Mesh stack(Shape a, Shape b, int n_a, int n_b, const Map& map_a = nullptr, const Map& map_b = nullptr) {
  Mesh m = together(block_mesh({.shape = a, .n = {n_a, n_a, 2}, .high = {1, 1, 0.5}, .map = map_a, .regions = {"A"}}),
                    block_mesh({.shape = b, .n = {n_b, n_b, 2}, .low = {0, 0, 0.5}, .map = map_b, .regions = {"B"}}));
  add_node_set(m, "side", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
  add_node_set(m, "back", [](const Vec3& x) { return std::abs(x[1]) < 1e-9; });
  return m;
}

/// Largest distance of the displacements from the linear field that fits them best, over the largest displacement; and its slope dz/dz.
std::pair<double, double> off_linear(const std::vector<Vec3>& X, const std::vector<Vec3>& u) {
  Eigen::MatrixXd A(X.size(), 4), B(X.size(), 3);
  for (size_t i = 0; i < X.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    A.row(k) << 1, X[i].transpose();
    B.row(k) = u[i].transpose();
  }
  const Eigen::MatrixXd F = A.colPivHouseholderQr().solve(B);
  return {(A * F - B).cwiseAbs().maxCoeff() / B.cwiseAbs().maxCoeff(), F(3, 2)};
}

// Truth: uniform stress is a linear field, p/E along it.
TEST(Ties, PatchAcrossMeshesThatDoNotMatch) {
  using enum Shape;
  for (const auto& [a, b] : {std::pair{hex8, hex8}, {tet4, hex8}, {hex8, wedge6}, {hex20, tet10}, {tet10, wedge15}, {hex8, hex20}}) {
    SceneCase c(pulled(0.3, 1, planes));
    const Mesh mesh = stack(a, b, 2, 3);
    c.use(mesh);
    const Results r = c.solved();
    const auto [off, slope] = off_linear(mesh.X, r.field("displacement"));
    EXPECT_LT(off, 1e-9) << text_of(c / "run.json") << info(a).name << " " << info(b).name;
    EXPECT_NEAR(slope, 1e-4, 5e-8) << info(a).name << " " << info(b).name;
    const Eigen::VectorXd carried = r.at("tie/weld", 1), pull = -Eigen::VectorXd::Unit(6, 2);
    EXPECT_LT((carried - pull).norm(), 1e-9) << carried.transpose() << info(a).name << " " << info(b).name;
  }
}

/// Largest change in a step: of energy over the largest, of both momenta over those of the parts.
struct Kept {
  double energy = 0, momentum = 0, angular = 0;
  explicit Kept(const Results& r) {
    const auto e = r.history("energy"), p = r.history("momentum");
    for (Eigen::Index k = 1; k < e.rows(); ++k) {
      energy = std::max(energy, std::abs(e(k, 5) - e(k - 1, 5)) / e.col(0).maxCoeff());
      momentum = std::max(momentum, (p.row(k) - p.row(k - 1)).head<3>().norm() / 1000);
      angular = std::max(angular, (p.row(k) - p.row(k - 1)).tail<3>().norm() / 1000);
    }
  }
};

/// The stack with a common surface that is curved, so that nodes of one side lie off the facets of the other.
Mesh bent(Shape a, Shape b, int n = 3) {
  const auto rise = [](const Vec3& x) { return 0.08 * std::sin(std::numbers::pi * x[0]) * (1 + x[1]); };
  return stack(
      a, b, n, n + 1, [=](const Vec3& x) { return Vec3(x + Vec3(0, 0, 2 * x[2] * rise(x))); },
      [=](const Vec3& x) { return Vec3(x + Vec3(0, 0, 2 * (1 - x[2]) * rise(x))); });
}

// Truth: nothing acts from outside.  Parts have momenta of about 1000 kg m/s and kg m^2/s.
TEST(Ties, CurvedOnesKeepEnergyAndMomenta) {
  using enum Shape;
  using enum Fidelity;
  for (const auto& [a, b, level] :
       {std::tuple{hex8, hex8, nonlinear}, {tet4, hex8, nonlinear}, {hex20, tet10, nonlinear}, {wedge6, hex8, rigid}}) {
    SceneCase c(flight());
    c.use(bent(a, b, 2), {level, nonlinear});
    const Results r = c.solved();
    const Kept kept(r);
    const std::string what = fmt::format("{} {} {}", info(a).name, info(b).name, word(level));
    EXPECT_LT(kept.energy, 1e-11) << what;
    EXPECT_LT(kept.momentum, 1e-12) << what;
    EXPECT_LT(kept.angular, 1e-12) << what;
    EXPECT_GT(r.history("energy").col(1).maxCoeff(), 1) << what << ": it shakes";
    const double moved = c.reported("largest_move");
    EXPECT_TRUE(moved > 1e-4 && moved < 0.05) << what << ": " << moved;
  }
}

// The same for linear regions: nodes by themselves, and where they are many by smooth functions.
TEST(Ties, OfLinearRegionsKeepEnergyAndMomenta) {
  using enum Fidelity;
  for (const auto& [n, a, b] : {std::tuple{2, linear, nonlinear},
                                {2, nonlinear, linear},
                                {2, linear, linear},
                                {2, rigid, linear},
                                {2, linear, rigid},
                                {8, nonlinear, linear},
                                {8, linear, linear}}) {
    SceneCase c(flight());
    c.use(bent(Shape::hex8, Shape::hex8, n), {a, b});
    const Results r = c.solved();
    const Kept kept(r);
    const std::string what = fmt::format("{} {} {}", n, word(a), word(b));
    EXPECT_LT(kept.energy, 1e-11) << what;
    EXPECT_LT(kept.momentum, 1e-12) << what;
    EXPECT_LT(kept.angular, 1e-12) << what;
    EXPECT_GT(r.history("energy").col(1).maxCoeff(), 1) << what << ": it shakes";
  }
}

// Truth: uniform stress is a linear field.  Strain is 1e-7, by which that of Green and Lagrange differs.
TEST(Ties, PatchOfLinearRegions) {
  using enum Fidelity;
  for (const auto& [n, a, b] : {std::tuple{2, linear, nonlinear},
                                {2, nonlinear, linear},
                                {2, linear, linear},
                                {8, linear, nonlinear},
                                {8, nonlinear, linear},
                                {8, linear, linear}}) {
    SceneCase c(pulled(0, 1e-3, held("Azmin")));
    const Mesh mesh = stack(Shape::hex8, Shape::hex8, n, n + 1);
    c.use(mesh, {a, b});
    const Results r = c.solved();
    const std::string what = fmt::format("{} {} {}", n, word(a), word(b));
    const auto [off, slope] = off_linear(mesh.X, r.field("displacement"));
    EXPECT_LT(off, 2e-7) << what;
    EXPECT_NEAR(slope, 1e-7, 1e-13) << what;
    const Eigen::VectorXd carried = r.at("tie/weld", 1), pull = -1e-3 * Eigen::VectorXd::Unit(6, 2);
    EXPECT_LT((carried - pull).norm(), 1e-11) << what << ": " << carried.transpose();
  }
}

// Truth: the run that names the rigid side as a; forces are those on the other side.
TEST(Ties, OfARigidBAreThoseOfARigidA) {
  SceneCase c(flight());
  c.use(bent(Shape::hex8, Shape::hex8, 2), {Fidelity::rigid, Fidelity::nonlinear});
  const Results r = c.solved();
  c.write("turned.toml", flight(tie("Bzmin", "Azmax", "gap = 0.05")));
  const Results turned = c.solved("", "turned.h5", "turned");
  const auto e = r.history("energy"), f = r.history("tie/weld");
  EXPECT_GT(f.cwiseAbs().maxCoeff(), 1);
  EXPECT_LT((turned.history("energy") - e).cwiseAbs().maxCoeff(), 1e-12 * e.col(0).maxCoeff());
  EXPECT_LT((turned.history("tie/weld") + f).cwiseAbs().maxCoeff(), 1e-9 * f.cwiseAbs().maxCoeff());
}

// Truth: the mean of the gap over facets that move stays zero, so that surfaces stay together to their sag.
TEST(Ties, EveryIntegratorHoldsThem) {
  for (const std::string method : {"mid-point", "bdf2", "generalized-alpha", "bathe", "U0", "V0", "radau", "gauss"}) {
    SceneCase c(flight());
    c.use(bent(Shape::hex8, Shape::hex8, 2));
    const std::string end = method == "gauss" ? "0.01" : "0.04";  // it is slow where no step resolves the waves
    c.solve("--set time.end=" + end + " --set 'time.integrator=\"" + method + "\"'");
    const Kept kept(c.results());
    EXPECT_LT(kept.momentum, 1e-9) << method;
  }
}

// Truth: (2 n - 1) c/(4 L) of a bar that is held at one end, c = 5000 m/s.
TEST(Ties, ABarOfTwoMeshesRings) {
  Mesh m = together(block_mesh({.n = {1, 1, 20}, .high = {0.1, 0.1, 1}, .regions = {"A"}}),
                    block_mesh({.n = {2, 2, 30}, .low = {0, 0, 1}, .high = {0.1, 0.1, 2}, .regions = {"B"}}));
  add_node_set(m, "guide", [](const Vec3& x) { return x[2] > 1e-9; });
  SceneCase c(rings(held("guide", "xy")));
  c.use(m);
  const Eigen::MatrixXd f = c.solved().history("mode").bottomRows(3);
  for (int n = 1; n <= 3; ++n) EXPECT_NEAR(f(n - 1, 0) / ((2 * n - 1) * 5000. / 8), 1, 2e-3) << n;
}

// Truth: one mesh, and beams: F L^3/(3 E I) with the shear of Timoshenko.
TEST(Ties, ACantileverOfTwoMeshesBendsAsOne) {
  const auto tip = [](bool tied, Shape a, Shape b) {
    const Mesh lower = block_mesh({.shape = a, .n = {2, 2, tied ? 4 : 8}, .high = Vec3(0.1, 0.1, tied ? 0.5 : 1), .regions = {"A"}});
    Mesh m = tied ? together(lower, block_mesh({.shape = b, .n = {3, 3, 5}, .low = {0, 0, 0.5}, .high = {0.1, 0.1, 1}, .regions = {"B"}}))
                  : lower;
    add_node_set(m, "wall", [](const Vec3& x) { return x[2] < 1e-9; });
    add_node_set(m, "tip", [](const Vec3& x) { return x[2] > 1 - 1e-9; });
    SceneCase c(solid(2e11, 0.3, 8000) + held("wall") + force("tip", "tip", {1e3, 0, 0}) + probe("tip") + fields("\"displacement\"") +
                in_steps(1) + (tied ? tie() : ""));
    c.use(m);
    c.solve();
    if (tied) {  // the law of the lever
      const Eigen::VectorXd carried = c.results().at("tie/weld", 1);
      EXPECT_NEAR(carried[0], -1e3, 1e-5) << info(a).name << " " << info(b).name;
      EXPECT_NEAR(carried[4], -500, 0.1) << carried.transpose() << info(a).name << " " << info(b).name;
    }
    const auto u = c.results().field("displacement");
    double sum = 0, n = 0;
    for (std::int64_t i = 0; i < m.n_nodes(); ++i)
      if (m.X[i][2] > 1 - 1e-9) sum += u[i][0], ++n;
    return sum / n;
  };
  const double one = tip(false, Shape::hex20, Shape::hex20), I = std::pow(0.1, 4) / 12;
  EXPECT_NEAR(one / (1e3 / (3 * 2e11 * I) + 1e3 / (2e11 / 2.6 * 0.01 * 5 / 6)), 1, 0.02) << "the wall holds its width";
  EXPECT_NEAR(tip(true, Shape::hex20, Shape::hex20) / one, 1, 2e-3);
  EXPECT_NEAR(tip(true, Shape::tet10, Shape::hex20) / one, 1, 1e-2);
  EXPECT_NEAR(tip(true, Shape::hex20, Shape::wedge15) / one, 1, 1e-2);
}

// Truth: the same beam by cells alone.  Where all motions of tied nodes are modes, what is left out is that of high modes.
TEST(Ties, LinearRegionsRingAsCellsDo) {
  using enum Fidelity;
  for (const int n : {2, 8}) {
    const Mesh m = together(block_mesh({.n = {n, n, 4}, .high = {0.1, 0.1, 0.5}, .regions = {"A"}}),
                            block_mesh({.n = {n + 1, n + 1, 4}, .low = {0, 0, 0.5}, .high = {0.1, 0.1, 1}, .regions = {"B"}}));
    const auto frequencies = [&](Fidelity a, Fidelity b) {
      SceneCase c(rings(""));
      c.use(m, {a, b});
      return Eigen::VectorXd(c.solved().history("mode").bottomRows(3).col(0));
    };
    const Eigen::VectorXd cells = frequencies(nonlinear, nonlinear);
    for (const auto& [a, b] : {std::pair{linear, nonlinear}, {nonlinear, linear}, {linear, linear}}) {
      const Eigen::VectorXd f = frequencies(a, b);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(f[k] / cells[k], 1, n == 2 ? 1e-7 : 2e-5) << n << word(a) << word(b) << k;
    }
  }
}

// Truth: Timoshenko's cantilever, F L^3/(3 E I) + F L/(k A G).  Its outer part hangs on the tie alone.
TEST(Ties, ALinearPartThatHangsOnOneIsHeld) {
  using enum Shape;
  const Mesh mesh = together(block_mesh({.shape = hex20r, .n = {4, 1, 1}, .high = {1, 0.1, 0.1}, .regions = {"A"}}),
                             block_mesh({.shape = tet10, .n = {3, 2, 2}, .low = {1, 0, 0}, .high = {1.5, 0.1, 0.1}, .regions = {"B"}}));
  const double E = 2e11, F = 1000, L = 1.5, I = std::pow(0.1, 4) / 12;
  const double truth = F * L * L * L / (3 * E * I) + F * L / (5. / 6 * 0.01 * E / 2);
  for (const bool turned : {false, true}) {
    SceneCase c(solid(E, 0, 8000) + (turned ? tie("Bxmin", "Axmax") : tie("Axmax", "Bxmin")) + held("Axmin") +
                force("down", "Bxmax", {0, 0, F}) + probe("tip", "Bxmax") + in_steps(1));
    c.use(mesh, {Fidelity::nonlinear, Fidelity::linear});
    EXPECT_NEAR(c.solved().at("probe/tip", 1)[2] - 0.05, truth, 0.01 * truth) << turned;  // few cells
  }
}

// Three blocks about an edge: its nodes are of two ties, and some of them are held.  Truth: uniform stress.
TEST(Ties, OfAnEdgeAndOfHeldNodes) {
  Mesh m = together(block_mesh({.n = {3, 2, 1}, .high = {1, 1, 0.5}, .regions = {"A"}}),
                    block_mesh({.n = {3, 3, 1}, .low = {0, 0, 0.5}, .high = {0.5, 1, 1}, .regions = {"B"}}),
                    block_mesh({.n = {2, 3, 1}, .low = {0.5, 0, 0.5}, .regions = {"C"}}));
  add_node_set(m, "side", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
  add_node_set(m, "back", [](const Vec3& x) { return std::abs(x[1]) < 1e-9; });
  SceneCase c(pulled(0.3, 1, planes) + tie("Azmax", "Czmin", "", "second") + tie("Cxmin", "Bxmax", "", "third") +
              load("traction", "q", "Czmax", "traction = [0, 0, 1]"));
  c.use(m);
  const auto [off, slope] = off_linear(m.X, c.solved().field("displacement"));
  EXPECT_LT(off, 1e-9);
  EXPECT_NEAR(slope, 1e-4, 5e-8);
}

/// One line with its place, and exit 2, of the flight with another surface b.
void expect_refused(const Mesh& mesh, const std::vector<Fidelity>& levels, const std::string& b, const std::string& words) {
  const bool twentieth = words.find("twentieth") != words.npos;
  SceneCase c(flight(tie("Azmax", b, twentieth ? "" : "gap = 0.05")));
  c.use(mesh, levels);
  const Ran ran = c.run(std::string("hilo-solve --quiet scene.toml ") + (levels.empty() ? "mesh.h5" : "tags.h5"));
  expect_end(ran, 2, words);
  EXPECT_NE(ran.err.find("hilo-solve: scene.toml:1"), std::string::npos) << ran.err;
}

TEST(Ties, ThatCannotBeAreRefused) {
  using enum Fidelity;
  const Mesh good = bent(Shape::hex8, Shape::hex8);
  expect_refused(good, {rigid, rigid}, "Bzmin", "region \"B\" is rigid, and so is the other side");
  expect_refused(good, {}, "Azmax", "a surface is not tied to itself");
  expect_refused(good, {}, "Azmin", "faces one of");
  expect_refused(good, {}, "A", "both surfaces have node");
  expect_refused(good, {}, "side", "\"side\" has no facets");
  expect_refused(good, {}, "Bzmim", "did you mean \"Bzmin\"");
  const Mesh apart = stack(Shape::hex8, Shape::hex8, 3, 4, nullptr, [](const Vec3& x) { return Vec3(x + Vec3(0, 0, 0.06)); });
  expect_refused(apart, {}, "Bzmin", "0.06 m off \"Azmax\", more than 0.0125 m, a twentieth of a facet (");
  SceneCase in_mm("units = \"mm-kg-ms\"\n" + flight(tie("Azmax", "Bzmin", "")));  // what is to be written is in the units of the scene
  in_mm.use(apart, {});
  expect_end(in_mm.run("hilo-solve --quiet scene.toml mesh.h5"), 2, "give gap = 63)");
  const Mesh deep = stack(Shape::hex8, Shape::hex8, 3, 4, nullptr, [](const Vec3& x) { return Vec3(x - Vec3(0, 0, 0.06)); });
  expect_refused(deep, {}, "Bzmin", "0.06 m off \"Azmax\", more than 0.0125 m, a twentieth of a facet (");
  Mesh twice = good;
  const std::vector<Facet> top = twice.facet_sets.at("Azmax");
  twice.facet_sets["Azmax"].insert(twice.facet_sets["Azmax"].end(), top.begin(), top.end());
  expect_refused(twice, {}, "Bzmin", "faces \"Azmax\" in two layers");
}

// Truth: two plates edge to edge, tied by their regions, touch.  Their faces above and below share nothing but an edge, wherever they lie.
TEST(Ties, PlatesEdgeToEdgeTouch) {
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(10, -3, 2), Vec3(-1000, 700, 300)}) {
    for (const double digits : {0.0, 1e-8}) {
      const auto there = [&](const Vec3& x) { return Vec3(Eigen::AngleAxisd(0.7, Vec3(1, 2, 0.5).normalized()) * x + place); };
      SceneCase c(solid(2e11, 0, 8000) + tie("A", "B") + held("Axmin") + "[time]\nanalysis = \"modes\"\nmodes = 1\n");
      c.use(together(block_mesh({.shape = Shape::hex8, .n = {6, 3, 1}, .high = {0.15, 0.06, 0.004}, .map = there, .regions = {"A"}}),
                     block_mesh({.shape = Shape::hex8,
                                 .n = {8, 5, 1},
                                 .low = {0.15 - digits, 0, 0},
                                 .high = {0.3, 0.06, 0.004},
                                 .map = there,
                                 .regions = {"B"}})));
      expect_end(c.solve(), 0, "");
    }
  }
}

// Truth: a strip that stands edge-on on facets fifteen times as wide turns about the nodes in its middle; one that the block follows rings
// at a twentieth of a steel cantilever's frequency or more.
TEST(Ties, AHingeIsTold) {
  for (const bool strip_is_b : {false, true}) {
    SceneCase c(solid(2e11, 0, 8000) + (strip_is_b ? tie("Azmax", "Bzmin") : tie("Bzmin", "Azmax")) + held("Azmin") +
                "[time]\nanalysis = \"modes\"\nmodes = 1\n");
    c.use(together(
        block_mesh({.shape = Shape::tet10, .n = {2, 2, 1}, .high = {0.12, 0.12, 0.1}, .regions = {"A"}}),
        block_mesh({.shape = Shape::hex20r, .n = {2, 1, 3}, .low = {0.01, 0.058, 0.1}, .high = {0.11, 0.062, 0.4}, .regions = {"B"}})));
    const Ran ran = c.solve();
    const double whole = std::pow(1.8751 / 0.3, 2) * std::sqrt(2e11 / 8000 / 12) * 0.004 / (2 * std::numbers::pi);
    const double ratio = c.results().at("mode", 1)(0) / whole;
    if (strip_is_b)
      EXPECT_EQ(ran.err.find("hinge"), std::string::npos) << ran.err;
    else
      expect_end(ran, 0, "tie \"weld\": a hinge about (");
    EXPECT_NEAR(ratio, strip_is_b ? 1 : 0.06, 0.05);
  }
}

}  // namespace
}  // namespace hilo::test::ties_test
