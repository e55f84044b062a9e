// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of linear fidelity: against closed forms, and against the same beams with fidelity nonlinear where they move little.
#include "ranks.hpp"
#include "verify/beams/beam_scene.hpp"
#include "verify/natural_modes/natural_modes.hpp"

namespace hilo::test::linear_beams_test {
namespace {

const std::string linear = "fidelity = \"linear\"\n", rigid = "fidelity = \"rigid\"\n", sharp = "[solver]\ntolerance = 1e-10\n";

class LinearBeams : public BeamPlace {
 protected:
  Results solved_as(const std::string& name, const std::string& scene, const std::string& options = "") {
    work.write(name + ".toml", scene);
    succeeded(ran = work.run(fmt::format("hilo-solve {0}.toml -o {0}.h5 {1}", name, options)));
    return Results(work / (name + ".h5"));
  }
  /// Both fidelities of a scene, in which FIDELITY stands for keys of its beams: what a history differs by, over its largest value.
  double apart(const std::string& scene, const std::vector<std::string>& histories) {
    const auto with = [&](const std::string& keys) {
      std::string out = scene;
      for (size_t at; (at = out.find("FIDELITY")) != out.npos;) out.replace(at, 8, keys);
      return out;
    };
    const Results one = solved_as("linear", with(linear)), other = solved_as("nonlinear", with(""));
    double most = 0;
    for (const std::string& name : histories) {
      const Eigen::MatrixXd a = one.history(name), b = other.history(name);
      const double off = (a - b).cwiseAbs().maxCoeff() / (b.rowwise() - b.row(0)).cwiseAbs().maxCoeff();
      std::printf("%s: %.2g\n", name.c_str(), off);
      most = std::max(most, off);
    }
    return most;
  }
};

std::string square_beam(int cells, const std::string& more) {
  return "[section.s]\nkind = \"rectangle\"\nwidth = 0.05\nheight = 0.05\n[material.m]\nE = 2e11\nnu = 0.3\ndensity = 7800\n" +
         beam_of("[[0, 0, 0], [1, 0, 0]]", cells, "material = \"m\"\n" + linear + more);
}

// Bernoulli's cantilever, less what shear and turns of sections soften it by: Timoshenko's, 1.8751 and 4.6941 (Huang 1961).
TEST_F(LinearBeams, ACantileverHasItsFrequencies) {
  work.write("scene.toml", square_beam(8, "a = \"ground\"") + "[time]\nanalysis = \"modes\"\nmodes = 8\n");
  succeeded(ran = work.run("hilo-solve scene.toml -o run.h5"));
  const Eigen::VectorXd f = Results(work / "run.h5").history("mode").col(0).tail(8);
  const double E = 2e11, rho = 7800, A = 0.0025, I = A * A / 12, s = std::sqrt(E * I / (rho * A)) / (2 * pi);
  for (const int k : {0, 1}) EXPECT_NEAR(f[k], 1.8751041 * 1.8751041 * s, 4e-3 * f[k]);
  for (const int k : {2, 3}) EXPECT_NEAR(f[k], 4.6940911 * 4.6940911 * s, 2e-2 * f[k]);
  EXPECT_NEAR(f[6], std::sqrt(2e11 / 2.6 * 0.140577 * A * A / (rho * 2 * I)) / 4, 1e-4 * f[6]) << "torsion";
  EXPECT_NEAR(f[7], std::sqrt(E / rho) / 4, 2e-3 * f[7]) << "stretch";
}

// Hoppe: in its plane w^2 = EI n^2 (n^2 - 1)^2/((n^2 + 1) m R^4), out of it with n^2 + 1 + nu in place of n^2 + 1.
TEST_F(LinearBeams, ARingHasHoppesFrequencies) {
  const double r = 0.004, E = 2e11, nu = 0.3, rho = 7800;
  work.write("scene.toml",
             "[section.s]\nkind = \"circle\"\ndiameter = 0.008\n[material.m]\nE = 2e11\nnu = 0.3\ndensity = 7800\n" +
                 beam_of("[[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]]", 12, "material = \"m\"\npath = \"arc\"\n" + linear) +
                 "[time]\nanalysis = \"modes\"\nmodes = 14\n");
  succeeded(ran = work.run("hilo-solve scene.toml -o run.h5"));
  const Eigen::VectorXd f = Results(work / "run.h5").history("mode").col(0).tail(14);
  EXPECT_LT(f.head<6>().cwiseAbs().maxCoeff(), 1e-2 * f[6]);
  Eigen::Index k = 6;
  for (const int n : {2, 3})
    for (const double c : {1 + nu, 1.0})
      for (int copy = 0; copy < 2; ++copy, ++k) {
        const double exact = std::sqrt(E / rho) * r / 2 / (2 * pi) * n * (n * n - 1) / std::sqrt(n * n + c);
        EXPECT_NEAR(f[k], exact, 2e-3 * exact) << k;
      }
}

// F L^3/3EI + F L/GA at the tip, F (L - x) along it; a quarter of a circle: F R^3 pi/4EI under a force along its radius at the tip, and
// F L of moment at its foot.
TEST_F(LinearBeams, TipsGiveAsClosedFormsSay) {
  const double EI = 1e4, GA = 1e6, F = 1;
  const std::string section =
      "[section.s]\nkind = \"matrix\"\nstiffness = [1e6, 1e6, 1e9]\nbending = [1e4, 1e4, 8e3]\nline_mass = 2\n"
      "inertia = [1e-3, 1e-3]\n";
  const Results r = solved(section + beam_of("[[0, 0, 0], [2, 0, 0]]", 3, "a = \"ground\"\n" + linear) + push("arm.end", Vec3(0, 0, F)) +
                           tip_probe() + in_steps(1) + sharp);
  const Eigen::MatrixXd tip = r.history("probe/tip");
  EXPECT_NEAR(tip(tip.rows() - 1, 2), F * 8 / (3 * EI) + F * 2 / GA, 1e-5 * F * 8 / (3 * EI));
  const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
  for (int end = 0; end < 6; ++end) {
    const double x = 2. * ((end + 1) / 2) / 3;
    EXPECT_NEAR(f[6 * end + 1], F, 1e-5);
    EXPECT_NEAR(f[6 * end + 3], -F * (2 - x), 1e-5);
  }
  const double h = std::sqrt(0.5);
  const Results arch = solved(
      section + beam_of(fmt::format("[[1, 0, 0], [{0:.17g}, {0:.17g}, 0], [0, 1, 0]]", h), 8, "a = \"ground\"\npath = \"arc\"\n" + linear) +
      push("arm.end", Vec3(0, F, 0)) + tip_probe() + in_steps(1) + sharp);
  const Eigen::MatrixXd top = arch.history("probe/tip");
  const double exact = F * pi / 4 * (1 / EI + 1 / GA + 1 / 1e9);  // m = F cos a, shear F sin a or cos a, stretch the other
  EXPECT_NEAR(top(top.rows() - 1, 1) - 1, exact, 1e-3 * exact);
}

// However slender and however turned: stretch is 1e8 times as stiff as bending here, and its force is still exact.  Bernoulli's
// frequencies.
TEST_F(LinearBeams, OfAnySlendernessKeepTheirDigits) {
  const Vec3 along(0.6, 0.48, 0.64);
  const double E = 2e11, h = 1e-4, I = h * h * h * h / 12, pull = 1e-5 * E * I, push_across = 1e-3 * pull;
  for (const int cells : {4, 40}) {
    const std::string scene =
        fmt::format("[section.s]\nkind = \"rectangle\"\nwidth = {0}\nheight = {0}\n[material.m]\nE = 2e11\nnu = 0.3\ndensity = 7800\n{1}",
                    h, beam_of("[[0, 0, 0], [0.6, 0.48, 0.64]]", cells, "material = \"m\"\na = \"ground\"\n" + linear));
    const Results r = solved(scene + push("arm.end", pull * along + push_across * Vec3(0.8, 0, -0.75 * 0.8)) + tip_probe() + in_steps(1));
    const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
    const double N = pull + push_across * (0.48 - 0.384);
    for (int end = 0; end < 2 * cells; ++end) EXPECT_NEAR(f[6 * end + 2], N, 1e-6 * N) << cells;
    const Vec3 across = push_across * (Vec3(0.8, 0, -0.6) - along * along.dot(Vec3(0.8, 0, -0.6))),
               u = r.history("probe/tip").row(1).head<3>().transpose() - along;
    EXPECT_LT((u - u.dot(along) * along - across / (3 * E * I)).norm(), 1e-5 * across.norm() / (3 * E * I)) << cells;
    work.write("modes.toml", scene + "[time]\nanalysis = \"modes\"\nmodes = 2\n");
    succeeded(work.run("hilo-solve modes.toml -o modes.h5"));
    const double exact = 1.8751041 * 1.8751041 / (2 * pi) * std::sqrt(E / 7800 * h * h / 12);
    for (const int k : {0, 1}) EXPECT_NEAR(Results(work / "modes.h5").history("mode").col(0).tail(2)[k], exact, 1e-4 * exact) << cells;
  }
}

// Rigid motion is exact: a free beam that spins keeps its momenta, however far it turns.
TEST_F(LinearBeams, AFreeBeamKeepsItsMomenta) {
  const Results r =
      solved(plain_section(1e6, 1e6, 500, 500, "line_mass = 1\ninertia = [1e-2, 1e-2]") + beam_of("[[0, 0, 0], [1, 0.5, 0.2]]", 6, linear) +
             "[[initial]]\non = [\"arm.*\"]\nvelocity = [1, 2, -1]\nspin = [0.4, -0.3, 2]\nabout = [1, 0, 0]\n" + in_time(10, 0.02));
  const Drift k = drift(r, 0);
  EXPECT_LT(k.energy, 1e-10);
  EXPECT_LT(k.momentum, 1e-10);
  EXPECT_LT(k.angular, 1e-10);
}

std::string frame(const std::string& more, double g = 9.81) {  // two legs and a beam between them on a section and a body without mass
  return fmt::format("gravity = [0, 0, {}]\n", -g) +
         "[section.s]\nkind = \"tube\"\ndiameter = 0.04\nthickness = 0.003\n[material.m]\nE = 2e11\nnu = 0.3\ndensity = 7800\n" +
         beam_of("[[0, 0, 0], [0, 0, 1], [1, 0, 1]]", 3, "material = \"m\"\na = \"ground\"\nFIDELITY" + more) +
         "[beam.leg]\npoints = [[1, 1, 0], [1, 1, 1]]\ncells = [3]\nsection = \"s\"\nmaterial = \"m\"\na = \"ground\"\nb = \"knee\"\n"
         "FIDELITY" +
         more +
         "[beam.cross]\npoints = [[1, 0.02, 1], [1, 0.98, 1]]\ncells = [4]\nsection = \"s\"\nmaterial = \"m\"\na = \"arm.end\"\n"
         "b = \"knee\"\nFIDELITY" +
         more + "[[body]]\nname = \"knee\"\nmass = 0\ncom = [1, 1, 1]\ninertia = [0, 0, 0]\n";
}

// At rest: moves, forces and moments, reactions of a spring, under weight, a push and loads by length.
TEST_F(LinearBeams, AtRestAFrameBearsWhatTheNonlinearOneDoes) {
  const std::string loads = push("arm.2", Vec3(0.3, 0.2, 0)) +
                            "[[load]]\nkind = \"line\"\nname = \"snow\"\non = \"cross\"\nforce_per_length = [0, 0.2, -1]\n"
                            "force_per_length_end = [0, 0, -3]\n"
                            "[[load]]\nkind = \"line\"\nname = \"wind\"\non = \"leg\"\nforce_per_length = [2, 1, 0.5]\nfollower = true\n";
  EXPECT_LT(
      apart(frame("") + loads + spring("axial", "stay", "ground", "cross.2", "at_a = [1, 0.5, 2]\nat_b = [1, 0.5, 1]\nstiffness = 1e3") +
                probe("p", "cross.1") + probe("knee") + in_steps(1),
            {"probe/p", "probe/knee", "beam/arm", "beam/cross", "beam/leg", "spring/stay", "body/arm.4"}),
      2e-3);
}

// A beam bears its weight: at the foot of a post all of it, half of it in the middle, whatever the bending beside it.
TEST_F(LinearBeams, APostBearsItsWeightExactly) {
  const Results r = solved("gravity = [1, 0, -9.81]\n" + plain_section(1e8, 1e8, 1e6, 1e6, "line_mass = 3\ninertia = [1e-4, 1e-4]") +
                           beam_of("[[0, 0, 0], [0, 0, 2]]", 8, "a = \"ground\"\n" + linear) + in_steps(1) + sharp);
  const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
  for (int end = 0; end < 16; ++end) {
    const double above = 2 - 2. * ((end + 1) / 2) / 8;
    EXPECT_NEAR(f[6 * end + 2], -3 * 9.81 * above, 3e-2);  // what the mean axes turn by tells of the force across
    EXPECT_NEAR(f.segment<3>(6 * end + 3).norm(), 3 * above * above / 2, 1e-3 * 6);
  }
}

// Moving: a push that comes and goes, damping by stiffness and by mass, a weight on the frame.  What their own weight softens the legs by
// a linear beam does not know, so it is small.
TEST_F(LinearBeams, MovingLittleAFrameDoesWhatTheNonlinearOneDoes) {
  const std::string moved = push("arm.2", Vec3(3, 2, 1), "history = {t = [0, 0.01, 0.02], value = [0, 1, 0], interpolation = \"smooth\"}");
  EXPECT_LT(apart(frame("damping = 2e-4\nmass_damping = 3\nmodes = 400\nup_to = 1e7\n", 0.1) + moved +
                      "[[point_mass]]\nname = \"w\"\non = \"cross.2\"\nmass = 2\n" + probe("p", "cross.1") + probe("q", "arm.5") +
                      in_time(0.1, 2e-4, "start = \"equilibrium\""),
                  {"probe/p", "probe/q", "beam/arm", "beam/cross"}),
            5e-4);
}

// The slowest swing of a rod on a hinge, sqrt(3 g/2 L), and no more: large turns are those of a rigid bar.
TEST_F(LinearBeams, OnAHingeItSwingsAsARigidBar) {
  const auto swing = [&](const std::string& name, const std::string& part, const std::string& on, const std::string& end) {
    const Results r = solved_as(name, "gravity = [0, 0, -9.81]\n" + part + axial("revolute", "pin", "ground", on, {0, 0, 0}, {0, 1, 0}) +
                                          probe("tip", end, "at = [1, 0, 0]") + in_time(2, 5e-3));
    return r.history("probe/tip");
  };
  const std::string section = plain_section(1e7, 2e7, 5e4, 5e4, "line_mass = 3\ninertia = [1e-3, 1e-3]");
  const Eigen::MatrixXd beam = swing("beam", section + beam_of("[[0, 0, 0], [1, 0, 0]]", 4, linear), "arm.0", "arm.end"),
                        bar = swing("bar", body("bar", 3, {0.5, 0, 0}, {2e-3, 0.25 + 1e-3, 0.25 + 1e-3}), "bar", "bar");
  EXPECT_GT(bar.col(0).maxCoeff() - bar.col(0).minCoeff(), 1.9) << "it turns far";
  EXPECT_LT((beam - bar).leftCols<3>().cwiseAbs().maxCoeff(), 2e-3);
}

// Regions of linear beams and others: a nonlinear beam on a section of a linear one, as if both were nonlinear.
TEST_F(LinearBeams, MeetNonlinearBeams) {
  EXPECT_LT(apart("gravity = [0, 0, -9.81]\n[section.s]\nkind = \"tube\"\ndiameter = 0.04\nthickness = 0.003\n[material.m]\nE = 2e11\n"
                  "nu = 0.3\ndensity = 7800\n" +
                      beam_of("[[0, 0, 0], [0, 0, 1]]", 4, "material = \"m\"\na = \"ground\"\nFIDELITY") +
                      "[beam.rod]\npoints = [[0, 0, 0.5], [1, 0, 0.5]]\ncells = [3]\nsection = \"s\"\nmaterial = \"m\"\na = \"arm.2\"\n" +
                      probe("p", "rod.end") + in_steps(1),
                  {"probe/p", "beam/arm", "beam/rod"}),
            1e-3);
}

// hilo-reduce keeps the modes of beams, of a scene without a mesh too; the run is the same, bit by bit, and what differs is refused.
TEST_F(LinearBeams, ModesOnFileServe) {
  std::string scene = frame("") + probe("p", "cross.1") + push("arm.2", Vec3(3, 2, 1)) + in_time(0.01, 5e-4);
  for (size_t at; (at = scene.find("FIDELITY")) != scene.npos;) scene.replace(at, 8, linear);
  const Results found = solved_as("found", scene);
  succeeded(work.run("hilo-reduce found.toml -o reduced.h5"));
  const Results taken = solved_as("taken", scene, "--modes reduced.h5");
  for (const std::string name : {"energy", "probe/p", "beam/arm"}) EXPECT_EQ(found.history(name), taken.history(name)) << name;
  expect_end(work.run("hilo-solve found.toml --modes reduced.h5 -o no.h5 --set material.m.E=1e11"), 2, "does not serve");
}

TEST_F(LinearBeams, AreTheSameOnRanksAndAfterARestart) {
  std::string scene = frame("") + probe("p", "cross.1") + push("arm.2", Vec3(3, 2, 1)) + in_time(0.02, 5e-4) + sharp;
  for (size_t at; (at = scene.find("FIDELITY")) != scene.npos;) scene.replace(at, 8, linear);
  const Results one = solved_as("one", scene);
  for (const int n : {2, 3}) {
    succeeded(mpirun(n, "hilo-solve --quiet one.toml -o ranks.h5", work.path()));
    for (const std::string name : {"probe/p", "beam/arm", "body/arm.4"}) {
      const Eigen::MatrixXd a = one.history(name), b = Results(work / "ranks.h5").history(name);
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-7 * a.cwiseAbs().maxCoeff()) << name << " on " << n;
    }
  }
  succeeded(work.run("hilo-solve one.toml -o cut.h5 --checkpoint 10steps --set time.end=0.01"));
  succeeded(work.run("hilo-solve --restart cut.h5 --set time.end=0.02 --accept"));
  const Eigen::MatrixXd a = one.history("probe/p"), b = Results(work / "cut.h5").history("probe/p");
  ASSERT_EQ(a.rows(), b.rows());
  // the step to the earlier end is shorter by round-off, and the tolerance is 1e-10
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9 * a.cwiseAbs().maxCoeff());
}

