// SPDX-License-Identifier: GPL-3.0-or-later
// Stress that a nearly incompressible cell has from its mean dilatation (physics/mean_dilatation.hpp).
#pragma once
#include <span>

#include "base/math.hpp"
#include "physics/mean_dilatation.hpp"

namespace hilo {

/// What the mean dilatation of a cell adds.
template <class Bulk>
struct CellMean {
  double lambda = 0, dilatation = 0;  // lambda_m [Pa]; mean of tr E, or of det C
  static constexpr bool of_trace = std::is_same_v<Bulk, SquareOfTrace>;

  /// S = lambda theta I, or S = 2 lambda U'(D) cof C
  void add(const double e[6], Vec6& s) const {
    if (lambda == 0) return;
    if constexpr (of_trace) {
      for (int i = 0; i < 3; ++i) s[i] += lambda * dilatation;
    } else if constexpr (!std::is_same_v<Bulk, NoBulk>) {
      double M[6], A[6], cof1[6], D0, D1, by_D, slope;
      volume::over_step(e, e, M, A, cof1, D0, D1);
      Bulk::quotient(dilatation, dilatation, by_D, slope);
      for (int i = 0; i < 6; ++i) s[i] += 2 * lambda * by_D * A[i];
    }
  }
};

template <class S, class Bulk>
inline CellMean<Bulk> mean_of(const Lame& c, std::span<const Vec3> X, std::span<const Vec3> x) {
  CellMean<Bulk> mean{mean_lambda<S, Bulk>(c), 0};
  if (mean.lambda == 0) return mean;
  double volume = 0;
  for (int p = 0; p < S::n_points; ++p) {
    double g[S::n][3], F[3][3], e[6];
    const double w = solid::point_gradients<S>(p, X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F);
    solid::green_lagrange(F, e);
    const double J = solid::determinant(F);
    volume += w, mean.dilatation += w * (mean.of_trace ? e[0] + e[1] + e[2] : J * J);
  }
  mean.dilatation /= volume;
  return mean;
}

}  // namespace hilo
