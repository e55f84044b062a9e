// SPDX-License-Identifier: GPL-3.0-or-later
// Forces between two surfaces and their tangent: forces on nodes, whatever these belong to.
#include <algorithm>

#include "system/contact/surface_pair.hpp"

namespace hilo {
namespace {

using Side9 = Eigen::Matrix<double, 9, 9>;

/// Shares that a node of either facet has of r, t1 and t2 (n nodes x 3).
struct NodeShares {
  std::vector<int> nodes;
  std::vector<std::array<double, 3>> share;
  NodeShares(const ContactSurface& own, const ContactSurface& other, const SurfacePoint& point) {
    const ContactSurface::Face &mine = own.faces[point.face], &its = other.faces[point.now.face];
    for (int a = 0; a < mine.n; ++a) nodes.push_back(mine.node[a]), share.push_back({point.share[a], 0, 0});
    const FacetCut& cut = cut_of(its.n);
    const auto& corner = cut.triangle[point.now.triangle];
    for (int a = 0; a < its.n; ++a) {
      const double w1 = cut.corner[corner[0]][a], w2 = cut.corner[corner[1]][a], w3 = cut.corner[corner[2]][a];
      nodes.push_back(its.node[a]), share.push_back({-w1, w2 - w1, w3 - w1});
    }
  }
};

}  // namespace

template <class T>
FacetForce<T> SurfacePair::force(const SurfacePoint& point, const Stage& s, const OverTriangle<double>& z0,
                                 const OverTriangle<T>& z1) const {
  if (!about_.empty()) return about(point.held, point.law, z0, z1, point.now.past);
  if (s.conserving()) return over_step(point.law, z0, z1, point.now.past, s.h);
  return at_end(point.law.as(share(), s.fixed_friction, sticks), z0, z1, point.now.past, touch(point), deep(point));
}

FacetForce<double> SurfacePair::force_of(int k, const SurfacePoint& point, const Stage& s) const {
  return force(point, s, over(k, point, point.now, begin(s)), over(k, point, point.now, s.e1->x));
}

void SurfacePair::evaluate(Pass& p) const {
  each_listed([&](int k, const SurfacePoint& point) {
    if (point.now.face < 0) return;
    const FacetForce<double> f = force_of(k, point, p.s);
    if (!f.acts) return;
    const NodeShares at(side[k], side[1 - k], point);
    const Vec3 on_point = values(f.on_point), on_second = values(f.on_second), on_third = values(f.on_third);
    for (size_t a = 0; a < at.nodes.size(); ++a)
      p.node[at.nodes[a]] += at.share[a][0] * on_point + at.share[a][1] * on_second + at.share[a][2] * on_third;
    p.scale(on_point.norm());
    if (p.K) add_tangent(p, k, point);
  });
}

void SurfacePair::add_tangent(Pass& p, int k, const SurfacePoint& point) const {
  const auto& list = partners_[k][point.face];
  const auto pair = std::find_if(list.begin(), list.end(), [&](const Partner& x) { return x.face == point.now.face; });
  const int clique = clique_[pair->pair];
  const std::span<const int> blocks = points_.layout.cliques[clique];
  if (blocks.empty()) return;
  const Stage& s = p.s;
  using T = Jet<9>;
  const OverTriangle<double> z1 = over(k, point, point.now, s.e1->x);
  const auto seeded = [](const Triple<double>& a, int first) {
    Triple<T> out;
    for (int i = 0; i < 3; ++i) out[i] = T(a[i]), out[i].d[first + i] = 1;
    return out;
  };
  const OverTriangle<T> z{seeded(z1.r, 0), seeded(z1.t1, 3), seeded(z1.t2, 6)};
  const OverTriangle<double> z0 = over(k, point, point.now, begin(s));
  const FacetForce<T> f = force(point, s, z0, z);
  Side9 K9;
  for (int i = 0; i < 3; ++i) K9.row(i) = f.on_point[i].d, K9.row(3 + i) = f.on_second[i].d, K9.row(6 + i) = f.on_third[i].d;
  K9 *= s.chain;
  const NodeShares at(side[k], side[1 - k], point);
  const auto n = static_cast<int>(at.nodes.size());
  thread_local Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> K;
  K.resize(3 * n, 3 * n);
  for (int a = 0; a < n; ++a) {
    Eigen::Matrix<double, 3, 9> row = Eigen::Matrix<double, 3, 9>::Zero();
    for (int i = 0; i < 3; ++i)
      if (at.share[a][i] != 0) row += at.share[a][i] * K9.middleRows<3>(3 * i);
    for (int b = 0; b < n; ++b)
      K.block<3, 3>(3 * a, 3 * b) =
          at.share[b][0] * row.leftCols<3>() + at.share[b][1] * row.middleCols<3>(3) + at.share[b][2] * row.rightCols<3>();
  }
  thread_local std::vector<NodeMap> maps;
  thread_local std::vector<std::array<bool, 3>> masks;
  points_.make_maps(at.nodes, blocks, s, maps, masks);
  add_reduced(*p.K, clique, n, K.data(), maps.data(), static_cast<int>(blocks.size()), masks.data());
}

double SurfacePair::energy() const {
  double sum = 0;
  each_listed([&](int, const SurfacePoint& point) { sum += stored(point, point.next.past); });
  return sum;
}

double SurfacePair::dissipated(const Stage& s) const {
  double sum = 0;
  each_listed([&](int k, const SurfacePoint& point) {
    sum += (point.law.friction > 0 || point.law.loss.any()) && point.now.face >= 0 ? force_of(k, point, s).dissipated : released(point);
  });
  return sum;
}

SurfacePair::Pressing SurfacePair::force(const Stage& s) const {
  Pressing out;
  each_listed([&](int k, const SurfacePoint& point) {
    if (point.now.face < 0) return;
    const FacetForce<double> f = force_of(k, point, s);
    if (!f.acts) return;
    if (!itself) out.on_b += (k == 0 ? 1 : -1) * values(f.on_point);
    out.sum += std::max(f.pressing, 0.);
  });
  return out;
}

}  // namespace hilo
