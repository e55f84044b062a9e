// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/incomplete_cholesky.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/wide.hpp"

namespace hilo::petsc {

using Eigen::Matrix3d;

static void store(const Matrix3d& m, float* to) { Eigen::Map<Eigen::Matrix3f>{to} = m.cast<float>(); }
static Matrix3d fetch(const float* from) { return Eigen::Map<const Eigen::Matrix3f>(from).cast<double>(); }

void IncompleteCholesky::factor(const LowerPattern& pattern, int n, const Row& row) {
  pattern_ = &pattern;
  if (inverse_.size() != static_cast<size_t>(n)) L_.resize(pattern.start[n]), inverse_.resize(n), work_.resize(n);
  const auto& start = pattern.start;
  const auto& column = pattern.column;
  std::vector<Matrix3d> S, unscaled;  // of F; L_ij D_j
  for (int i = 0; i < n; ++i) {
    const size_t first = start[i], last = start[i + 1];
    S.resize(last - first), unscaled.resize(last - first);
    Matrix3d own;
    row(i, S.data(), own);
    Matrix3d D = own;
    for (size_t e = first; e < last; ++e) {
      const int k = column[e];
      Matrix3d& s = S[e - first];
      size_t a = first, b = start[k];
      while (a < e && b < start[k + 1]) {  // common columns
        if (column[a] < column[b])
          ++a;
        else if (column[b] < column[a])
          ++b;
        else
          s.noalias() -= unscaled[a++ - first] * fetch(L_[b++]).transpose();
      }
      unscaled[e - first] = s;
      const Matrix3d L = s * fetch(inverse_[k]);
      store(L, L_[e]);
      D.noalias() -= s * L.transpose();
    }
    const Eigen::LLT<Matrix3d> llt(D);
    const bool good = llt.info() == Eigen::Success && D.trace() > 1e-3 * own.trace();
    store(good ? Matrix3d(llt.solve(Matrix3d::Identity())) : Matrix3d(own.inverse()), inverse_[i]);
  }
}

/// Forwards and backwards; work: (n).
HILO_WIDE static void substitute(const LowerPattern& pattern, const FloatBlocks& L, const FloatBlocks& inverse, double scale,
                                 const double* b, std::vector<Lane>& work, double* x) {
  const auto& [row, place, start, column] = pattern;
  const size_t n = work.size();
  for (size_t i = 0; i < n; ++i) {
    __builtin_prefetch(b + 3 * row[std::min(i + 16, n - 1)]);
    const double* v = b + 3 * row[i];
    Lane y{static_cast<float>(scale * v[0]), static_cast<float>(scale * v[1]), static_cast<float>(scale * v[2]), 0};
    for (size_t e = start[i]; e < start[i + 1]; ++e) y -= times(L.load(e), work[column[e]]);
    work[i] = y;
  }
  for (size_t i = 0; i < n; ++i) work[i] = without_last(times(inverse.load(i), work[i]));
  for (size_t i = n; i-- > 0;) {
    const Lane y = work[i];
    for (size_t e = start[i + 1]; e-- > start[i];)  // downwards all through: memory is read ahead in one direction
      work[column[e]] -= transposed_times(L.load(e), y);
    __builtin_prefetch(x + 3 * row[i < 16 ? 0 : i - 16], 1);
    double* v = x + 3 * row[i];
    for (int c = 0; c < 3; ++c) v[c] = y[c] / scale;
  }
}

void IncompleteCholesky::solve(const double* b, double* x) {
  double largest = 0;  // within the range of single precision
  const size_t n = 3 * work_.size();
  for (size_t i = 0; i < n && !std::isnan(largest); ++i)
    if (!(std::abs(b[i]) <= largest)) largest = std::abs(b[i]);
  if (!(largest > 0)) {
    std::fill(x, x + n, largest);
    return;
  }
  substitute(*pattern_, L_, inverse_, 1 / largest, b, work_, x);
}

}  // namespace hilo::petsc
