// SPDX-License-Identifier: GPL-3.0-or-later
// Triangular solves with a supernodal factor in CHOLMOD's layout: rows in part, with its values or a copy of them in single precision. They
// read the values once, at memory speed; in single precision they take half the time.
#pragma once
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "linear/lapack.hpp"
#include "linear/panel.hpp"

namespace hilo::supernodal {

/// Values of a factor by supernodes, each by columns: as CHOLMOD computed them,
class DoubleValues {
 public:
  explicit DoubleValues(const cholmod_factor* L) : first_(static_cast<const int*>(L->px)), values_(static_cast<const double*>(L->x)) {}
  const double* operator[](int supernode) const { return values_ + first_[supernode]; }

 private:
  const int* first_;
  const double* values_;
};

/// and in single precision.
class SingleValues {
 public:
  /// Those of L.  A large L keeps its pattern alone until it is factored again: piece by piece, from the end, CHOLMOD's memory is given
  /// back and serves the next piece, so that values in both precisions are never there whole.  A small one keeps its memory, and so do
  /// its single values: given back and had again at every factor, its pages would cost a tenth of a step.
  void take_from(cholmod_factor* L, cholmod_common& common) {
    const auto* first = static_cast<const int*>(L->px);
    start_.resize(L->nsuper);
    is_large_ = L->xsize > size_t{1} << 23;  // 64 MB
    if (!is_large_) {
      pieces_.resize(1);
      copy(static_cast<const double*>(L->x), L->xsize, pieces_[0]);
      for (size_t s = 0; s < L->nsuper; ++s) start_[s] = pieces_[0].data() + first[s];
      return;
    }
    pieces_.clear();
    const size_t piece = L->xsize / 32 + 1;
    size_t held = L->xsize;
    for (auto to = static_cast<int>(L->nsuper); to > 0;) {
      int from = to - 1;
      while (from > 0 && held - first[from] < piece) --from;
      copy(static_cast<const double*>(L->x) + first[from], held - first[from], pieces_.emplace_back());
      for (int s = from; s < to; ++s) start_[s] = pieces_.back().data() + (first[s] - first[from]);
      L->x = cholmod_realloc(std::max(first[from], 1), sizeof(double), L->x, &held, &common);
      to = from;
    }
    const size_t size = std::exchange(L->xsize, held);  // what CHOLMOD gives back now
    cholmod_change_factor(CHOLMOD_PATTERN, 1, 1, 1, 1, L, &common);
    L->xsize = size;
  }
  void clear() {
    start_.clear();
    if (is_large_) pieces_.clear();
  }
  bool exist() const { return !start_.empty(); }
  const float* operator[](int supernode) const { return start_[supernode]; }
  double bytes() const {
    size_t n = 0;
    for (const auto& piece : pieces_) n += piece.size();
    return 4. * static_cast<double>(n);
  }

 private:
  static void copy(const double* from, size_t n, std::vector<float>& to) {
    to.resize(n);
    std::transform(from, from + n, to.begin(), [](double v) { return static_cast<float>(v); });
  }

