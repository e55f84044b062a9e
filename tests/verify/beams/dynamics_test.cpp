// SPDX-License-Identifier: GPL-3.0-or-later
// Beams in motion: what a step keeps however long it is, and published motions.
#include <Eigen/Geometry>

#include "physics/joint.hpp"
#include "verify/beams/beam_scene.hpp"
#include "verify/spin_up/spin_up.hpp"

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

// Every kind of joints at the section in the middle of a free beam, by turns as end a and b: a hundred thousand times stiffer, the beam
// moves what hangs on it as a rigid bar does; soft, it keeps energy, and momenta where nothing holds to the ground.
TEST_F(BeamDynamics, JointsOfEveryKindActOnSections) {
  const double mu = 3, inertia = 2e-3;
  const std::string at = "at = [1, 0, 0.05]\n";
  struct Kind {
    const char* name;
    std::string keys;
    bool on_ground = false;
  };
  const Kind kinds[] = {
      {"fixed", at},
      {"spherical", at},
      {"revolute", at + "axis = [1, 0.5, 0]"},
      {"cylindrical", at + "axis = [1, 0, 0.3]"},
      {"prismatic", at + "axis = [1, 0.2, 0]"},
      {"universal", at + "axis = [0, 0, 1]\nx = [1, 0, 0]"},
      {"constant-velocity", at + "axis = [0, 0, 1]\naxis_b = [0, 0, 1]"},
      {"screw", at + "axis = [0.3, 0, 1]\npitch = 0.1"},
      {"planar", at + "axis = [0, 0, 1]"},
      {"in-plane", at + "axis = [0, 0, 1]"},
      {"in-line", at + "axis = [0, 0, 1]"},
      {"gear", at + "axis = [0, 0, 1]\nratio = -2", true},
      {"rack", at + "axis = [0, 0, 1]\ndirection = [1, 0, 0]\nradius = 0.1", true},
      {"distance", "at_a = [1, 0, 0]\nat_b = [1.1, 0.1, 0.2]"},
      {"weighted-sum", "at_a = [1, 0, 0]\nat_b = [1.1, 0.1, 0.2]\nfactors = [1, -2]\naxis_a = [0.2, 0, 1]", true},
      {"point-on-curve", at + "points = [[1, -1, 0.05], [1.2, -0.5, 0.05], [1.1, -0.1, 0.05], [1, 0, 0.05], [1.1, 0.5, 0.05]]"},
      {"rolling", at + "axis = [0, 0, 1]\nradius = 0.05"},
      {"knife-edge", at + "axis = [0, 0, 1]\nedge = [1, 0.2, 0]"}};
  ASSERT_EQ(std::size(kinds), joint_kinds().size());
  const auto scene = [&](const Kind& kind, double stiff, bool swap) {  // stiff 0: a rigid bar
    const double J = 2 * mu * 4 / 12 + 2 * inertia;
    const std::string beam = plain_section(2e3 * stiff, 4e3 * stiff, 5 * stiff, 5 * stiff, "line_mass = 3\ninertia = [2e-3, 2e-3]") +
                             beam_of("[[0, 0, 0], [2, 0, 0]]", 4, ""),
                      on = stiff == 0 ? "arm" : "arm.2";
    return (stiff == 0 ? body("arm", 2 * mu, {1, 0, 0}, {4 * inertia, J, J}) : beam) +
           body("bob", 0.5, {1.1, 0.1, 0.2}, {0.01, 0.012, 0.008}) +
           fmt::format("[[joint]]\nkind = \"{}\"\nname = \"j\"\na = \"{}\"\nb = \"{}\"\n{}\n", kind.name, swap ? "bob" : on,
                       swap ? on : "bob", kind.keys) +
           initial("*", "velocity = [1, 2, -1]\nspin = [2, 3, 1]\nabout = [0.5, 0, 0]") +
           force("kick", "bob", {3, -4, 5}, "history = {t = [0, 0.05, 0.1], value = [0, 1, 0]}") + in_time(0.2, 0.004);
  };
  bool swap = false;
  for (const Kind& kind : kinds) {
    const Drift k = drift(solved(scene(kind, 1, swap)), 0.102);
    EXPECT_GT(k.strained, 1e-3) << kind.name;
    EXPECT_LT(k.energy, 1e-12) << kind.name;
    if (!kind.on_ground) {
      EXPECT_LT(k.momentum, 1e-12) << kind.name;
      EXPECT_LT(k.angular, 1e-12) << kind.name;
    }
    swap = !swap;
    const Eigen::MatrixXd rigid = solved(scene(kind, 0, swap)).history("body/bob"),
                          stiff = solved(scene(kind, 1e5, swap)).history("body/bob");
    const double off = (stiff - rigid).cwiseAbs().maxCoeff();
    std::printf("%s%s: %.1e m\n", kind.name, swap ? ", swapped" : "", off);
    EXPECT_LT(off, 2e-4) << kind.name;
  }
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
  const Results r = solved(plain_section(1e7, 2.8e7, 1.4e4, 1.4e4, "line_mass = 1.2\ninertia = [6e-4, 6e-4]") +
                           beam_of("[[0, 0, 0], [10, 0, 0]]", 4, "") + SpinUpBeam::turned(work, "arm.0") + tip_probe() + in_time(18, 0.02));
  const Eigen::MatrixXd x = r.history("probe/tip");
  const auto in_hub = [&](Eigen::Index i) { return SpinUpBeam::in_hub(r.t()[i], x.row(i).head<3>()); };
  double most = 0, steady = 0;
  for (int t = 1; t <= 14; ++t) most = std::max(most, std::abs(in_hub(r.index(t))[1] - SpinUpBeam::u2[t]));
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
