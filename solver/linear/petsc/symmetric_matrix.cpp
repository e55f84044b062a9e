// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/symmetric_matrix.hpp"

#include <algorithm>

#include "base/wide.hpp"
#include "linear/petsc/session.hpp"
#include "linear/petsc/solver.hpp"

namespace hilo::petsc {

using Eigen::Matrix3d;
using Double4 = double __attribute__((vector_size(32)));

SymmetricMatrix::SymmetricMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared) : shared_(shared) {
  const int n_local = static_cast<int>(map.global.size());
  n_owned_ = static_cast<PetscInt>(std::clamp<std::int64_t>(map.first_dense - map.first, 0, map.n_owned));
  std::vector<int> number(n_local, -1), local(n_owned_);  // flexible blocks: owned ones, then others
  for (int i = 0; i < n_local; ++i) {
    if (map.global[i] >= map.first_dense) continue;
    if (shared.is_owned(i))
      number[i] = static_cast<int>(map.global[i] - map.first), local[number[i]] = i;
    else
      number[i] = static_cast<int>(local.size()), local.push_back(i);
  }
  const int n = static_cast<int>(local.size());
  // cliques of each block, then its neighbours
  std::vector<int> at(n + 1, 0), list, start{0}, columns, seen(n, -1);
  const auto each = [&](int e, auto&& visit) {
    for (const int i : cliques[e])
      if (i >= 0 && number[i] >= 0) visit(number[i]);
  };
  for (int e = 0; e < cliques.size(); ++e) each(e, [&](int k) { ++at[k + 1]; });
  for (int k = 0; k < n; ++k) at[k + 1] += at[k];
  list.resize(at[n]);
  auto next = at;
  for (int e = 0; e < cliques.size(); ++e) each(e, [&](int k) { list[next[k]++] = e; });
  for (int k = 0; k < n; ++k) {
    seen[k] = k;
    for (int c = at[k]; c < at[k + 1]; ++c)
      each(list[c], [&](int j) {
        if (seen[j] != k) seen[j] = k, columns.push_back(j);
      });
    start.push_back(static_cast<int>(columns.size()));
  }
  pattern_ = order_lower(start, columns, n_owned_);
  place_.assign(n_local, -1), local_.resize(n), global_.resize(n);
  for (int k = 0; k < n; ++k) {
    const int p = pattern_.place[k];
    place_[local[k]] = p, local_[p] = local[k], global_[p] = static_cast<PetscInt>(map.global[local[k]]);
  }
  L_.resize(pattern_.column.size()), R_.assign(9 * static_cast<size_t>(n), 0.0);
  all_.assign(3 * static_cast<size_t>(n_local), 0.0), x_.assign(4 * static_cast<size_t>(n), 0.0), y_.resize(n);
  if (size() > 1) lend(map);
  check(MatCreateShell(PETSC_COMM_WORLD, 3 * n_owned_, 3 * n_owned_, PETSC_DETERMINE, PETSC_DETERMINE, this, &A_));
  check(MatShellSetOperation(A_, MATOP_MULT, reinterpret_cast<void (*)(void)>(+[](Mat A, Vec x, Vec y) -> PetscErrorCode {
                               void* self;
                               const PetscErrorCode code = MatShellGetContext(A, &self);
                               if (!code) static_cast<SymmetricMatrix*>(self)->multiply(x, y);
                               return code;
                             })));
}

SymmetricMatrix::~SymmetricMatrix() { MatDestroy(&A_); }

size_t SymmetricMatrix::find(int row, int column) const {
  const auto first = pattern_.column.begin() + static_cast<std::ptrdiff_t>(pattern_.start[row]),
             last = pattern_.column.begin() + static_cast<std::ptrdiff_t>(pattern_.start[row + 1]);
  const auto it = std::lower_bound(first, last, column);
  return it != last && *it == column ? static_cast<size_t>(it - pattern_.column.begin()) : pattern_.column.size();
}

