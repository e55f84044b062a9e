#include "linear/petsc/schur_factor.hpp"

#include <Eigen/SparseCore>
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
  for (const double v : value_)
    if (!std::isfinite(v)) return false;
  symbolic_ = klu_analyze(n_, start_.data(), row_.data(), &common_);
  numeric_ = symbolic_ ? klu_factor(start_.data(), row_.data(), value_.data(), symbolic_, &common_) : nullptr;
  return numeric_ && common_.status == KLU_OK && klu_rcond(symbolic_, numeric_, &common_) && common_.rcond > 1e-14;
}

}  // namespace hilo::petsc