// A rigid beam is the body that its sections make.  Welds of its sections and joints of a body take the same swing by steps of second
// order, each its own.
TEST_F(LinearBeams, RigidOnesMoveAsTheBodyTheyAre) {
  const auto swing = [&](const std::string& name, const std::string& part, const std::string& on, const std::string& end) {
    return solved_as(name, "gravity = [0, 0, -9.81]\n" + part + axial("revolute", "pin", "ground", on, {0, 0, 0}, {0, 1, 0}) +
                               "[[load]]\nkind = \"torque\"\nname = \"t\"\non = \"" + end + "\"\ntorque = [0, 2, 0]\n" +
                               probe("tip", end, "at = [1, 0, 0]") + in_time(2, 1e-3) + sharp);
  };
  const std::string section = plain_section(1e7, 2e7, 5e4, 5e4, "line_mass = 3\ninertia = [1e-3, 1e-3]");
  const Results beam = swing("beam", section + beam_of("[[0, 0, 0], [1, 0, 0]]", 4, rigid), "arm.0", "arm.end"),
                bar = swing("bar", body("bar", 3, {0.5, 0, 0}, {2e-3, 0.25 + 1e-3, 0.25 + 1e-3}), "bar", "bar");
  for (const std::string name : {"probe/tip", "joint/pin", "energy"}) {
    const Eigen::MatrixXd a = beam.history(name), b = bar.history(name);
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-4 * b.cwiseAbs().maxCoeff()) << name;
  }
}

