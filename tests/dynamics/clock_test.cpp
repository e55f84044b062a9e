// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of mechanisms of one degree of freedom: where it is used, what it leaves alone, and what it does where the motion turns back.
#include "dynamics/scenes.hpp"

namespace hilo::test::clock_test {
namespace {

const std::string pin = "axis = [0, 0, 1]\n", time_table = "[time]\nend = 1\nstep = 0.01\n";
const std::string pendulum = "gravity = [0, -9.81, 0]\n" + body("rod", 1, {-0.5, 0, 0}, {1e-3, 0.08, 0.08}) +
                             joint("revolute", "pin", "ground", "rod", Vec3::Zero(), pin);

/// The mechanisms that the run of the scene says it keeps the time of.
std::string timed(const std::string& scene, const std::string& options = "") {
  const Workplace w;
  w.write("scene.toml", scene);
  succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 " + options));
  const std::string text = text_of(w / "run.json");
  const auto at = text.find("\"clocks\": ") + 10;
  return text.substr(at, text.find("\n", at) - at - 1);
}

TEST(Clock, ServesEveryMechanismOfOneFreedomAndIsNamed) {
  EXPECT_EQ(timed(pendulum + time_table), "[\"rod\"]");
  EXPECT_EQ(timed(pendulum + time_table, "--set time.tolerance=1e-4"), "[]") << "steps are chosen by an estimate of second order";
  EXPECT_EQ(timed(pendulum + time_table, integrator("generalized-alpha")), "[]") << "does not keep energy";
  const std::string knee =
      body("second", 1, {-1.5, 0, 0}, {1e-3, 0.08, 0.08}) + joint("revolute", "knee", "rod", "second", {-1, 0, 0}, pin);
  EXPECT_EQ(timed(pendulum + knee + time_table), "[]") << "two degrees of freedom";
  EXPECT_EQ(timed(pendulum + knee + body("third", 1, {5, 0, 0}, {1e-3, 0.08, 0.08}) +
                  joint("revolute", "far", "ground", "third", {4.5, 0, 0}, pin) + time_table),
            "[\"third\"]");
  const std::string cart = body("cart", 1, {0, 0, 0}, {1, 1, 1}) +
                           joint("prismatic", "rail", "ground", "cart", Vec3::Zero(), "axis = [1, 0, 0]\n") +
                           body("rod", 1, {-0.5, 0, 0}, {1e-3, 0.08, 0.08}) + joint("revolute", "pin", "cart", "rod", Vec3::Zero(), pin),
                    rail = "axis = [1, 0, 0]\n";
  std::string driven = cart;
  driven.replace(driven.find(rail), rail.size(), rail + "displacement = 0.1\nhistory = {t = [0, 1], value = [0, 1]}\n");
  EXPECT_EQ(timed("gravity = [0, -9.81, 0]\n" + driven + time_table), "[]") << "moved from outside";
  driven = cart;
  driven.replace(driven.find(rail), rail.size(), rail + "displacement = 0\n");
  EXPECT_EQ(timed("gravity = [0, -9.81, 0]\n" + driven + time_table), "[\"cart, rod\"]") << "a drive at rest is a weld";
}

/// What does nothing, or is not connected, does not change the answer; what does little changes it little.
TEST(Clock, TwoScenesThatMeanTheSameHaveTheSameAnswer) {
  const Workplace w;
  const auto end = [&](const std::string& more, const std::string& options = "") {
    w.write("scene.toml", pendulum + more + "[[probe]]\nname = \"tip\"\non = \"rod\"\nat = [-1, 0, 0]\n[time]\nend = 2\nstep = 0.02\n");
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 " + options));
    return Vec3(Results(w / "run.h5").at("probe/tip", 2).head<3>());
  };
  const Vec3 alone = end(""), truth = end("", integrator("radau") + "--set time.step=2e-3"), without = end("", integrator("mid-point"));
  EXPECT_LT(100 * (alone - truth).norm(), (without - truth).norm()) << "the gain that is at stake";
  const auto spring = [](const std::string& c) {
    return "[[spring]]\nkind = \"torsion\"\nname = \"brake\"\na = \"ground\"\nb = \"rod\"\naxis = [0, 0, 1]\ndamping = " + c + "\n";
  };
  const auto torque = [](const std::string& m) {
    return "[[load]]\nkind = \"torque\"\nname = \"turn\"\non = \"rod\"\ntorque = [0, 0, " + m + "]\n";
  };
  const std::string motor = "[[motor]]\nkind = \"rotary\"\nname = \"drive\"\njoint = \"pin\"\nrate = [0]\ntorque = [0]\n",
                    friction = "[[friction]]\nname = \"rub\"\njoint = \"pin\"\ncoefficient = 0\nradius = 0.1\n",
                    stop = "[[stop]]\nkind = \"angle\"\nname = \"end\"\njoint = \"pin\"\nupper = 7\nstiffness = 1e6\nrestitution = 0.5\n",
                    far = body("far", 3, {50, 0, 0}, {1, 1, 1}),
                    twin = body("twin", 1, {9.5, 0, 0}, {1e-3, 0.08, 0.08}) + joint("revolute", "other", "ground", "twin", {10, 0, 0}, pin),
                    knee = body("a", 1, {19.5, 0, 0}, {1e-3, 0.08, 0.08}) + joint("revolute", "a", "ground", "a", {20, 0, 0}, pin) +
                           body("b", 1, {18.5, 0, 0}, {1e-3, 0.08, 0.08}) + joint("revolute", "b", "a", "b", {19, 0, 0}, pin);
  for (const auto& more : {spring("0"), spring("1e-12"), torque("0"), torque("1e-12"), motor, friction, stop, far, twin, knee})
    EXPECT_LT((end(more) - alone).norm(), 1e-9) << more;
  for (const auto& more : {spring("1e-6"), torque("1e-6")}) EXPECT_LT((end(more) - alone).norm(), 1e-5) << more;
}

/// A brake, a torque, both with gravity: near the error without it, or far below.
TEST(Clock, DoesLittleHarmWhereWorkIsNotExact) {
  const Workplace w;
  for (const double c : {0.03, 0.3, 3.0})
    for (const double torque : {0.0, 3.0}) {
      w.write("scene.toml", pendulum +
                                fmt::format("[[spring]]\nkind = \"torsion\"\nname = \"brake\"\na = \"ground\"\nb = \"rod\"\naxis = "
                                            "[0, 0, 1]\ndamping = {}\n[[load]]\nkind = \"torque\"\nname = \"turn\"\non = "
                                            "\"rod\"\ntorque = [0, 0, {}]\n",
                                            c, torque) +
                                "[[probe]]\nname = \"tip\"\non = \"rod\"\nat = [-1, 0, 0]\n[time]\nend = 2\n");
      const auto end = [&](const std::string& options) {
        succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 " + options));
        const auto x = Results(w / "run.h5").history("probe/tip");
        Eigen::MatrixXd places(20, 3);  // every tenth of a second
        for (int k = 0; k < 20; ++k) places.row(k) = x.row((k + 1) * (x.rows() - 1) / 20).head(3);
        return places;
      };
      const auto truth = end("--set time.step=1e-3 " + integrator("mid-point"));
      const double with = (end("--set time.step=0.02") - truth).norm(),
                   without = (end("--set time.step=0.02 " + integrator("mid-point")) - truth).norm();
      EXPECT_LT(with, 1.2 * without) << c << " " << torque;
    }
}

TEST(Clock, TakesPositionsOfASliderCrankToFourthOrder) {
  const Workplace w;
  const OrderCase c = slider(w);
  const auto error = [&](double h) {
    const Ran ran =
        w.run(fmt::format("hilo-solve --quiet slider.toml -o run.h5 --set time.step={} --set time.end=0.24 "
                          "--set solver.tolerance=1e-12",
                          h));
    EXPECT_EQ(ran.exit, 0) << ran.err;
    const auto p = Results(w / "run.h5").at("probe/block", c.t[2]);
    return Eigen::Vector2d((p.head<3>() - c.truth[2].x).norm(), (p.segment<3>(3) - c.truth[2].v).norm());
  };
  const Eigen::Vector2d coarse = error(8e-3), fine = error(4e-3);
  EXPECT_GT(std::log2(coarse[0] / fine[0]), 3.7) << coarse[0] << " " << fine[0];
  EXPECT_GT(std::log2(coarse[1] / fine[1]), 1.95) << "across the path velocities stay of second order";
}

/// A disc on a torsion spring at rest at 0.5 rad: phi = (1 - cos(sqrt(k/J) t))/2, exactly.
TEST(Clock, TakesASpringToFourthOrder) {
  const Workplace w;
  w.write("scene.toml", body("disc", 1, Vec3::Zero(), {0.1, 0.1, 0.2}) + joint("revolute", "pin", "ground", "disc", Vec3::Zero(), pin) +
                            "[[spring]]\nkind = \"torsion\"\nname = \"spring\"\na = \"ground\"\nb = \"disc\"\naxis = [0, 0, 1]\n"
                            "stiffness = 0.8\nangle = 0.5\n[[probe]]\nname = \"rim\"\non = \"disc\"\nat = [1, 0, 0]\n[time]\nend = 10\n");
  const auto error = [&](const char* step, const char* method) {
    succeeded(w.run(std::string("hilo-solve --quiet scene.toml -o run.h5 --set time.step=") + step + " " + integrator(method)));
    const auto x = Results(w / "run.h5").at("probe/rim", 10);
    return std::abs(std::atan2(x[1], x[0]) - 0.5 * (1 - std::cos(2 * 10.0)));
  };
  const double coarse = error("0.1", "energy-momentum"), fine = error("0.05", "energy-momentum");
  EXPECT_LT(100 * coarse, error("0.1", "mid-point")) << "the same method without the clock";
  EXPECT_GT(std::log2(coarse / fine), 3.8) << coarse << " " << fine;
}

/// Energy is kept whatever the clock does: also at steps of a tenth of a swing.
TEST(Clock, LeavesEnergyAloneAtLongSteps) {
  const Workplace w;
  w.write("scene.toml", pendulum + "[time]\nend = 40\nstep = 0.2\n");
  succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5"));
  const auto e = Results(w / "run.h5").history("energy");
  EXPECT_LT((e.col(0) + e.col(2)).array().abs().maxCoeff(), 1e-10 * e.col(0).maxCoeff());
}

}  // namespace
}  // namespace hilo::test::clock_test
