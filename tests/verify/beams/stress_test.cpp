// SPDX-License-Identifier: GPL-3.0-or-later
// Forces, moments and stress along beams, as hilo-post shows them, against closed forms.
#include "verify/beams/beam_scene.hpp"

namespace hilo::test::beams_stress_test {
namespace {

constexpr double pi = std::numbers::pi;

class BeamStress : public BeamPlace {};

constexpr const char* steel = "[material.m]\nE = 2e11\nnu = 0.3\n";

// A cantilever with a force at its tip: m = F (L - x), its stress m c/I = 6 m/(b h^2), that of the force 1.5 F/(b h).
TEST_F(BeamStress, ACantileverHasTheMomentAndStressOfItsTipForce) {
  const double F = 2, L = 1.2, b = 0.02, h = 0.05;
  const auto at = curves(fmt::format("[section.s]\nkind = \"rectangle\"\nwidth = {}\nheight = {}\n", b, h) + steel +
                         beam_of(fmt::format("[[0, 0, 0], [{}, 0, 0]]", L), 4, "a = \"ground\"\nmaterial = \"m\"") +
                         push("arm.end", Vec3(0, 0, F)) + in_steps(1));
  ASSERT_EQ(at.at("s").size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    const double s = L / 4 * std::ceil(i / 2.0), m = F * (L - s), stress = 6 * m / (b * h * h), room = 1e-6 * 6 * F * L / (b * h * h);
    EXPECT_NEAR(at.at("s")[i], s, 1e-12);
    EXPECT_NEAR(at.at("V2")[i], F, 1e-6 * F);
    EXPECT_NEAR(at.at("M1")[i], -m, 1e-6 * F * L) << "pressed above";
    EXPECT_NEAR(at.at("high")[i], stress, room);
    EXPECT_NEAR(at.at("low")[i], -stress, room);
    EXPECT_NEAR(at.at("von_mises")[i], std::max(stress, std::sqrt(3.0) * 1.5 * F / (b * h)), room);
    for (const char* none : {"V1", "N", "M2", "T"}) EXPECT_LT(std::abs(at.at(none)[i]), 1e-4 * F) << none;
  }
}

// A quarter of a circle, held at its foot: at the angle a a force F along x at its tip leaves m = F R (1 - sin a), n = -F sin a, one along
// z the torsion F R (1 - sin a) with the moment F R cos a.
TEST_F(BeamStress, AnArchBearsWhatEquilibriumAsks) {
  const double F = 0.02, R = 0.8, r = 0.01, A = pi * r * r, I = pi * r * r * r * r / 4, h = std::sqrt(0.5) * R;
  const double middle = std::sqrt(3.0) * (3 + 2 * 0.3) / (2 + 2 * 0.3) * F / A;  // von Mises stress of the force alone
  const std::string arch = fmt::format("[section.s]\nkind = \"circle\"\ndiameter = {}\n", 2 * r) + steel +
                           beam_of(fmt::format("[[{0}, 0, 0], [{1:.17g}, {1:.17g}, 0], [0, {0}, 0]]", R, h), 6,
                                   "a = \"ground\"\nmaterial = \"m\"\npath = \"arc\"");
  const auto flat = curves(arch + push("arm.end", Vec3(F, 0, 0)) + in_steps(1));
  const auto out = curves(arch + push("arm.end", Vec3(0, 0, F)) + in_steps(1));
  for (size_t i = 0; i < 12; ++i) {
    const double a = pi / 12 * std::ceil(i / 2.0), m = F * R * (1 - std::sin(a)), n = -F * std::sin(a), bending = m * r / I;
    EXPECT_NEAR(flat.at("s")[i], R * a, 1e-9);
    EXPECT_NEAR(flat.at("N")[i], n, 1e-4 * F);
    EXPECT_NEAR(std::hypot(flat.at("M1")[i], flat.at("M2")[i]), m, 1e-4 * F * R);
    EXPECT_NEAR(flat.at("high")[i], n / A + bending, 1e-4 * F * R * r / I);
    EXPECT_NEAR(flat.at("low")[i], n / A - bending, 1e-4 * F * R * r / I);
    const double twist = F * R * (1 - std::sin(a)), bend = F * R * std::cos(a);
    EXPECT_NEAR(std::abs(out.at("T")[i]), twist, 1e-3 * F * R);
    EXPECT_NEAR(std::hypot(out.at("M1")[i], out.at("M2")[i]), bend, 1e-3 * F * R);
    EXPECT_NEAR(out.at("von_mises")[i], std::max(std::hypot(bend * r / I, std::sqrt(3.0) * twist * r / (2 * I)), middle),
                5e-3 * F * R * r / I);
  }
}

// Of a falling weight on a bar: histories, the least and the largest of all steps and a quantity agree with n/A of the bar.
TEST_F(BeamStress, HistoriesEnvelopesAndQuantitiesAreOfTheSameStress) {
  const Results r =
      solved("gravity = [0, 0, -9.81]\n[section.s]\nkind = \"circle\"\ndiameter = 0.01\n" + std::string(steel) + "density = 7850\n" +
             beam_of("[[0, 0, 0], [0, 0, -1]]", 2, "a = \"ground\"\nmaterial = \"m\"") +
             "[[point_mass]]\nname = \"w\"\non = \"arm.end\"\nmass = 50\n" +
             "[[quantity]]\nname = \"bar\"\nkind = \"peak\"\nformula = \"stress [Pa] = beam_stress.arm.high\"\n" + in_time(0.008, 2e-5));
  const double A = pi * 0.005 * 0.005;
  const Eigen::MatrixXd f = r.history("beam/arm");
  const double most = std::max({f.col(2).maxCoeff(), f.col(8).maxCoeff(), f.col(14).maxCoeff(), f.col(20).maxCoeff()});
  EXPECT_GT(most, 1.9 * 50 * 9.81) << "twice the weight, which falls onto an unloaded bar";
  EXPECT_LT(most, 2.1 * 52 * 9.81);
  const Ran series = succeeded(work.run("hilo-post series run.h5 beam_stress.arm.high beam_stress.arm.cell1.b.low -o -"));
  double high = 0, low = 0;
  std::istringstream lines(series.out);
  std::string line;
  std::getline(lines, line);
  for (Eigen::Index row = 0; std::getline(lines, line); ++row) {
    double t, h, l;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &h, &l), 3);
    high = std::max(high, h), low = std::max(low, l);
    EXPECT_NEAR(l, f(row, 20) / A, 1e-6 * most / A);
  }
  EXPECT_NEAR(high, most / A, 1e-6 * most / A);
  const Ran quantity = work.run("hilo-post quantity run.h5");
  EXPECT_NE(quantity.out.find(fmt::format("{:.5g}", high).substr(0, 6)), std::string::npos) << quantity.out << quantity.err;
  const Ran over = work.run("hilo-post beam run.h5 arm --envelope -o -");
  EXPECT_NE(over.out.find(fmt::format(",{},", f.col(2).maxCoeff())), std::string::npos) << over.out;
}

