// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that are folded where the points of the stress do not see it: no state to go on from.  Compressions beyond which a law or a cell
// is no longer what it stands for: told once for a region, at the state that reaches them.
//
// Laws: what physics/material says of each.  Cells of one or eight points: modes that they do not see turn up from stretches of .55 to .5
// on (docs/elements.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/shell_shape.hpp"
#include "physics/cell_strain.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

constexpr double folded = 0.55;

bool sees_less(Shape s) { return s == Shape::hex8 || s == Shape::hex20r; }
double limit(const SolidBatch& b) {
  return kind_of(b.material).soft_below > 0 ? kind_of(b.material).soft_below : sees_less(b.shape) ? folded : 0;
}

}  // namespace

std::string Solids::fault(const Config& q) const {
  if (!some_) return "";
  std::vector<Vec3> from, to;
  LeastDet least;
  for (const SolidBatch& b : batches) {
    if (b.shape == Shape::bar2 || b.shape == Shape::tet4) continue;  // F is constant
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    from.resize(n), to.resize(n);
    for (size_t e = 0; e < b.cells.size(); ++e) {
      for (size_t a = 0; a < n; ++a) from[a] = points_.X[b.nodes[e * n + a]], to[a] = q.x[b.nodes[e * n + a]];
      least.take({least_det(b.shape, from, to), b.region});
    }
  }
  const double worst = -points_.comm->max(-least.det);
  if (worst > 0) return "";
  const int region = static_cast<int>(points_.comm->max(least.det == worst ? least.region : -1));
  return fmt::format("a cell of region \"{}\" is folded between its points (det F = {:.2g}): more cells, C3D20 or tet10 hold longer",
                     points_.mesh->mesh.region_name[region], worst);
}

/// Where det F stays above zero.  What moves by less than a tenth of its height, apart from all of it, is not looked at.
double Solids::longest_share(const Config& from, const Config& to) const {
  constexpr double little = 0.1, least = 1e-3;
  double most = 0;
  for (size_t i = 0; i < from.x.size(); ++i) most = std::max(most, (to.x[i] - from.x[i]).squaredNorm());
  if (2 * std::sqrt(most) < little * least_height_) return 1;
  double share = 1;
  std::vector<Vec3> X, x;
  for (const SolidBatch& b : batches) {
    if (b.shape == shell8) continue;  // may fold on its way
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    X.resize(n), x.resize(n);
    for (size_t e = 0; e < b.height.size(); ++e) {
      const int* nodes = b.nodes.data() + e * n;
      const auto way = [&](size_t a) -> Vec3 { return to.x[nodes[a]] - from.x[nodes[a]]; };
      const Vec3 whole = way(0);
      double far = 0;
      for (size_t a = 1; a < n; ++a) far = std::max(far, (way(a) - whole).squaredNorm());
      if (far < std::pow(little * b.height[e], 2)) continue;
      for (size_t a = 0; a < n; ++a) X[a] = points_.X[nodes[a]];
      const auto is_whole = [&](double at) {
        for (size_t a = 0; a < n; ++a) x[a] = from.x[nodes[a]] + at * way(a);
        return least_det(b.shape, X, x) > 0;
      };
      if (is_whole(share) || !is_whole(0)) continue;
      while (share > least && !is_whole(share)) share /= 2;
    }
  }
  return share;
}

void Solids::watch_strain(const Config& q) {
  const auto& names = points_.mesh->mesh.region_name;
  strain_told_.resize(names.size(), 0);
  std::vector<double> beyond(3 * names.size(), 0.0);  // by region: how far below the limit, of the law and of the cells; the law
  std::vector<Vec3> from, to;
  for (const SolidBatch& b : batches) {
    const double floor = limit(b);
    if (floor == 0 || strain_told_[b.region]) continue;
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    from.resize(n), to.resize(n);
    double& worst = beyond[3 * b.region + (kind_of(b.material).soft_below > 0 ? 0 : 1)];
    beyond[3 * b.region + 2] = static_cast<double>(law_index(b.material));
    for (size_t e = 0; e < b.cells.size(); ++e) {
      for (size_t a = 0; a < n; ++a) from[a] = points_.X[b.nodes[e * n + a]], to[a] = q.x[b.nodes[e * n + a]];
      worst = std::max(worst, floor - least_stretch(b.shape, from, to, floor));
    }
  }
  double any = 0;
  for (size_t r = 0; r < names.size(); ++r) any = std::max({any, beyond[3 * r], beyond[3 * r + 1]});
  if (!(points_.comm->max(any) > 0)) return;
  for (double& v : beyond) v = points_.comm->max(v);
  for (size_t r = 0; r < names.size(); ++r) {
    const double law = beyond[3 * r], cells = beyond[3 * r + 1];
    const MaterialKind& its = material_kinds()[static_cast<size_t>(beyond[3 * r + 2])];
    if (!(law > 0 || cells > 0)) continue;
    strain_told_[r] = 1;
    if (points_.comm->rank != 0) continue;
    if (law > 0)
      warn(names[r],
           fmt::format("compressed to {:.2g} of a length: below {:g} {}", its.soft_below - law, its.soft_below, its.soft_because));
    else
      warn(names[r],
           fmt::format("compressed to {:.2g} of a length: below 0.55 hex8 and hex20r may fold in modes that their points do not see "
                       "(C3D20 or tet10 do not)",
                       folded - cells));
  }
}

}  // namespace hilo
