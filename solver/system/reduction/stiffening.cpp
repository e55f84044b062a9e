// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/stiffening.hpp"

#include <fmt/format.h>

#include <algorithm>

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

/// A matrix of the region on its modes, of degree two in amplitudes: K(eta) = K0 + sum T_i eta_i + sum Q_ij eta_i eta_j/2.
struct ByAmplitudes {
  Matrix K0;
  std::vector<Matrix> T, Q;  // m; m (m + 1)/2
};

/// T and Q_ii from the matrix at +-eta_i, Q_ij from that at eta_i and eta_j together.
ByAmplitudes by_amplitudes(RegionCells::Kind kind, const RegionCells& cells, const Matrix& modes, double length,
                           const std::function<void(const std::string&)>& tell) {
  const Index m = modes.cols();
  ByAmplitudes out{cells.projected(kind, modes, Vector::Zero(modes.rows())), std::vector<Matrix>(m), std::vector<Matrix>(m * (m + 1) / 2)};
  std::vector<Matrix> at(m);  // K(eta_i) - K0
  Vector h(m);
  for (Index i = 0; i < m; ++i) {
    h[i] = wide(modes, i, length);
    const Vector u = h[i] * modes.col(i);
    at[i] = cells.projected(kind, modes, u) - out.K0;
    const Matrix back = cells.projected(kind, modes, -u) - out.K0;
    out.T[i] = (at[i] - back) / (2 * h[i]), out.Q[QuadraticStrain::pair(i, i)] = (at[i] + back) / (h[i] * h[i]);
  }
  for (Index j = 0; j < m; ++j) {
    tell(fmt::format("strains of the second degree, mode {} of {}", j + 1, m));
    for (Index i = 0; i < j; ++i)
      out.Q[QuadraticStrain::pair(i, j)] =
          (cells.projected(kind, modes, h[i] * modes.col(i) + h[j] * modes.col(j)) - out.K0 - at[i] - at[j]) / (h[i] * h[j]);
  }
  return out;
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

QuadraticStrain quadratic_strain(const RegionCells& cells, const Matrix& modes, const Vector& omega2, double length,
                                 const std::function<void(const std::string&)>& tell) {
  const ByAmplitudes K = by_amplitudes(RegionCells::stiffness, cells, modes, length, tell);
  return {omega2, K.T, K.Q};
}

/// With strains E = E_k eta_k + E_ij eta_i eta_j, E_ij = E_ji, their slopes are B_k = E_k + 2 E_ik eta_i, and with (a|b) = int a beta C b
/// dV
///   T_i(k, d) = 2 (E_ik|E_d) + 2 (E_k|E_id),     Q_ij(k, d) = 4 (E_ik|E_jd) + 4 (E_jk|E_id),
/// from which each product by itself: the energy has their symmetric sums alone, and a rate of strain is no product of amplitudes.
Matrix viscous_strain(const RegionCells& cells, const Matrix& modes, double length, const std::function<void(const std::string&)>& tell) {
  const ByAmplitudes K = by_amplitudes(RegionCells::damping_by_stiffness, cells, modes, length, tell);
  const Index m = modes.cols();
  const auto at = [m](Index i, Index j) { return m + QuadraticStrain::pair(i, j); };
  const auto Q = [&](Index i, Index j) -> const Matrix& { return K.Q[QuadraticStrain::pair(std::min(i, j), std::max(i, j))]; };
  const auto terms = [](Index i, Index j) { return i == j ? 1.0 : 2.0; };
  Matrix KK(at(m - 1, m - 1) + 1, at(m - 1, m - 1) + 1);
  KK.topLeftCorner(m, m) = (K.K0 + K.K0.transpose()) / 2;
  for (Index k = 0; k < m; ++k)
    for (Index i = 0; i <= k; ++i) {
      for (Index d = 0; d < m; ++d) KK(at(i, k), d) = KK(d, at(i, k)) = terms(i, k) * (K.T[i](k, d) + K.T[k](i, d) - K.T[d](i, k)) / 4;
      for (Index d = 0; d < m; ++d)
        for (Index j = 0; j <= d; ++j)
          KK(at(i, k), at(j, d)) = terms(i, k) * terms(j, d) * (Q(i, j)(k, d) + Q(j, k)(i, d) - Q(i, k)(j, d)) / 8;
    }
  return (KK + KK.transpose()) / 2;
}

}  // namespace hilo
