// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/quadratic_strain.hpp"

#include <cmath>

namespace hilo {
namespace {

using Eigen::Index;

}  // namespace

/// W3 = sum T_kij eta_k eta_i eta_j/6 and W4 = sum Q_ijkl eta_i eta_j eta_k eta_l/24: every pair i < j stands for two terms.
QuadraticStrain::QuadraticStrain(const Vector& stiffness, const std::vector<Matrix>& T, const std::vector<Matrix>& Q)
    : m_(stiffness.size()) {
  const Index n = m_ * (m_ + 1) / 2;
  KK_.setZero(m_ + n, m_ + n);
  KK_.diagonal().head(m_) = stiffness;
  const auto terms = [](Index i, Index j) { return i == j ? 1.0 : 2.0; };
  for (Index j = 0; j < m_; ++j)
    for (Index i = 0; i <= j; ++i) {
      const Index row = m_ + pair(i, j);
      for (Index k = 0; k < m_; ++k) KK_(row, k) = KK_(k, row) = terms(i, j) * T[static_cast<size_t>(k)](i, j) / 6;
      for (Index l = 0; l < m_; ++l)
        for (Index k = 0; k <= l; ++k)
          KK_(row, m_ + pair(k, l)) = terms(i, j) * terms(k, l) * Q[static_cast<size_t>(pair(i, j))](k, l) / 12;
    }
  KK_ = ((KK_ + KK_.transpose()) / 2).eval();
}

QuadraticStrain::QuadraticStrain(Matrix KK) : KK_(std::move(KK)) {
  m_ = std::lround((std::sqrt(9 + 8 * static_cast<double>(KK_.rows())) - 3) / 2);
}

Eigen::VectorXd QuadraticStrain::measures(const Vector& eta) const {
  Vector e(KK_.rows());
  e.head(m_) = eta;
  for (Index j = 0; j < m_; ++j) e.segment(m_ + pair(0, j), j + 1) = eta[j] * eta.head(j + 1);
  return e;
}

double QuadraticStrain::energy(const Vector& eta) const {
  const Vector e = measures(eta);
  return e.dot(KK_ * e) / 2;
}

Eigen::VectorXd QuadraticStrain::force(const Vector& eta0, const Vector& eta1, double w, Matrix* slope) const {
  const Vector at = (1 - w) * eta0 + w * eta1, s = KK_ * ((1 - w) * measures(eta0) + w * measures(eta1));
  // B^T of columns: of the product of i and j eta_i goes to j and eta_j to i
  const auto pulled = [&](const Vector& of, const auto& t) {
    Vector f = t.head(m_);
    for (Index j = 0; j < m_; ++j) {
      const auto products = t.segment(m_ + pair(0, j), j + 1);
      f[j] += of.head(j + 1).dot(products);
      f.head(j + 1) += of[j] * products;
    }
    return f;
  };
  if (slope) {
    Matrix KB = KK_.leftCols(m_);  // KK B(eta1)
    for (Index j = 0; j < m_; ++j)
      for (Index i = 0; i <= j; ++i) {
        const auto column = KK_.col(m_ + pair(i, j));
        KB.col(j) += eta1[i] * column, KB.col(i) += eta1[j] * column;
      }
    for (Index k = 0; k < m_; ++k) slope->col(k) = w * pulled(at, KB.col(k));
    for (Index j = 0; j < m_; ++j)
      for (Index i = 0; i <= j; ++i) {
        const double stress = w * s[m_ + pair(i, j)];
        (*slope)(i, j) += stress, (*slope)(j, i) += stress;
      }
  }
  return pulled(at, s);
}

}  // namespace hilo
