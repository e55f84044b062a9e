// SPDX-License-Identifier: GPL-3.0-or-later
// Stages of one step that are solved together and share its way: what quadratic measures, and functions of them, do along it.
//
// A measure e(q) of degree two changes over the step by  e(q1) - e(q0) = sum b_j h G(Q_j) V_j  exactly when the weights b and nodes c are
// those of Gauss, so that  E_i = e(q0) + sum a_ij h G(Q_j) V_j  is a second measure of the stage beside e(Q_i), and forces taken at it keep
// the energy [hairer-wanner-1996, collocation keeps quadratic invariants; docs/gauss.md].
#pragma once
#include "physics/force_law.hpp"
#include "physics/row_law.hpp"

namespace hilo {

struct Stage;

struct Collocation {
  static constexpr int n = 3;
  double a[n][n], b[n], c[n];              // the tableau
  double t = 0, h = 0;                     // start and length of the step [s]
  const Config* start = nullptr;           // q0
  const Config *before[n]{}, *after[n]{};  // Q_j - h V_j/2, Q_j + h V_j/2
};

/// The vector of the skew part of M.
inline Vec3 axial(const Mat3& M) { return Vec3(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1)) / 2; }
/// By how much a body turns in what `s` stands for in the work of its step.
Vec3 turned(const Stage& s, int body);

/// The measures of a connector over the step.
struct MeasurePath {
  using Values = std::array<double, max_measures>;
  MeasurePath(const Connector& c, const Collocation& step);
  /// way[j] alone.
  static Values way_of(const Connector& c, const Collocation& step, int j);
  Values e0, e1;               // at its ends
  Values way[Collocation::n];  // h G(Q_j) V_j
  Values at[Collocation::n];   // E_j
};

/// Adds to `d`, slopes of a function at stage i, what makes their sum along the ways that of its mean slopes over the step,
/// sum b_j mean.way_j, in proportion to weights (positive, of the measures); `slopes`: at the stages.
template <class Vector>
void complete(const Vector& mean, const std::array<Vector, Collocation::n>& slopes, const std::array<Vector, Collocation::n>& ways,
              const Vector& weights, const Collocation& step, int i, Vector& d) {
  double missing = 0, size = 0;
  for (int j = 0; j < Collocation::n; ++j) {
    missing += step.b[j] * (mean - slopes[j]).dot(ways[j]);
    size += step.b[j] * weights.dot(ways[j].cwiseAbs2());
  }
  if (size > 1e-280) d += missing / size * weights.cwiseProduct(ways[i]);  // else the measures rest
}

/// Forces of a potential W at stage i:  dW(E_i) + (W1 - W0 - sum b_j dW(E_j).way_j) C way_i / (sum b_j way_j.C way_j)  with a stiffness C
/// of the step, so that sum b_i s_i.way_i = W1 - W0; the bracket is of order h^7.  D is that of dW(E_i).
void elastic_along(const SpringLaw& law, const MeasurePath& path, const Collocation& step, int i, Response& out);
/// Gradients of rows at stage i, likewise: sum b_i d_r.way_i = g_r(e1) - g_r(e0).  D is half the derivative.
void gradient_along(const RowLaw& rows, const MeasurePath& path, const Collocation& step, int i, RowLaw::Gradient& out);

}  // namespace hilo
