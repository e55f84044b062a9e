// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of one side of a contact: facets cut into flat triangles, and the points that meet the other side.
#pragma once
#include <span>

#include "physics/contact/facet_contact.hpp"
#include "system/facet.hpp"

namespace hilo {

/// Along an edge of a quadratic facet, which the triangles follow within a sixteenth of its sag; and most triangles of a facet.
constexpr int facet_pieces = 4;
constexpr size_t most_triangles = size_t{2} * facet_pieces * facet_pieces;

/// How a facet of n nodes is cut: its corners (and what lies between) are means of its nodes, so that forces on them are forces on nodes.
struct FacetCut {
  std::vector<std::array<double, 8>> corner;  // shares of the nodes, which come first
  std::vector<std::array<int, 3>> triangle;   // outward
  std::vector<std::array<int, 3>> on_edge;    // of each side of a triangle, from corner k to k + 1: the edge of the facet, or -1
};
const FacetCut& cut_of(size_t n);

/// Points of a facet with their shares of its nodes and their reference areas: n x n Gauss points (2 to 4); of a triangle three or, from
/// n = 3 on, six.
struct FacetPoints {
  std::vector<std::vector<double>> share;
  std::vector<double> area;  // [m^2]
};
FacetPoints facet_points(std::span<const Vec3> X, int n = 2);

/// Where a point stands between steps.
struct FacetState {
  FacetPast past{.gap = 1e300};
  int face = -1, triangle = -1;  // of the other side
};

/// Tangential over normal stiffness of two like surfaces (Mindlin 1949).
inline double tangential_ratio(double nu) { return 2 * (1 - nu) / (2 - nu); }

struct SurfacePoint {
  int face = 0;
  std::array<double, 8> share{};
  PointLaw law;
  double cell = 0;              // depth of the cell behind it [m]
  double area = 0;              // [m^2]
  FacetState state, now, next;  // accepted, of the step at work, and at its end
  HeldPoint held;               // in small motions about a state
  std::pair<int, int> left{};   // face and triangle that it had before in the step at work
  bool parts = false;           // touches without pressure, and would be pulled in the step at work
};

/// Facets of n <= 8 nodes each.
struct ContactSurface {
  struct Face {
    int n = 0;
    std::array<int, 8> node{};
    std::array<int, 8> joint{};    // its nodes; those that move as one have one number
    std::array<bool, 4> border{};  // edges that no other facet of the surface has
    std::array<int, 4> across{};   // the facet beyond each edge, or -1
    int first = 0, n_points = 0;   // of its points
    double cell = 0;               // depth of the cell behind it [m]
  };
  std::vector<Face> faces;
  std::vector<SurfacePoint> points;

  void find_borders();
  Vec3 at(const SurfacePoint& point, std::span<const Vec3> x) const;
  std::array<Vec3, 3> triangle(int face, int triangle, std::span<const Vec3> x) const;
};

}  // namespace hilo
