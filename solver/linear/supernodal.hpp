// Triangular solves with a supernodal factor as CHOLMOD stores it: rows in part, and in a precision of choice.  They read the factor once,
// at memory speed; in single precision they take half the time.
#pragma once
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <vector>

#include "linear/panel.hpp"

#define HILO_BLAS(T, p)                                                                                                               \
  void p##trsv_(const char*, const char*, const char*, const int*, const T*, const int*, T*, const int*);                             \
  void p##gemv_(const char*, const int*, const int*, const T*, const T*, const int*, const T*, const int*, const T*, T*, const int*); \
  void p##trsm_(const char*, const char*, const char*, const char*, const int*, const int*, const T*, const T*, const int*, T*,       \
                const int*);                                                                                                          \
  void p##gemm_(const char*, const char*, const int*, const int*, const int*, const T*, const T*, const int*, const T*, const int*,   \
                const T*, T*, const int*);
extern "C" {
HILO_BLAS(double, d)
HILO_BLAS(float, s)
void dtrmv_(const char*, const char*, const char*, const int*, const double*, const int*, double*, const int*);
void dtrmm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*, const int*, double*,
            const int*);
}
#undef HILO_BLAS

namespace hilo::supernodal {

/// X := op(L)^-1 X, (n x columns) with columns `next` apart.
template <class T>
void solve_triangle(const char* transposed, int n, const T* L, int stride, T* X, int next, int columns) {
  const int one = 1;
  const T unit = 1;
  if constexpr (std::is_same_v<T, double>)
    columns == 1 ? dtrsv_("L", transposed, "N", &n, L, &stride, X, &one)
                 : dtrsm_("L", "L", transposed, "N", &n, &columns, &unit, L, &stride, X, &next);
  else
    columns == 1 ? strsv_("L", transposed, "N", &n, L, &stride, X, &one)
                 : strsm_("L", "L", transposed, "N", &n, &columns, &unit, L, &stride, X, &next);
}

/// Y := alpha op(A) X + beta Y; A: (m x n).
template <class T>
void multiply(const char* transposed, int m, int n, T alpha, const T* A, int stride, const T* X, int next_X, T beta, T* Y, int next_Y,
              int columns) {
  const int one = 1, rows = *transposed == 'T' ? n : m, inner = *transposed == 'T' ? m : n;
  if constexpr (std::is_same_v<T, double>)
    columns == 1 ? dgemv_(transposed, &m, &n, &alpha, A, &stride, X, &one, &beta, Y, &one)
                 : dgemm_(transposed, "N", &rows, &columns, &inner, &alpha, A, &stride, X, &next_X, &beta, Y, &next_Y);
  else
    columns == 1 ? sgemv_(transposed, &m, &n, &alpha, A, &stride, X, &one, &beta, Y, &one)
                 : sgemm_(transposed, "N", &rows, &columns, &inner, &alpha, A, &stride, X, &next_X, &beta, Y, &next_Y);
}

/// The values of a factor in single precision, in the place of the double ones; the next factorisation overwrites them.
inline void narrow(cholmod_factor* L) {
  const auto* from = static_cast<const double*>(L->x);
  auto* to = static_cast<char*>(L->x);
  for (size_t i = 0; i < L->xsize; ++i) {
    const auto value = static_cast<float>(from[i]);
    std::memcpy(to + sizeof(float) * i, &value, sizeof(float));
  }
}

/// x[from .. to) := L_ft^-1 x, and the rows below follow: x_below -= L_below x.  x: (n x columns), all of the factor's rows.
template <class T>
void forward(const cholmod_factor* L, int from, int to, T* x, std::vector<T>& scratch, int columns = 1) {
  if (from >= to) return;
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *px = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s);
  const auto* values = static_cast<const T*>(L->x);
  const int n_super = static_cast<int>(L->nsuper), n = static_cast<int>(L->n);
  scratch.resize(L->n * columns);
  for (int s = static_cast<int>(std::upper_bound(super, super + n_super, from) - super) - 1; s < n_super && super[s] < to; ++s) {
    const int a = std::max(from, super[s]), b = std::min(to, super[s + 1]), m = b - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    const T* D = values + px[s] + o + static_cast<size_t>(o) * stride;
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
    solve_triangle("N", m, D, stride, x + a, n, columns);
    if (n_below == 0) continue;
    multiply("N", n_below, m, T(-1), D + m, stride, x + a, n, T(0), scratch.data(), n_below, columns);
    const int* row = rows + pi[s] + o + m;
    for (int c = 0; c < columns; ++c) {
      T* to_x = x + static_cast<size_t>(c) * n;
      const T* part = scratch.data() + static_cast<size_t>(c) * n_below;
      for (int k = 0; k < n_below; ++k) to_x[row[k]] += part[k];
    }
  }
}

