// SPDX-License-Identifier: GPL-3.0-or-later
// Histories of the slide and the angle of joints, against what probes and closed forms say of the same motion.
#include "verify/verify.hpp"

namespace hilo::test::joint_coordinates_test {
namespace {

std::string body(const std::string& name) {
  return "[[body]]\nname = \"" + name + "\"\nmass = 2\ncom = [0, 0, 0]\ninertia = [0.1, 0.1, 0.1]\n";
}
constexpr auto time_of = "[time]\nend = 2\nstep = 1e-2\n";

// The drive of scene.toml prescribes the angle: 7 rad, more than a turn.  A probe sees the arm at (cos, sin) of it.
TEST(Coordinate, OfARevoluteCountsTurns) {
  const Case c("drives");
  const Results r = c.solved();
  const Eigen::MatrixXd at = r.history("coordinate/motor"), arm = r.history("probe/arm");
  ASSERT_EQ(at.cols(), 2);
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    ASSERT_NEAR(std::cos(at(i, 1)), 2 * arm(i, 0), 1e-10) << r.t()[i];
    ASSERT_NEAR(std::sin(at(i, 1)), 2 * arm(i, 2), 1e-10) << r.t()[i];
    ASSERT_EQ(at(i, 0), 0) << "a revolute does not slide";
  }
  EXPECT_NEAR(at(at.rows() - 1, 1), 7, 1e-10);
}

// A start may be turns away from the drawing: 10 N m on 1 N m/rad, or a drive that begins at 9 rad.
TEST(Coordinate, CountsTheTurnsOfAStart) {
  const Case c("drives");
  const std::string hinge = "[[joint]]\nkind = \"revolute\"\nname = \"j\"\nb = \"a\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
  const std::string spring = "[[spring]]\nkind = \"torsion\"\nname = \"t\"\nb = \"a\"\naxis = [0, 0, 1]\nstiffness = 1\n";
  const std::string load = "[[load]]\nkind = \"torque\"\nname = \"m\"\non = \"a\"\ntorque = [0, 0, 10]\n";
  const std::string drive = "angle = 1\nhistory = {t = [0, 2], value = [9, 12]}\n";
  for (const auto& [scene, first, last] : {std::tuple{hinge + spring + load + time_of + "start = \"equilibrium\"\n", 10., 10.},
                                           std::tuple{hinge + drive + time_of, 9., 12.}}) {
    c.write("scene.toml", body("a") + scene);
    const Eigen::VectorXd angle = c.solved().history("coordinate/j").col(1);
    EXPECT_NEAR(angle[0], first, 1e-8);
    EXPECT_NEAR(angle[angle.size() - 1], last, 1e-8);
  }
}

// A nut that is turned by three turns and more goes along by its pitch a turn; the signs are those of the axis.
TEST(Coordinate, OfAScrewIsItsPitchATurn) {
  const Case c("drives");
  c.write("scene.toml", body("nut") +
                            "[[joint]]\nkind = \"screw\"\nname = \"thread\"\nb = \"nut\"\nat = [0, 0, 0]\naxis = [0, 0, 2]\npitch = 0.1\n"
                            "angle = -20\nhistory = {t = [0, 2], value = [0, 1], interpolation = \"smoother\"}\n[[probe]]\nname = \"nut\"\n"
                            "on = \"nut\"\n" +
                            time_of);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r = c.results();
  const Eigen::VectorXd end = r.at("coordinate/thread", 2);
  EXPECT_NEAR(end[1], -20, 1e-9);
  EXPECT_NEAR(end[0], -20 * 0.1 / (2 * M_PI), 1e-9);
  EXPECT_NEAR(r.at("probe/nut", 2)[2], end[0], 1e-12);
}

// Between two bodies that turn as one in space, the angle is that of b against a; a compliant joint has one as well.  Truth: w t, where a
// motion spins b with w about the axis and a stands.
TEST(Coordinate, OfACompliantJointIsTheAngleBetweenItsEnds) {
  const Case c("drives");
  c.write("scene.toml", body("a") + body("b") +
                            "[[motion]]\nkind = \"rotation\"\nname = \"whole\"\non = \"a\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\nangle = 3\n"
                            "history = {t = [0, 2], value = [0, 1]}\n"
                            "[[motion]]\nkind = \"rotation\"\nname = \"more\"\non = \"b\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\nangle = 13\n"
                            "history = {t = [0, 2], value = [0, 1]}\n"
                            "[[joint]]\nkind = \"revolute\"\nname = \"bush\"\na = \"a\"\nb = \"b\"\nat = [0, 0, 0]\naxis = [0, -1, 0]\n"
                            "stiffness = 1e5\nangular_stiffness = 1e3\n" +
                            time_of);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r = c.results();
  for (const double t : {0.5, 1.0, 1.99}) EXPECT_NEAR(r.at("coordinate/bush", t)[1], -10 * t / 2, 1e-9) << t;
  const Ran list = c.run("hilo-post series run.h5 coordinate.bush.angle --times 1:1.001");
  EXPECT_NE(list.out.find("coordinate.bush.angle [rad]"), std::string::npos) << list.out << list.err;
}

}  // namespace
}  // namespace hilo::test::joint_coordinates_test
