// SPDX-License-Identifier: GPL-3.0-or-later
// Logarithmic strain h = ln(I + 2E)/2 of a Green-Lagrange strain E, with its derivatives, in the principal axes of E [miehe-apel-2002]:
//
//   h = sum_i phi(e_i) v_i v_i^T,   phi(e) = ln(1 + 2e)/2
//   Q[x] = dh/dE : x                =  V (phi[e_i, e_j] (V^T x V)_ij) V^T
//   L_T[x] = d(T : Q)/dE : x        =  V (sum_k phi[e_i, e_j, e_k] (x_ik T_kj + T_ik x_kj)) V^T       (all in principal axes)
//
// with divided differences phi[., .] and phi[., ., .], by series where arguments are close.  Q and L_T are their own adjoints.
#pragma once
#include "base/math.hpp"
#include "physics/material/voigt.hpp"

namespace hilo {

class LogStrain {
 public:
  /// `twice`: L will be asked for.
  explicit LogStrain(const Mat3& E, bool twice = false);
  const Mat3& value() const { return value_; }
  Mat3 Q(const Mat3& x) const;
  /// Prepare L_T of a symmetric T.
  struct Second {
    Mat3 T;  // in principal axes
  };
  Second second(const Mat3& T) const { return {V_.transpose() * T * V_}; }
  Mat3 L(const Second& T, const Mat3& x) const;
  /// exp(s h) for a factor s.
  Mat3 power(double s) const;

 private:
  friend class LogStep;
  Mat3 V_, first_, value_;
  double third_[3][3][3];
  Vec3 e_, phi_;
};

/// Exact difference quotient of W = lambda/2 (tr h)^2 + mu h:h over a step.  With E0 = sum b_j m_j m_j^T, E1 = sum a_i n_i n_i^T, any f:
///
///   tr f(E1) - tr f(E0) = G:(E1 - E0),   G = sym sum_ij f[a_i, b_j] (n_i.m_j) n_i m_j^T
///
/// because n_i.(E1 - E0) m_j = (a_i - b_j) n_i.m_j and sum_j (n_i.m_j)^2 = 1; here f = phi for tr h and phi^2 for h:h, whose differences
/// are (phi(a) + phi(b)) phi[a, b] and phi(a) phi[a, c, b] + phi[a, c] phi[c, b] + phi[a, c, b] phi(b).  The derivative of G by E1 along x
/// is sym sum_ikj f[a_i, a_k, b_j] (n_i.x n_k) (n_k.m_j) n_i m_j^T.
class LogStep {
 public:
  /// `twice`: the slope will be asked for.
  LogStep(const LogStrain& from, const LogStrain& to, const Lame& c, bool twice);
  /// S with S:(E1 - E0) = W1 - W0.
  const Mat3& stress() const { return stress_; }
  /// dS/dE1 : x
  Mat3 slope(const Mat3& x) const;

 private:
  Mat3 N_, M_, P_, trace_, by_trace_, stress_;  // trace_: G of tr h
  double twice_[3][3][3];
};

/// exp of a symmetric matrix.
Mat3 exponential(const Mat3& A);

}  // namespace hilo
