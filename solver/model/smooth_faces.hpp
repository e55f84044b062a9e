// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth faces of a mesh's surface: facets that meet without an edge, as a CAD program sees a bore or a foot.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "model/facet_key.hpp"

namespace hilo {

/// A facet of the surface with all that others need to know of it; no pointers, so that ranks can send it.
struct SurfaceFacet {
  std::int64_t n_nodes = 0, n_corners = 0;
  std::array<std::int64_t, 8> node{};             // numbers, corners first
  std::array<std::array<double, 3>, 4> corner{};  // their positions  [m]
  Vec3 at(size_t i) const { return Vec3(corner[i].data()); }
  Vec3 centre() const;
  Vec3 area() const;  // outward, by its corners  [m^2]
};
template <class Number>
SurfaceFacet surface_facet(const Mesh& mesh, const Facet& f, const Number& number) {
  SurfaceFacet s;
  const auto nodes = mesh.facet_nodes(f);
  s.n_nodes = static_cast<std::int64_t>(nodes.size()), s.n_corners = nodes.size() % 3 == 0 ? 3 : 4;
  for (size_t i = 0; i < nodes.size() && i < s.node.size(); ++i) s.node[i] = number(nodes[i]);
  for (size_t i = 0; i < static_cast<size_t>(s.n_corners); ++i)
    for (int k = 0; k < 3; ++k) s.corner[i][static_cast<size_t>(k)] = mesh.X[static_cast<size_t>(nodes[i])][k];
  return s;
}

/// The face of each facet, numbered from 0 by their first facets: facets that share an edge of two corners are of one face where they
/// turn by less than `angle` [rad] there, and where those of coarse cells lie on one cylinder.
std::vector<int> smooth_faces(std::span<const SurfaceFacet> facets, double angle);
/// From a point to the nearest point of a facet (of its triangles)  [m].
double distance(const SurfaceFacet& f, const Vec3& x);

/// What a face is: a plane, a bore (a cylinder seen from inside), a shaft, or free.  A cylinder has six corners at least, and a radius of
/// 100 times the face's size at most.
struct FaceShape {
  std::string kind;                                 // "plane", "bore", "shaft", "free"
  double area = 0, radius = 0, length = 0;          // [m^2], [m], [m] along the axis
  Vec3 middle = Vec3::Zero(), axis = Vec3::Zero();  // of the cylinder; of a plane the centroid and the outward normal  [m], [1]
  Vec3 point = Vec3::Zero();                        // on the face, far from its border  [m]
};
FaceShape shape_of_face(std::span<const SurfaceFacet> facets);

}  // namespace hilo
