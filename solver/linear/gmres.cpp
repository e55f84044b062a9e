// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/gmres.hpp"

#include <Eigen/Core>
#include <Eigen/Jacobi>
#include <cmath>

namespace hilo {

Gmres::Report Gmres::solve(const Map& multiply, const Map& precondition, std::span<const double> weight, std::span<const double> b,
                           std::span<double> x, double tolerance, int most_iterations) {
  using Vector = Eigen::Map<Eigen::VectorXd>;
  const auto n = static_cast<Eigen::Index>(b.size());
  const Eigen::Map<const Eigen::VectorXd> W(weight.data(), n);
  const auto kept = [&](std::vector<std::vector<double>>& vectors, int k) {
    if (k == static_cast<int>(vectors.size())) vectors.emplace_back();
    vectors[k].resize(b.size());
    return Vector(vectors[k].data(), n);
  };
  const auto v = [&](int k) { return kept(basis_, k); };
  w_.resize(b.size());
  Vector w(w_.data(), n), solution(x.data(), n);
  solution.setZero();
  Vector v0 = v(0);
  v0 = W.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
  const double norm = v0.norm();
  Report report;
  if (!(norm > 0)) return report.residual = norm, report;
  v0 /= norm;
  Eigen::MatrixXd R(most_iterations + 1, most_iterations);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(most_iterations + 1);
  std::vector<Eigen::JacobiRotation<double>> turns;
  g[0] = norm;
  int k = 0;
  while (k < most_iterations && report.residual > tolerance && std::isfinite(report.residual)) {
    kept(directions_, k);
    w = v(k).cwiseQuotient(W);
    precondition(w_.data(), directions_[k].data());
    multiply(directions_[k].data(), w_.data());
    w.array() *= W.array();
    for (int i = 0; i <= k; ++i) {  // modified Gram-Schmidt
      const Vector vi(basis_[i].data(), n);
      R(i, k) = vi.dot(w);
      w -= R(i, k) * vi;
    }
    const double length = w.norm();
    R(k + 1, k) = length;
    for (int i = 0; i < k; ++i) R.col(k).applyOnTheLeft(i, i + 1, turns[i].adjoint());
    turns.emplace_back();
    turns[k].makeGivens(R(k, k), R(k + 1, k));
    R.col(k).applyOnTheLeft(k, k + 1, turns[k].adjoint());
    g.applyOnTheLeft(k, k + 1, turns[k].adjoint());
    report.residual = std::abs(g[k + 1]) / norm;
    ++k;
    if (!(length > 0)) break;  // the solution lies in the space so far
    v(k) = w / length;
  }
  report.iterations = k;
  if (k == 0) return report;
  const Eigen::VectorXd y = R.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
  for (int i = 0; i < k; ++i) solution += y[i] * Vector(directions_[i].data(), n);
  return report;
}

}  // namespace hilo