  bool is_large_ = false;
  std::vector<std::vector<float>> pieces_;
  std::vector<const float*> start_;  // of each supernode
};

/// Bytes of a factor and of its values in single precision, if it has given its own away.
inline double bytes_of(const cholmod_factor* L, const SingleValues& single) {
  return (L->x ? 8. * static_cast<double>(L->xsize) : 0) + single.bytes() + 4. * static_cast<double>(L->ssize);
}

/// x[from .. to) := L_ft^-1 x, and the rows below follow: x_below -= L_below x.  x: (n x columns), all of the factor's rows.
/// `values`: those of L, in the precision of x.
template <class T, class Values>
void forward(const cholmod_factor* L, const Values& values, int from, int to, T* x, std::vector<T>& scratch, int columns = 1) {
  if (from >= to) return;
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *rows = static_cast<const int*>(L->s);
  const int n_super = static_cast<int>(L->nsuper), n = static_cast<int>(L->n);
  scratch.resize(L->n * columns);
  for (int s = static_cast<int>(std::upper_bound(super, super + n_super, from) - super) - 1; s < n_super && super[s] < to; ++s) {
    const int a = std::max(from, super[s]), b = std::min(to, super[s + 1]), m = b - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    const T* D = values[s] + o + static_cast<size_t>(o) * stride;
    const int n_below = stride - o - m;
    if (columns == 1) {
      T* y = scratch.data();
      std::copy_n(x + a, m, y), std::fill_n(y + m, n_below, T{});
      forward_panel(m, m + n_below, D, stride, y);
      std::copy_n(y, m, x + a);
      const int* row = rows + pi[s] + o + m;
      for (int k = 0; k < n_below; ++k) x[row[k]] += y[m + k];
      continue;
    }
    lapack::solve_triangle('N', m, D, stride, x + a, n, columns);
    if (n_below == 0) continue;
    lapack::multiply('N', n_below, m, T(-1), D + m, stride, x + a, n, T(0), scratch.data(), n_below, columns);
    const int* row = rows + pi[s] + o + m;
    for (int c = 0; c < columns; ++c) {
      T* to_x = x + static_cast<size_t>(c) * n;
      const T* part = scratch.data() + static_cast<size_t>(c) * n_below;
      for (int k = 0; k < n_below; ++k) to_x[row[k]] += part[k];
    }
  }
}

/// x[from .. to) := L_ft^-T (x - L_below^T x_below)
template <class T, class Values>
void backward(const cholmod_factor* L, const Values& values, int from, int to, T* x, std::vector<T>& scratch, int columns = 1) {
  if (from >= to) return;
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *rows = static_cast<const int*>(L->s);
  const int n_super = static_cast<int>(L->nsuper), n = static_cast<int>(L->n);
  scratch.resize(L->n * columns);
  for (int s = static_cast<int>(std::lower_bound(super, super + n_super, to) - super) - 1; s >= 0 && super[s + 1] > from; --s) {
    const int a = std::max(from, super[s]), b = std::min(to, super[s + 1]), m = b - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    const T* D = values[s] + o + static_cast<size_t>(o) * stride;
    const int n_below = stride - o - m;
    const int* row = rows + pi[s] + o + m;
    if (columns == 1) {
      T* y = scratch.data();
      std::copy_n(x + a, m, y);
      for (int k = 0; k < n_below; ++k) y[m + k] = x[row[k]];
      backward_panel(m, m + n_below, D, stride, y);
      std::copy_n(y, m, x + a);
      continue;
    }
    for (int c = 0; c < columns; ++c) {
      const T* of_x = x + static_cast<size_t>(c) * n;
      T* part = scratch.data() + static_cast<size_t>(c) * n_below;
      for (int k = 0; k < n_below; ++k) part[k] = of_x[row[k]];
    }
    if (n_below > 0) lapack::multiply('T', n_below, m, T(-1), D + m, stride, scratch.data(), n_below, T(1), x + a, n, columns);
    lapack::solve_triangle('T', m, D, stride, x + a, n, columns);
  }
}

/// x[from .. n) := L L^T x, columns [from, n) of L only.
inline void multiply(const cholmod_factor* L, int from, double* x, std::vector<double>& scratch, int columns = 1) {
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *rows = static_cast<const int*>(L->s);
  const DoubleValues values(L);
  const int n_super = static_cast<int>(L->nsuper), n = static_cast<int>(L->n);
  scratch.resize(L->n * columns);
  const int first = static_cast<int>(std::upper_bound(super, super + n_super, from) - super) - 1;
  const auto visit = [&](int s, auto&& f) {
    const int a = std::max(from, super[s]), m = super[s + 1] - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    f(m, values[s] + o + static_cast<size_t>(o) * stride, stride, x + a, stride - o - m, rows + pi[s] + o + m);
  };
  for (int s = first; s < n_super; ++s)
    visit(s, [&](int m, const double* D, int stride, double* y, int n_below, const int* row) {
      lapack::multiply_triangle('T', m, D, stride, y, n, columns);
      for (int c = 0; c < columns; ++c)
        for (int k = 0; k < n_below; ++k) scratch[k + static_cast<size_t>(c) * n_below] = x[row[k] + static_cast<size_t>(c) * n];
      if (n_below > 0) lapack::multiply('T', n_below, m, 1., D + m, stride, scratch.data(), n_below, 1., y, n, columns);
    });
  for (int s = n_super - 1; s >= first; --s)
    visit(s, [&](int m, const double* D, int stride, double* y, int n_below, const int* row) {
      if (n_below > 0) lapack::multiply('N', n_below, m, 1., D + m, stride, y, n, 0., scratch.data(), n_below, columns);
      for (int c = 0; c < columns; ++c)
        for (int k = 0; k < n_below; ++k) x[row[k] + static_cast<size_t>(c) * n] += scratch[k + static_cast<size_t>(c) * n_below];
      lapack::multiply_triangle('N', m, D, stride, y, n, columns);
    });
}

}  // namespace hilo::supernodal