// Rigid between others: as a nonlinear beam that is a million times as stiff, under loads by length, weights and a spring.
TEST_F(LinearBeams, RigidOnesMeetLinearAndNonlinearOnes) {
  const auto scene = [&](const std::string& of_arm) {
    return "gravity = [0, 0, -0.1]\n" + plain_section(1e8, 2e8, 2e5, 1.5e5, "line_mass = 3\ninertia = [1e-3, 1e-3]") +
           "[section.stiff]\nkind = \"matrix\"\nstiffness = [1e14, 1e14, 2e14]\nbending = [2e11, 2e11, 1.5e11]\nline_mass = 3\n"
           "inertia = [1e-3, 1e-3]\n"
           "[beam.arm]\npoints = [[0, 0, 1], [1, 0, 1], [1, 1, 1]]\ncells = [2, 3]\na = \"post.end\"\nb = \"knee\"\n" +
           of_arm + "[beam.post]\npoints = [[0, 0, 0], [0, 0, 1]]\ncells = [3]\nsection = \"s\"\na = \"ground\"\n" + linear +
           "[beam.leg]\npoints = [[1, 1, 0], [1, 1, 1]]\ncells = [3]\nsection = \"s\"\na = \"ground\"\nb = \"knee\"\n"
           "[[body]]\nname = \"knee\"\nmass = 0\ncom = [1, 1, 1]\ninertia = [0, 0, 0]\n"
           "[[load]]\nkind = \"line\"\nname = \"snow\"\non = \"arm\"\nforce_per_length = [0, 2, -1]\n"
           "[[load]]\nkind = \"line\"\nname = \"wind\"\non = \"arm\"\nforce_per_length = [0.2, 1, 0]\nfollower = true\n"
           "[[point_mass]]\nname = \"w\"\non = \"arm.1\"\nmass = 2\n" +
           spring("axial", "stay", "ground", "arm.3", "at_a = [1, 0.5, 2]\nat_b = [1, 0.3333333333333333, 1]\nstiffness = 1e4") +
           probe("p", "arm.2") + in_steps(1) + sharp;
  };
  const Results one = solved_as("rigid", scene("section = \"s\"\n" + rigid)), other = solved_as("stiff", scene("section = \"stiff\"\n"));
  for (const std::string name : {"probe/p", "beam/post", "beam/leg", "spring/stay"}) {
    const Eigen::MatrixXd a = one.history(name), b = other.history(name);
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-4 * (b.rowwise() - b.row(0)).cwiseAbs().maxCoeff()) << name;
  }
  EXPECT_FALSE(one.file().has("/history/beam/arm")) << "what it bears is not known";
  succeeded(mpirun(2, "hilo-solve --quiet rigid.toml -o ranks.h5", work.path()));
  const Eigen::MatrixXd a = one.history("beam/post"), b = Results(work / "ranks.h5").history("beam/post");
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-7 * a.cwiseAbs().maxCoeff());
  succeeded(work.run("hilo-post render rigid.h5 --field von_mises --steps last -o picture.png"));
  succeeded(work.run("hilo-post beam rigid.h5"));
  EXPECT_EQ(work.run("hilo-post beam rigid.h5 arm").exit, 2);
}

