// SPDX-License-Identifier: GPL-3.0-or-later
// Factors of the loads at which drawn states give way, `analysis = "buckling"`, against closed forms.
#include "verify/beams/beam_scene.hpp"

namespace hilo::test::buckling_test {
namespace {

constexpr double pi = std::numbers::pi;

class Buckling : public BeamPlace {
 protected:
  /// Factors, the smallest in size first.
  std::vector<double> factors(const std::string& scene, int wanted) {
    work.write("scene.toml", scene + fmt::format("[time]\nanalysis = \"buckling\"\nmodes = {}\n", wanted));
    ran = work.run("hilo-solve scene.toml " + mesh + " -o run.h5");
    succeeded(ran);
    const Eigen::MatrixXd rows = Results(work / "run.h5").history("buckling");
    EXPECT_LT(rows.col(1).maxCoeff(), 1e-5) << "shapes satisfy the equations";
    std::vector<double> out;
    for (Eigen::Index k = 1; k < rows.rows(); ++k) out.push_back(rows(k, 0));
    return out;
  }
  std::string refused(const std::string& scene, const std::string& more = "", const std::string& command = "hilo-solve") {
    work.write("scene.toml", scene + "[time]\nanalysis = \"buckling\"\n" + more);
    ran = work.run(command + " --quiet scene.toml " + mesh + " -o run.h5");
    EXPECT_EQ(ran.exit, 2) << ran.err;
    return ran.err;
  }
  std::string mesh;
};

std::string column(const std::string& ends = "a = \"ground\"", int n = 12) {
  return "[section.s]\nkind = \"matrix\"\nstiffness = [1e8, 1e8, 1e8]\nbending = [100, 120, 100]\n" +
         beam_of("[[0, 0, 0], [0, 0, 1]]", n, ends);
}
/// A revolute joint about y with a torsion spring.
std::string hinge(const std::string& name, const std::string& a, const std::string& b, double z, double k) {
  return axial("revolute", name, a, b, Vec3(0, 0, z), Vec3::UnitY()) +
         spring("torsion", "k" + name, a, b, fmt::format("axis = [0, 1, 0]\nstiffness = {}\n", k));
}
std::string rod_at(const Vec3& com, const std::string& name = "rod") { return body(name, 1, com, Vec3::Constant(0.1)); }
std::string rod(const std::string& name, double z) { return rod_at(Vec3(0, 0, z), name); }
std::string down(const std::string& on, double z) { return push(on, Vec3(0, 0, -1), fmt::format("at = [0, 0, {}]\n", z)); }

TEST_F(Buckling, OfAColumnIsEulers) {
  const auto f = factors(column() + push("arm.end", Vec3(0, 0, -1)), 4);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(f[k] / (std::array{1., 1.2, 9., 10.8}[k] * pi * pi * 25), 1, 3e-4) << k;
  const auto pulled = factors(column() + push("arm.end", Vec3(0, 0, 1)), 1);
  EXPECT_NEAR(pulled[0] / f[0], -1, 1e-6) << "a pull buckles where it is reversed";
}

// Truth: Euler's load, a half of which has a history that is 1/2 at the end.
TEST_F(Buckling, OfLoadsWithAHistory) {
  const auto half = [](const std::string& name, double size, const std::string& more) {
    return force(name, "arm.end", Vec3(0, 0, -size), more);
  };
  const auto f = factors(column() + half("a", 0.5, "") + half("b", 1, "history = {t = [0, 1], value = [0, 0.5]}"), 1);
  EXPECT_NEAR(f[0] / (pi * pi * 25), 1, 3e-4);
}

// Under its own weight: 7.8373 EI/(q L^3) [timoshenko-gere-1961].
TEST_F(Buckling, OfAHeavyColumnIsGreenhills) {
  const std::string weight = "[[load]]\nkind = \"line\"\nname = \"q\"\non = \"arm\"\nforce_per_length = [0, 0, -1]\n";
  EXPECT_NEAR(factors(column("a = \"ground\"", 24) + weight, 1)[0] / 783.73, 1, 2e-3);
}

// Truth: a rod of 1 m on a hinge between two guys of 100 N (or slack by 20 N), l^2 = 1.25 m^2: 2 (k cos^2 + P/l sin^2) - 2 P/l.  The guys
// press the hinge, and with it the rod: the factor knew this force of the joint from where the centre of the rod is.
TEST_F(Buckling, OfAMastBetweenTightGuys) {
  const auto guys = [](const std::string& on, double preload) {
    std::string text;
    for (const double side : {0.5, -0.5})
      text += spring("axial", side > 0 ? "left" : "right", "ground", on,
                     fmt::format("at_a = [{}, 0, 0]\nat_b = [0, 0, 1]\nstiffness = 200\npreload = {}\n", side, preload));
    return text;
  };
  const auto truth = [](double preload) {
    const double l = std::sqrt(1.25);
    return 2 * (200 * 0.2 + preload / l * 0.8) - 2 * preload / l;
  };
  const std::string hinged = axial("revolute", "p", "ground", "a", Vec3::Zero(), Vec3::UnitY());
  for (const double centre : {0., 0.3, 1.})
    for (const double preload : {0., 7., 100., -20.})
      EXPECT_NEAR(factors(rod("a", centre) + hinged + guys("a", preload) + down("a", 1), 1)[0], truth(preload), 1e-4) << centre << preload;
  const std::string mast = column("");
  EXPECT_NEAR(factors(mast + axial("revolute", "p", "ground", "arm.0", Vec3::Zero(), Vec3::UnitY()) + guys("arm.end", 7) +
                          push("arm.end", Vec3(0, 0, -1)),
                      1)[0] /
                  truth(7),
              1, 0.1);
}

TEST_F(Buckling, OfRigidRodsIsThatOfTheirSprings) {
  EXPECT_NEAR(factors(rod("a", 0.3) + hinge("p", "ground", "a", 0, 10) + down("a", 0.8), 3)[0], 12.5, 1e-5);
  const auto two =
      factors(rod("a", 0.3) + rod("b", 0.8) + hinge("p", "ground", "a", 0, 10) + hinge("q", "a", "b", 0.5, 10) + down("b", 1), 3);
  ASSERT_EQ(two.size(), 2u) << "and there are no more";
  EXPECT_NEAR(two[0], 10 * (3 - std::sqrt(5)), 1e-5);
  EXPECT_NEAR(two[1], 10 * (3 + std::sqrt(5)), 1e-4);
  const auto heavy = factors("gravity = [0, 0, -9.81]\n" + rod("a", 0.3) + hinge("p", "ground", "a", 0, 10), 1);
  EXPECT_NEAR(heavy[0], 10 / (9.81 * 0.3), 1e-5);
}

// A rod on a hinge whose tip e moves, between springs along n of length l that take N as it moves, and their and the load's share T of
// tension: sum k (n.e)^2 + f (sum N/l (1 - (n.e)^2) + T/L) = 0.
TEST_F(Buckling, OfARodBetweenObliqueSpringsIsThatOfTheirTension) {
  const double L = 1.2, k[] = {300, 900};
  for (const Vec3& F : {Vec3(20, 0, -60), Vec3(-35, 0, -10)}) {
    const Vec3 tip(L * std::sin(0.3), 0, L * std::cos(0.3)), e(std::cos(0.3), 0, -std::sin(0.3));
    std::string scene = rod_at(tip / 2) + axial("revolute", "foot", "ground", "rod", Vec3::Zero(), Vec3::UnitY()) +
                        push("rod", F, fmt::format("at = {}\n", list(tip)));
    double K = 0, pulled = 0, T = F.dot(tip) / L;
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < 2; ++i) {
        const Vec3 from = i == 0 ? Vec3(1.5, 0, 0.2) : Vec3(-0.8, 0, 2), way = tip - from, n = way.normalized();
        if (pass == 0) {
          K += k[i] * n.dot(e) * n.dot(e);
          scene += spring("axial", fmt::format("s{}", i), "ground", "rod",
                          fmt::format("at_a = {}\nat_b = {}\nstiffness = {}\n", list(from), list(tip), k[i]));
        } else {
          const double N = k[i] * n.dot(e) * F.dot(e) / K;
          pulled += N / way.norm() * (1 - n.dot(e) * n.dot(e)), T -= N * n.dot(tip) / L;
        }
      }
    EXPECT_NEAR(factors(scene, 1)[0] / (-K / (pulled + T / L)), 1, 1e-5) << F.transpose();
  }
}

// Levy: 3 EI/R^3, under a pressure that turns with the ring.
TEST_F(Buckling, OfARingUnderPressureIsLevys) {
  const auto f = factors(
      "[section.s]\nkind = \"matrix\"\nstiffness = [1e5, 1e5, 1e5]\nbending = [10, 1, 10]\n"
      "[beam.arm]\npath = \"arc\"\npoints = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]]\ncells = [24]\nsection = \"s\"\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"hold\"\non = \"arm.0\"\n"
      "[[load]]\nkind = \"line\"\nname = \"p\"\non = \"arm\"\nforce_per_length = [1, 0, 0]\nfollower = true\n",
      1);
  EXPECT_NEAR(f[0], 3, 0.02);
}

// Argyris' frame, whose limits under loads of both signs are 1.0843 and -0.6791 N (tests/verify/beams); a linear problem is off by what
// the frame has bent by then.
TEST_F(Buckling, OfAFrameOfAStripIsNearThatOfItsPath) {
  const auto f = factors(
      "[section.s]\nkind = \"rectangle\"\nwidth = 30e-3\nheight = 0.6e-3\nshear = [0.8333333, 0.8333333]\n[material.m]\nE = "
      "71.24e9\nnu = 0.31\ndensity = 2700\n" +
          beam_of("[[0, 0, 0], [0.24, 0, 0], [0.24, 0.24, 0]]", 8, "a = \"ground\"\nmaterial = \"m\"") + push("arm.end", Vec3(1, 0, 0)),
      2);
  EXPECT_NEAR(f[0], -0.6791, 5e-3);
  EXPECT_NEAR(f[1], 1.0843, 1e-2);
}

// Three legs that their loads bend more than they press them, in their plane: factors of Bernoulli beams, 80 a leg, with the linear
// stiffness of their normal forces.  (Slopes of the strains where the loads had moved a cell gave legs of eight cells 26.8.)
TEST_F(Buckling, OfAFrameThatItsLoadsBendIsThatOfItsNormalForces) {
  const std::string tube =
      "[section.s]\nkind = \"tube\"\ndiameter = 0.012\nthickness = 0.002\n[material.m]\nE = 2e11\nnu = 0.3\ndensity = 8000\n";
  for (const int n : {5, 10}) {
    const auto f = factors(tube +
                               beam_of("[[0, 0, 0], [0.53, 0, 0.55], [1.05, 0, 0.66], [2.07, 0, 0.35]]", n,
                                       "a = \"ground\"\nb = \"ground\"\nmaterial = \"m\"") +
                               push(fmt::format("arm.{}", n), Vec3(-6, 0, -12.7)) + push(fmt::format("arm.{}", 2 * n), Vec3(-0.75, 0, -45)),
                           6);
    for (const double plane : {46.918, 84.434}) {
      const auto nearest = std::ranges::min(f, {}, [&](double x) { return std::abs(x / plane - 1); });
      EXPECT_NEAR(nearest / plane, 1, 6e-3) << n;
    }
    EXPECT_EQ(f.size(), 6u);
    for (const double x : f) EXPECT_GT(x, 14) << "pushed as they are, none buckles where the loads are reversed";
  }
}

// The same column of cells, and of a linear region whose stiffness follows its stress.
TEST_F(Buckling, OfCellsAndOfStiffeningRegionsIsEulers) {
  const BlockOptions o{.shape = Shape::hex20r, .n = {1, 1, 10}, .high = {0.04, 0.05, 1}};
  write_mesh(work / "mesh.h5", block_mesh(o), {"test"});
  const double E = 1e9, euler = pi * pi * E * 0.05 * 0.04 * 0.04 * 0.04 / 12 / 4;
  for (const auto& [fidelity, law] : {std::pair{Fidelity::nonlinear, ""}, std::pair{Fidelity::linear, "stiffening = true"}}) {
    write_tags(work / "tags.h5", work / "mesh.h5", {fidelity}, {"test"});
    mesh = "tags.h5";
    const auto f = factors(solid(E, 0, 1000, "*", "", law) + held("zmin") + push("zmax", Vec3(0, 0, -1)), 2);
    EXPECT_NEAR(f[0] / euler, 1, 0.01) << law;
    EXPECT_NEAR(f[1] / euler, 1.25 * 1.25, 0.02) << law;
  }
  const auto linear = [&](const char* law) { return solid(E, 0, 1000, "*", "", law) + held("zmin") + push("zmax", Vec3(0, 0, -1)); };
  const std::string said = refused(linear(""));
  EXPECT_NE(said.find("its stresses change no stiffness, so factors are too large (stiffening = true"), said.npos) << said;
  EXPECT_NEAR(factors(linear("stiffening = false"), 2)[0] / euler, 1.22, 0.01);
  EXPECT_NE(ran.err.find("its stresses change no stiffness"), ran.err.npos) << ran.err;
  write_tags(work / "tags.h5", work / "mesh.h5", {Fidelity::nonlinear}, {"test"});
  const std::string metal = refused(solid(E, 0, 1000, "*", "kind = \"j2\"\nyield = 1e6") + held("zmin") + push("zmax", Vec3(0, 0, -1)));
  EXPECT_NE(metal.find("is plastic: buckling knows elastic laws"), metal.npos) << metal;
  ASSERT_EQ(work.run("hilo-post render run.h5 --steps 1 --field displacement -o shape.png").exit, 0);
  EXPECT_NE(work.run("hilo-post response run.h5 --base z --at x.z").exit, 0) << "it has no frequencies";
}

TEST_F(Buckling, IsRefusedByName) {
  const auto says = [](const std::string& said, const char* words) { EXPECT_NE(said.find(words), said.npos) << said; };
  const std::string push_end = push("arm.end", Vec3(0, 0, -1));
  says(refused(column()), "no load grows");
  says(refused(column("") + push_end), "is free to move");
  says(refused(column("a = \"ground\"\nfidelity = \"linear\"") + push_end, "",
               "hilo-solve --set section.s.line_mass=1 --set 'section.s.inertia=[0.01, 0.01]'"),
       "its stresses change no stiffness, so factors are too large (fidelity = \"nonlinear\")");
  says(refused(column() + push_end, "start = \"equilibrium\"\n"), "grow from the drawn state");
  says(refused(column() + push_end, "", "export " + for_ranks + "\nmpirun -n 2 hilo-solve"), "on one rank");
  says(refused(column() + load("line", "follows", "arm", "force_per_length = [0, 0, -1]\nfollower = true\n")), "no potential");
  says(refused(column() + push_end +
               motion("translation", "lift", "arm.end", "displacement = [0.1, 0, 0]\nhistory = {t = [0, 1], value = [0, 1]}\n")),
       "buckling knows loads alone");
  says(refused(rod("a", 0.3) + hinge("p", "ground", "a", 0, 10) + down("a", 0.8) + rod("b", 0.3) +
               "[[joint]]\nkind = \"prismatic\"\nname = \"jack\"\na = \"ground\"\nb = \"b\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n"
               "displacement = 0.1\nhistory = {t = [0, 1], value = [0, 1]}\n"),
       "a drive moves its joint");
  says(refused(rod("a", 0.3) + hinge("p", "ground", "a", 0, 10) + down("a", 0.8) +
               spring("axial", "tight", "ground", "a", "at_a = [1, 0, 0.3]\nat_b = [0, 0, 0.3]\nstiffness = 1\nlength = 0.2\n")),
       "is not at rest without the loads");
}

}  // namespace
}  // namespace hilo::test::buckling_test
