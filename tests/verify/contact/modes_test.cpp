// SPDX-License-Identifier: GPL-3.0-or-later
// Modes about a state in contact, and starts from equilibrium in contact: closed forms of rods, balls and boxes that lie on something.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::contact_modes_test {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;
const double ratio = 2 * (1 - 0.3) / (2 - 0.3);  // of tangential and normal stiffness

struct Place : Case {
  Place() : Case("contact") {}
  Results run(const std::string& scene, const std::string& options = "") const {
    std::ofstream(*this / "scene.toml") << scene;
    succeeded(Case::run("hilo-solve --quiet scene.toml " + options + " -o run.h5"));
    return Results(*this / "run.h5");
  }
  Eigen::VectorXd frequencies(const std::string& scene, const std::string& options = "") const {
    return run(scene, options).history("mode").col(0).tail(run_modes_);
  }
  int run_modes_ = 6;
};

std::string modes(int n) { return fmt::format("[time]\nanalysis = \"modes\"\nstart = \"equilibrium\"\nmodes = {}\n", n); }

/// A body of 2 kg with a skin that lies on the ground.
std::string lies(const std::string& skin, const Vec3& J, double z, const std::string& contact) {
  return fmt::format(
      "gravity = [0, 0, -9.81]\n[[body]]\nname = \"part\"\nmass = 2\ncom = [0, 0, {3}]\ninertia = [{0}, {1}, {2}]\n[[obstacle]]\nkind = "
      "\"plane\"\nname = \"ground\"\n[[obstacle]]\n{4}\nname = \"skin\"\non = \"part\"\nat = [0, 0, {3}]\n[[contact]]\nname = \"c\"\na = "
      "\"ground\"\nb = \"skin\"\n{5}\n",
      J[0], J[1], J[2], z, skin, contact);
}

// Truth: a mass on a contact spring, sqrt(k/m); where friction holds, sqrt(3.5 kt/m) of a ball against its rolling, which nothing resists.
TEST(ContactModes, ABallLiesOnAPlane) {
  const Place c;
  const double R = 0.1, J = 0.4 * 2 * R * R, k = 1e5, K = 1e7, depth = std::pow(2 * g / K, 2. / 3);
  const auto at = [&](const std::string& contact) {
    return c.frequencies(lies("kind = \"sphere\"\nradius = 0.1", Vec3::Constant(J), R, contact) + modes(6));
  };
  const double f = std::sqrt(k / 2) / (2 * pi), stuck = std::sqrt(3.5 * ratio * k / 2) / (2 * pi);
  const Eigen::VectorXd slides = at(fmt::format("stiffness = {}", k));
  EXPECT_NEAR(slides[5], f, 1e-7 * f);
  EXPECT_LT(slides.head(5).cwiseAbs().maxCoeff(), 1e-4 * f) << "nothing else is held";
  const Eigen::VectorXd sticks = at(fmt::format("stiffness = {}\nfriction = 0.3", k));
  EXPECT_LT(sticks.head(3).cwiseAbs().maxCoeff(), 1e-4 * f) << "it rolls and spins";
  EXPECT_NEAR(sticks[3], f, 1e-7 * f);
  EXPECT_NEAR(sticks[4], stuck, 1e-6 * stuck);
  EXPECT_NEAR(sticks[5], stuck, 1e-6 * stuck);
  const double E = K / (4. / 3 * std::sqrt(R)), hertz = std::sqrt(1.5 * K * std::sqrt(depth) / 2) / (2 * pi);
  EXPECT_NEAR(at(fmt::format("modulus = {:.17g}", E))[5], hertz, 1e-6 * hertz);
}

