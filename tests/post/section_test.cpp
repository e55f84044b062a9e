// SPDX-License-Identifier: GPL-3.0-or-later
// Sections and iso-surfaces: areas and values that are known.
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>

#include <cmath>

#include "moving_run.hpp"
#include "post/surface/iso_surface.hpp"
#include "post/surface/pieces.hpp"
#include "post/surface/skin.hpp"
#include "sample_run.hpp"

namespace hilo::test::section_test {
namespace {

/// Area of the polygons that satisfy a test on their corners.
template <class Test>
double area(vtkPolyData* data, Test&& test) {
  double sum = 0;
  auto* cells = data->GetPolys();
  vtkIdType n = 0;
  const vtkIdType* id = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(n, id);) {
    std::vector<Vec3> x;
    for (vtkIdType k = 0; k < n; ++k) x.emplace_back(data->GetPoint(id[k]));
    if (!std::all_of(x.begin(), x.end(), test)) continue;
    Vec3 twice = Vec3::Zero();
    for (size_t k = 2; k < x.size(); ++k) twice += (x[k - 1] - x[0]).cross(x[k] - x[0]);
    sum += twice.norm() / 2;
  }
  return sum;
}

std::vector<std::int64_t> cells_of(const Mesh& mesh, const std::string& region) {
  std::vector<std::int64_t> cells;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    if (mesh.region_name[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])] == region) cells.push_back(c);
  return cells;
}

Skin cut_skin(const Mesh& mesh, const std::string& region, const Plane& plane) {
  std::vector<bool> shown;
  for (const auto& name : mesh.region_name) shown.push_back(name == region);
  return {mesh, boundary_facets(mesh, shown), {}, &plane, cells_of(mesh, region)};
}

TEST(Cut, a_cut_box_is_closed_by_its_section) {
  const Mesh mesh = sample::cube(4);
  struct Case {
    Plane plane;
    double section, whole;
  };
  const double half = std::sqrt(0.5);
  for (const Case& c : {Case{{{1, 0, 0}, 0.3}, 1, 2 + 4 * 0.3},                            // through cells
                        Case{{{1, 0, 0}, 0.5}, 1, 2 + 4 * 0.5},                            // through nodes
                        Case{{{-1, 0, 0}, -0.25}, 1, 2 + 4 * 0.75},                        // the other side
                        Case{{{half, half, 0}, half}, std::sqrt(2), 3 + std::sqrt(2)}}) {  // along a diagonal
    const Skin skin = cut_skin(mesh, "cube", c.plane);
    EXPECT_NEAR(area(skin.faces(), [&](const Vec3& x) { return std::abs(c.plane(x)) < 1e-6; }), c.section, 1e-6);
    EXPECT_NEAR(area(skin.faces(), [](const Vec3&) { return true; }), c.whole, 1e-6);
    for (vtkIdType k = 0; k < skin.faces()->GetNumberOfPoints(); ++k) EXPECT_LT(c.plane(Vec3(skin.faces()->GetPoint(k))), 1e-6);
  }
  EXPECT_TRUE(cut_skin(mesh, "cube", {{1, 0, 0}, 0}).empty());
  EXPECT_NEAR(area(cut_skin(mesh, "cube", {{1, 0, 0}, 1}).faces(), [](const Vec3&) { return true; }), 6, 1e-6);
}

TEST(Cut, the_section_shows_the_values_within) {
  Mesh mesh = sample::cube(3);
  Skin skin = cut_skin(mesh, "cube", {Vec3(1, 2, 3).normalized(), 0.9});
  std::vector<double> value;
  for (const Vec3& X : mesh.X) value.push_back(2 * X.x() - 5 * X.y() + X.z());
  skin.set_values(value);
  const auto* shown = vtkFloatArray::SafeDownCast(skin.faces()->GetPointData()->GetScalars());
  for (vtkIdType k = 0; k < skin.faces()->GetNumberOfPoints(); ++k) {
    const Vec3 x(skin.faces()->GetPoint(k));
    EXPECT_NEAR(shown->GetValue(k), 2 * x.x() - 5 * x.y() + x.z(), 1e-5);
  }
  std::vector<Vec3> moved;  // and moves with the material
  for (const Vec3& X : mesh.X) moved.push_back(3 * X + Vec3(1, 0, 0));
  skin.move(moved);
  const Plane plane{Vec3(1, 2, 3).normalized(), 0.9};
  double nearest = 1;
  for (vtkIdType k = 0; k < skin.faces()->GetNumberOfPoints(); ++k) {
    const Vec3 X = (Vec3(skin.faces()->GetPoint(k)) - Vec3(1, 0, 0)) / 3;
    EXPECT_LT(plane(X), 1e-6);
    nearest = std::min(nearest, std::abs(plane(X)));
  }
  EXPECT_LT(nearest, 1e-6);
}

TEST(Cut, cells_with_mid_side_nodes_have_the_section_of_their_shape) {
  const Mesh mesh = sample::machine();
  const auto flat = [](double z) { return [z](const Vec3& x) { return std::abs(x.z() - z) < 1e-6; }; };
  EXPECT_NEAR(area(cut_skin(mesh, "foot", {{0, 0, 1}, -0.71}).faces(), flat(-0.71)), 0.25, 1e-6);  // 10-node tetrahedra of a box
  // Half of a ring of radii 0.15 and 0.3, 20-node hexahedra of 90 degrees: through its axis plane two rectangles, here one of them.
  const Plane plane{{1, 0, 0}, 0.6};
  EXPECT_NEAR(area(cut_skin(mesh, "support", plane).faces(), [&](const Vec3& x) { return std::abs(plane(x)) < 1e-6; }), 0.15 * 0.4, 2e-4);
}

