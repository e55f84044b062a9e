// SPDX-License-Identifier: GPL-3.0-or-later
// One evaluation in flight, and what it gives.
#pragma once
#include "system/points.hpp"

namespace hilo {

/// Smallest det F of a cell, and the region it is in, or -1.
struct LeastDet {
  double det = 1e300;
  int region = -1;
  void take(const LeastDet& other) {
    if (!(other.det > det)) *this = other;  // keeps a NaN
  }
};

/// Residual with the scales that judge it.
struct Residual {
  std::vector<double> r;   // (3 x n_blocks): equations, then constraint rows
  double force_scale = 0;  // largest force summed into r [N]
  LeastDet least_det;
  double sigma = 1;  // scale of the constraint rows; multipliers are found divided by it
  bool finite = true;
};

/// What the contributions share during an evaluation.
struct Pass {
  const Stage& s;
  std::span<const double> lambda;  // (3 x joint blocks), indexed by block - first joint block
  Residual& out;
  KktSolver* K;             // null: residual only
  std::vector<Vec3>& node;  // residual of each node before reduction
  std::vector<Vec6>& body;  // residual of each body: force, moment about its left centre
  double sigma = 1;         // scale of constraint rows and multiplier columns
  bool loads = true;        // what acts from outside, too

  void scale(double force) {
    if (force > out.force_scale) out.force_scale = force;
  }
};

/// Forces before reduction, of which reactions are made: per node, and per body (force, moment about its left centre).
struct Forces {
  std::vector<Vec3> node;
  std::vector<Vec6> body;
};

}  // namespace hilo
