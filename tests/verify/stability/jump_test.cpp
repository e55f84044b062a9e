// SPDX-License-Identifier: GPL-3.0-or-later
// Load steps that jump to another branch of equilibrium are told, and those that do not are not: the truss of two bars, whose path is
// known in closed form, alone, beside what moves farther, with histories, on ranks; an arch of solids; and softening, stiffening and stops
// along one branch.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::jump_test {
namespace {

constexpr double EA = 2e6, height = 0.3;  // of two bars from (-1, 0), (1, 0) to (0, height)

/// Force down at the apex that holds it at y: EA y (h^2 - y^2)/L^3, of strains (l^2 - L^2)/(2 L^2).
double truss_force(double y) { return EA * y * (height * height - y * y) / std::pow(1 + height * height, 1.5); }
const double limit = truss_force(height / std::sqrt(3.0));

/// The height at which a force down holds the apex: drawn upwards (the branch it starts on), or hanging through.
double truss_height(double force, bool through) {
  double low = through ? -10 : height / std::sqrt(3.0), high = through ? -height / std::sqrt(3.0) : 10;  // the force falls as y rises
  while (high - low > 1e-14) {
    const double mid = (low + high) / 2;
    (truss_force(mid) > force ? low : high) = mid;
  }
  return low;
}

const std::string truss = solid(2e9, 0, 1000, "*", "kind = \"stvk\"", "area = 1e-3") + held("feet") + held("apex", "z") +
                          held("end", "yz") + probe("apex") + probe("end");

struct JumpTold {
  double from, to, way;
};

/// The truss, and a bar of 4 m in line with the x axis beside it.
struct Snap : Case {
  Snap() : Case("stability") {
    write("truss.inp",
          "*NODE, NSET=all\n1, -1, 0, 0\n2, 1, 0, 0\n3, 0, 0.3, 0\n4, 0, 9, 0\n5, 4, 9, 0\n*NSET, NSET=feet\n1, 2, 4\n"
          "*NSET, NSET=apex\n3\n*NSET, NSET=end\n5\n*ELEMENT, TYPE=T3D2, ELSET=legs\n1, 1, 3\n2, 2, 3\n"
          "*ELEMENT, TYPE=T3D2, ELSET=far\n3, 4, 5\n");
    EXPECT_EQ(run("hilo-import --quiet truss.inp --regions legs,far -o mesh.h5").exit, 0);
    EXPECT_EQ(run("hilo-part --quiet mesh.h5 -n 2 -o parts.h5").exit, 0);
  }
  Ran solve(const std::string& text, int ranks = 1, const std::string& options = "") {
    write("scene.toml", text);
    const std::string command = fmt::format("hilo-solve scene.toml {} -o run.h5 {}", ranks == 1 ? "mesh.h5" : "parts.h5", options);
    const Ran ran = succeeded(ranks == 1 ? run(command) : mpirun(ranks, command, path()));
    return ran;
  }
  double last(const std::string& probe, Eigen::Index column) const {
    const auto x = results().history("probe/" + probe);
    return x(x.rows() - 1, column);
  }
  /// What run.json has of jumps.
  std::vector<JumpTold> jumps() const {
    const std::string text = text_of(*this / "run.json");
    std::vector<JumpTold> out;
    for (size_t at = text.find("{\"from\": "); at != std::string::npos; at = text.find("{\"from\": ", at + 1)) {
      const auto number = [&](const char* key) { return std::stod(text.substr(text.find(key, at) + std::string(key).size())); };
      out.push_back({number("\"from\": "), number("\"to\": "), number("\"way\": ")});
    }
    return out;
  }
};

}  // namespace

// Truth: above its limit the truss hangs through, and it went there at two thirds of 1.5 times that.
TEST(SnapThrough, OfTwoBarsIsToldWithItsLoad) {
  Snap c;
  for (const int steps : {1, 2, 3, 4, 7, 20, 50}) {
    const Ran ran = c.solve(truss + force("push", "apex", {0, -1.5 * limit, 0}) + in_steps(steps));
    SCOPED_TRACE(fmt::format("{} steps\n{}", steps, ran.err));
    EXPECT_NEAR(c.last("apex", 1), truss_height(1.5 * limit, true), 1e-8);
    const auto jumps = c.jumps();
    ASSERT_EQ(jumps.size(), 1u);
    EXPECT_LE(jumps[0].from, 2 / 3. + 1e-9);
    EXPECT_GE(jumps[0].to, 2 / 3. - 1e-9);
    EXPECT_LE(jumps[0].to - jumps[0].from, 1 / (16. * steps));
    EXPECT_NEAR(jumps[0].way, truss_height(jumps[0].from * 1.5 * limit, false) - truss_height(jumps[0].to * 1.5 * limit, true), 1e-6);
    EXPECT_NE(ran.err.find("positions jump by"), std::string::npos);
    EXPECT_NE(ran.err.find("analysis = \"path\""), std::string::npos);
  }
}