TEST(Pieces, fill_every_shape_and_have_its_border_as_their_border) {
  for (const Shape shape : {Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20, Shape::hex20r}) {
    // Corners of the unit cell; mid-side nodes where their weights say.
    const bool box = info(shape).n_corners == 8, prism = shape == Shape::wedge6 || shape == Shape::wedge15;
    const std::vector<Vec3> corner =
        box     ? std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}
        : prism ? std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}
                : std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    using Edges = std::vector<std::pair<size_t, size_t>>;
    const Edges edges = box     ? Edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}
                        : prism ? Edges{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}
                                : Edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    std::vector<Vec3> node = corner;
    if (static_cast<size_t>(info(shape).n_nodes) > corner.size())
      for (const auto& [a, b] : edges) node.push_back(0.5 * (corner[a] + corner[b]));
    const Pieces& p = pieces(shape);
    std::vector<Vec3> x;
    for (const auto& w : p.point) {
      Vec3 sum = Vec3::Zero();
      for (size_t a = 0; a < node.size(); ++a) sum += w[a] * node[a];
      x.push_back(sum);
    }
    double volume = 0, border = 0;
    for (size_t t = 0; t < p.tet.size(); ++t) {
      const auto at = [&](int i) { return x[static_cast<size_t>(p.tet[t][static_cast<size_t>(i)])]; };
      volume += std::abs((at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0))) / 6;
      for (int i = 0; i < 4; ++i)
        if (p.on_border[t][static_cast<size_t>(i)]) {
          const Vec3 a = at((i + 1) % 4), b = at((i + 2) % 4), c = at((i + 3) % 4);
          border += (b - a).cross(c - a).norm() / 2;
        }
    }
    EXPECT_NEAR(volume, box ? 1.0 : prism ? 0.5 : 1.0 / 6, 1e-12) << info(shape).name;
    EXPECT_NEAR(border, box ? 6.0 : prism ? 3 + std::sqrt(2) : 1.5 + std::sqrt(3) / 2, 1e-12) << info(shape).name;
  }
}

TEST(Iso, of_a_linear_field_is_a_plane_of_the_known_area) {
  const Mesh cube = sample::cube(3), machine = sample::machine();
  const auto check = [](const Mesh& mesh, const std::string& region, const Vec3& slope, double level, double expected) {
    std::vector<double> value;
    for (const Vec3& X : mesh.X) value.push_back(slope.dot(X));
    IsoSurface iso(mesh, cells_of(mesh, region), {level});
    iso.update(value, mesh.X);
    ASSERT_GT(iso.surface()->GetNumberOfPoints(), 0);
    for (vtkIdType k = 0; k < iso.surface()->GetNumberOfPoints(); ++k) {
      EXPECT_NEAR(slope.dot(Vec3(iso.surface()->GetPoint(k))), level, 1e-6 * slope.norm());
      const Vec3 n(iso.surface()->GetPointData()->GetNormals()->GetTuple3(k));
      EXPECT_NEAR(n.dot(slope.normalized()), 1, 1e-5);
    }
    EXPECT_NEAR(area(iso.surface(), [](const Vec3&) { return true; }), expected, 1e-5);
  };
  check(cube, "cube", {4, 0, 0}, 1.7, 1);
  check(cube, "cube", {1, 1, 1}, 1.5, 3 * std::sqrt(3) / 4);  // a regular hexagon of sides 1/sqrt(2)
  check(machine, "foot", {0, 0, 2}, -1.33, 0.25);
}

TEST(Iso, of_a_sphere_comes_near_to_it_and_is_drawn_or_refused) {
  const Workplace place;
  write_moving_run(
      place, [](const Vec3& X, double) { return X; }, 1);
  EXPECT_EQ(place.run("hilo-post render run.h5 --iso 3,9 --size 320x180 -o iso.png").exit, 0);
  EXPECT_EQ(place.run("hilo-post render run.h5 --cut x=0.5 --size 320x180 -o cut.png").exit, 0);
  struct Fault {
    const char *rest, *text;
    int exit;
  };
  for (const Fault& f : {Fault{"--iso 300", "no value is reached (there are 0 to 10 MPa)", 2}, Fault{"--iso a", "\"a\" is no number", 1},
                         Fault{"--iso 1 --cut x=0", "give one", 1}, Fault{"--cut x", "\"x\" is no plane (write x=0.1", 1},
                         Fault{"--cut x=-1", "removes all that is shown", 2}, Fault{"--iso 1 --field region", "region has no values", 1}}) {
    const Ran ran = place.run(std::string("hilo-post render run.h5 -o x.png ") + f.rest);
    EXPECT_EQ(ran.exit, f.exit) << f.rest;
    EXPECT_NE(ran.err.find(f.text), std::string::npos) << ran.err;
  }
  const Mesh mesh = sample::cube(20);
  std::vector<std::int64_t> all;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) all.push_back(c);
  std::vector<double> r;
  for (const Vec3& X : mesh.X) r.push_back((X - Vec3(0.5, 0.5, 0.5)).norm());
  IsoSurface iso(mesh, all, {0.4});
  iso.update(r, mesh.X);
  EXPECT_NEAR(area(iso.surface(), [](const Vec3&) { return true; }), 4 * M_PI * 0.16, 0.01);
}

}  // namespace
}  // namespace hilo::test::section_test