// Truth: four corners: 4 k/m, 4 k a^2/J of rocking, less the weight above them, and with friction 4 kt (a^2 + b^2)/J of turning about the
// vertical, which is free without.
TEST(ContactModes, ABoxLiesOnItsCorners) {
  const Place c;
  const double k = 1e5, a = 0.3, b = 0.2, J = 0.1;
  const auto at = [&](const std::string& friction) {
    const Eigen::VectorXd f = c.frequencies(
        lies("kind = \"box\"\nsize = [0.6, 0.4, 0.2]", {0.05, 0.07, J}, 0.1, fmt::format("stiffness = {}\n{}", k, friction)) + modes(6));
    return std::vector<double>(f.begin(), f.end());
  };
  const auto has = [](const std::vector<double>& list, double f) {
    return std::ranges::any_of(list, [&](double x) { return std::abs(x - f) < 1e-6 * f; });
  };
  const auto of = [&](double stiffness, double inertia) { return std::sqrt(stiffness / inertia) / (2 * pi); };
  const auto slides = at("");
  EXPECT_TRUE(has(slides, of(4 * k, 2)));
  EXPECT_TRUE(std::ranges::any_of(slides, [&](double x) { return std::abs(x / of(4 * k * b * b, 0.05) - 1) < 2e-4; }));
  EXPECT_TRUE(std::ranges::any_of(slides, [&](double x) { return std::abs(x / of(4 * k * a * a, 0.07) - 1) < 2e-4; }));
  EXPECT_EQ(std::ranges::count_if(slides, [](double x) { return std::abs(x) < 1e-3; }), 3);
  const auto sticks = at("friction = 0.5");
  EXPECT_TRUE(has(sticks, of(4 * k, 2)));
  EXPECT_TRUE(has(sticks, of(4 * ratio * k * (a * a + b * b), J)));
  EXPECT_EQ(std::ranges::count_if(sticks, [](double x) { return std::abs(x) < 1e-3; }), 0) << "it is held";
}

// Truth: 4 kt (a^2 + b^2)/J of turning about the vertical, as a run in time shows it.  A push of more than mu m g slides the box against a
// spring; there every corner is at its limit, and holds once a vibration has turned.
TEST(ContactModes, WhatSlidToItsPlaceHolds) {
  Place c;
  const double k = 1e5, truth = std::sqrt(4 * ratio * k * (0.09 + 0.04) / 0.1) / (2 * pi);
  const std::string box = lies("kind = \"box\"\nsize = [0.6, 0.4, 0.2]", {0.05, 0.07, 0.1}, 0.1, "stiffness = 1e5\nfriction = 0.2") +
                          "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"part\"\nforce = [10, 0, 0]\nat = [0, 0, 0.1]\n"
                          "[[spring]]\nkind = \"bushing\"\nname = \"s\"\na = \"ground\"\nb = \"part\"\nat = [0, 0, 0.1]\nstiffness = [1e4, "
                          "1, 1]\n";
  const Eigen::VectorXd f = c.frequencies(box + modes(6));
  EXPECT_GT(f.minCoeff(), 10) << "it is held";
  EXPECT_LT((f.array() / truth - 1).abs().minCoeff(), 1e-4);
  const Results r =
      c.run(box +
            "[[initial]]\non = [\"part\"]\nspin = [0, 0, 1e-5]\n[[probe]]\nname = \"side\"\non = \"part\"\nat = [0.3, 0, 0.1]\n"
            "[time]\nstart = \"equilibrium\"\nend = 0.3\nstep = 1e-4\n");
  const Eigen::VectorXd y = r.history("probe/side").col(1);
  const double mean = y.tail(2500).mean();
  std::vector<double> rises;  // through its mean, once it has turned
  for (Eigen::Index i = 501; i < y.size(); ++i)
    if (y[i - 1] < mean && y[i] >= mean) rises.push_back(r.t()[i] - 1e-4 * (y[i] - mean) / (y[i] - y[i - 1]));
  ASSERT_GT(rises.size(), 20u);
  EXPECT_NEAR(static_cast<double>(rises.size() - 1) / (rises.back() - rises.front()) / truth, 1, 5e-3);
}

