// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/scaled_jacobian.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace hilo {
namespace {

/// A corner and its three neighbours, right-handed.
using Corner = std::array<int, 4>;
constexpr std::array<Corner, 4> tet{{{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
constexpr std::array<Corner, 6> wedge{{{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
constexpr std::array<Corner, 8> hex{
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

template <size_t n>
double least(const Mesh& m, std::span<const std::int64_t> nodes, const std::array<Corner, n>& corners, double regular) {
  double worst = std::numeric_limits<double>::infinity();
  for (const auto& [o, a, b, c] : corners) {
    const Vec3 x = m.X[nodes[a]] - m.X[nodes[o]], y = m.X[nodes[b]] - m.X[nodes[o]], z = m.X[nodes[c]] - m.X[nodes[o]];
    worst = std::min(worst, x.cross(y).dot(z) / (x.norm() * y.norm() * z.norm()));
  }
  return worst / regular;
}

}  // namespace

double scaled_jacobian(const Mesh& m, std::int64_t c) {
  if (info(m.shape[c]).dimension < 3) return 1;
  switch (info(m.shape[c]).n_corners) {
    case 4:
      return least(m, m.cell(c), tet, std::sqrt(0.5));
    case 6:
      return least(m, m.cell(c), wedge, std::sqrt(0.75));
    case 8:
      return least(m, m.cell(c), hex, 1);
    default:
      return quality(m, c).scaled_jacobian;
  }
}

}  // namespace hilo