/// Entries between two blocks of one other rank go there, for its factors, where its pattern has them.
void SymmetricMatrix::lend(const BlockMap& map) {
  std::vector<std::vector<PetscInt>> ask(size()), answer(size());
  lent_.resize(size()), borrowed_.resize(size());
  for (int i = n_owned_; i < pattern_.n(); ++i)
    for (size_t e = pattern_.start[i]; e < pattern_.start[i + 1]; ++e) {
      const int r = shared_.owner(global_[i]), j = pattern_.column[e];
      if (j < n_owned_ || shared_.owner(global_[j]) != r) continue;
      ask[r].push_back(global_[i]), ask[r].push_back(global_[j]);
      lent_[r].push_back(e);
    }
  const auto asked = comm().exchange(ask);
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < asked[r].size(); k += 2) {
      const int i = pattern_.place[asked[r][k] - map.first], j = pattern_.place[asked[r][k + 1] - map.first];
      const size_t at = find(std::max(i, j), std::min(i, j));
      answer[r].push_back(at < pattern_.column.size());
      if (answer[r].back()) borrowed_[r].push_back({at, i < j});
    }
  const auto answered = comm().exchange(answer);
  for (int r = 0; r < size(); ++r) {
    size_t kept = 0;
    for (size_t k = 0; k < lent_[r].size(); ++k)
      if (answered[r][k]) lent_[r][kept++] = lent_[r][k];
    lent_[r].resize(kept);
  }
}

void SymmetricMatrix::zero() {
  L_.zero();
  asymmetry_ = 0;
  std::fill(R_.begin(), R_.end(), 0.0);
}

void SymmetricMatrix::add(int, std::span<const int> blocks, const double* K) {
  const size_t n = blocks.size(), width = 3 * n;
  double sums = 0, differences = 0;
  for (size_t a = 0; a < n; ++a) {
    const int i = blocks[a] < 0 ? -1 : place_[blocks[a]];
    if (i < 0) continue;
    double* sum = &R_[9 * static_cast<size_t>(i)];
    for (size_t b = 0; b < n; ++b) {
      const int j = blocks[b] < 0 ? -1 : place_[blocks[b]];
      if (j < 0) continue;
      const double *k = K + 3 * a * width + 3 * b, *t = K + 3 * b * width + 3 * a;
      float* to = i > j ? L_[find(i, j)] : nullptr;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          const double value = 0.5 * (k[r * width + c] + t[c * width + r]), half = value - t[c * width + r];
          sums += value * value, differences += half * half;
          sum[3 * c + r] += value;
          if (to) to[3 * c + r] += static_cast<float>(value);
        }
    }
  }
  if (differences > asymmetry_ * sums) asymmetry_ = differences / sums;
}

void SymmetricMatrix::add_diagonal(int block, const double d[3]) {
  for (int c = 0; c < 3; ++c) R_[9 * static_cast<size_t>(place_[block]) + 4 * c] += d[c];
}

void SymmetricMatrix::assemble() {
  if (size() == 1) return;
  std::vector<std::vector<double>> send(size());
  for (int r = 0; r < size(); ++r)
    for (const size_t e : lent_[r]) {
      send[r].insert(send[r].end(), L_[e], L_[e] + 9);
      std::fill_n(L_[e], 9, 0.0f);
    }
  const auto got = comm().exchange(send);
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < borrowed_[r].size(); ++k) {
      const auto [at, transposed] = borrowed_[r][k];
      for (int c = 0; c < 9; ++c) L_[at][transposed ? 3 * (c % 3) + c / 3 : c] += static_cast<float>(got[r][9 * k + c]);
    }
}

std::vector<Matrix3d> SymmetricMatrix::own_diagonals() const {
  const int n = pattern_.n();
  std::vector<Matrix3d> D(n);
  for (int i = 0; i < n; ++i) D[i] = Eigen::Map<const Matrix3d>(&R_[9 * static_cast<size_t>(i)]);
  for (int i = 0; i < n; ++i)
    for (size_t e = pattern_.start[i]; e < pattern_.start[i + 1]; ++e) {
      const Matrix3d A = lower(e);
      D[i] -= A, D[pattern_.column[e]] -= A.transpose();
    }
  return D;
}