// Rows that depend on others are found through rigid beams as through bodies: a four-bar linkage in a plane, of three rigid beams or of the
// bodies that they are; and what holds itself, with the reaction of a lever.
TEST_F(LinearBeams, RigidOnesMayBeHeldMoreThanEnough) {
  const Vec3 at[] = {{0, 0, 0}, {0.1, 0, 0.2}, {0.7, 0, 0.45}, {0.6, 0, 0}};
  const char* names[] = {"crank", "coupler", "rocker"};
  const auto linkage = [&](bool beams) {
    std::string out = "gravity = [0, 0, -9.81]\n" + plain_section(1e7, 2e7, 5e4, 5e4, "line_mass = 3\ninertia = [1e-3, 1e-3]");
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = at[k + 1] - at[k], t = along.normalized();
      const double L = along.norm();
      const Mat3 J = L * L * L / 4 * (Mat3::Identity() - t * t.transpose()) + L * 1e-3 * (Mat3::Identity() + t * t.transpose());
      if (beams)
        out += fmt::format("[beam.{}]\npoints = [{}, {}]\ncells = [3]\nsection = \"s\"\n{}", names[k], list(at[k]), list(at[k + 1]), rigid);
      else
        out += fmt::format("[[body]]\nname = \"{}\"\nmass = {}\ncom = {}\ninertia = [{}, {}, {}, {}, {}, {}]\n", names[k], 3 * L,
                           list((at[k] + at[k + 1]) / 2), J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2));
    }
    const auto end = [&](int k, const char* which) -> std::string {
      return k < 0 || k > 2 ? "ground" : beams ? names[k] + std::string(".") + which : names[k];
    };
    for (int k = 0; k < 4; ++k)
      out += axial("revolute", fmt::format("j{}", k), k < 3 ? end(k - 1, "end") : "ground", k < 3 ? end(k, "0") : end(2, "end"), at[k],
                   {0, 1, 0});
    return out + probe("p", end(1, "end"), fmt::format("at = {}", list(at[2]))) + in_time(0.3, 1e-3) + sharp;
  };
  const Results beam = solved_as("beam", linkage(true)), bar = solved_as("bar", linkage(false));
  for (const std::string name : {"probe/p", "joint/j0", "joint/j2", "joint/j3", "energy"}) {
    const Eigen::MatrixXd a = beam.history(name), b = bar.history(name);
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-3 * b.cwiseAbs().maxCoeff()) << name;
  }
  (void)solved_as("cut", linkage(true), "--checkpoint 10steps --set time.end=0.1");
  succeeded(work.run("hilo-solve --restart cut.h5 --set time.end=0.3 --accept"));
  const Eigen::MatrixXd whole = beam.history("probe/p"), cut = Results(work / "cut.h5").history("probe/p");
  ASSERT_EQ(whole.rows(), cut.rows());
  EXPECT_LT((whole - cut).cwiseAbs().maxCoeff(), 1e-8 * whole.cwiseAbs().maxCoeff()) << "gone on with";
  const Results lever = solved(
      plain_section(1e7, 2e7, 5e4, 5e4, "line_mass = 3\ninertia = [1e-3, 1e-3]") +
      beam_of("[[0, 0, 0], [3, 0, 0]]", 3, "a = \"hub\"\n" + rigid) + body("hub", 2, {0, 0, 0}, {1, 1, 1}) +
      axial("revolute", "pin", "ground", "hub", {0, 0, 0}, {0, 1, 0}) + axial("in-plane", "rest", "ground", "arm.1", {1, 0, 0}, {0, 0, 1}) +
      axial("in-plane", "guide", "ground", "arm.2", {2, 0, 0}, {0, 1, 0}) + push("arm.end", Vec3(0, 0, -6)) + in_steps(1));
  const Eigen::VectorXd rest = lever.history("joint/rest").bottomRows(1).transpose();
  EXPECT_NEAR(rest[2], 18, 1e-6);
  EXPECT_NEAR(lever.history("joint/guide").bottomRows(1).norm(), 0, 1e-6);
}

