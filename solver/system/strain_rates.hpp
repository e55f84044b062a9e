// SPDX-License-Identifier: GPL-3.0-or-later
// Damping by stiffness of a linear region that stiffens: by the rate of the measures e of its quadratic strain
// (system/quadratic_strain.hpp), with KK of beta C in the place of C.  The work of B(eta_mid)^T KK (e1 - e0) through eta1 - eta0 is (e1 -
// e0).KK (e1 - e0), never negative.
#pragma once
#include "system/quadratic_strain.hpp"

namespace hilo {

/// Times h, of the rate between eta0 and eta1, h apart.  `slope`, where it is wanted: c0 times its derivative by eta0 and c1 times that by
/// eta1.
inline Eigen::VectorXd rate_force(const Eigen::MatrixXd& KK, const Eigen::VectorXd& eta0, const Eigen::VectorXd& eta1, double c0, double c1,
                                  Eigen::MatrixXd* slope) {
  using Eigen::Index;
  const Index m = eta0.size();
  const auto pair = [m](Index i, Index j) { return m + QuadraticStrain::pair(i, j); };
  const auto measures = [&](const Eigen::VectorXd& eta) {
    Eigen::VectorXd e(KK.rows());
    e.head(m) = eta;
    for (Index j = 0; j < m; ++j) e.segment(pair(0, j), j + 1) = eta[j] * eta.head(j + 1);
    return e;
  };
  const Eigen::VectorXd at = (eta0 + eta1) / 2, s = KK * (measures(eta1) - measures(eta0));
  const auto pulled = [&](const Eigen::VectorXd& of) {  // B(at)^T
    Eigen::VectorXd f = of.head(m);
    for (Index j = 0; j < m; ++j)
      f[j] += at.head(j + 1).dot(of.segment(pair(0, j), j + 1)), f.head(j + 1) += at[j] * of.segment(pair(0, j), j + 1);
    return f;
  };
  if (!slope) return pulled(s);
  const Eigen::VectorXd by = c1 * eta1 - c0 * eta0;
  Eigen::MatrixXd KB = (c1 - c0) * KK.leftCols(m);  // KK (c1 B(eta1) - c0 B(eta0))
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i <= j; ++i) KB.col(j) += by[i] * KK.col(pair(i, j)), KB.col(i) += by[j] * KK.col(pair(i, j));
  slope->resize(m, m);
  for (Index k = 0; k < m; ++k) slope->col(k) = pulled(KB.col(k));
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i <= j; ++i) {
      const double stress = (c0 + c1) / 2 * s[pair(i, j)];
      (*slope)(i, j) += stress, (*slope)(j, i) += stress;
    }
  return pulled(s);
}

}  // namespace hilo
