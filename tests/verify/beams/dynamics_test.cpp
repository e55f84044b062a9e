// SPDX-License-Identifier: GPL-3.0-or-later
// Beams in motion: what a step keeps however long it is, and published motions.
#include <Eigen/Geometry>

#include "succeeded.hpp"
#include "verify/beams/beam_scene.hpp"

namespace hilo::test::beams_dynamics_test {
namespace {

using BeamDynamics = BeamPlace;

/// Simo and Vu-Quoc's flying spaghetti in space: ten cells, thrown by a force and moments at one end.
std::string spaghetti(double end, double step, const std::string& more = "") {
  const std::string hat = "history = {t = [0, 2.5, 5], value = [0, 1, 0]}";
  return plain_section(1e4, 1e4, 500, 500, "line_mass = 1\ninertia = [10, 10]") + beam_of("[[6, 0, 0], [0, 8, 0]]", 10, "") +
         push("arm.0", Vec3(20, 0, 0), hat) + twist("arm.0", Vec3(0, -100, -200), hat) + tip_probe() + in_time(end, step, more);
}

TEST_F(BeamDynamics, TheFlyingSpaghettiKeepsEnergyAndMomentaOverTenThousandSteps) {
  const Results r = solved(spaghetti(1000, 0.1));
  const Drift k = drift(r, 5.05);
  std::printf("E %.2g, P %.2g, L %.2g\n", k.energy, k.momentum, k.angular);
  EXPECT_LT(k.energy, 1e-10);
  EXPECT_LT(k.momentum, 1e-10);
  EXPECT_LT(k.angular, 1e-10);
  EXPECT_NEAR(r.history("momentum")(100, 0), 50, 1e-9) << "the impulse";
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * 728) << "with the work of the loads";
}

TEST_F(BeamDynamics, TheFlyingSpaghettiKeepsThemInStepsOfHalfASecond) {
  const Drift k = drift(solved(spaghetti(300, 0.5)), 5.05);
  EXPECT_LT(k.energy, 1e-10);
  EXPECT_LT(k.momentum, 1e-10);
  EXPECT_LT(k.angular, 1e-10);
}

std::string right_angle(int steps) {
  return plain_section(1e6, 1e6, 1e3, 1e3, "line_mass = 1\ninertia = [10, 10]") + beam_of("[[0, 0, 0], [10, 0, 0], [10, 10, 0]]", 8) +
         push("arm.8", Vec3(0, 0, 50), "history = {t = [0, 1, 2], value = [0, 1, 0]}") + tip_probe() + in_time(0.25 * steps, 0.25);
}
TEST_F(BeamDynamics, TheRightAngleKeepsItsEnergy) { EXPECT_LT(drift(solved(right_angle(400)), 2.05).energy, 1e-10); }
class DISABLED_LongThinBeams : public BeamDynamics {};  // half a minute
TEST_F(DISABLED_LongThinBeams, TheRightAngleKeepsItsEnergyOverTenThousandSteps) {
  const double change = drift(solved(right_angle(10000)), 2.05).energy;
  std::printf("E %.2g\n", change);
  EXPECT_LT(change, 1e-10);
}

// A beam that rides on a rigid body off its axis and turned: no rows, nothing lost.
TEST_F(BeamDynamics, ABodyWithABeamOffItsAxisKeepsThemToo) {
  const Results r =
      solved(plain_section(1e4, 1e4, 500, 500, "line_mass = 1\ninertia = [10, 10]") +
             "[[body]]\nname = \"hub\"\nmass = 8\ncom = [0, 0, 0]\ninertia = [6, 7, 8, 0.5, -0.3, 0.2]\n" +
             beam_of("[[0.5, 0.3, -0.2], [4, 6, 7]]", 6, "a = \"hub\"\norientation = [1, 0.2, 0.3]") +
             "[[initial]]\non = [\"*\"]\nvelocity = [1, 2, -1]\nspin = [0.4, -0.3, 0.6]\nabout = [1, 0, 0]\n" + in_time(40, 0.1));
  const Drift k = drift(r, 0);
  EXPECT_GT(r.history("energy").col(1).maxCoeff(), 0.05);
  EXPECT_LT(k.energy, 1e-11);
  EXPECT_LT(k.momentum, 1e-11);
  EXPECT_LT(k.angular, 1e-11);
}

// What damping takes is in the balance, and it never pays in.
TEST_F(BeamDynamics, DampingTakesWhatTheBalanceSays) {
  const Results r = solved("gravity = [0, 0, -1]\n" + plain_section(1e4, 1e4, 500, 500, "line_mass = 1\ninertia = [10, 10]") +
                           beam_of("[[6, 0, 0], [0, 8, 0]]", 6, "damping = 0.02\nmass_damping = 0.05") + tip_probe() +
                           push("arm.0", Vec3(20, 5, 3)) + in_time(10, 0.1, "dissipation = 0.2"));
  const Eigen::MatrixXd E = r.history("energy");
  EXPECT_GT(E(E.rows() - 1, 4), 1);
  EXPECT_GE((E.col(4).tail(E.rows() - 1) - E.col(4).head(E.rows() - 1)).minCoeff(), 0);
  EXPECT_LT(E.col(5).cwiseAbs().maxCoeff(), 1e-9 * E.col(3).cwiseAbs().maxCoeff());
}

// A free beam under a force per length: the impulse, on one rank and on two; the balance is checked in every step.
TEST_F(BeamDynamics, ALineLoadGivesItsImpulse) {
  const std::string scene = plain_section(1e4, 1e4, 100, 100, "line_mass = 2\ninertia = [0.1, 0.1]") +
                            beam_of("[[0, 0, 0], [3, 4, 0]]", 4, "") +
                            "[[load]]\nkind = \"line\"\nname = \"gust\"\non = \"arm\"\nforce_per_length = [1, 2, -3]\n"
                            "history = {t = [0, 1], value = [0, 2]}\n" +
                            in_time(1, 0.1);
  for (const char* options : {"", "--set time.integrator=\"generalized-alpha\""}) {
    const Eigen::MatrixXd p = solved(scene, options).history("momentum");
    EXPECT_LT((p.bottomRows(1).leftCols<3>().transpose() - 5 * Vec3(1, 2, -3)).norm(), 1e-8) << options;
  }
}

// One that turns with the beam and varies along it: the balance of energy holds at every step, and it drives what it is on without an end.
TEST_F(BeamDynamics, ALineLoadThatTurnsIsInTheBalance) {
  const std::string scene =
      plain_section(1e4, 1e4, 100, 100, "line_mass = 2\ninertia = [0.1, 0.1]") + beam_of("[[0, 0, 0], [3, 4, 0]]", 4, "") +
      "[[load]]\nkind = \"line\"\nname = \"jet\"\non = \"arm\"\nforce_per_length = [2, 4, -3]\nforce_per_length_end = [-1, 3, 5]\n"
      "follower = true\nhistory = {t = [0, 2], value = [0, 2]}\n" +
      in_time(2, 0.05);
  const Results one = solved(scene);
  const Eigen::MatrixXd E = one.history("energy");
  EXPECT_GT(E.col(0).maxCoeff(), 10) << "it moves";
  EXPECT_LT(E.col(5).cwiseAbs().maxCoeff(), 1e-8 * E.col(0).maxCoeff());
  succeeded(mpirun(2, "hilo-solve --quiet scene.toml -o two.h5", work.path()));
  EXPECT_LT((Results(work / "two.h5").history("beam/arm") - one.history("beam/arm")).cwiseAbs().maxCoeff(), 1e-6);
}

// Four cells, the root turned by a law, whose work is in the balance.
TEST_F(BeamDynamics, SpinUpBendsBackAndIsStretched) {
  const auto psi = [](double t) {
    return t < 15 ? 0.4 * (t * t / 2 + std::pow(7.5 / M_PI, 2) * (std::cos(2 * M_PI * t / 15) - 1)) : 6 * t - 45;
  };
  std::string csv = "t,psi\n";
  for (int i = 0; i <= 900; ++i) csv += fmt::format("{:.17g},{:.17g}\n", 0.02 * i, psi(0.02 * i));
  work.write("spin.csv", csv);
  const Results r = solved(plain_section(1e7, 2.8e7, 1.4e4, 1.4e4, "line_mass = 1.2\ninertia = [6e-4, 6e-4]") +
                           beam_of("[[0, 0, 0], [10, 0, 0]]", 4, "") +
                           "[[motion]]\nkind = \"rotation\"\nname = \"hub\"\non = \"arm.0\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 1\n"
                           "history = \"psi\"\n[history.psi]\nfile = \"spin.csv\"\n" +
                           tip_probe() + in_time(18, 0.02));
  const Eigen::MatrixXd x = r.history("probe/tip");
  const auto in_hub = [&](Eigen::Index i) -> Vec3 {
    return Eigen::AngleAxisd(-psi(r.t()[i]), Vec3::UnitZ()) * Vec3(x(i, 0), x(i, 1), x(i, 2)) - Vec3(10, 0, 0);
  };
  const std::pair<int, double> table[] = {{1, -0.02054},  {2, -0.10238},  {3, -0.21726},  {4, -0.34227}, {5, -0.46846},
                                          {6, -0.54360},  {7, -0.57133},  {8, -0.54288},  {9, -0.46032}, {10, -0.36287},
                                          {11, -0.25740}, {12, -0.15093}, {13, -0.06924}, {14, -0.02030}};
  double most = 0, steady = 0;
  for (const auto& [t, u2] : table) most = std::max(most, std::abs(in_hub(r.index(t))[1] - u2));
  int n = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (r.t()[i] > 15.5) steady += in_hub(i)[0], ++n;
  std::printf("u2 within %.2g of the table, steady u1 %.4g\n", most, steady / n);
  EXPECT_LT(most, 0.003);
  EXPECT_NEAR(steady / n, 5.143e-4, 0.02 * 5.143e-4);
  const Eigen::MatrixXd E = r.history("energy");
  EXPECT_LT(E.col(5).cwiseAbs().maxCoeff(), 1e-9 * E.col(0).maxCoeff()) << "the work of the motion is the change of energy";
}

// What any other method makes of the flight tends to that of energy-momentum.
TEST_F(BeamDynamics, EveryIntegratorFliesTheSameWay) {
  const Vec3 there = tip(spaghetti(4, 2.5e-3));
  for (const char* method : {"mid-point", "generalized-alpha", "newmark", "hht", "wbz", "U0", "V0", "bathe", "bdf2", "radau", "gauss"}) {
    const double away = (tip(spaghetti(4, 5e-3, fmt::format("integrator = \"{}\"", method))) - there).norm();
    std::printf("%s: %.2g m\n", method, away);
    EXPECT_LT(away, 0.02) << method << ", of a way of " << there.norm();
  }
}

TEST_F(BeamDynamics, IsTheSameOnRanks) {
  work.write("scene.toml", spaghetti(6, 0.1));
  for (const int n : {1, 2, 3}) {
    succeeded(mpirun(n, fmt::format("hilo-solve --quiet scene.toml -o r{}.h5", n), work.path()));
  }
  const Results one(work / "r1.h5");
  for (const char* n : {"r2.h5", "r3.h5"})
    for (const char* name : {"probe/tip", "beam/arm", "energy", "momentum"})
      EXPECT_LT((Results(work / n).history(name) - one.history(name)).cwiseAbs().maxCoeff(), 1e-6) << n << " " << name;
}

}  // namespace
}  // namespace hilo::test::beams_dynamics_test
