// SPDX-License-Identifier: GPL-3.0-or-later
// Paths of equilibrium past limits of load and of displacement: bars whose path is known in closed form, and Lee's frame.
#include "verify/lee_frame.hpp"

namespace hilo::test::path_test {
namespace {

constexpr double EA = 2e6, height = 0.3;  // of two bars from (-1, 0), (1, 0) to (0, height)

/// Force down at the apex that holds it at y: EA y (h^2 - y^2)/L^3, of strains (l^2 - L^2)/(2 L^2).
double truss_force(double y) { return EA * y * (height * height - y * y) / std::pow(1 + height * height, 1.5); }
const double limit = truss_force(height / std::sqrt(3.0));

std::string scene(const std::string& loaded, double pushes, const std::string& time) {
  return solid(2e9, 0, 1000, "legs", "kind = \"stvk\"", "area = 1e-3") + solid(4e8, 0, 1000, "spring", "kind = \"stvk\"", "area = 1e-3") +
         held("feet") + held("apex", "z") + held("top", "xz") + force("push", loaded, {0, -pushes, 0}) + probe("apex") + probe("top") +
         "[time]\nanalysis = \"path\"\n" + time;
}

/// The truss, and a bar of 4 m that stands on its apex.
struct Truss : Case {
  Truss() : Case("path") {
    write("truss.inp",
          "*NODE, NSET=all\n1, -1, 0, 0\n2, 1, 0, 0\n3, 0, 0.3, 0\n4, 0, 4.3, 0\n5, 9, 0, 0\n*NSET, NSET=feet\n1, 2\n"
          "*NSET, NSET=apex\n3\n*NSET, NSET=top\n4\n*ELEMENT, TYPE=T3D2, ELSET=legs\n1, 1, 3\n2, 2, 3\n"
          "*ELEMENT, TYPE=T3D2, ELSET=spring\n3, 3, 4\n");
    EXPECT_EQ(run("hilo-import --quiet truss.inp --regions legs,spring -o mesh.h5").exit, 0);
  }
  Results follow(const std::string& text, const std::string& options = "") {
    write("scene.toml", text);
    succeeded(run("hilo-solve scene.toml mesh.h5 -o run.h5 " + options));
    return results();
  }
};

}  // namespace

TEST(LoadPath, OfTwoBarsPassesBothLimitsOfTheLoad) {
  Truss c;
  const double whole = 1.5 * limit;
  const Results r = c.follow(scene("apex", whole, "steps = 20\n"));
  const auto path = r.history("path");
  const auto apex = r.history("probe/apex");
  std::vector<double> turns;
  for (Eigen::Index k = 0; k < path.rows(); ++k) {
    const double y = apex(k, 1);
    EXPECT_NEAR(path(k, 0) * whole, truss_force(y), 1e-8 * whole) << k;
    EXPECT_NEAR(apex(k, 0), 0, 1e-9);
    const double slope = height * height - 3 * y * y;  // of the force over y: falls on the way down while the truss is stable
    if (std::abs(slope) > 1e-3 * height * height) {
      EXPECT_EQ(path(k, 2), slope > 0 ? 1 : 0) << "at y = " << y;
      EXPECT_EQ(path(k, 1) < 0, slope > 0) << "at y = " << y;
    }
    if (k > 0 && std::abs(path(k, 1)) < 1e-3) turns.push_back(path(k, 0));
  }
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_NEAR(turns[0], 1 / 1.5, 1e-7);
  EXPECT_NEAR(turns[1], -1 / 1.5, 1e-7);
  EXPECT_DOUBLE_EQ(path(path.rows() - 1, 0), 1);
  EXPECT_LT(path.rows(), 300);
  const std::string report = text_of(c / "run.json");
  EXPECT_NE(report.find("\"kind\": \"maximum\", \"load\": 0.66666"), std::string::npos) << report;
  EXPECT_NE(report.find("\"kind\": \"minimum\", \"load\": -0.66666"), std::string::npos) << report;
}

// On a soft spring the end of the spring comes back while the truss snaps.
TEST(LoadPath, OfTwoBarsUnderASpringPassesLimitsOfDisplacement) {
  Truss c;
  const double whole = 1.5 * limit, stiff = 4e5 / 4;
  const Results r = c.follow(scene("top", whole, "steps = 40\n"));
  const auto path = r.history("path");
  const auto apex = r.history("probe/apex"), top = r.history("probe/top");
  int backwards = 0;
  for (Eigen::Index k = 0; k < path.rows(); ++k) {
    const double y = apex(k, 1), stretch = (top(k, 1) - y) / 4;
    EXPECT_NEAR(path(k, 0) * whole, truss_force(y), 1e-8 * whole) << k;
    EXPECT_NEAR(path(k, 0) * whole, stiff * 4 * stretch * (1 - stretch * stretch) / 2, 1e-8 * whole) << k;
    if (k == 0) continue;
    EXPECT_LT(y, apex(k - 1, 1) + 1e-9) << "the truss goes one way";
    backwards += top(k, 1) > top(k - 1, 1) + 1e-6;
  }
  EXPECT_GT(backwards, 3);
  EXPECT_DOUBLE_EQ(path(path.rows() - 1, 0), 1);
}

TEST(LoadPath, IsTheSameBySmallAndLargeSteps) {
  Truss c;
  for (const char* steps : {"3", "7", "100"}) {
    const Results r = c.follow(scene("apex", 1.5 * limit, std::string("steps = ") + steps + "\n"));
    const auto path = r.history("path");
    EXPECT_NEAR(path.col(0).minCoeff(), -1 / 1.5, 1e-6) << steps;
    EXPECT_DOUBLE_EQ(path(path.rows() - 1, 0), 1);
    EXPECT_NEAR(r.history("probe/apex")(path.rows() - 1, 1), r.history("probe/apex").col(1).minCoeff(), 1e-12);
  }
}

// A rigid strut that leans by asin(0.1), held upright by a spring that stays level: P = k L cos(theta) (1 - sin(theta_0)/sin(theta)), of
// which the largest is k L (1 - sin(theta_0)^(2/3))^(3/2).
TEST(LoadPath, OfALeaningStrutIsThatOfKoiter) {
  Case c("path");
  c.write("scene.toml", body("strut", 1, {0.05, 0, 0.5}, {0.1, 0.1, 0.1}) +
                            axial("revolute", "foot", "ground", "strut", Vec3::Zero(), {0, 1, 0}) +
                            spring("bushing", "side", "ground", "strut", "at = [0.1, 0, 0.99498743710662]\nstiffness = [1000, 0, 0]") +
                            force("weight", "strut", {0, 0, -1000}, "at = [0.1, 0, 0.99498743710662]") +
                            probe("tip", "strut", "at = [0.1, 0, 0.99498743710662]") + R"([time]
analysis = "path"
steps = 30
reach = 0.9
)");
  const Ran ran = succeeded(c.run("hilo-solve scene.toml -o run.h5"));
  const Results r = c.results();
  const auto path = r.history("path"), tip = r.history("probe/tip");
  Eigen::Index top = 0;
  EXPECT_NEAR(path.col(0).maxCoeff(&top), std::pow(1 - std::pow(0.1, 2.0 / 3), 1.5), 1e-8);
  for (Eigen::Index k = 1; k < path.rows(); ++k) {
    EXPECT_NEAR(path(k, 0), tip(k, 2) * (1 - 0.1 / tip(k, 0)), 1e-8);
    EXPECT_TRUE(k == top || path(k, 2) == (k > top)) << k << " of " << top;
  }
  EXPECT_EQ(ran.err.find("stability"), std::string::npos) << ran.err;
  EXPECT_NE((ran.out + ran.err).find("largest load at 0.694922"), std::string::npos) << ran.out << ran.err;
}

// The same frame, pushed by a law: the force that takes is that of the path, before and behind the limit.
TEST(LoadPath, OfLeesFrameIsThatOfDisplacementControl) {
  Case c("path");
  c.use(lee_frame());
  constexpr double whole = 30e3;
  c.write("scene.toml", lee_frame_scene("[[load]]\nkind = \"force\"\nname = \"push\"\non = \"load\"\nforce = [0, -30e3, 0]\n"
                                        "[[probe]]\nname = \"load\"\non = \"load\"\n"
                                        "[time]\nanalysis = \"path\"\nsteps = 20\n"));
  Ran ran = succeeded(c.run("hilo-solve scene.toml mesh.h5 -o path.h5"));
  const Results found = c.results("path.h5");
  const auto path = found.history("path"), probe = found.history("probe/load");
  c.write("scene.toml", lee_frame_scene(pushed_by_a_law + "[time]\nanalysis = \"static\"\nend = 1\nsteps = 90\n"));
  ran = c.run("hilo-solve --quiet scene.toml mesh.h5 -o pushed.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto force = c.results("pushed.h5").history("motion/push");
  int compared = 0;
  for (Eigen::Index k = 1; k < path.rows(); ++k) {
    const double down = (probe(0, 1) - probe(k, 1)) / 0.45 * 90;
    const auto i = static_cast<Eigen::Index>(down);
    if (i + 2 >= force.rows() || probe(k, 1) >= probe(k - 1, 1)) break;
    if (i < 1) continue;
    const double x = down - static_cast<double>(i);  // cubic between four of them
    const double by_law = -force(i - 1, 1) * x * (x - 1) * (x - 2) / 6 + force(i, 1) * (x + 1) * (x - 1) * (x - 2) / 2 -
                          force(i + 1, 1) * (x + 1) * x * (x - 2) / 2 + force(i + 2, 1) * (x + 1) * x * (x - 1) / 6;
    EXPECT_NEAR(path(k, 0) * whole, -by_law, 1e-3 * whole) << "at " << probe(k, 1);
    ++compared;
  }
  EXPECT_GT(compared, 20);
  EXPECT_LT(path.col(0).minCoeff(), 0) << "it snaps back under a load upwards";
}

}  // namespace hilo::test::path_test