// Truth: a ball of radius R, d deep in a bowl of radius a at its bottom, a sphere or heights of a paraboloid: sqrt(g/(a - R + d)).
TEST(ContactModes, ABallLiesInABowl) {
  const Place c;
  std::ofstream grid(c / "bowl.csv");
  grid << "y\\x,-0.5,-0.3,-0.1,0.1,0.3,0.5\n";
  for (const double y : {-0.5, -0.2, 0., 0.2, 0.5}) {
    grid << y;
    for (const double x : {-0.5, -0.3, -0.1, 0.1, 0.3, 0.5}) grid << fmt::format(",{:.17g}", (x * x + y * y) / 2);
    grid << "\n";
  }
  grid.close();
  const double k = 1e5, truth = std::sqrt(g / (1 - 0.1 + 2 * g / k)) / (2 * pi);
  for (const char* bowl :
       {"kind = \"height-field\"\nfile = \"bowl.csv\"", "kind = \"sphere\"\nradius = 1\nat = [0, 0, 1]\ninside = true"}) {
    std::string scene = lies("kind = \"sphere\"\nradius = 0.1", Vec3::Constant(0.008), 0.1, "stiffness = 1e5") + modes(6);
    scene.replace(scene.find("kind = \"plane\""), 14, bowl);
    const Eigen::VectorXd f = c.frequencies(scene);
    EXPECT_LT(f.head(3).cwiseAbs().maxCoeff(), 1e-4 * truth) << bowl;
    EXPECT_NEAR(f[3], truth, 1e-5 * truth) << bowl;
    EXPECT_NEAR(f[4], truth, 1e-5 * truth) << bowl;
    EXPECT_NEAR(f[5], std::sqrt(k / 2) / (2 * pi), 1e-5 * f[5]) << bowl;
  }
}

// Truth: what is not pressed is not held.
TEST(ContactModes, WhatIsApartIsFree) {
  const Place c;
  const Eigen::VectorXd f =
      c.frequencies(lies("kind = \"sphere\"\nradius = 0.1", Vec3::Constant(0.008), 0.11, "stiffness = 1e5\nfriction = 0.3") +
                    "[[spring]]\nkind = \"bushing\"\nname = \"s\"\na = \"ground\"\nb = \"part\"\nat = [0, 0, 0.11]\nstiffness = [1e5, 2e5, "
                    "3e5]\n[time]\nanalysis = \"modes\"\nmodes = 6\n");
  EXPECT_NEAR(f[5], std::sqrt(3e5 / 2) / (2 * pi), 1e-5 * f[5]);
}

const std::string rod_material =
    "gravity = [0, 0, -9.81]\n[material.m]\nE = 1e9\nnu = 0\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n";
std::string sides(const std::string& region) {
  std::string out;
  for (const char* side : {"xmin", "xmax", "ymin", "ymax"})
    out += fmt::format("[[motion]]\nkind = \"fixed\"\nname = \"{0}{1}\"\non = \"{0}{1}\"\ncomponents = [\"{2}\"]\n", region, side, side[0]);
  return out;
}
/// Lowest beta of beta tan(beta L) = 1/l, the n-th root counted from zero.
double root(double L, double l, int n) {
  double low = (n * pi + 1e-9) / L, high = ((n + 0.5) * pi - 1e-9) / L;
  for (int i = 0; i < 100; ++i) {
    const double x = (low + high) / 2;
    (x * std::tan(x * L) < 1 / l ? low : high) = x;
  }
  return low;
}

// Truth: a rod, free at the top, on a layer of stiffness E/l at its foot: beta tan(beta L) = 1/l; the mesh adds (beta l)^2/24.
TEST(ContactModes, ARodIsPressedAgainstAPlane) {
  Place c;
  BlockOptions o;
  o.n[2] = 40, o.high = Vec3(0.1, 0.1, 2);
  c.use(block_mesh(o), {Fidelity::nonlinear});
  c.run_modes_ = 2;
  const Eigen::VectorXd f = c.frequencies(
      rod_material + sides("") +
          "[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"zmin\"\n" + modes(2),
      "tags.h5");
  for (int n = 0; n < 2; ++n) {
    const double beta = root(2, 0.05, n), truth = 1000 * beta / (2 * pi);
    EXPECT_NEAR(f[n] / truth - 1, beta * beta * 0.05 * 0.05 / 24, 1e-4) << n;
  }
}