// A force that grows in four steps: the largest moment of the steps chosen is F L of the last of them.
TEST_F(BeamStress, TheLargestValuesAreOfTheTimesChosen) {
  const double F = 2, L = 1.2;
  (void)solved("[section.s]\nkind = \"rectangle\"\nwidth = 0.02\nheight = 0.05\n" + std::string(steel) +
               beam_of(fmt::format("[[0, 0, 0], [{}, 0, 0]]", L), 4, "a = \"ground\"\nmaterial = \"m\"") + push("arm.end", Vec3(0, 0, F)) +
               in_steps(4));
  for (const auto& [times, largest] : std::map<std::string, double>{
           {"", 1}, {"--times 0.5", 0.5}, {"--times 0.25,0.75", 0.75}, {"--times 0:0.6", 0.5}, {"--envelope", 1}}) {
    const Ran ran = succeeded(work.run("hilo-post beam run.h5 --json " + times));
    const auto at = ran.out.find("\"M [N m]\": ");
    ASSERT_NE(at, std::string::npos) << ran.out;
    EXPECT_NEAR(std::stod(ran.out.substr(at + 11)), largest * F * L, 1e-5 * F * L) << times;
  }
  for (const char* names : {"", "arm"})
    expect_end(work.run(fmt::format("hilo-post beam run.h5 {} --times 9", names)), 2, "no step near t = 9");
}

