// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/surface/skin.hpp"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkPointData.h>

#include <cmath>

#include "sample_run.hpp"

namespace hilo::test::skin_test {
namespace {

using Points = std::vector<Vec3>;

/// Area of the drawn faces and the volume they enclose (divergence theorem); the latter is right only if all faces look outwards.
std::pair<double, double> area_and_volume(const Skin& skin) {
  double area = 0, volume = 0;
  for (vtkIdType f = 0; f < skin.faces()->GetNumberOfCells(); ++f) {
    vtkCell* cell = skin.faces()->GetCell(f);
    const auto at = [&](int k) { return Vec3(Eigen::Map<const Vec3>(cell->GetPoints()->GetPoint(k))); };
    for (int k = 2; k < cell->GetNumberOfPoints(); ++k) {
      const Vec3 n = 0.5 * (at(k - 1) - at(0)).cross(at(k) - at(0));
      area += n.norm();
      volume += n.dot(at(0)) / 3;
    }
  }
  return {area, volume};
}

Skin skin_of(const Mesh& mesh, const std::string& region) {
  std::vector<bool> shown(mesh.region_name.size(), false);
  shown[static_cast<size_t>(mesh.find_region(region))] = true;
  return Skin(mesh, boundary_facets(mesh, shown));
}

TEST(Skin, of_a_cube_has_six_sides) {
  const Mesh mesh = sample::cube(3);
  EXPECT_EQ(boundary_facets(mesh, {true}).size(), 54u);
  const auto [area, volume] = area_and_volume(skin_of(mesh, "cube"));
  EXPECT_NEAR(area, 6, 1e-6);  // points are single precision
  EXPECT_NEAR(volume, 1, 1e-6);
}

TEST(Skin, keeps_the_edges_of_a_cube_sharp_and_its_sides_smooth) {
  const Mesh mesh = sample::cube(3);
  const Skin skin = skin_of(mesh, "cube");
  EXPECT_EQ(skin.faces()->GetNumberOfPoints(), 6 * 16);  // a corner is drawn three times, an inner point of a side once
  EXPECT_EQ(skin.feature_edges()->GetNumberOfLines(), 12 * 3);
  for (vtkIdType v = 0; v < skin.faces()->GetNumberOfPoints(); ++v) {
    double n[3];
    skin.faces()->GetPointData()->GetNormals()->GetTuple(v, n);
    EXPECT_NEAR(std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}), 1, 1e-6);
  }
}

TEST(Skin, of_curved_cells_follows_their_shape_functions) {
  // Two cells, each a quarter of a ring whose arcs are parabolas through three points of the circle, drawn with four chords: per radius^2
  // the sector has 1/2 (triangle) + 2/3 c s (parabola on chord c = sqrt2 with rise s = 1 - 1/sqrt2), of which four chords leave out 1/16.
  const Mesh mesh = sample::machine();
  const auto [area, volume] = area_and_volume(skin_of(mesh, "support"));
  const double R = 0.3, r = 0.15, b = 0.4, sector = 0.5 + 15.0 / 16 * 2 / 3 * std::sqrt(2) * (1 - 1 / std::sqrt(2));
  EXPECT_NEAR(volume, 2 * sector * (R * R - r * r) * b, 1e-7);  // points are single precision
  const double around = M_PI * (R + r) * b + M_PI * (R * R - r * r) + 2 * (R - r) * b;
  EXPECT_NEAR(area / around, 1, 0.02);
}

TEST(Skin, moves_with_its_nodes) {
  const Mesh mesh = sample::machine();
  for (const char* region : {"barrel", "support", "foot"}) {
    Skin skin = skin_of(mesh, region);
    const auto [area, volume] = area_and_volume(skin);
    std::vector<Vec3> x = mesh.X;
    for (Vec3& p : x) p = 2 * Vec3(p.y(), p.z(), p.x()) + Vec3(1, 2, 3);  // turned, doubled, moved
    skin.move(x);
    const auto [new_area, new_volume] = area_and_volume(skin);
    EXPECT_NEAR(new_area / area, 4, 1e-4) << region;
    EXPECT_NEAR(new_volume / volume, 8, 1e-4) << region;
  }
}

TEST(Skin, interpolates_a_linear_field_exactly) {
  const Mesh mesh = sample::machine();
  for (const char* region : {"barrel", "support", "foot"}) {
    Skin skin = skin_of(mesh, region);
    std::vector<double> value;
    for (const Vec3& p : mesh.X) value.push_back(1 + 2 * p.x() - 3 * p.y() + 4 * p.z());
    skin.set_values(value);
    for (vtkIdType v = 0; v < skin.faces()->GetNumberOfPoints(); ++v) {
      const Vec3 p = Eigen::Map<const Vec3>(skin.faces()->GetPoint(v));
      EXPECT_NEAR(skin.faces()->GetPointData()->GetScalars()->GetTuple1(v), 1 + 2 * p.x() - 3 * p.y() + 4 * p.z(), 1e-5);
    }
  }
}

TEST(Skin, shows_the_face_between_two_regions_only_where_one_is_hidden) {
  Mesh mesh = sample::cube(2);
  mesh.region_name.push_back("upper");
  mesh.region_data.push_back({});
  for (std::int64_t c = 4; c < 8; ++c) mesh.region[static_cast<size_t>(c)] = 1;
  EXPECT_EQ(boundary_facets(mesh, {true, true}).size(), 24u);
  EXPECT_EQ(boundary_facets(mesh, {true, false}).size(), 16u);
}

}  // namespace
}  // namespace hilo::test::skin_test
