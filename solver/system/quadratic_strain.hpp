// SPDX-License-Identifier: GPL-3.0-or-later
// Strain energy of a linear region that stiffens: St. Venant-Kirchhoff on x = X + sum_j phi_j eta_j has Green-Lagrange strains of degree
// two in the amplitudes, and so an energy of degree four,
//
//   W = e^T KK e / 2,   e = (eta_i, eta_i eta_j (i <= j)),   KK constant
//
// As the strain of a solid is quadratic in positions, so is e in eta: with s = KK (e0 + e1)/2 the force B(eta_mid)^T s, B = de/d eta, is a
// discrete gradient, f.(eta1 - eta0) = W1 - W0.  With a share w of the end it is B(eta_w)^T KK ((1 - w) e0 + w e1).
#pragma once
#include <Eigen/Dense>

namespace hilo {

class QuadraticStrain {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  QuadraticStrain() = default;
  /// Third and fourth derivatives of W at rest: T[k](i, j) and Q[pair(i, j)](k, l) of m modes, beside stiffness (m).
  QuadraticStrain(const Vector& stiffness, const std::vector<Matrix>& T, const std::vector<Matrix>& Q);
  explicit QuadraticStrain(Matrix KK);

  bool used() const { return KK_.size() > 0; }
  const Matrix& matrix() const { return KK_; }
  /// Number of the product eta_i eta_j, i <= j.
  static Eigen::Index pair(Eigen::Index i, Eigen::Index j) { return j * (j + 1) / 2 + i; }

  double energy(const Vector& eta) const;
  /// Force over a step; `slope`, where it is wanted: its derivative by eta1 (m x m).
  Vector force(const Vector& eta0, const Vector& eta1, double w, Matrix* slope) const;

 private:
  Vector measures(const Vector& eta) const;
  Matrix KK_;  // (m + m (m + 1)/2)^2
  Eigen::Index m_ = 0;
};

}  // namespace hilo
