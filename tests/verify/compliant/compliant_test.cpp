// SPDX-License-Identifier: GPL-3.0-or-later
// Joints that give way: springs along the rows of the joint.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::compliant_test {
namespace {

// Truth: let go, a mass m on k and c sinks as -m g/k (1 - exp(-d t)(cos w t + d/w sin w t)), d = c/(2 m), w^2 = k/m - d^2; the mount
// carries it.
TEST(CompliantJoint, MountSinksAsADampedOscillator) {
  const Case c("compliant");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "mount");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  const double m = 40, k = 1e5, d = 400 / (2 * m), w = std::sqrt(k / m - d * d), sink = m * 9.81 / k;
  const auto x = r.history("probe/engine"), f = r.history("joint/mount");
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double t = r.t()[i], at = std::exp(-d * t), z = -sink * (1 - at * (std::cos(w * t) + d / w * std::sin(w * t)));
    EXPECT_NEAR(x(i, 2), 1 + z, 1e-3 * sink);
    EXPECT_NEAR(f(i, 2), -k * z + 400 * sink * k / m / w * at * std::sin(w * t), 2e-3 * m * 9.81) << "upwards, on the engine";
  }
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10);
}

// Truth: the stiffer the pin, the nearer the pendulum to the one on a rigid pin: the pin gives by F/k.
TEST(CompliantJoint, TendsToTheRigidJoint) {
  const Case c("compliant");
  ASSERT_EQ(c.solve("--quiet", "rigid.h5", 0, "rigid").exit, 0);
  const auto rigid = c.results("rigid.h5").history("probe/bob");
  double apart[2];
  for (int i = 0; i < 2; ++i) {
    const Results r = c.solved(i ? "--set 'joint.pin.stiffness=[1e6,1e6,1e6]'" : "--set joint.pin.stiffness=1e5");
    const auto x = r.history("probe/bob");
    apart[i] = (x.leftCols(3) - rigid.leftCols(3)).cwiseAbs().maxCoeff();
    EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_LT(apart[1], 20 * 60 / 1e6) << "the pin carries up to 3 m g = 60 N";
  EXPECT_LT(apart[1], 0.2 * apart[0]);
}

const std::string disc =
    body("d", 1, Vec3::Zero(), {0.1, 0.1, 0.1}) + load("torque", "T", "d", "torque = [0, 0, TORQUE]") + probe("p", "d", "at = [1, 0, 0]");
const std::string on_bushing =
    spring("bushing", "b", "ground", "d", "at = [0, 0, 0]\nstiffness = [1e5, 1e5, 1e5]\nangular_stiffness = [100, 100, 100]");

// Truth: Hooke: the angle is the moment over the stiffness, at any angle below half a turn; beyond, a bushing that is stiff about three
// axes says so.
TEST(CompliantJoint, TurnsByTheMomentOverTheStiffness) {
  const Case c("compliant");
  const std::string fixed = joint("fixed", "b", "ground", "d", Vec3::Zero(), "stiffness = 1e5\nangular_stiffness = 100");
  const std::string single = std::string(on_bushing).replace(on_bushing.find("[100, 100, 100]"), 15, "[0, 0, 100]");
  for (const double torque : {50.0, 95.0, 300.0, 400.0}) {
    for (const std::string& holder : {on_bushing, fixed, single}) {
      if (torque == 400 && holder != on_bushing) continue;
      c.write("turn.toml", std::string(disc).replace(disc.find("TORQUE"), 6, std::to_string(torque)) + holder +
                               (holder == single ? "[[joint]]\nkind = \"revolute\"\nname = \"r\"\nb = "
                                                   "\"d\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n"
                                                 : "") +
                               "[time]\nanalysis = \"static\"\nsteps = 10\n");
      const Ran ran = succeeded(c.run("hilo-solve turn.toml -o turn.h5"));
      const auto p = c.results("turn.h5").history("probe/p");
      if (torque < 100 * M_PI) {
        EXPECT_NEAR(p(10, 0), std::cos(torque / 100), 1e-9) << torque;
        EXPECT_NEAR(p(10, 1), std::sin(torque / 100), 1e-9) << torque;
      }
      EXPECT_EQ(ran.err.find("passes half a turn at t = ") != std::string::npos, torque == 400) << ran.err;
    }
  }
}

// Truth: energy and both momenta of two bodies in space that a bushing or a compliant joint holds stay, at long steps and by every method
// that keeps them.
TEST(CompliantJoint, KeepsEnergyAndMomentaAtLargeAngles) {
  const Case c("compliant");
  const std::string bodies = body("one", 2, Vec3::Zero(), {0.2, 0.3, 0.4}) + body("two", 1, {0.5, 0.1, 0}, {0.1, 0.15, 0.2}) +
                             initial("two", "spin = [3, -2, 5]") + initial("one", "spin = [-1, 1, -3]") + in_time(3, 0.01);
  const char* holders[] = {
      "[[spring]]\nkind = \"bushing\"\nname = \"h\"\na = \"one\"\nb = "
      "\"two\"\nat = [0.3, 0, 0.1]\nstiffness = [200, 300, 250]\n"
      "angular_stiffness = [3, 2, 4]\n",
      "[[spring]]\nkind = \"bushing\"\nname = \"h\"\na = \"one\"\nb = "
      "\"two\"\nat = [0.3, 0, 0.1]\nstiffness = [200, 300, 250]\n"
      "angular_stiffness = [6, 0, 4]\n",
      "[[joint]]\nkind = \"revolute\"\nname = \"h\"\naxis = [1, 0, 2]\na = "
      "\"one\"\nb = \"two\"\nat = [0.3, 0, 0.1]\nstiffness = "
      "200\nangular_stiffness = 8\n",
      "[[joint]]\nkind = \"fixed\"\nname = \"h\"\na = \"one\"\nb = \"two\"\nat "
      "= [0.3, 0, 0.1]\nstiffness = 200\nangular_stiffness = 3\n",
      "[[joint]]\nkind = \"constant-velocity\"\nname = \"h\"\naxis = [1, 0, "
      "2]\na = \"one\"\nb = \"two\"\nat = [0.3, 0, 0.1]\nstiffness = 200\n"
      "angular_stiffness = 3\n"};
  for (const char* method : {"energy-momentum", "gauss"})
    for (const char* holder : holders) {
      c.write("pair.toml", std::string(holder) + bodies);
      const Ran ran = c.run(std::string("hilo-solve --quiet pair.toml -o "
                                        "pair.h5 --set time.integrator=") +
                            method);
      ASSERT_EQ(ran.exit, 0) << ran.err << holder;
      const auto e = c.results("pair.h5").history("energy"), m = c.results("pair.h5").history("momentum");
      // directors of gauss are orthonormal to some 1e-9 alone, on which the rotation vector depends
      EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), method[0] == 'g' ? 1e-8 : 1e-11) << method << holder;
      EXPECT_LT((m.rowwise() - m.row(0)).cwiseAbs().maxCoeff(), 1e-11) << method << holder;
      EXPECT_GT(e.col(1).maxCoeff() - e.col(1).minCoeff(), 0.5) << "it is wound up";
    }
}

TEST(CompliantJoint, MistakesAreNamed) {
  const Case c("compliant");
  c.expect_mistake("'joint.pin.stiffness=[1,2]'", "2 numbers, not 1 or 3");
  c.expect_mistake("'joint.pin.angular_stiffness=[1,0,1]'", "leaves a row of the joint without a spring");
  c.expect_mistake("joint.pin.spin=3", "cannot be driven");
}

TEST(CompliantJoint, SpringsThatActOnNothingAreTold) {
  const Case c("compliant");
  const Ran ran = c.solve("--set 'joint.pin.angular_stiffness=[1e3,1e3,1e3]' --set time.end=0.01");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_TRUE(ran.err.find("is free about its axis, so its angular_stiffness there acts on nothing") != ran.err.npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::compliant_test
