// The clock of mechanisms of one degree of freedom: where it is used, what it leaves alone, and what it does where the motion turns back.
#include <fmt/format.h>

#include "dynamics/scenes.hpp"

namespace hilo::test {
namespace {

const std::string pin = "axis = [0, 0, 1]\n", time_table = "[time]\nend = 1\nstep = 0.01\n";
const std::string pendulum = "gravity = [0, -9.81, 0]\n" + body("rod", 1, {-0.5, 0, 0}, {1e-3, 0.08, 0.08}) +
                             joint("revolute", "pin", "ground", "rod", Vec3::Zero(), pin);

/// Whether the run of the scene says that it keeps the clock.
bool keeps_time(const std::string& scene, const std::string& options = "") {
  const Workplace w;
  w.write("scene.toml", scene);
  const Ran ran = w.run("hilo-solve --quiet scene.toml -o run.h5 " + options);
  EXPECT_EQ(ran.exit, 0) << ran.err;
  return text_of(w / "run.json").find("on the clock") != std::string::npos;
}

TEST(Clock, ServesWhereThePathIsKnownAndTheEnergyKept) {
  EXPECT_TRUE(keeps_time(pendulum + time_table));
  EXPECT_FALSE(keeps_time(pendulum + time_table, "--set time.tolerance=1e-4")) << "steps are chosen by an estimate of second order";
  EXPECT_FALSE(keeps_time(pendulum + time_table, integrator("generalized-alpha"))) << "does not keep energy";
  EXPECT_FALSE(keeps_time(pendulum + body("second", 1, {-1.5, 0, 0}, {1e-3, 0.08, 0.08}) +
                          joint("revolute", "knee", "rod", "second", {-1, 0, 0}, pin) + time_table))
      << "two degrees of freedom";
  const std::string push = "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"rod\"\nforce = [1, 0, 0]\n",
                    turn = "[[load]]\nkind = \"torque\"\nname = \"turn\"\non = \"rod\"\ntorque = [0, 0, 1]\n",
                    spring =
                        "[[spring]]\nkind = \"torsion\"\nname = \"spring\"\na = \"ground\"\nb = \"rod\"\naxis = [0, 0, 1]\nstiffness = 1\n";
  EXPECT_TRUE(keeps_time(pendulum + push + spring + time_table));
  EXPECT_FALSE(keeps_time(pendulum + push + "history = \"h\"\n[history.h]\nt = [0, 1]\nvalue = [0, 1]\n" + time_table));
  EXPECT_FALSE(keeps_time(pendulum + turn + time_table)) << "a torque's work is of second order";
  EXPECT_FALSE(keeps_time(pendulum + spring + "damping = 1\n" + time_table));
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
    const Ran ran = w.run(std::string("hilo-solve --quiet scene.toml -o run.h5 --set time.step=") + step + " " + integrator(method));
    EXPECT_EQ(ran.exit, 0) << ran.err;
    const auto x = Results(w / "run.h5").at("probe/rim", 10);
    return std::abs(std::atan2(x[1], x[0]) - 0.5 * (1 - std::cos(2 * 10.0)));
  };
  const double coarse = error("0.1", "energy-momentum"), fine = error("0.05", "energy-momentum");
  EXPECT_LT(100 * coarse, error("0.1", "mid-point")) << "the same method without the clock";
  EXPECT_GT(std::log2(coarse / fine), 3.8) << coarse << " " << fine;
}

/// Energies kept, and places on the same curve, whatever the clock does: also at steps of a tenth of a swing.
TEST(Clock, LeavesEnergyAloneAtLongSteps) {
  const Workplace w;
  w.write("scene.toml", pendulum + "[time]\nend = 40\nstep = 0.2\n");
  const Ran ran = w.run("hilo-solve --quiet scene.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto e = Results(w / "run.h5").history("energy");
  EXPECT_LT((e.col(0) + e.col(2)).array().abs().maxCoeff(), 1e-10 * e.col(0).maxCoeff());
}

}  // namespace
}  // namespace hilo::test