/// A rod of 2 m in two regions, the upper one on the lower one, which is held.
struct Stack : Place {
  explicit Stack(double gap = 0) {
    BlockOptions A, B;
    A.regions = {"A"}, B.regions = {"B"};
    A.n[2] = B.n[2] = 20, A.high = Vec3(0.1, 0.1, 1), B.low = Vec3(0, 0, 1 + gap), B.high = Vec3(0.1, 0.1, 2 + gap);
    use(together(block_mesh(A), block_mesh(B)), {Fidelity::nonlinear, Fidelity::nonlinear});
    run_modes_ = 2;
  }
  std::string scene() const {
    return rod_material + sides("A") + sides("B") +
           "[[motion]]\nkind = \"fixed\"\nname = \"foot\"\non = \"Azmin\"\n[[contact]]\nname = \"c\"\na = \"Azmax\"\nb = \"Bzmin\"\n";
  }
};

// Truth: weight above, W = rho g A; the layers between, l/E of both sides in series, are pressed by 2 l p/E; then nothing moves.
TEST(ContactModes, SurfacesStartFromEquilibrium) {
  for (const double gap : {0., 1e-3, -1e-3, 0.5}) {
    const Stack c(gap);
    const Results r = c.run(
        c.scene() + "[[probe]]\nname = \"top\"\non = \"Bzmax\"\n[time]\nstart = \"equilibrium\"\nend = 0.02\nstep = 0.001\n", "tags.h5");
    const auto f = r.history("contact/c"), x = r.history("probe/top"), e = r.history("energy");
    const double W = 1000 * g * 0.01, p = 1000 * g;
    EXPECT_NEAR(f(f.rows() - 1, 2), W, 1e-9 * W) << gap;
    EXPECT_NEAR(f(0, 3), 2 * 0.05 * p / 1e9, 1e-4 * 1e-6) << gap;
    // each half sinks by p L/(2E), A by p L/E more under B
    EXPECT_NEAR(x(0, 2) - (2 + gap), -gap - p / 1e9 * (0.5 + 1 + 0.5 + 0.1), 1e-4 * 2e-5) << gap;
    EXPECT_LT((x.rowwise() - x.row(0)).leftCols(3).cwiseAbs().maxCoeff(), 1e-9) << gap;
    EXPECT_LT(e.col(0).maxCoeff(), 1e-12) << gap;
    EXPECT_LT((e.col(5).array() - e(0, 5)).abs().maxCoeff(), 1e-11) << gap;
  }
}

// Truth: what friction can hold stays where it is drawn, on a slope of 0.2, by forces m g; of a slope it cannot hold there is no
// equilibrium.
TEST(ContactModes, FrictionHoldsFromTheStart) {
  const Place c;
  const std::string box = lies("kind = \"box\"\nsize = [0.6, 0.4, 0.2]", {0.05, 0.07, 0.1}, 0.1, "stiffness = 1e5\nfriction = 0.5");
  const std::string time = "[time]\nstart = \"equilibrium\"\nend = 0.1\nstep = 0.002\n";
  const Results r = c.run(box + time, "--set 'gravity=[1.962,0,-9.81]'");
  const auto e = r.history("energy"), f = r.history("contact/c");
  EXPECT_LT(e.col(0).maxCoeff(), 1e-12);
  EXPECT_NEAR(f(f.rows() - 1, 0), -2 * 1.962, 1e-6);
  EXPECT_NEAR(f(f.rows() - 1, 2), 2 * 9.81, 1e-6);
  EXPECT_LT((e.col(5).array() - e(0, 5)).abs().maxCoeff(), 1e-11);
  std::ofstream(c / "scene.toml") << box + time;
  const Ran ran = static_cast<const Case&>(c).run("hilo-solve --quiet scene.toml --set 'gravity=[6,0,-9.81]' -o run.h5");
  EXPECT_EQ(ran.exit, 3) << ran.err;
  // two blocks of cells that nothing else holds sideways, drawn a millimetre apart, the upper one rigid or not
  for (const Fidelity upper : {Fidelity::nonlinear, Fidelity::rigid}) {
    BlockOptions A, B;
    A.regions = {"A"}, B.regions = {"B"};
    A.n[0] = A.n[1] = A.n[2] = 3, A.high = Vec3(1, 1, 0.3), B.n[0] = B.n[1] = B.n[2] = 2, B.low = Vec3(0.1, 0.1, 0.301),
    B.high = Vec3(0.9, 0.9, 0.6);
    Place two;
    two.use(together(block_mesh(A), block_mesh(B)), {Fidelity::nonlinear, upper});
    const Results s = two.run(
        "gravity = [1, 0, -9.81]\n[material.m]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n"
        "[[motion]]\nkind = \"fixed\"\nname = \"foot\"\non = \"Azmin\"\n[[contact]]\nname = \"c\"\na = \"A\"\nb = \"B\"\nfriction = 0.4\n" +
            time,
        "tags.h5");
    const double m = 1000 * 0.64 * 0.299;
    const auto F = s.history("contact/c");
    EXPECT_NEAR(F(F.rows() - 1, 0), -m, 1e-3 * m) << word(upper);
    EXPECT_NEAR(F(F.rows() - 1, 2), 9.81 * m, 1e-3 * m) << word(upper);
    EXPECT_LT(s.history("energy").col(0).maxCoeff(), 1e-8) << word(upper);
  }
}