TEST_F(LinearBeams, WhatTheyCannotBeIsRefusedByName) {
  const auto refused = [&](const std::string& scene, const std::string& why) {
    work.write("scene.toml", scene + in_steps(1));
    const Ran r = work.run("hilo-solve scene.toml -o run.h5");
    EXPECT_EQ(r.exit, 2) << why;
    EXPECT_NE(r.err.find(why), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("scene.toml:"), std::string::npos) << r.err;
  };
  const std::string beam = beam_of("[[0, 0, 0], [1, 0, 0]]", 2, "a = \"ground\"\n" + linear);
  refused(plain_section(1e6, 1e6, 1e3, 1e3) + beam, "needs a mass");
  refused(plain_section(1e6, 1e6, 1e3, 1e3, "line_mass = 1") + beam, "inertia about its axis");
  refused(plain_section(1e6, 1e6, 1e3, 1e3) + beam_of("[[0, 0, 0], [1, 0, 0]]", 2, "a = \"ground\"\n" + rigid), "needs a mass");
  refused(plain_section(1e6, 1e6, 1e3, 1e3, "line_mass = 1\ninertia = [1e-3, 1e-3]") +
              beam_of("[[0, 0, 0], [1, 0, 0]]", 2, "fidelity = \"stiff\""),
          "is not known");
}

}  // namespace
}  // namespace hilo::test::linear_beams_test