// Where no iteration comes from just below the limit to the other branch, the run stops and says what goes on.
TEST(SnapThrough, OrStopsAndNamesThePath) {
  Snap c;
  c.write("scene.toml", truss + force("push", "apex", {0, -1.5 * limit, 0}) + in_steps(100));
  const Ran ran = c.run("hilo-solve scene.toml mesh.h5 -o run.h5");
  EXPECT_TRUE(ran.exit == 3 || c.jumps().size() == 1) << ran.err;
  EXPECT_NE(ran.err.find("analysis = \"path\""), std::string::npos) << ran.err;
}

// Truth: the load at which a state just before the limit is left makes no difference, however soft the truss is there.
TEST(SnapThrough, FromJustBelowTheLimitIsTold) {
  Snap c;
  for (const double near : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const Ran ran = c.solve(truss + force("push", "apex", {0, -2 * (1 - near) * limit, 0}) + in_steps(2));
    EXPECT_EQ(c.jumps().size(), 1u) << near << ran.err;
    EXPECT_NEAR(c.last("apex", 1), truss_height(2 * (1 - near) * limit, true), 1e-8) << near;
  }
}

// Truth: below the limit, pulled up, or pushed down by what moves, the truss stays on its branch, and nothing is told.
TEST(SnapThrough, IsNotToldWhereThereIsNone) {
  Snap c;
  for (const int steps : {1, 2, 5, 20})
    for (const double share : {-10., -1., 0.5, 0.9, 0.999}) {
      const Ran ran = c.solve(truss + force("push", "apex", {0, -share * limit, 0}) + in_steps(steps));
      EXPECT_NEAR(c.last("apex", 1), truss_height(share * limit, false), 1e-8) << share << " in " << steps << ran.err;
      EXPECT_EQ(c.jumps().size(), 0u) << share << " in " << steps << ran.err;
    }
  std::string moved = truss;
  moved += "[[motion]]\nkind = \"translation\"\nname = \"ram\"\non = \"apex\"\ncomponents = [\"y\"]\ndisplacement = [0, -0.5, 0]\n";
  for (const int steps : {2, 5, 20}) {
    const Ran ran = c.solve(moved + in_steps(steps));
    EXPECT_NEAR(c.last("apex", 1), -0.2, 1e-12);
    EXPECT_EQ(c.jumps().size(), 0u) << steps << ran.err;
  }
}

// Truth: the same beside a bar that is pulled out by a metre on the way.
TEST(SnapThrough, BesideWhatMovesFartherIsTold) {
  Snap c;
  const double far = EA * ((25. / 16) - 1) / 2 * 5 / 4;  // of the strain (l^2 - L^2)/(2 L^2) at 5 m
  for (const int steps : {5, 20}) {
    const Ran ran = c.solve(truss + force("push", "apex", {0, -1.5 * limit, 0}) + force("pull", "end", {far, 0, 0}) + in_steps(steps));
    EXPECT_NEAR(c.last("end", 0), 5, 1e-8);
    EXPECT_EQ(c.jumps().size(), 1u) << steps << ran.err;
  }
}

// Truth: loads by a history: down through, and up again at the limit of the other side.
TEST(SnapThrough, OnTheWayBackIsToldToo) {
  Snap c;
  const Ran ran = c.solve(truss + force("push", "apex", {0, -1.5 * limit, 0}, "history = {t = [0, 1, 3], value = [0, 1, -1]}") +
                          in_steps(60, "end = 3"));
  EXPECT_NEAR(c.last("apex", 1), truss_height(-1.5 * limit, false), 1e-8);
  const auto jumps = c.jumps();
  ASSERT_EQ(jumps.size(), 2u) << ran.err;
  EXPECT_NEAR(jumps[0].to, 2. / 9, 1. / 960);
  EXPECT_NEAR(jumps[1].to, (1 + 5. / 3) / 3, 1. / 960);
}

// The same on two ranks, with the solver that counts eigenvalues there and with one that does not.
TEST(SnapThrough, IsToldOnRanks) {
  Snap c;
  for (const char* solver : {"direct", "iterative"}) {
    const std::string options = fmt::format("--set solver.kind='\"{}\"'", solver);
    const Ran ran = c.solve(truss + force("push", "apex", {0, -1.5 * limit, 0}) + in_steps(7), 2, options);
    SCOPED_TRACE(ran.err);
    EXPECT_NEAR(c.last("apex", 1), truss_height(1.5 * limit, true), 1e-7) << solver;
    ASSERT_EQ(c.jumps().size(), 1u) << solver;
    EXPECT_NEAR(c.jumps()[0].to, 2 / 3., 1 / 100.) << solver;
    const Ran calm = c.solve(truss + force("push", "apex", {0, -0.9 * limit, 0}) + in_steps(7), 2, options);
    EXPECT_EQ(c.jumps().size(), 0u) << solver << calm.err;
  }
}