// Where nothing is known of the shape there is no stress, and no number stands for it.
TEST_F(BeamStress, ASectionWithoutShapeHasNone) {
  const auto at =
      curves(plain_section(1e6, 2e6, 900, 700) + beam_of("[[0, 0, 0], [1, 0, 0]]", 1) + push("arm.end", Vec3(0, 3, 0)) + in_steps(1));
  EXPECT_NEAR(at.at("M2")[0], 3, 1e-4);
  EXPECT_TRUE(std::isnan(at.at("high")[0]));
  EXPECT_EQ(work.run("hilo-post series run.h5 beam_stress.arm").exit, 2);
  expect_end(work.run("hilo-post beam run.h5 am"), 2, "arm");
}

/// A rectangle b x h of n x m quadrangles in millimetres, away from the origin and turned by a right angle where `lying`, as gmsh writes
/// it.
std::string face_file(double b, double h, int n, int m, bool lying = false) {
  std::string nodes, cells;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = 1000 * b * i / n, y = 1000 * h * j / m;
      nodes += fmt::format("{} {} {} 0\n", j * (n + 1) + i + 1, 300 + (lying ? -y : x), 70 + (lying ? x : y));
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int at = j * (n + 1) + i + 1;
      cells += fmt::format("{} 3 2 0 1 {} {} {} {}\n", j * n + i + 1, at, at + 1, at + n + 2, at + n + 1);
    }
  return fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n", (n + 1) * (m + 1),
                     nodes, n * m, cells);
}

