// SPDX-License-Identifier: GPL-3.0-or-later
// Poles and shapes of (s^2 M + s C + K) x = 0 on the span of modes without damping and spin, which grows until the equations hold on all
// unknowns: by static answers to what is left of them, so that motions without mass join too.  All is measured by K + shift M, which is the
// unit on the span.
#pragma once
#include <complex>
#include <functional>

#include "dynamics/modes/linearized.hpp"
#include "dynamics/modes/natural_modes.hpp"

namespace hilo {

/// Of each pair of poles the one above the axis, and the real ones.
struct Poles {
  Eigen::MatrixXd M, C;                     // on the span
  std::vector<std::complex<double>> value;  // [1/s]
  Eigen::MatrixXcd shape, left;             // unit columns; of the transposed problem
  std::vector<double> error;                // what is left of the equations, over the largest of their forces, where it was asked for
  bool swings(size_t i) const { return value[i].imag() > 0; }
};

/// Of matrices, K + shift M of the size of one.  Poles as good as infinite are left out.
Poles poles_of(Eigen::MatrixXd M, Eigen::MatrixXd C, const Eigen::MatrixXd& K, double shift);

class QuadraticSpan {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  /// C x, and what K x has beside that of the pose; empty where it has nothing.
  using Forces = std::function<std::pair<Vector, Vector>(const Vector& x)>;
  /// `at` has the factors of K + shift M; modes that nothing resists have no stiffness at all.
  QuadraticSpan(const Linearized& at, double shift, const std::vector<FoundMode>& modes, Forces forces);

  /// Poles of a span on which those that `wanted` chooses hold, as far as rounding allows.
  Poles settle(const std::function<std::vector<size_t>(const Poles&)>& wanted);
  /// Those on the first `n` modes alone.
  Poles of_modes(Eigen::Index n) const;

  const Matrix& basis() const { return V_; }         // (n x columns), those of the modes first
  const Matrix& multipliers() const { return mu_; }  // (n_mu x columns)
  Matrix mass() const;
  Matrix damping() const;

 private:
  Matrix stiffness() const;
  void extend(Vector w, Vector Sw, Vector mu);

  const Linearized& at_;
  double shift_;
  Forces forces_;
  Eigen::Index m_;                     // modes
  Matrix V_, mu_, SV_, MV_, CV_, DV_;  // S = K + shift M of the pose, D what forces add to K
  Vector of_modes_, sign_;             // masses of the modes; of V^T S V
};

}  // namespace hilo
