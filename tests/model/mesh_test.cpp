// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/error.hpp"
#include "block.hpp"
#include "folder.hpp"
#include "model/mesh_tags.hpp"
#include "model/store.hpp"

namespace hilo::test::mesh_test {
namespace {

using test::block;
using test::Folder;
using test::one_cell;
using test::text_of;

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& e) {
    return e.what();
  }
  return "no Error was thrown";
}

class EveryShape : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Mesh, EveryShape,
                         testing::Values(Shape::bar2, Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

class EverySolid : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Mesh, EverySolid,
                         testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

double reference_volume(Shape s) {
  const std::string_view name = info(s).name;
  return name.starts_with("tet") ? 1. / 6 : name.starts_with("wedge") ? 0.5 : 1;
}
double reference_surface(Shape s) {
  const std::string_view name = info(s).name;
  return name.starts_with("tet") ? 1.5 + std::sqrt(3.) / 2 : name.starts_with("wedge") ? 3 + std::sqrt(2.) : 6;
}

TEST_P(EverySolid, FacetsPointOutwardsAndAddUpToTheSurface) {
  const Mesh m = one_cell(GetParam());
  Vec3 centre = Vec3::Zero(), sum = Vec3::Zero();
  for (int a = 0; a < info(GetParam()).n_corners; ++a) centre += m.X[a] / info(GetParam()).n_corners;
  double surface = 0;
  for (size_t f = 0; f < info(GetParam()).facets.size(); ++f) {
    const Facet facet{0, static_cast<std::int64_t>(f)};
    const Vec3 area = facet_area(m, facet);
    for (const auto n : m.facet_nodes(facet)) EXPECT_GT(area.dot(m.X[n] - centre), 0) << "facet " << f << " node " << n;
    surface += area.norm(), sum += area;
  }
  EXPECT_NEAR(surface, reference_surface(GetParam()), 1e-13);
  EXPECT_LT(sum.norm(), 1e-13);  // closed
}

TEST_P(EverySolid, FacetsShareEveryEdgeTwiceInOppositeSense) {
  std::map<std::array<int, 3>, int> edges;  // from, to, mid-side node
  for (const auto& f : info(GetParam()).facets) {
    const size_t n = info(GetParam()).n_nodes > info(GetParam()).n_corners ? f.size() / 2 : f.size();
    for (size_t a = 0; a < n; ++a) ++edges[{f[a], f[(a + 1) % n], f.size() > n ? f[n + a] : -1}];
  }
  for (const auto& [e, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({e[1], e[0], e[2]}), 1u) << e[0] << " " << e[1];
  }
}

TEST_P(EveryShape, VolumeIsThatOfTheReferenceCellUnderAnyLinearMap) {
  Mat3 A;
  A << 2, 0.3, -0.1, 0.2, 1.5, 0.4, -0.3, 0.1, 0.8;
  const Mesh m = one_cell(GetParam(), [&](const Vec3& x) { return Vec3(A * x + Vec3(5, -3, 2)); });
  const double expected = info(GetParam()).dimension == 1 ? A.col(0).norm() : A.determinant() * reference_volume(GetParam());
  EXPECT_NEAR(quality(m, 0).volume, expected, 1e-13 * 100);
  EXPECT_NEAR(quality(m, 0).scaled_jacobian, 1, 1e-13);
}

TEST_P(EverySolid, InvertedCellHasNegativeQuality) {
  const auto q = quality(one_cell(GetParam(), [](const Vec3& x) { return Vec3(x.x(), x.y(), -x.z()); }), 0);
  EXPECT_NEAR(q.scaled_jacobian, -1, 1e-13);
  EXPECT_NEAR(q.volume, -reference_volume(GetParam()), 1e-13);
}

TEST_P(EveryShape, FlatCellHasNoQuality) {
  const auto q = quality(one_cell(GetParam(), [](const Vec3& x) { return Vec3(0, x.y(), x.z() + x.y()); }), 0);
  EXPECT_NEAR(q.scaled_jacobian, 0, 1e-6);
  EXPECT_NEAR(q.volume, 0, 1e-13);
}

TEST(Mesh, VolumeOfATwistedHexahedronIsTheIntegralOfItsJacobian) {
  // x = (r + rs/2, s, t + rt): det = (1 + s/2)(1 + r), integral over the unit cube 5/4 * 3/2.
  const Mesh m = one_cell(Shape::hex8, [](const Vec3& x) { return Vec3(x.x() + x.x() * x.y() / 2, x.y(), x.z() + x.x() * x.z()); });
  EXPECT_NEAR(quality(m, 0).volume, 1.25 * 1.5, 1e-13);
  // Corner Jacobians run from 1 to 3/2 * 2.
  EXPECT_NEAR(quality(m, 0).scaled_jacobian, 1. / 3, 1e-13);
}

TEST(Mesh, RaisedMidSideNodeAddsItsShareOfTheFacet) {
  // The shape function of a mid-side node of the eight-node square integrates to 1/3 of its area.
  Mesh m = one_cell(Shape::hex20);
  m.X[12].z() += 0.3;
  EXPECT_NEAR(quality(m, 0).volume, 1 + 0.1, 1e-13);
}

TEST(Mesh, FileComesBackAsWritten) {
  const Folder folder;
  Mesh m = block(3, 2, 2, {"left", "right"}, [](int i) { return i > 0; });
  const std::int64_t bar[] = {0, 35};
  m.add_cell(Shape::bar2, bar, 1, 99);
  m.region_data[1] = {7850, 2.1e11, 0.3};
  m.node_sets["a/b"] = {};
  m.deck_scene = "[time]\n";
  write_mesh(folder / "mesh.h5", m, {"hilo-import x.inp"});
  const MeshFile f = read_mesh_file(folder / "mesh.h5");
  EXPECT_EQ(f.mesh.X, m.X);
  EXPECT_EQ(f.mesh.node_id, m.node_id);
  EXPECT_EQ(f.mesh.shape, m.shape);
  EXPECT_EQ(f.mesh.offset, m.offset);
  EXPECT_EQ(f.mesh.nodes, m.nodes);
  EXPECT_EQ(f.mesh.region, m.region);
  EXPECT_EQ(f.mesh.cell_id, m.cell_id);
  EXPECT_EQ(f.mesh.region_name, m.region_name);
  EXPECT_EQ(f.mesh.node_sets, m.node_sets);
  EXPECT_EQ(f.mesh.cell_sets, m.cell_sets);
  ASSERT_EQ(f.mesh.facet_sets.at("left face").size(), 4u);
  EXPECT_EQ(f.mesh.facet_sets.at("left face")[1].cell, 3);
  EXPECT_EQ(f.mesh.region_data[1].E, 2.1e11);
  EXPECT_TRUE(std::isnan(f.mesh.region_data[0].nu));
  EXPECT_EQ(f.mesh.deck_scene, m.deck_scene);
  EXPECT_EQ(f.provenance, std::vector<std::string>{"hilo-import x.inp"});
  EXPECT_FALSE(f.tagged);
  EXPECT_EQ(f.fidelity, std::vector<Fidelity>(2, Fidelity::nonlinear));
  EXPECT_TRUE(f.rank.empty());
  EXPECT_EQ(folder.files(), std::set<std::string>{"mesh.h5"});
}

TEST(Mesh, SameMeshGivesSameBytes) {
  const Folder folder;
  write_mesh(folder / "a.h5", block(4, 3, 2), {"hilo-import"});
  write_mesh(folder / "b.h5", block(4, 3, 2), {"hilo-import"});
  EXPECT_EQ(text_of(folder / "a.h5"), text_of(folder / "b.h5"));
}

/// geometry/mesh.h5, tags.h5 and out/parts-2.h5 of a two-region block.
void write_chain(const Folder& folder) {
  std::filesystem::create_directories(folder / "case/geometry");
  std::filesystem::create_directories(folder / "case/out");
  write_mesh(folder / "case/geometry/mesh.h5", block(4, 1, 1, {"left", "right"}, [](int i) { return i > 1; }), {"one"});
  write_tags(folder / "case/tags.h5", folder / "case/geometry/mesh.h5", {Fidelity::rigid, Fidelity::nonlinear}, {"one", "two"});
  write_parts(folder / "case/out/parts-2.h5", folder / "case/tags.h5", 2, {0, 0, 1, 1}, {"one", "two", "three"});
}

TEST(MeshChain, PartsReadMeshAndTagsThroughTheirLinksEvenAfterAMove) {
  const Folder folder;
  write_chain(folder);
  std::filesystem::rename(folder / "case", folder / "moved");
  const MeshFile f = read_mesh_file(folder / "moved/out/parts-2.h5");
  EXPECT_EQ(f.mesh.n_cells(), 4);
  EXPECT_TRUE(f.tagged);
  EXPECT_EQ(f.fidelity, (std::vector<Fidelity>{Fidelity::rigid, Fidelity::nonlinear}));
  EXPECT_EQ(f.rank, (std::vector<std::int32_t>{0, 0, 1, 1}));
  EXPECT_EQ(f.n_parts, 2);
  EXPECT_EQ(f.provenance.size(), 3u);
}

TEST(MeshChain, TagsMadeFromTagsLinkToTheMeshItself) {
  const Folder folder;
  write_chain(folder);
  write_tags(folder / "case/again.h5", folder / "case/out/parts-2.h5", {Fidelity::nonlinear, Fidelity::rigid}, {});
  std::filesystem::remove(folder / "case/tags.h5");
  std::filesystem::remove(folder / "case/out/parts-2.h5");
  EXPECT_EQ(read_mesh_file(folder / "case/again.h5").fidelity[1], Fidelity::rigid);
}

TEST(MeshChain, MissingLinkedFileIsNamed) {
  const Folder folder;
  write_chain(folder);
  std::filesystem::remove(folder / "case/geometry/mesh.h5");
  const auto message = message_of([&] { read_mesh_file(folder / "case/tags.h5"); });
  EXPECT_EQ(message.find(folder / "case/tags.h5: mesh is in " + (folder / "case/geometry/mesh.h5") + ", which is missing"), 0u) << message;
}

TEST(MeshChain, AChangedMeshIsRefusedWithTheCommandToRun) {
  const Folder folder;
  write_chain(folder);
  EXPECT_EQ(message_of([&] { read_mesh_file(folder / "case/tags.h5"); }), "no Error was thrown");
  write_mesh(folder / "case/geometry/mesh.h5", block(4, 1, 1, {"left", "right"}, [](int i) { return i > 2; }), {"one"});
  const auto message = message_of([&] { read_mesh_file(folder / "case/tags.h5"); });
  EXPECT_NE(message.find("mesh.h5 has changed since this file was made"), std::string::npos) << message;
}

TEST(MeshFile, DamageIsFoundOnReading) {
  const Folder folder;
  Mesh m = block(2, 1, 1);
  m.nodes[3] = 1000;
  write_mesh(folder / "mesh.h5", m, {});
  EXPECT_NE(message_of([&] { read_mesh_file(folder / "mesh.h5"); }).find("damaged: /mesh/cells/nodes holds 1000"), std::string::npos);
  Store other = Store::create(folder / "other.h5");
  other.write<double>("/mesh", std::vector<double>{1}, {1});
  other.publish();
  EXPECT_NE(message_of([&] { read_mesh_file(folder / "other.h5"); }).find("not a hilo file"), std::string::npos);
}

TEST(Mesh, NamesResolveToNodesWhateverTheirKind) {
  const Mesh m = block(2, 1, 1, {"a", "b"}, [](int i) { return i; });
  EXPECT_EQ(m.nodes_of("left", "x"), (std::vector<std::int64_t>{0, 3, 6, 9}));
  EXPECT_EQ(m.nodes_of("left face", "x"), (std::vector<std::int64_t>{0, 3, 6, 9}));
  EXPECT_EQ(m.nodes_of("b", "x"), (std::vector<std::int64_t>{1, 2, 4, 5, 7, 8, 10, 11}));
  EXPECT_EQ(m.nodes_of("first", "x").size(), 12u);
  EXPECT_EQ(message_of([&] { m.nodes_of("letf", "scene.toml:3:1"); }),
            "scene.toml:3:1: no region or set \"letf\" in the mesh (did you mean \"left\"?)");
}

TEST(Tags, RigidRegionsThatShareNodesAreOneBody) {
  const Mesh m = block(5, 1, 1, {"a", "b", "c", "d", "e"}, [](int i) { return i; });
  using enum Fidelity;
  EXPECT_EQ(body_of_region(m, std::vector{rigid, rigid, nonlinear, rigid, nonlinear}), (std::vector<int>{0, 0, -1, 1, -1}));
  EXPECT_EQ(body_of_region(m, std::vector{rigid, nonlinear, rigid, nonlinear, rigid}), (std::vector<int>{0, -1, 1, -1, 2}));
}

TEST(Tags, BoxTakesRegionsThatLieWhollyInside) {
  const Mesh m = block(4, 1, 1, {"a", "b", "c", "d"}, [](int i) { return i; });
  TagRules rules;
  rules.rules.push_back(tag_rule_of_option(Fidelity::rigid, "--rigid", "box:0,0,0,2.5,1,1"));
  const auto tags = apply_tag_rules(m, rules);
  EXPECT_EQ(tags[0], Fidelity::rigid);
  EXPECT_EQ(tags[1], Fidelity::rigid);
  EXPECT_EQ(tags[2], std::nullopt);  // sticks out
  EXPECT_EQ(tags[3], std::nullopt);
}

}  // namespace
}  // namespace hilo::test::mesh_test