// A meshed rectangle bends as F L^3/(3 E I) + F L/(k G A) says, k of the energy of shear [timoshenko-goodier, 121: for 1:2 and nu = 0.3
// nearly 5/6], twists by J, and its stress is that of the closed forms, whatever way its face is drawn.  Two and three ranks find the same.
TEST_F(BeamStress, AMeshedSectionBendsTwistsAndHasItsStress) {
  const double b = 0.02, h = 0.04, L = 0.2, F = 2, T = 0.05, E = 2e11, G = E / 2.6, I = b * h * h * h / 12, J = 0.229 * h * b * b * b;
  for (const bool lying : {false, true}) {
    work.write("face.msh", face_file(b, h, 4, 8, lying));
    const std::string scene = std::string("[section.s]\nkind = \"mesh\"\nfile = \"face.msh\"\nscale = 1e-3\n") + steel +
                              beam_of(fmt::format("[[0, 0, 0], [{}, 0, 0]]", L), 4,
                                      std::string("a = \"ground\"\nmaterial = \"m\"") + (lying ? "\norientation = [0, 1, 0]" : "")) +
                              push("arm.end", Vec3(0, 0, F)) + twist("arm.end", Vec3(T, 0, 0)) + tip_probe() + in_steps(1);
    const auto at = curves(scene);
    const Results r(work / "run.h5");
    const double w = r.history("probe/tip").bottomRows(1)(0, 2);
    EXPECT_NEAR(w, F * L * L * L / (3 * E * I) + F * L / (0.832 * G * b * h), 1e-4 * w);
    EXPECT_NEAR(at.at("high")[0], 6 * F * L / (b * h * h), 1e-4 * 6 * F * L / (b * h * h));
    // at the tip shear alone: of torsion T/(0.246 h b^2) amid the long sides, and of the force about 1.5 F/(b h) more on one of them
    const double shear = T / (0.246 * h * b * b) + 1.5 * F / (b * h);
    EXPECT_NEAR(at.at("von_mises").back(), std::sqrt(3.0) * shear, 0.02 * std::sqrt(3.0) * shear);
    const Eigen::MatrixXd body = r.history("body/arm.4");
    double turn = 0;  // of the axis that moves most
    for (const int k : {3, 6, 9}) {
      const Eigen::RowVector2d from = body.block<1, 2>(0, k + 1) - body.block<1, 2>(0, 1),
                               to = body.block<1, 2>(1, k + 1) - body.block<1, 2>(1, 1);
      if (from.norm() > 0.5 * (body.block<1, 3>(0, k) - body.block<1, 3>(0, 0)).norm())
        turn = (from.x() * to.y() - from.y() * to.x()) / from.squaredNorm();
    }
    EXPECT_NEAR(turn, T * L / (G * J), 5e-3 * T * L / (G * J));
    if (lying) continue;
    const Ran table = work.run("hilo-post beam run.h5 --sections --json");
    EXPECT_NE(table.out.find("arm"), std::string::npos) << table.err;
    for (const int n : {2, 3}) {
      succeeded(mpirun(n, fmt::format("hilo-solve --quiet scene.toml -o r{}.h5", n), work.path()));
      EXPECT_LT((Results(work / fmt::format("r{}.h5", n)).history("beam/arm") - r.history("beam/arm")).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST_F(BeamStress, AMeshedSectionWithoutItsFileIsRefused) {
  const auto said = [&](const std::string& section) {
    work.write("scene.toml", section + steel + beam_of("[[0, 0, 0], [1, 0, 0]]", 1, "a = \"ground\"\nmaterial = \"m\"") + in_steps(1));
    const Ran r = work.run("hilo-solve --quiet scene.toml -o run.h5");
    EXPECT_EQ(r.exit, 2);
    return r.err;
  };
  EXPECT_NE(said("[section.s]\nkind = \"mesh\"\n").find("scene.toml:1:10: section \"s\": no file of its mesh"), std::string::npos);
  EXPECT_NE(said("[section.s]\nkind = \"mesh\"\nfile = \"none.msh\"\n").find("scene.toml:3:1: section \"s\": no file"), std::string::npos);
  work.write("face.msh", face_file(1, 1, 1, 1).substr(0, 80));
  EXPECT_NE(said("[section.s]\nkind = \"mesh\"\nfile = \"face.msh\"\n").find("hilo-solve: face.msh:"), std::string::npos);
}

// Of a section given by its numbers, the stress at the points that it names: N/A + M1 x2/I1 - M2 x1/I2.
TEST_F(BeamStress, FibresOfASectionGivenByNumbersHaveAxialStress) {
  const auto at =
      curves("[section.s]\nkind = \"general\"\narea = 1e-3\nI1 = 2e-6\nI2 = 1e-6\nJ = 1e-6\nfibres = [[0.03, 0.05], [-0.02, -0.04]]\n" +
             std::string(steel) + beam_of("[[0, 0, 0], [1, 0, 0]]", 1, "a = \"ground\"\nmaterial = \"m\"") +
             push("arm.end", Vec3(5, 0, 3)) + in_steps(1));
  const double M1 = at.at("M1")[0], one = 5 / 1e-3 + M1 * 0.05 / 2e-6, other = 5 / 1e-3 - M1 * 0.04 / 2e-6;
  EXPECT_NEAR(M1, -3, 1e-4);
  EXPECT_NEAR(at.at("high")[0], std::max(one, other), 1e-3 * std::abs(other));
  EXPECT_NEAR(at.at("low")[0], std::min(one, other), 1e-3 * std::abs(one));
}

}  // namespace
}  // namespace hilo::test::beams_stress_test
