// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/schur_factor.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace hilo::petsc {

bool SchurFactor::factor(const Coupling& coupling, const std::vector<int>& touched, const Eigen::MatrixXd& given) {
  std::vector<Eigen::Triplet<double>> entries;
  coupling.for_each_D([&](int i, int j, const double* D) {
    for (int c = 0; c < 9; ++c)
      if (D[c] != 0) entries.emplace_back(3 * i + c / 3, 3 * j + c % 3, D[c]);
  });
  for (size_t i = 0; i < touched.size(); ++i)
    for (size_t j = 0; j < touched.size(); ++j)
      entries.emplace_back(touched[i], touched[j], given(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  n_ = coupling.m();
  Eigen::SparseMatrix<double> S(n_, n_);
  S.setFromTriplets(entries.begin(), entries.end());
  forget();
  start_.assign(S.outerIndexPtr(), S.outerIndexPtr() + n_ + 1);
  row_.assign(S.innerIndexPtr(), S.innerIndexPtr() + S.nonZeros());
  value_.assign(S.valuePtr(), S.valuePtr() + S.nonZeros());
  row_scale_.assign(n_, 0.0), column_scale_.assign(n_, 0.0);
  const auto each = [&](auto&& visit) {
    for (int j = 0; j < n_; ++j)
      for (int k = start_[j]; k < start_[j + 1]; ++k) visit(row_[k], j, value_[k]);
  };
  const auto invert = [](std::vector<double>& scale) {
    for (double& s : scale) s = 1 / s;
    return std::all_of(scale.begin(), scale.end(), [](double s) { return std::isfinite(s) && s > 0; });
  };
  each([&](int i, int, double v) { row_scale_[i] = std::max(row_scale_[i], std::abs(v)); });
  if (!invert(row_scale_)) return false;
  each([&](int i, int j, double v) { column_scale_[j] = std::max(column_scale_[j], row_scale_[i] * std::abs(v)); });
  if (!invert(column_scale_)) return false;
  each([&](int i, int j, double& v) { v *= row_scale_[i] * column_scale_[j]; });
  symbolic_ = klu_analyze(n_, start_.data(), row_.data(), &common_);
  numeric_ = symbolic_ ? klu_factor(start_.data(), row_.data(), value_.data(), symbolic_, &common_) : nullptr;
  return numeric_ && common_.status == KLU_OK && klu_rcond(symbolic_, numeric_, &common_) && common_.rcond > 1e-14;
}

void SchurFactor::solve(double* x) {
  for (int i = 0; i < n_; ++i) x[i] *= row_scale_[i];
  klu_solve(symbolic_, numeric_, n_, 1, x, &common_);
  for (int i = 0; i < n_; ++i) x[i] *= column_scale_[i];
}

}  // namespace hilo::petsc
