// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of folds of which one motion holds a component, and something else the block as well: its own motion, a joint, a spring.
#include "../scene_parts.hpp"
#include "import_case.hpp"

namespace hilo::test::held_folds_test {
namespace {

constexpr double E = 2e11, L = 0.2, stress = 1e6;

/// An angle that is pulled along its fold.
class HeldFolds : public Import {
 protected:
  void SetUp() override {
    Import::SetUp();
    imported_deck("angle.geo",
                  "Point(1) = {0, 0, 0}; Point(2) = {.1, 0, 0}; Point(3) = {0, .1, 0}; Line(1) = {1, 2}; Line(2) = {1, 3};\n"
                  "Transfinite Curve{1, 2} = 3; s() = Extrude {0, 0, .2} { Curve{1:2}; Layers{2}; Recombine; };\n"
                  "Physical Surface(\"angle\") = {s(1), s(5)}; Physical Curve(\"foot\") = {1, 2};\n"
                  "Physical Curve(\"head\") = {s(0), s(4)}; Physical Point(\"corner\") = {1};\n",
                  "--thickness 0.004");
  }
  const std::string steel = solid(E, 0, 7850), foot = held("foot", "z"),
                    pull = load("traction", "pull", "head", fmt::format("traction = [0, 0, {}]", stress)), head = probe("head");
  std::string command = "hilo-solve --quiet run.toml out.h5 -o run.h5";

  Store solved(const std::string& scene) {
    place.write("run.toml", scene);
    succeeded(place.run("export " + for_ranks + "\n" + command), scene);
    return Store::open(place / "run.h5");
  }
  Vec3 way(const std::string& scene) {
    const auto x = solved(scene).read<double>("/history/probe/head");
    const size_t n = x.size() - 9;
    return Vec3(x[n] - x[0], x[n + 1] - x[1], x[n + 2] - x[2]);
  }
  double first_mode(const std::string& scene) { return solved(scene).read<double>("/history/mode")[10]; }
};

const std::vector<std::string> holds = {
    motion("fixed", "all", "corner", ""),
    joint("fixed", "hold", "ground", "block_1", Vec3::Zero()),
    joint("fixed", "hold", "ground", "near", Vec3::Zero()) + "[set.near]\nkind = \"ball\"\nat = [0, 0, 0]\nradius = 0.006\n",
};

// Twice held is held: nu = 0, so the strain along is stress/E.  It overran the rows of a joint of no body.
TEST_F(HeldFolds, BearWhatHoldsThemWholeBesides) {
  const auto bears = [&](const std::string& hold, const std::string& both) {
    const Vec3 to = way(steel + both + pull + head + in_steps(1));
    EXPECT_NEAR(to.z() / (stress / E * L), 1, 1e-4) << hold;
    EXPECT_LT(std::hypot(to.x(), to.y()), 1e-3 * to.z()) << hold;
  };
  for (const std::string& hold : holds) bears(hold, foot + hold);
  bears(holds[1], holds[1] + foot);
  command = "mpirun -n 2 " + command;
  bears(holds[1], foot + holds[1]);
}

TEST_F(HeldFolds, VibrateAndMoveAlikeHoweverHeld) {
  std::vector<double> f, z;
  for (const std::string& hold : holds) {
    f.push_back(first_mode(steel + foot + hold + "[time]\nanalysis = \"modes\"\nmodes = 2\n"));
    z.push_back(way(steel + foot + hold + pull + head + in_time(1e-4, 1e-5)).z());
  }
  for (size_t k = 1; k < holds.size(); ++k) {
    EXPECT_NEAR(f[k] / f[0], 1, 1e-8);
    EXPECT_NEAR(z[k] / z[0], 1, 1e-8);
  }
}

// A spring and a body on a ball joint take nothing from what holds z.
TEST_F(HeldFolds, CarrySpringsAndBodies) {
  const std::string spring_on = "at = [0, 0, 0]\nstiffness = [1e6, 1e6, 1e6]\nangular_stiffness = [1e4, 1e4, 1e4]";
  const std::string soft = spring("bushing", "soft", "ground", "block_1", spring_on);
  const std::string carried = body("B", 1, {0, 0, 0.05}, {1e-3, 1e-3, 1e-3}) + joint("spherical", "ball", "B", "block_1", Vec3::Zero()) +
                              spring("bushing", "soft", "ground", "B", spring_on) + joint("fixed", "hold", "ground", "sides", {.1, 0, .1}) +
                              "[set.sides]\nkind = \"box\"\nlow = [0.09, -1, -1]\nhigh = [1, 1, 1]\n";
  EXPECT_NEAR(way(steel + foot + soft + pull + head + in_steps(1)).z() / (stress / E * L), 1, 1e-4);
  for (const std::string& time : {in_steps(1), in_time(1e-4, 1e-5), std::string("[time]\nanalysis = \"modes\"\nmodes = 2\n")})
    solved(steel + foot + carried + pull + head + time);
}

TEST_F(HeldFolds, RefuseAMotionAgainstThem) {
  const auto moved = [](const Vec3& by) { return motion("translation", "all", "corner", "displacement = " + list(by)); };
  place.write("run.toml", steel + foot + moved({0, 0, 1e-4}) + in_steps(1));
  expect_end(place.run("hilo-solve --quiet run.toml out.h5 -o run.h5"), 2,
             "motion \"foot z\" holds single components of nodes of block_1, which motion \"all\" moves");
  EXPECT_LT((way(steel + foot + moved({1e-4, 0, 0}) + head + in_steps(1)) - Vec3(1e-4, 0, 0)).norm(), 1e-9) << "aside it goes along";
}

// A quarter of a square tube that is pulled.  The block of a fold keeps the thickness there, where metal would thin: the strain of the page
// against stress/E of n cells in half a side.
TEST_F(HeldFolds, KeepTheirThickness) {
  int n = 1;
  for (const double share : {0.976, 0.985, 0.993, 0.996}) {
    imported_deck(
        "side.geo",
        fmt::format("Point(1) = {{0, 0, 0}}; Point(2) = {{.05, 0, 0}}; Point(3) = {{0, .05, 0}}; Line(1) = {{1, 2}}; Line(2) = {{1, 3}};\n"
                    "Transfinite Curve{{1, 2}} = {}; s() = Extrude {{0, 0, .2}} {{ Curve{{1:2}}; Layers{{4}}; Recombine; }};\n"
                    "Physical Surface(\"side\") = {{s(1), s(5)}}; Physical Curve(\"foot\") = {{1, 2}};\n"
                    "Physical Curve(\"head\") = {{s(0), s(4)}}; Physical Curve(\"x\") = {{s(2)}}; Physical Curve(\"y\") = {{s(6)}};\n",
                    n + 1),
        "--thickness 0.004");
    const Vec3 to = way(solid(E, 0.3, 7850) + foot + held("x", "x") + held("y", "y") + pull + head + in_steps(1));
    std::printf("%d cells: %.4f\n", n, to.z() / (stress / E * L));
    EXPECT_NEAR(to.z() / (stress / E * L), share, 1e-3);
    n *= 2;
  }
}

}  // namespace
}  // namespace hilo::test::held_folds_test
