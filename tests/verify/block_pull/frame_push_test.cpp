// Lee's frame of hexahedra, one through the section, pushed down beside its corner by what moves by a law, to more than a third of its
// height: two legs of 1.2 m and a section of 20 x 30 mm, hinged at both feet.
#include "verify/verify.hpp"

namespace hilo::test {
namespace {

constexpr double leg = 1.2, half = 0.01;

/// A straight bar of 2.4 m folded to a frame, with a mitre at the corner.
Vec3 fold(const Vec3& at) {
  const double s = at[0], n = at[1], along = leg - n;
  return s <= leg ? Vec3(n, s / leg * along, at[2]) : Vec3(n + (s - leg) / leg * along, along, at[2]);
}

const std::string scene = R"(
[material.frame]
E = 70.608e9
nu = 0.3
density = 2700
[region."*"]
material = "frame"
[[joint]]
kind = "revolute"
name = "foot"
a = "ground"
b = "xmin"
at = [0, 0, 0.015]
axis = [0, 0, 1]
[[joint]]
kind = "revolute"
name = "far"
a = "ground"
b = "xmax"
at = [1.2, 1.2, 0.015]
axis = [0, 0, 1]
[[motion]]
kind = "translation"
name = "push"
on = "load"
components = ["y"]
displacement = [0, -0.45, 0]
history = {t = [0, 1], value = [0, 1]}
[time]
analysis = "static"
end = 1
)";

/// 208 and 394 iterations in 60 and 120 steps before tangents foresaw stresses.
TEST(FramePush, TakesThreeIterationsAStepAndNoCut) {
  Case c("block_pull");
  BlockOptions o;
  o.n[0] = 80, o.low = Vec3(0, -half, 0), o.high = Vec3(2 * leg, half, 0.03), o.map = fold;
  Mesh mesh = block_mesh(o);
  add_node_set(mesh, "load", [](const Vec3& x) { return std::abs(x[0] - 0.232) < 0.01 && x[1] > leg + half / 2; });
  ASSERT_EQ(mesh.node_sets.at("load").size(), 2u);
  c.use(mesh);
  c.write("scene.toml", scene);
  std::vector<double> force;
  for (const int steps : {60, 120}) {
    const Ran ran = c.run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5 --set time.steps=" + std::to_string(steps));
    ASSERT_EQ(ran.exit, 0) << ran.err;
    EXPECT_EQ(c.reported("cuts"), 0);
    EXPECT_LE(c.reported("newton_iterations"), steps == 60 ? 190 : 260);
    force.push_back(c.results().at("motion/push", 1)[1]);
  }
  EXPECT_NEAR(force[0], force[1], 1e-6 * std::abs(force[1]));
}

}  // namespace
}  // namespace hilo::test
