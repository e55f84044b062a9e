// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/stiffening.hpp"

#include <fmt/format.h>

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double least_share = 1e-4;  // of the energy of the largest derivative, below which one is left out

/// Amplitude at which a mode moves its nodes by a share of the region: the stiffness is a polynomial of the second degree in amplitudes, so
/// differences of any width are exact but for round-off, which is least where the degrees are of one size.
double wide(const Matrix& modes, Index j, double length) {
  double most = 0;
  for (Index i = 0; i < modes.rows(); i += 3) most = std::max(most, modes.block<3, 1>(i, j).norm());
  return 0.3 * length / most;
}

}  // namespace

Matrix modal_derivatives(const RegionCells& cells, const Matrix& modes, const Vector& omega2, double length,
                         const std::function<Matrix(const Matrix&)>& solve) {
  const Index n = modes.cols();
  Matrix all(modes.rows(), n * (n + 1) / 2);
  for (Index j = 0; j < n; ++j) {
    const double h = wide(modes, j, length);
    const Vector u = h * modes.col(j), back = -u;
    const Matrix slope = (cells.times(RegionCells::stiffness, modes.leftCols(j + 1), &u) -
                          cells.times(RegionCells::stiffness, modes.leftCols(j + 1), &back)) /
                         (2 * h);
    const Matrix answers = solve(slope);
    for (Index i = 0; i <= j; ++i) all.col(QuadraticStrain::pair(i, j)) = -answers.col(i) / std::sqrt(omega2[i] * omega2[j]);
  }
  const Matrix G = all.transpose() * cells.times(RegionCells::stiffness, all);
  const Eigen::SelfAdjointEigenSolver<Matrix> energy((G + G.transpose()) / 2);
  Index kept = 0;
  while (kept < G.cols() && energy.eigenvalues()[G.cols() - 1 - kept] > least_share * energy.eigenvalues()[G.cols() - 1]) ++kept;
  return all * energy.eigenvectors().rightCols(kept);
}

/// With K(eta) = K0 + sum T_i eta_i + sum Q_ij eta_i eta_j/2: T and Q_ii from the stiffness at +-eta_i, Q_ij from that at eta_i and eta_j
/// together.
QuadraticStrain quadratic_strain(const RegionCells& cells, const Matrix& modes, const Vector& omega2, double length,
                                 const std::function<void(const std::string&)>& tell) {
  const Index m = modes.cols();
  const Matrix K0 = cells.projected_stiffness(modes, Vector::Zero(modes.rows()));
  std::vector<Matrix> T(m), Q(m * (m + 1) / 2), at(m);  // at: K(eta_i) - K0
  Vector h(m);
  for (Index i = 0; i < m; ++i) {
    h[i] = wide(modes, i, length);
    const Vector u = h[i] * modes.col(i);
    at[i] = cells.projected_stiffness(modes, u) - K0;
    const Matrix back = cells.projected_stiffness(modes, -u) - K0;
    T[i] = (at[i] - back) / (2 * h[i]), Q[QuadraticStrain::pair(i, i)] = (at[i] + back) / (h[i] * h[i]);
  }
  for (Index j = 0; j < m; ++j) {
    tell(fmt::format("strains of the second degree, mode {} of {}", j + 1, m));
    for (Index i = 0; i < j; ++i)
      Q[QuadraticStrain::pair(i, j)] =
          (cells.projected_stiffness(modes, h[i] * modes.col(i) + h[j] * modes.col(j)) - K0 - at[i] - at[j]) / (h[i] * h[j]);
  }
  return {omega2, T, Q};
}

}  // namespace hilo
