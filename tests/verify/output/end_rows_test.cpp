// SPDX-License-Identifier: GPL-3.0-or-later
// The first and the last row of what belongs to the inside of steps: forces of an unbalanced rotor.
#include "verify/verify.hpp"

namespace hilo::test::end_rows_test {
namespace {

// Truth: m r w^2 = 1000 N throughout, in 20 steps a turn.  The first row is that of the start; the last one of methods whose forces belong
// to the middle of steps is extrapolated along a parabola, which is off by the fourth order in size.
TEST(EndRows, OfAnUnbalancedRotor) {
  const Workplace w;
  w.write("scene.toml", R"([[body]]
name = "a"
mass = 1
com = [0.1, 0, 0]
inertia = [0.1, 0.1, 0.1]
[[joint]]
kind = "revolute"
name = "j"
b = "a"
at = [0, 0, 0]
axis = [0, 0, 1]
spin = 100
[time]
end = 0.0628318530717958
step = 0.003141592653589793
)");
  const std::vector<std::pair<std::string, double>> methods{
      {"gauss", 1e-3}, {"energy-momentum", 16}, {"mid-point", 16}, {"radau", 8}, {"generalized-alpha", 40}};
  for (const auto& [method, last] : methods) {
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 --set 'time.integrator=\"" + method + "\"'"));
    const auto f = Results(w / "run.h5").history("joint/j");
    EXPECT_NEAR(f.row(0).head(3).norm(), 1000, 1e-6) << method;
    EXPECT_NEAR(f.row(f.rows() - 1).head(3).norm(), 1000, last) << method;
  }
}

// Truth: w = 10 + 100 t about a hinge 0.1 m off, which then holds m r w^2 and m r dw/dt.  Nothing rings after the start or after a jump of
// the load: a fourth of the error at half the step, in all rows.
TEST(EndRows, FollowedByWhatDoesNotRing) {
  const Workplace w;
  w.write("scene.toml", R"([[body]]
name = "a"
mass = 1
com = [0.1, 0, 0]
inertia = [0.01, 0.01, 0.01]
[[joint]]
kind = "revolute"
name = "j"
b = "a"
at = [0, 0, 0]
axis = [0, 0, 1]
[[initial]]
on = ["a"]
spin = [0, 0, 10]
about = [0, 0, 0]
[[load]]
kind = "torque"
name = "t"
on = "a"
torque = [0, 0, 2]
history = {t = [0, 0.02, 0.02, 1], value = [1, 1, 3, 3]}
[time]
end = 0.04
)");
  for (const std::string method : {"generalized-alpha", "hht", "wbz", "energy-momentum"}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const double h = 1e-3 / (1 << k);
      succeeded(w.run(fmt::format("hilo-solve --quiet scene.toml -o run.h5 --set 'time.integrator=\"{}\"' --set time.step={}", method, h)));
      const auto f = Results(w / "run.h5").history("joint/j");
      error[k] = 0;
      for (Eigen::Index i = 0; i < f.rows(); ++i) {
        const double t = h * double(i), past = std::max(0., t - 0.02), speed = 10 + 100 * t + 200 * past,
                     rate = i * h > 0.02 - 1e-9 ? 300 : 100;
        error[k] = std::max(error[k], std::abs(f.row(i).head(3).norm() - 0.1 * std::hypot(speed * speed, rate)));
      }
    }
    EXPECT_LT(error[0], 0.03) << method;
    EXPECT_GT(error[0] / error[1], 3.3) << method;
  }
}

// Truth: the same bits as in one run, also at the former end, where the force jumps from 10 to -20 N.
TEST(EndRows, AtAJumpWhereTheRunHadEnded) {
  const Workplace w;
  w.write("scene.toml", R"([[body]]
name = "a"
mass = 1
com = [0, 0, 0]
inertia = [1, 1, 1]
[[load]]
kind = "force"
name = "f"
on = "a"
force = [10, 0, 0]
history = {t = [0, 0.01, 0.01, 1], value = [1, 1, -2, -2]}
[[probe]]
name = "p"
on = "a"
[time]
end = 0.02
step = 0.001
)");
  for (const std::string method : {"energy-momentum", "generalized-alpha"}) {
    const std::string by = "hilo-solve --quiet scene.toml --checkpoint 5steps --set 'time.integrator=\"" + method + "\"' ";
    succeeded(w.run(by + "-o whole.h5"));
    succeeded(w.run(by + "-o run.h5 --set time.end=0.01"));
    succeeded(w.run("hilo-solve --quiet --restart run.h5 --set time.end=0.02"));
    const auto whole = Results(w / "whole.h5").history("probe/p"), again = Results(w / "run.h5").history("probe/p");
    EXPECT_EQ((whole - again).cwiseAbs().maxCoeff(), 0) << method;
    EXPECT_NEAR(whole(10, 6), -20, 1e-9) << method;
  }
}

}  // namespace
}  // namespace hilo::test::end_rows_test
