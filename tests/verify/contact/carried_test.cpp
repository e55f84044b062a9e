// SPDX-License-Identifier: GPL-3.0-or-later
// Load steps of bodies that lie on what a law moves, or in the edge of a container: balance of forces.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "succeeded.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::carried_test {
namespace {

constexpr double g = 9.81;

Eigen::VectorXd last(const Results& r, const std::string& history) { return r.history(history).bottomRows(1).transpose(); }

/// A plate that a law moves, and what lies on it with a friction of 0.8: the run of so many load steps.
Results on_moved_plate(const Case& c, const std::string& motion, const std::string& on_it, int steps = 10,
                       const std::string& history = "{t = [0, 1], value = [0, 1]}") {
  std::ofstream(c / "scene.toml")
      << "gravity = [0, 0, -9.81]\n[[body]]\nname = \"plate\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n"
         "[[obstacle]]\nkind = \"plane\"\nname = \"top\"\non = \"plate\"\n[[motion]]\nname = \"m\"\non = \"plate\"\n"
         "history = " +
             history + "\n" + motion +
             "[[contact]]\nname = \"c\"\na = \"top\"\nb = \"it\"\nfriction = 0.8\nstiffness = 1e6\nrestitution = 1\n" + on_it +
             fmt::format("[[probe]]\nname = \"p\"\non = \"b\"\n[time]\nanalysis = \"static\"\nsteps = {}\n", steps);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  return Results(c / "run.h5");
}
std::string moved(double far) { return fmt::format("kind = \"translation\"\ndisplacement = [{}, 0, 0]\n", far); }
std::string turned(const char* axis, double angle) {
  return fmt::format("kind = \"rotation\"\nat = [0, 0, 0]\naxis = {}\nangle = {}\n", axis, angle);
}

constexpr double weight = 2 * g, most = 0.8 * weight;  // and what friction bears [N]
/// A box of 2 kg; on a spring along x, where k is not zero.
std::string box(double x, double k = 0) {
  return fmt::format(
             "[[body]]\nname = \"b\"\nmass = 2\ncom = [{0}, 0, 0.1]\ninertia = [0.02, 0.02, 0.02]\n"
             "[[obstacle]]\nkind = \"box\"\nname = \"it\"\non = \"b\"\nat = [{0}, 0, 0.1]\nsize = [0.2, 0.2, 0.2]\n",
             x) +
         (k > 0 ? fmt::format("[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"b\"\nat = [{}, 0, 0.1]\nstiffness = [{}, 0, 0]\n", x, k)
                : "");
}

// Truth: a box sticks to what moves below it, as nothing holds it back.  It was left behind, with slip and work of friction and no force.
TEST(LoadSteps, ABoxGoesAlongWithWhatItLiesOn) {
  const Case c("contact");
  for (const double far : {0.1, 3.}) {
    const Results r = on_moved_plate(c, moved(far), box(0));
    EXPECT_NEAR(last(r, "probe/p")[0], far, 1e-8 * far);
    EXPECT_NEAR(last(r, "contact/c")[5], 0, 1e-9) << "slip";
    EXPECT_NEAR(last(r, "contact/c")[6], 0, 1e-9) << "work";
  }
  const Results r = on_moved_plate(c, turned("[0, 0, 1]", 1), box(0.5));
  EXPECT_NEAR(last(r, "probe/p")[0], 0.5 * std::cos(1), 1e-6);
  EXPECT_NEAR(last(r, "probe/p")[1], 0.5 * std::sin(1), 1e-6);
  for (const double k : {5., 40.})  // it holds, or slides
    EXPECT_NEAR(last(on_moved_plate(c, moved(0.5), box(0, k)), "probe/p")[0], std::min(0.5, most / k), 1e-4) << k;
}

// Truth: x follows the plate within mu N/k, where N grows with the load.  There and back: what slides one way slides the other.
TEST(LoadSteps, ABoxOnASpringThatIsDraggedThereAndBack) {
  const Case c("contact");
  for (const double k : {20., 400., 1e4})
    for (const double far : {0.02, 0.5, 3.}) {
      const Results r = on_moved_plate(c, moved(far), box(0, k), 10, "{t = [0, 0.5, 1], value = [0, 1, 0]}");
      double x = 0, before = 0;
      for (int i = 1; i <= 10; ++i) {
        const double t = 0.1 * i, plate = far * (t <= 0.5 ? 2 * t : 2 - 2 * t), away = most * t / k;
        x = std::clamp(x + plate - before, -away, away), before = plate;
      }
      EXPECT_NEAR(last(r, "probe/p")[0], x, 2e-3 * std::abs(x) + 4e-5) << k << " " << far;
    }
}

// Truth: nothing where all sticks; mu N along the slip of a step that goes on from rest; mu N along the way of what slides.
TEST(LoadSteps, FrictionTakesItsForceAlongTheSlip) {
  const Case c("contact");
  for (const int steps : {1, 2, 10}) {
    const auto row = last(on_moved_plate(c, turned("[0, 1, 0]", -0.4), box(0.5), steps), "contact/c");
    EXPECT_LE(row[6], most * row[5] * (1 + 1e-6)) << steps;
    EXPECT_LT(row[5], 1e-4) << steps;
    EXPECT_TRUE(steps == 1 || row[6] < 1e-9) << steps << " " << row[6];
  }
  for (const int steps : {1, 10}) {
    const auto row = last(on_moved_plate(c, moved(0.1), box(0, 1e4), steps), "contact/c");
    EXPECT_NEAR(row[5], 0.1 - most / 1e4, 1e-4) << steps;
    EXPECT_NEAR(row[6], most * row[5] * (1 + 1. / steps) / 2, 1e-6) << steps;  // the weight grows with the steps
  }
}

// Truth: h/R.  A load step sees the way of the lowest point where it ends: a wheel turns by asin(h/R), 5 % too far at 0.5 rad a step.
TEST(LoadSteps, AWheelOnAHeldAxleRolls) {
  const Case c("contact");
  const std::string wheel =
      "[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0.0999]\ninertia = [0.004, 0.004, 0.004]\n"
      "[[obstacle]]\nkind = \"sphere\"\nname = \"it\"\non = \"b\"\nat = [0, 0, 0.0999]\nradius = 0.1\n"
      "[[joint]]\nkind = \"revolute\"\nname = \"axle\"\nb = \"b\"\nat = [0, 0, 0.0999]\naxis = [0, 1, 0]\n";
  const auto angle = [](const Eigen::MatrixXd& rows, Eigen::Index k) {  // of a point in the plane of the wheel, about its centre
    Vec3 x = (rows.row(k).segment<3>(3) - rows.row(k).head<3>()).transpose();
    if (std::hypot(x[0], x[2]) < 1e-3) x = (rows.row(k).segment<3>(6) - rows.row(k).head<3>()).transpose();
    return std::atan2(-x[2], x[0]);
  };
  for (const int steps : {20, 40, 200}) {
    const Eigen::MatrixXd b = on_moved_plate(c, moved(1), wheel, steps).history("body/b");
    const double turn = angle(b, b.rows() - 1) - angle(b, 0) + steps * std::asin(1. / steps / 0.1);
    EXPECT_NEAR(std::remainder(turn, 2 * std::numbers::pi), 0, 0.02) << steps;
  }
}

// Truth: balance of forces.  A ball in the edge or the corner of a container presses each wall, where the nearest one alone had all.  On a
// ring it meets one point, and a state out of balance is not taken for rest.
TEST(LoadSteps, ABallInTheEdgeOfAContainer) {
  const Case c("contact");
  const auto forces = [&](const std::string& container, const Vec3& at, const Vec3& gravity) {
    std::ofstream(c / "scene.toml") << fmt::format(
        "gravity = [{}, {}, {}]\n[[body]]\nname = \"b\"\nmass = 1\ncom = [{}, {}, {}]\ninertia = [0.004, 0.004, 0.004]\n"
        "[[obstacle]]\nname = \"t\"\ninside = true\n{}\n[[obstacle]]\nkind = \"sphere\"\nname = \"w\"\non = \"b\"\n"
        "at = [{}, {}, {}]\nradius = 0.1\n[[contact]]\nname = \"c\"\na = \"t\"\nb = \"w\"\nstiffness = 1e5\n"
        "[time]\nanalysis = \"static\"\nsteps = 2\n",
        gravity[0], gravity[1], gravity[2], at[0], at[1], at[2], container, at[0], at[1], at[2]);
    succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
    return Vec3(last(Results(c / "run.h5"), "contact/c").head<3>());
  };
  const std::string box = "kind = \"box\"\nsize = [1, 1, 1]", can = "kind = \"cylinder\"\nradius = 0.5\nlength = 1\naxis = [0, 0, 1]";
  for (const Vec3& gravity : {Vec3(1, 0, -g), Vec3(1, 2, -g), Vec3(-g, 3, 0.5)}) {
    const Vec3 at = 0.4 * gravity.cwiseSign();
    EXPECT_LT((forces(box, at, gravity) + gravity).norm(), 1e-5) << gravity.transpose();
  }
  for (const double aside : {1., 20.}) {
    const Vec3 gravity(aside, 0, -g);
    EXPECT_LT((forces(can, Vec3(0.4, 0, -0.4), gravity) + gravity).norm(), 1e-5) << aside;
  }
  std::ofstream(c / "ring.toml") << "gravity = [0, 0, -9.81]\n[[body]]\nname = \"b\"\nmass = 1\ncom = [0.0001, 0, 0.4898979]\n"
                                    "inertia = [0.1, 0.1, 0.1]\n[[obstacle]]\nkind = \"torus\"\nname = \"t\"\nradius = 0.5\ntube = 0.1\n"
                                    "[[obstacle]]\nkind = \"sphere\"\nname = \"w\"\non = \"b\"\nat = [0.0001, 0, 0.4898979]\nradius = 0.6\n"
                                    "[[contact]]\nname = \"c\"\na = \"t\"\nb = \"w\"\nstiffness = 1e5\n[time]\nanalysis = \"static\"\n";
  EXPECT_EQ(c.run("hilo-solve --quiet ring.toml -o ring.h5").exit, 3);
}

}  // namespace
}  // namespace hilo::test::carried_test