// Drawn in touch, but for rounding: the program ended with signal 11.  In the first millisecond the pile weighs on its foot a little, and
// nothing is lost.
TEST(ContactModes, APileDrawnInTouchRuns) {
  for (const double off : {0.0, 3e-17, -3e-17}) {
    BlockOptions A, B, C;
    A.regions = {"A"}, B.regions = {"B"}, C.regions = {"C"};
    for (BlockOptions* one : {&A, &B, &C}) one->n[0] = one->n[1] = one->n[2] = 2;
    A.high = Vec3(0.2, 0.2, 0.1);
    B.low = Vec3(0.013, 0, 0.1 - off), B.high = Vec3(0.213, 0.2, 0.2);
    C.low = Vec3(0.026, 0, 0.1 + 0.2 - 0.1 + off), C.high = Vec3(0.226, 0.2, 0.3);
    Place c;
    c.use(together(block_mesh(A), block_mesh(B), block_mesh(C)), {Fidelity::nonlinear, Fidelity::nonlinear, Fidelity::nonlinear});
    const Results r = c.run(
        "gravity = [0, 0, -9.81]\n[material.m]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n"
        "[[motion]]\nkind = \"fixed\"\nname = \"foot\"\non = \"Azmin\"\n[[contact]]\nname = \"c\"\na = \"A\"\nb = \"B\"\nfriction = 0.3\n"
        "[[contact]]\nname = \"d\"\na = \"B\"\nb = \"C\"\nfriction = 0.3\n[time]\nend = 0.001\nstep = 0.0002\n",
        "tags.h5");
    const auto E = r.history("energy");
    EXPECT_GT(E(E.rows() - 1, 0), 0) << off;
    EXPECT_LT(E.col(5).cwiseAbs().maxCoeff(), 1e-11) << off;
  }
}

// Truth: two rods with the layers between them: beta tan(beta L) = 2 k/E = 1/l, k = E/(2 l).
TEST(ContactModes, ARodStandsOnAnother) {
  const Stack c;
  const Eigen::VectorXd f = c.frequencies(c.scene() + modes(2), "tags.h5");
  const double truth = 1000 * root(2, 0.05, 0) / (2 * pi);
  EXPECT_NEAR(f[0], truth, 2e-4 * truth);
  EXPECT_GT(f[1], 2.5 * truth);
}

// Truth: without contact the upper part falls for ever, and the run says so.
TEST(ContactModes, WhatLiesOnNothingHasNoEquilibrium) {
  const Stack c(0.01);
  std::ofstream(c / "scene.toml") << c.scene() + "[time]\nstart = \"equilibrium\"\nend = 0.02\nstep = 0.001\n";
  const Ran ran = static_cast<const Case&>(c).run("hilo-solve --quiet scene.toml tags.h5 --set 'gravity=[0,0,9.81]' -o run.h5");
  EXPECT_EQ(ran.exit, 3) << ran.err;
}

}  // namespace
}  // namespace hilo::test::contact_modes_test
