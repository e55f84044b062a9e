// Logarithmic strain h = ln(I + 2E)/2 of a Green-Lagrange strain E, with its derivatives, in the principal axes of E [miehe-apel-2002]:
//
//   h = sum_i phi(e_i) v_i v_i^T,   phi(e) = ln(1 + 2e)/2
//   Q[x] = dh/dE : x                =  V (phi[e_i, e_j] (V^T x V)_ij) V^T
//   L_T[x] = d(T : Q)/dE : x        =  V (sum_k phi[e_i, e_j, e_k] (x_ik T_kj + T_ik x_kj)) V^T       (all in principal axes)
//
// with divided differences phi[., .] and phi[., ., .], by series where arguments are close.  Q and L_T are their own adjoints.
#pragma once
#include "base/math.hpp"

namespace hilo {

class LogStrain {
 public:
  explicit LogStrain(const Mat3& E);
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
  Mat3 V_, first_, value_;
  double third_[3][3][3];
  Vec3 e_;
};

/// exp of a symmetric matrix.
Mat3 exponential(const Mat3& A);

}  // namespace hilo
