// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth faces of coarse cells: what is one cylinder, and what is none.
#include "model/smooth_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hilo::test::smooth_faces_test {
namespace {

SurfaceFacet quadrangle(const std::array<std::int64_t, 4>& node, const std::array<Vec3, 4>& x) {
  SurfaceFacet f;
  f.n_nodes = f.n_corners = 4;
  for (size_t i = 0; i < 4; ++i) {
    f.node[i] = node[i];
    for (int k = 0; k < 3; ++k) f.corner[i][static_cast<size_t>(k)] = x[i][k];
  }
  return f;
}

/// A shaft of radius 1 along z in two layers, of strips with these angles [deg].
std::vector<SurfaceFacet> shaft(const std::vector<double>& strips) {
  std::vector<SurfaceFacet> out;
  const auto n = static_cast<std::int64_t>(strips.size());
  double from = 0;
  const auto at = [](double deg, double z) {
    return Vec3(std::cos(deg * std::numbers::pi / 180), std::sin(deg * std::numbers::pi / 180), z);
  };
  for (std::int64_t i = 0; i < n; ++i) {
    const double to = from + strips[static_cast<size_t>(i)];
    for (std::int64_t z = 0; z < 2; ++z) {
      const auto node = [&](std::int64_t k, std::int64_t layer) { return layer * n + k % n; };
      const auto h = static_cast<double>(z);
      out.push_back(quadrangle({node(i, z), node(i + 1, z), node(i + 1, z + 1), node(i, z + 1)},
                               {at(from, h), at(to, h), at(to, h + 1), at(from, h + 1)}));
    }
    from = to;
  }
  return out;
}

int count(const std::vector<int>& face) { return 1 + *std::ranges::max_element(face); }

// Facets that turn by more than the angle are of the cylinder all the same.
TEST(SmoothFaces, CoarseStripsOfOneShaftAreOneFace) {
  std::vector<double> strips(6, 30);
  strips.insert(strips.end(), 4, 45);
  const auto facets = shaft(strips);
  EXPECT_EQ(count(smooth_faces(facets, 0.7)), 1);
  const FaceShape s = shape_of_face(facets);
  EXPECT_EQ(s.kind, "shaft");
  EXPECT_NEAR(s.radius, 1, 1e-12);
  EXPECT_NEAR(s.length, 2, 1e-12);
}

// A flat of 60 degrees lies far deeper below the surface than the chords of 20 degrees beside it.
TEST(SmoothFaces, AFlatOnAShaftIsAFaceOfItsOwn) {
  std::vector<double> strips(15, 20);
  strips.push_back(60);
  const auto facets = shaft(strips);
  const auto face = smooth_faces(facets, 0.6);
  EXPECT_EQ(count(face), 2);
  EXPECT_NE(face.back(), face.front());
}

// No bore of kilometres where a face is only nearly plane.
TEST(SmoothFaces, ANearlyPlaneFaceIsNoBore) {
  std::vector<SurfaceFacet> facets;
  const auto z = [](std::int64_t i, std::int64_t j) { return 2e-4 * std::sin(2.1 * static_cast<double>(i * i + 3 * j)); };
  for (std::int64_t i = 0; i < 8; ++i)
    for (std::int64_t j = 0; j < 8; ++j) {
      const auto at = [&](std::int64_t a, std::int64_t b) {
        return Vec3(1e-3 * static_cast<double>(a), 1e-1 * static_cast<double>(b), z(a, b));
      };
      facets.push_back(quadrangle({9 * i + j, 9 * (i + 1) + j, 9 * (i + 1) + j + 1, 9 * i + j + 1},
                                  {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}));
    }
  const FaceShape s = shape_of_face(facets);
  EXPECT_EQ(s.kind, "free") << s.radius;
}

// Any five points lie on a cylinder.
TEST(SmoothFaces, TwoTrianglesAreNoCylinder) {
  const Vec3 x[] = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.2), Vec3(1, 1, 0)};
  std::vector<SurfaceFacet> facets(2);
  for (size_t f = 0; f < 2; ++f) {
    facets[f].n_nodes = facets[f].n_corners = 3;
    const std::array<size_t, 3> of = f == 0 ? std::array<size_t, 3>{0, 1, 2} : std::array<size_t, 3>{1, 3, 2};
    for (size_t i = 0; i < 3; ++i) {
      facets[f].node[i] = static_cast<std::int64_t>(of[i]);
      for (int k = 0; k < 3; ++k) facets[f].corner[i][static_cast<size_t>(k)] = x[of[i]][k];
    }
  }
  EXPECT_EQ(shape_of_face(facets).kind, "free");
}

}  // namespace
}  // namespace hilo::test::smooth_faces_test
