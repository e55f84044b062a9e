// SPDX-License-Identifier: GPL-3.0-or-later
// Mortar rows between two surfaces whose meshes do not match [puso-2004, wohlmuth-2000]:
//   sum_s n_is x_s - sum_m m_im x_m = 0,   n_is = int psi_i N_s dA,   m_im = int psi_i N_m dA   over what both surfaces cover.
// Shape functions sum to one on both sides and are taken at the same points, so that sum_s n_is = sum_m m_im whatever the quadrature.
// On facets of three and four nodes psi is dual to N over the covered part, n_is = delta_is int N_s; on facets of six and eight, N itself.
#pragma once
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// n nodes (3, 4, 6 or 8), outward: corners, then those between them.
struct MortarFacet {
  int n = 0;
  std::array<int, 8> node{};
};

struct MortarRow {
  int node = -1;                             // of the slave side, whose weight is 1
  std::vector<std::pair<int, double>> term;  // node, weight; those of the slave side, then those of the other with their sign; sum 0
  int n_slave = 0;                           // so many of them are of the slave side
  double own = 1;                            // n_ii, by which weights were divided [m^2]
};

struct Mortar {
  std::vector<MortarRow> rows;
  int n_nodes = 0;        // of the slave side
  double covered = 0;     // share of the slave side's area
  Mat3 spread;            // mean of (x - centre) (x - centre)^T over what is covered [m^2]
  double facet = 0;       // largest tied slave facet, root of its area [m]
  double widest = 0;      // largest gap that is within the limit [m]
  double open = 0;        // largest gap beyond it, in front of a node without a row [m]
  int open_node = -1;     // this node
  double open_limit = 0;  // and what was allowed there [m]
  int twice_node = -1;    // of a facet that faces two layers of the other side
};

/// Rows of the slave facets against the others, at X.  Facets that face each other within `gap` [m] are tied; below 0: a twentieth of the
/// slave facet's size.
Mortar mortar(std::span<const Vec3> X, std::span<const MortarFacet> slave, std::span<const MortarFacet> master, double gap);

/// Moves nodes of the slave side by n^-1 times the gap, so that the rows vanish at X.
void close_gaps(std::span<const MortarRow> rows, std::span<Vec3> X);

/// How rows hold turns of the other side while the slave side moves with it: mean squared motion of the slave's nodes over that of the
/// covered patch, in the turn where it is least.  About 1 where the patch is glued, 0 at a hinge.
struct TurnHeld {
  double share;
  Vec3 axis;
};
TurnHeld least_held_turn(const Mortar& mortar, std::span<const Vec3> X);

}  // namespace hilo