std::vector<Matrix3d> SymmetricMatrix::diagonals() const {
  auto D = own_diagonals();
  if (size() == 1) return D;
  std::vector<double> values(all_.size());
  for (int c = 0; c < 3; ++c) {
    std::fill(values.begin(), values.end(), 0.0);
    for (size_t i = 0; i < D.size(); ++i) std::copy_n(D[i].col(c).data(), 3, &values[3 * static_cast<size_t>(local_[i])]);
    shared_.sum(values);
    for (size_t i = 0; i < D.size(); ++i) std::copy_n(&values[3 * static_cast<size_t>(local_[i])], 3, D[i].col(c).data());
  }
  return D;
}

void SymmetricMatrix::for_each_block(const std::function<void(PetscInt, PetscInt, const Matrix3d&)>& visit) const {
  const auto D = own_diagonals();
  for (int i = 0; i < pattern_.n(); ++i) {
    visit(global_[i], global_[i], D[i]);
    for (size_t e = pattern_.start[i]; e < pattern_.start[i + 1]; ++e) {
      const Matrix3d A = lower(e);
      visit(global_[i], global_[pattern_.column[e]], A), visit(global_[pattern_.column[e]], global_[i], A.transpose());
    }
  }
}

/// y_i += sum_j A_ij (x_j - x_i), both halves at once; x: (n x 4), y: zero.
HILO_WIDE static void add_differences(const LowerPattern& pattern, const FloatBlocks& L, const double* x, Lane* y) {
  const auto load = [&](int i) {
    Double4 v;
    std::memcpy(&v, x + 4 * static_cast<size_t>(i), sizeof(v));
    return v;
  };
  for (int i = 0; i < pattern.n(); ++i) {
    const Double4 own = load(i);
    Lane sum{};
    for (size_t e = pattern.start[i]; e < pattern.start[i + 1]; ++e) {
      const int j = pattern.column[e];
      const Lane d = __builtin_convertvector(load(j) - own, Lane);
      const FloatBlock A = L.load(e);
      sum += times(A, d);
      y[j] -= transposed_times(A, d);
    }
    y[i] += sum;
  }
}

void SymmetricMatrix::multiply(Vec x, Vec y) {
  const int n = pattern_.n();
  const double* in;
  check(VecGetArrayRead(x, &in));
  for (PetscInt k = 0; k < n_owned_; ++k) std::copy_n(in + 3 * k, 3, &all_[3 * static_cast<size_t>(shared_.owned(k))]);
  check(VecRestoreArrayRead(x, &in));
  shared_.copy_out(all_);
  double largest = 0;  // within the range of single precision
  for (const double v : all_) largest = std::max(largest, std::abs(v));
  const double scale = largest > 0 ? 1 / largest : 0;
  const auto at = [&](int i) { return &all_[3 * static_cast<size_t>(local_[i])]; };
  for (int i = 0; i < n; ++i) {
    __builtin_prefetch(at(std::min(i + 16, n - 1)));
    for (int c = 0; c < 3; ++c) x_[4 * static_cast<size_t>(i) + c] = scale * at(i)[c];
  }
  std::fill(y_.begin(), y_.end(), Lane{});
  add_differences(pattern_, L_, x_.data(), y_.data());
  for (int i = 0; i < n; ++i) {
    __builtin_prefetch(at(std::min(i + 16, n - 1)), 1);
    const double *R = &R_[9 * static_cast<size_t>(i)], *v = &x_[4 * static_cast<size_t>(i)];
    for (int r = 0; r < 3; ++r) at(i)[r] = largest * (y_[i][r] + R[r] * v[0] + R[3 + r] * v[1] + R[6 + r] * v[2]);
  }
  if (size() > 1) shared_.sum(all_);
  const Values out(y);
  for (PetscInt k = 0; k < n_owned_; ++k) std::copy_n(&all_[3 * static_cast<size_t>(shared_.owned(k))], 3, out.data() + 3 * k);
}

double SymmetricMatrix::bytes() const {
  return L_.bytes() + 8. * static_cast<double>(R_.size() + x_.size() + all_.size()) + 4. * static_cast<double>(pattern_.column.size()) +
         static_cast<double>(y_.size() * sizeof(Lane));
}

}  // namespace hilo::petsc
