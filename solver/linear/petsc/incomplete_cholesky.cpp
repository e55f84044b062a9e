#include "linear/petsc/incomplete_cholesky.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "linear/petsc/session.hpp"

namespace hilo::petsc {

using Eigen::Matrix3d;

/// Breadth first from a peripheral row, turned round [cuthill-mckee-1969]: factors without fill are better for it, and neighbours are near.
void IncompleteCholesky::find_order(const PetscInt* ia, const PetscInt* ja, PetscInt n) {
  row_.clear();
  place_.assign(n, -1);
  for (PetscInt seed = 0; seed < n; ++seed) {
    if (place_[seed] >= 0) continue;
    PetscInt from = seed;
    for (int sweep = 0; sweep < 2; ++sweep) {  // the last row reached is far away: start there
      const size_t first = row_.size();
      row_.push_back(from), place_[from] = 0;
      for (size_t k = first; k < row_.size(); ++k)
        for (PetscInt e = ia[row_[k]]; e < ia[row_[k] + 1]; ++e)
          if (place_[ja[e]] < 0) place_[ja[e]] = 0, row_.push_back(ja[e]);
      if (sweep == 1) break;
      from = row_.back();
      for (size_t k = first; k < row_.size(); ++k) place_[row_[k]] = -1;
      row_.resize(first);
    }
  }
  std::reverse(row_.begin(), row_.end());
  for (PetscInt k = 0; k < n; ++k) place_[row_[k]] = static_cast<int>(k);
}

void IncompleteCholesky::factor(Mat F) {
  PetscInt n = 0;
  const PetscInt *ia = nullptr, *ja = nullptr;
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(F, 0, PETSC_FALSE, PETSC_TRUE, &n, &ia, &ja, &done));
  double* values = nullptr;
  check(MatSeqBAIJGetArray(F, &values));
  if (static_cast<PetscInt>(row_.size()) != n) {
    find_order(ia, ja, n);
    start_.assign(1, 0), column_.clear();
    for (PetscInt i = 0; i < n; ++i) {
      for (PetscInt e = ia[row_[i]]; e < ia[row_[i] + 1]; ++e)
        if (place_[ja[e]] < i) column_.push_back(place_[ja[e]]);
      std::sort(column_.begin() + static_cast<std::ptrdiff_t>(start_.back()), column_.end());
      start_.push_back(column_.size());
    }
    L_.resize(column_.size()), inverse_.resize(n), work_.resize(n);
  }
  const auto block = [&](PetscInt row, PetscInt column) -> Matrix3d {  // of the matrix; zero outside its pattern
    const PetscInt* at = std::lower_bound(ja + ia[row], ja + ia[row + 1], column);
    if (at == ja + ia[row + 1] || *at != column) return Matrix3d::Zero();
    return Eigen::Map<const Matrix3d>(values + 9 * (at - ja));
  };
  const auto store = [](const Matrix3d& m) {
    Block b;
    for (int c = 0; c < 3; ++c) b.c[c] = Lane{static_cast<float>(m(0, c)), static_cast<float>(m(1, c)), static_cast<float>(m(2, c)), 0};
    return b;
  };
  const auto fetch = [](const Block& b) {
    Matrix3d m;
    for (int c = 0; c < 3; ++c) m.col(c) << b.c[c][0], b.c[c][1], b.c[c][2];
    return m;
  };
  std::vector<Matrix3d> scaled;  // L_ij D_j of the row at hand
  for (PetscInt i = 0; i < n; ++i) {
    const size_t first = start_[i], last = start_[i + 1];
    const Matrix3d own = block(row_[i], row_[i]);
    Matrix3d D = (own + own.transpose()) / 2;
    scaled.resize(last - first);
    for (size_t e = first; e < last; ++e) {
      const int k = column_[e];
      Matrix3d S = (block(row_[i], row_[k]) + block(row_[k], row_[i]).transpose()) / 2;
      size_t a = first, b = start_[k];
      while (a < e && b < start_[k + 1]) {  // common columns
        if (column_[a] < column_[b])
          ++a;
        else if (column_[b] < column_[a])
          ++b;
        else
          S.noalias() -= scaled[a++ - first] * fetch(L_[b++]).transpose();
      }
      scaled[e - first] = S;
      const Matrix3d L = S * fetch(inverse_[k]);
      L_[e] = store(L);
      D.noalias() -= S * L.transpose();
    }
    const Eigen::LLT<Matrix3d> llt(D);
    const bool good = llt.info() == Eigen::Success && D.trace() > 1e-3 * own.trace();
    inverse_[i] = store(good ? Matrix3d(llt.solve(Matrix3d::Identity())) : Matrix3d(((own + own.transpose()) / 2).inverse()));
  }
  check(MatSeqBAIJRestoreArray(F, &values));
  check(MatRestoreRowIJ(F, 0, PETSC_FALSE, PETSC_TRUE, &n, &ia, &ja, &done));
}

/// (sum of p, sum of q, sum of r, 0)
static IncompleteCholesky::Lane sums(IncompleteCholesky::Lane p, IncompleteCholesky::Lane q, IncompleteCholesky::Lane r) {
  using Lane = IncompleteCholesky::Lane;
  constexpr Lane zero{};
  const Lane pq = __builtin_shufflevector(p, q, 0, 4, 1, 5) + __builtin_shufflevector(p, q, 2, 6, 3, 7);
  const Lane rz = __builtin_shufflevector(r, zero, 0, 4, 1, 5) + __builtin_shufflevector(r, zero, 2, 6, 3, 7);
  return __builtin_shufflevector(pq, rz, 0, 1, 4, 5) + __builtin_shufflevector(pq, rz, 2, 3, 6, 7);
}

void IncompleteCholesky::solve(const double* b, double* x) {
  const size_t n = row_.size();
  double largest = 0;  // within the range of single precision
  for (size_t i = 0; i < 3 * n; ++i) largest = std::max(largest, std::abs(b[i]));
  if (!(largest > 0)) {
    std::fill(x, x + 3 * n, largest);
    return;
  }
  const double scale = 1 / largest;
  const auto times = [](const Block& m, const Lane& v) { return m.c[0] * v[0] + m.c[1] * v[1] + m.c[2] * v[2]; };
  for (size_t i = 0; i < n; ++i) {
    const double* v = b + 3 * row_[i];
    Lane y{static_cast<float>(scale * v[0]), static_cast<float>(scale * v[1]), static_cast<float>(scale * v[2]), 0};
    for (size_t e = start_[i]; e < start_[i + 1]; ++e) y -= times(L_[e], work_[column_[e]]);
    work_[i] = y;
  }
  for (size_t i = 0; i < n; ++i) work_[i] = times(inverse_[i], work_[i]);
  for (size_t i = n; i-- > 0;) {
    const Lane y = work_[i];
    for (size_t e = start_[i]; e < start_[i + 1]; ++e) {
      work_[column_[e]] -= sums(L_[e].c[0] * y, L_[e].c[1] * y, L_[e].c[2] * y);
    }
    double* v = x + 3 * row_[i];
    for (int c = 0; c < 3; ++c) v[c] = largest * y[c];
  }
}

}  // namespace hilo::petsc
