// SPDX-License-Identifier: GPL-3.0-or-later
// Load steps of bodies that lie on what a law moves, or in the edge of a container: balance of forces.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "succeeded.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::carried_test {
namespace {

constexpr double g = 9.81;

Eigen::VectorXd last(const Results& r, const std::string& history) { return r.history(history).bottomRows(1).transpose(); }

/// A plate that a law moves, what lies on it, and its place at the end.
Results on_moved_plate(const Case& c, const std::string& motion, const std::string& on_it,
                       const std::string& history = "{t = [0, 1], value = [0, 1]}") {
  std::ofstream(c / "scene.toml")
      << "gravity = [0, 0, -9.81]\n[[body]]\nname = \"plate\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n"
         "[[obstacle]]\nkind = \"plane\"\nname = \"top\"\non = \"plate\"\n[[motion]]\nname = \"m\"\non = \"plate\"\n"
         "history = " +
             history + "\n" + motion + "[[contact]]\nname = \"c\"\na = \"top\"\nb = \"it\"\nfriction = 0.5\nstiffness = 1e6\n" + on_it +
             "[[probe]]\nname = \"p\"\non = \"b\"\n[time]\nanalysis = \"static\"\n";
  succeeded(c.run("hilo-solve --quiet scene.toml --set time.steps=10 -o run.h5"));
  return Results(c / "run.h5");
}

// Truth: a box sticks to what moves below it, as nothing holds it back.  It was left behind, with slip and work of friction and no force.
TEST(LoadSteps, ABoxGoesAlongWithWhatItLiesOn) {
  const Case c("contact");
  const auto box = [](double x, const std::string& more = "") {
    return fmt::format(
        "[[body]]\nname = \"b\"\nmass = 2\ncom = [{0}, 0, 0.1]\ninertia = [0.02, 0.02, 0.02]\n"
        "[[obstacle]]\nkind = \"box\"\nname = \"it\"\non = \"b\"\nat = [{0}, 0, 0.1]\nsize = [0.2, 0.2, 0.2]\n{1}",
        x, more);
  };
  const auto moved = [](double far) { return fmt::format("kind = \"translation\"\ndisplacement = [{}, 0, 0]\n", far); };
  for (const double far : {0.1, 3.}) {
    const Results r = on_moved_plate(c, moved(far), box(0));
    EXPECT_NEAR(last(r, "probe/p")[0], far, 1e-8 * far);
    EXPECT_NEAR(last(r, "contact/c")[5], 0, 1e-9) << "slip";
    EXPECT_NEAR(last(r, "contact/c")[6], 0, 1e-9) << "work";
  }
  const Results turned = on_moved_plate(c, "kind = \"rotation\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 1\n", box(0.5));
  EXPECT_NEAR(last(turned, "probe/p")[0], 0.5 * std::cos(1), 1e-6);
  EXPECT_NEAR(last(turned, "probe/p")[1], 0.5 * std::sin(1), 1e-6);
  const std::string spring = "[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"b\"\nat = [0, 0, 0.1]\n";
  for (const double k : {5., 40.}) {  // of 9.81 N at most: it holds, or slides
    const Results r = on_moved_plate(c, moved(0.5), box(0, spring + fmt::format("stiffness = [{}, 0, 0]\n", k)));
    EXPECT_NEAR(last(r, "probe/p")[0], std::min(0.5, 9.81 / k), 1e-4) << k;
  }
}

// Truth: x follows the plate within mu N/k, where N grows with the load.  There and back: what slides one way slides the other.
TEST(LoadSteps, ABoxOnASpringThatIsDraggedThereAndBack) {
  const Case c("contact");
  for (const double k : {20., 400., 1e4})
    for (const double far : {0.02, 0.5, 3.}) {
      const std::string box = fmt::format(
          "[[body]]\nname = \"b\"\nmass = 2\ncom = [0, 0, 0.1]\ninertia = [0.02, 0.02, 0.02]\n"
          "[[obstacle]]\nkind = \"box\"\nname = \"it\"\non = \"b\"\nat = [0, 0, 0.1]\nsize = [0.2, 0.2, 0.2]\n"
          "[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"b\"\nat = [0, 0, 0.1]\nstiffness = [{}, 0, 0]\n",
          k);
      const Results r = on_moved_plate(c, fmt::format("kind = \"translation\"\ndisplacement = [{}, 0, 0]\n", far), box,
                                       "{t = [0, 0.5, 1], value = [0, 1, 0]}");
      double x = 0, before = 0;
      for (int i = 1; i <= 10; ++i) {
        const double t = 0.1 * i, plate = far * (t <= 0.5 ? 2 * t : 2 - 2 * t), most = 9.81 * t / k;
        x = std::clamp(x + plate - before, -most, most), before = plate;
      }
      EXPECT_NEAR(last(r, "probe/p")[0], x, 2e-3 * std::abs(x) + 4e-5) << k << " " << far;
    }
}

// Truth: balance of forces.  A ball in the edge or the corner of a container presses each wall, where the nearest one alone had all.
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
}

}  // namespace
}  // namespace hilo::test::carried_test
