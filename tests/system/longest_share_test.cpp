// SPDX-License-Identifier: GPL-3.0-or-later
// How far a correction of Newton's may go: a cube that is pressed by twice its height is flat at half of the way, so a quarter is left to
// go, whatever its cells; motions that leave it whole go all the way.
#include "model/local_mesh.hpp"
#include "system/system.hpp"
#include "verify/verify.hpp"

namespace hilo::test::longest_share_test {
namespace {

class LongestShare : public testing::TestWithParam<Shape> {
 protected:
  void SetUp() override {
    write_mesh(place / "mesh.h5", block_mesh({.shape = GetParam(), .n = {2, 2, 2}}), {"test"});
    local = read_local_mesh(place / "mesh.h5", Comm::world());
    const Scene scene = Scene::parse(R"(
material.soft = {kind = "neo-hookean", E = 2e5, nu = 0.3, density = 1000}
region."*" = {material = "soft"}
time = {end = 1, step = 1}
)",
                                     "scene.toml");
    system = build_system(scene, &local, Comm::world());
  }
  double share(const std::function<Vec3(const Vec3&)>& move) const {
    Config to = system->start;
    for (Vec3& x : to.x) x = move(x);
    return system->longest_share(system->start, to);
  }
  Workplace place;
  LocalMesh local;
  std::unique_ptr<System> system;
};

TEST_P(LongestShare, KeepsCellsWhole) {
  EXPECT_EQ(share([](const Vec3& x) -> Vec3 { return Vec3(x[0], x[1], -1.1 * x[2]); }), 0.25);
  EXPECT_EQ(share([](const Vec3& x) -> Vec3 { return Vec3(x[0], x[1], 0.1 * x[2]); }), 1);
  EXPECT_EQ(share([](const Vec3& x) -> Vec3 { return x + Vec3(1e3, -7, 2); }), 1);
  EXPECT_EQ(share([](const Vec3& x) -> Vec3 { return Vec3(x[0], -x[2], x[1]); }), 1) << "a quarter of a turn";
  EXPECT_EQ(share([](const Vec3& x) -> Vec3 { return Vec3(x[0], x[1], x[2] > 0.9 ? x[2] - 2.2 : x[2]); }), 0.125)
      << "one layer, of half the height";
}

INSTANTIATE_TEST_SUITE_P(Shapes, LongestShare, testing::Values(Shape::hex8, Shape::tet4, Shape::wedge6));

}  // namespace
}  // namespace hilo::test::longest_share_test
