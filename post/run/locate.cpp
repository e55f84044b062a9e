// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/locate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/smooth_faces.hpp"
#include "physics/shape/shapes.hpp"

namespace hilo {
namespace {

/// How far beyond the faces of a tetrahedron (4 corners), wedge (6) or hexahedron (8) its own coordinates lie.
double beyond(int corners, const Vec3& xi) {
  if (corners == 8) return xi.cwiseAbs().maxCoeff() - 1;
  if (corners == 4) return std::max(-xi.minCoeff(), xi.sum() - 1);
  return std::max({-xi[0], -xi[1], xi[0] + xi[1] - 1, std::abs(xi[2]) - 1});
}

/// Newton from the middle of the cell; no more than one length of the cell in a step.
template <class S>
Located in_solid(const Mesh& mesh, std::span<const std::int64_t> nodes, const Vec3& X) {
  constexpr int corners = S::n == 20 ? 8 : S::n == 15 ? 6 : S::n == 10 ? 4 : S::n;
  Vec3 xi = corners == 8 ? Vec3(0, 0, 0) : corners == 4 ? Vec3(0.25, 0.25, 0.25) : Vec3(1. / 3, 1. / 3, 0);
  double N[S::n], dN[S::n][3];
  bool solved = false;
  for (int k = 0; k < 40 && !solved; ++k) {
    S::values(xi.data(), N);
    S::gradients(xi.data(), dN);
    Vec3 gap = X;
    Mat3 J = Mat3::Zero();
    for (int a = 0; a < S::n; ++a) {
      const Vec3& Xa = mesh.X[static_cast<size_t>(nodes[static_cast<size_t>(a)])];
      gap -= N[a] * Xa;
      J += Xa * Vec3(dN[a]).transpose();
    }
    Vec3 step = J.fullPivLu().solve(gap);
    if (!step.allFinite()) return {};
    const double size = step.norm();
    if (size > 1) step /= size;
    xi += step;
    if (xi.cwiseAbs().maxCoeff() > 4) return {};
    solved = size < 1e-13 || (k > 5 && size < 1e-9);
  }
  const double outside = beyond(corners, xi);
  if (!solved || outside > most_outside) return {};
  S::values(xi.data(), N);
  return {0, {nodes.begin(), nodes.end()}, {N, N + S::n}, outside};
}

Located in_bar(const Mesh& mesh, std::span<const std::int64_t> nodes, const Vec3& X) {
  const Vec3 a = mesh.X[static_cast<size_t>(nodes[0])], d = mesh.X[static_cast<size_t>(nodes[1])] - a;
  const double s = (X - a).dot(d) / d.squaredNorm(), outside = std::max({-s, s - 1, (X - a - s * d).norm() / d.norm()});
  if (!(outside <= most_outside)) return {};
  return {0, {nodes.begin(), nodes.end()}, {1 - s, s}, outside};
}

/// Distance to the box around the nodes of a cell, and the length of its diagonal  [m].
std::pair<double, double> to_box(const Mesh& mesh, std::span<const std::int64_t> nodes, const Vec3& X) {
  Vec3 low = mesh.X[static_cast<size_t>(nodes[0])], high = low;
  for (const std::int64_t n : nodes) {
    low = low.cwiseMin(mesh.X[static_cast<size_t>(n)]);
    high = high.cwiseMax(mesh.X[static_cast<size_t>(n)]);
  }
  return {(low - X).cwiseMax(X - high).cwiseMax(0).norm(), (high - low).norm()};
}

}  // namespace

Located locate(const Mesh& mesh, const std::vector<bool>& wanted, const Vec3& X) {
  Located best;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    if (!wanted[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])]) continue;
    const auto nodes = mesh.cell(c);
    const auto [distance, size] = to_box(mesh, nodes, X);
    if (distance > 0.2 * size) continue;  // curved edges leave the box of their nodes by less
    const auto shape = static_cast<Shape>(mesh.shape[static_cast<size_t>(c)]);
    Located found =
        shape == Shape::bar2 ? in_bar(mesh, nodes, X) : of_shape(shape, Located{}, [&]<class S>() { return in_solid<S>(mesh, nodes, X); });
    if (found.cell < 0 || (best.cell >= 0 && found.outside >= best.outside)) continue;
    best = std::move(found);
    best.cell = c;
  }
  return best;
}

NearestRegion nearest_region(const Mesh& mesh, const std::vector<bool>& wanted, const Vec3& X) {
  NearestRegion nearest{-1, std::numeric_limits<double>::infinity()};
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const int region = mesh.region[static_cast<size_t>(c)];
    const auto nodes = mesh.cell(c);
    if (!wanted[static_cast<size_t>(region)] || to_box(mesh, nodes, X).first >= nearest.distance) continue;
    const ShapeInfo& shape = info(mesh.shape[static_cast<size_t>(c)]);
    const auto closer = [&](double d) {
      if (d < nearest.distance) nearest = {region, d};
    };
    if (shape.dimension == 1) {
      const Vec3 a = mesh.X[static_cast<size_t>(nodes[0])], d = mesh.X[static_cast<size_t>(nodes[1])] - a;
      closer((X - a - std::clamp((X - a).dot(d) / d.squaredNorm(), 0., 1.) * d).norm());
      continue;
    }
    for (std::int64_t f = 0; f < static_cast<std::int64_t>(shape.facets.size()); ++f)
      closer(distance(surface_facet(mesh, {c, f}, [](std::int64_t n) { return n; }), X));
  }
  return nearest;
}

}  // namespace hilo
