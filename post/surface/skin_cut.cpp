// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a Skin behind a plane, closed by the section of its cells.
#include <algorithm>
#include <bit>
#include <cmath>

#include "post/surface/pieces.hpp"
#include "post/surface/skin_builder.hpp"

namespace hilo {

double SkinBuilder::depth(const Vec3& x) const {
  const double d = (*cut_)(x);
  return std::abs(d) < near_ ? 0 : d;
}

std::int64_t SkinBuilder::between(std::int64_t p, std::int64_t q) {
  if (p > q) std::swap(p, q);
  const double a = depth(position_[static_cast<size_t>(p)]), b = depth(position_[static_cast<size_t>(q)]);
  if (a == 0) return p;
  if (b == 0) return q;
  const std::array<std::int64_t, 3> key{p, q, -1};
  if (const auto found = on_edge_.find(key); found != on_edge_.end()) return found->second;
  const double w = a / (a - b);
  std::vector<std::int64_t> nodes;
  std::vector<double> weights;
  for (const auto& [point, share] : {std::pair{p, 1 - w}, std::pair{q, w}})
    for (std::int64_t k = first[static_cast<size_t>(point)]; k < first[static_cast<size_t>(point) + 1]; ++k)
      nodes.push_back(node[static_cast<size_t>(k)]), weights.push_back(share * weight[static_cast<size_t>(k)]);
  return on_edge_[key] = new_point(nodes, weights);
}

std::int64_t SkinBuilder::piece_point(std::span<const std::int64_t> nodes, const std::vector<double>& weights) {
  // The same point of two cells has the same nodes and weights, in whatever order.
  std::vector<std::pair<std::int64_t, std::int64_t>> parts;
  for (size_t k = 0; k < nodes.size(); ++k)
    if (weights[k] != 0) parts.emplace_back(nodes[k], std::llround(weights[k] * 1e9));
  if (parts.size() == 1) return point_of_node(parts.front().first);
  std::sort(parts.begin(), parts.end());
  std::uint64_t hash = 0xCBF29CE484222325ull;
  for (const auto& [n, w] : parts)
    for (const auto x : {static_cast<std::uint64_t>(n), static_cast<std::uint64_t>(w)})
      hash = std::rotl((hash ^ x) * 0x9E3779B97F4A7C15ull, 29) * 0xC2B2AE3D27D4EB4Full;
  const auto [at, fresh] = piece_point_.try_emplace(hash, 0);
  if (fresh) at->second = new_point(nodes, weights);
  return at->second;
}

void SkinBuilder::add_clipped(std::span<const std::int64_t> points, std::int64_t cell) {
  std::vector<std::int64_t> kept;
  const auto keep = [&](std::int64_t p) {
    if (kept.empty() || (kept.back() != p && kept.front() != p)) kept.push_back(p);
  };
  bool any = false;
  for (size_t k = 0; k < points.size(); ++k) {
    const std::int64_t p = points[k], q = points[(k + 1) % points.size()];
    const bool p_in = depth(position_[static_cast<size_t>(p)]) < 0, q_in = depth(position_[static_cast<size_t>(q)]) < 0;
    any = any || p_in;
    if (p_in) keep(p);
    if (p_in != q_in) keep(between(p, q));
  }
  if (any && kept.size() >= 3) keep_polygon(kept, cell);
}

void SkinBuilder::clip_edges(std::vector<std::array<std::int64_t, 2>>& edges, std::vector<std::int64_t>* cells) {
  size_t kept = 0;
  for (size_t k = 0; k < edges.size(); ++k) {
    auto [p, q] = edges[k];
    const bool p_in = depth(position_[static_cast<size_t>(p)]) < 0, q_in = depth(position_[static_cast<size_t>(q)]) < 0;
    if (!p_in && !q_in) continue;
    if (!p_in) p = between(p, q);
    if (!q_in) q = between(p, q);
    if (cells) (*cells)[kept] = (*cells)[k];
    edges[kept++] = {p, q};
  }
  edges.resize(kept);
  if (cells) cells->resize(kept);
}

void SkinBuilder::add_section(std::span<const std::int64_t> cells) {
  std::vector<std::int64_t> point;
  std::vector<double> value;
  for (const std::int64_t c : cells) {
    const auto nodes = mesh_.cell(c);
    double low = 0, high = -1;
    for (const auto n : nodes) {
      const double d = depth(mesh_.X[static_cast<size_t>(n)]);
      low = std::min(low, d), high = d >= 0 ? 1 : high;
    }
    if (low >= 0 || high < 0) continue;
    const Pieces& p = pieces(static_cast<Shape>(mesh_.shape[static_cast<size_t>(c)]));
    point.assign(p.point.size(), -1), value.resize(p.point.size());
    for (size_t k = 0; k < p.point.size(); ++k) {
      Vec3 x = Vec3::Zero();
      for (size_t a = 0; a < nodes.size(); ++a) x += p.point[k][a] * mesh_.X[static_cast<size_t>(nodes[a])];
      value[k] = depth(x);
    }
    const auto point_of = [&](int k) {
      auto& id = point[static_cast<size_t>(k)];
      if (id < 0) id = piece_point(nodes, p.point[static_cast<size_t>(k)]);
      return id;
    };
    for (size_t t = 0; t < p.tet.size(); ++t) {
      const auto& tet = p.tet[t];
      const auto at = [&](int i) { return value[static_cast<size_t>(tet[static_cast<size_t>(i)])]; };
      const Crossing cross = crossing({at(0), at(1), at(2), at(3)}, p.on_border[t]);
      std::array<std::int64_t, 4> corner{};
      for (size_t k = 0; k < static_cast<size_t>(cross.n); ++k)
        corner[k] = between(point_of(tet[static_cast<size_t>(cross.edge[k][0])]), point_of(tet[static_cast<size_t>(cross.edge[k][1])]));
      std::vector<std::int64_t> polygon;  // without corners that coincide
      for (size_t k = 0; k < static_cast<size_t>(cross.n); ++k)
        if (polygon.empty() || (corner[k] != polygon.back() && corner[k] != polygon.front())) polygon.push_back(corner[k]);
      if (polygon.size() < 3) continue;
      const auto x = [&](size_t k) -> const Vec3& { return position_[static_cast<size_t>(polygon[k])]; };
      if ((x(1) - x(0)).cross(x(2) - x(0)).dot(cut_->normal) < 0) std::reverse(polygon.begin(), polygon.end());
      keep_polygon(polygon, c);
      for (size_t k = 0; k < static_cast<size_t>(cross.n); ++k)
        if (cross.border[k] && corner[k] != corner[(k + 1) % static_cast<size_t>(cross.n)])
          facet_edges.push_back({corner[k], corner[(k + 1) % static_cast<size_t>(cross.n)]});
    }
  }
}

}  // namespace hilo