namespace {

/// A shallow arch of steel, 1 m long, rise 20 mm, 10 mm high, clamped at both ends: 24 x 1 x 1 hexahedra of 20 nodes, half of it.
Mesh arch() {
  return block_mesh(
      {.shape = Shape::hex20, .n = {12, 1, 1}, .low = {-0.5, -0.005, -0.005}, .high = {0, 0.005, 0.005}, .map = [](const Vec3& x) {
         return Vec3(x[0], x[1] + 0.01 * (1 + std::cos(2 * M_PI * x[0])), x[2]);
       }});
}

}  // namespace

// Truth: the limit that `path` finds; static steps jump there, also of a law that remembers what it has yielded, here nothing.
TEST(SnapThrough, OfAnArchOfSolidsIsToldAtThePathsLimit) {
  Case c("stability");
  c.use(arch());
  ASSERT_EQ(c.run("hilo-part --quiet mesh.h5 -n 2 -o parts.h5").exit, 0);
  const auto scene = [](const std::string& law, const std::string& time) {
    return solid(2e11, 0.3, 7800, "*", law) + held("xmin") + held("xmax", "xz") + force("push", "xmax", {0, -2000, 0}) +
           probe("middle", "xmax") + "[time]\n" + time;
  };
  for (const std::string law : {"kind = \"stvk\"\n", "kind = \"j2\"\nyield = 1e13\n"}) {
    c.write("scene.toml", scene(law, "analysis = \"path\"\nsteps = 20\n"));
    const Ran path = succeeded(c.run("hilo-solve scene.toml mesh.h5 -o path.h5"));
    const size_t at = (path.out + path.err).find("largest load at ");
    ASSERT_NE(at, std::string::npos) << path.out << path.err;
    const double largest = std::stod((path.out + path.err).substr(at + 16));
    const auto end = c.results("path.h5").history("probe/middle");
    c.write("scene.toml", scene(law, "analysis = \"static\"\nsteps = 10\n"));
    for (const char* how : {"mesh.h5", "parts.h5 --set solver.kind='\"direct\"'"}) {
      if (how[0] == 'p' && law[8] == 'j') continue;
      const std::string command = std::string("hilo-solve scene.toml -o run.h5 ") + how;
      const Ran ran = how[0] == 'm' ? c.run(command) : mpirun(2, command, c.path());
      SCOPED_TRACE(command + "\n" + ran.err);
      ASSERT_EQ(ran.exit, 0);
      const auto static_end = c.results().history("probe/middle");
      EXPECT_NEAR(static_end(static_end.rows() - 1, 1), end(end.rows() - 1, 1), 1e-6);
      const size_t told = ran.err.find("positions jump by");
      ASSERT_NE(told, std::string::npos);
      const std::string rest = ran.err.substr(ran.err.find("between ", told) + 8);
      EXPECT_LE(std::stod(rest), largest + 1e-6);
      EXPECT_GE(std::stod(rest.substr(rest.find("and ") + 4)), largest - 1e-6);
    }
  }
}

// Truth: a cantilever of perfect plasticity bends on one branch through its hinge, 1.45 of the elastic limit of 1.5, and back: nothing is
// told.
TEST(SnapThrough, IsNotToldOfAPlasticHinge) {
  Case c("stability");
  const BlockOptions o{.shape = Shape::hex20, .n = {10, 1, 2}, .high = {1, 0.1, 0.1}};
  c.use(block_mesh(o));
  const double yields = 250e6 * std::pow(0.1, 3) / 6;  // N, at the tip
  for (const int steps : {2, 4, 16}) {
    c.write("scene.toml", solid(2e11, 0.3, 7800, "*", "kind = \"j2\"\nyield = 250e6") + held("xmin") +
                              force("push", "xmax", {0, 0, 1.45 * yields}, "history = {t = [0, 1, 2], value = [0, 1, 0]}") +
                              probe("tip", "xmax") + in_steps(steps, "end = 2"));
    const Ran ran = succeeded(c.run("hilo-solve scene.toml mesh.h5 -o run.h5"));
    const auto tip = c.results().history("probe/tip");
    EXPECT_GT(tip(tip.rows() - 1, 2), 1e-3) << "what is left of the hinge";
    EXPECT_EQ(ran.err.find("jump"), std::string::npos) << steps << ran.err;
  }
}

// Truth: one branch that stiffens by forty times where a gap closes: nothing is told.
TEST(SnapThrough, IsNotToldOfStops) {
  Case c("stability");
  for (const int steps : {1, 3, 10})
    for (const double pushes : {200., -200.}) {
      c.write("scene.toml", pushed_cart(pushes) + R"([[stop]]
kind = "slide"
name = "gap"
joint = "rail"
lower = -1.0
upper = 1.0
stiffness = 4000.0
)" + in_steps(steps));
      const Ran ran = succeeded(c.run("hilo-solve scene.toml -o run.h5"));
      const auto x = c.results().history("probe/cart");
      EXPECT_NEAR(x(x.rows() - 1, 0), std::copysign(1 + 100 / 4100., pushes), 1e-8);
      EXPECT_EQ(ran.err.find("jump"), std::string::npos) << steps << ran.err;
    }
}

}  // namespace hilo::test::jump_test
