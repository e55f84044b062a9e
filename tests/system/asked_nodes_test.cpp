// SPDX-License-Identifier: GPL-3.0-or-later
// A configuration holds the nodes that a step asks for; of a linear region these are few, whatever entries of the scene are called.
#include "model/local_mesh.hpp"
#include "system/system.hpp"
#include "verify/verify.hpp"

namespace hilo::test::asked_nodes_test {
namespace {

class AskedNodes : public testing::Test {
 protected:
  AskedNodes() {
    write_mesh(place / "mesh.h5", block_mesh({.n = {4, 4, 6}}), {"test"});
    write_tags(place / "tags.h5", place / "mesh.h5", {Fidelity::linear}, {"test"});
  }
  /// Nodes held of the block, of 175, beside what the scene adds.
  size_t with(const std::string& more) {
    const Scene scene = Scene::parse(
        "material.m = {E = 1e6, nu = 0.3, density = 1000}\nregion.block = {material = \"m\", modes = 3}\n"
        "joint = [{kind = \"fixed\", name = \"foot\", b = \"zmin\", at = [0.5, 0.5, 0]}]\ntime = {end = 0.1, step = 0.01}\n" +
            more,
        "scene.toml");
    LocalMesh mesh = read_local_mesh(place / "tags.h5", Comm::world());
    return build_system(scene, &mesh, Comm::world())->start.x.size();
  }
  Workplace place;
};

TEST_F(AskedNodes, AreNotThoseOfARegionWhoseNameAnEntryHas) {
  EXPECT_EQ(with(""), 0U) << "a joint acts on the patch";
  EXPECT_EQ(with("probe = [{name = \"block\", on = \"zmax\"}]\n"), 25U);
  EXPECT_EQ(with("probe = [{name = \"p\", on = \"block\"}]\n"), 175U);
}

TEST_F(AskedNodes, AreNotThoseOfARegionThatASetBelongsToOrWhoseStressIsAskedFor) {
  EXPECT_EQ(with("quantity = [{name = \"q\", kind = \"peak\", stress = \"block\"}]\n"), 0U);
  EXPECT_EQ(
      with("set.edge = {kind = \"box\", of = \"block\", low = [0, 0, 1], high = [1, 0, 1]}\nprobe = [{name = \"p\", on = \"edge\"}]\n"),
      5U);
}

}  // namespace
}  // namespace hilo::test::asked_nodes_test