/// x[from .. to) := L_ft^-T (x - L_below^T x_below)
template <class T>
void backward(const cholmod_factor* L, int from, int to, T* x, std::vector<T>& scratch, int columns = 1) {
  if (from >= to) return;
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *px = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s);
  const auto* values = static_cast<const T*>(L->x);
  const int n_super = static_cast<int>(L->nsuper), n = static_cast<int>(L->n);
  scratch.resize(L->n * columns);
  for (int s = static_cast<int>(std::lower_bound(super, super + n_super, to) - super) - 1; s >= 0 && super[s + 1] > from; --s) {
    const int a = std::max(from, super[s]), b = std::min(to, super[s + 1]), m = b - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    const T* D = values + px[s] + o + static_cast<size_t>(o) * stride;
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
    if (n_below > 0) multiply("T", n_below, m, T(-1), D + m, stride, scratch.data(), n_below, T(1), x + a, n, columns);
    solve_triangle("T", m, D, stride, x + a, n, columns);
  }
}

/// x[from .. n) := L L^T x, columns [from, n) of L only.
inline void multiply(const cholmod_factor* L, int from, double* x, std::vector<double>& scratch, int columns = 1) {
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *px = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s);
  const auto* values = static_cast<const double*>(L->x);
  const int one = 1, n_super = static_cast<int>(L->nsuper), n = static_cast<int>(L->n);
  const double unit = 1;
  scratch.resize(L->n * columns);
  const int first = static_cast<int>(std::upper_bound(super, super + n_super, from) - super) - 1;
  const auto visit = [&](int s, auto&& f) {
    const int a = std::max(from, super[s]), m = super[s + 1] - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    f(m, values + px[s] + o + static_cast<size_t>(o) * stride, stride, x + a, stride - o - m, rows + pi[s] + o + m);
  };
  const auto triangle = [&](const char* transposed, int m, const double* D, int stride, double* y) {
    columns == 1 ? dtrmv_("L", transposed, "N", &m, D, &stride, y, &one)
                 : dtrmm_("L", "L", transposed, "N", &m, &columns, &unit, D, &stride, y, &n);
  };
  for (int s = first; s < n_super; ++s)
    visit(s, [&](int m, const double* D, int stride, double* y, int n_below, const int* row) {
      triangle("T", m, D, stride, y);
      for (int c = 0; c < columns; ++c)
        for (int k = 0; k < n_below; ++k) scratch[k + static_cast<size_t>(c) * n_below] = x[row[k] + static_cast<size_t>(c) * n];
      if (n_below > 0) multiply("T", n_below, m, 1., D + m, stride, scratch.data(), n_below, 1., y, n, columns);
    });
  for (int s = n_super - 1; s >= first; --s)
    visit(s, [&](int m, const double* D, int stride, double* y, int n_below, const int* row) {
      if (n_below > 0) multiply("N", n_below, m, 1., D + m, stride, y, n, 0., scratch.data(), n_below, columns);
      for (int c = 0; c < columns; ++c)
        for (int k = 0; k < n_below; ++k) x[row[k] + static_cast<size_t>(c) * n] += scratch[k + static_cast<size_t>(c) * n_below];
      triangle("N", m, D, stride, y);
    });
}

}  // namespace hilo::supernodal
