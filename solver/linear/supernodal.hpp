// Triangular solves with a supernodal factor as CHOLMOD stores it: rows in part, and in a precision of choice.  They read the factor once,
// at memory speed; in single precision they take half the time.
#pragma once
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cstring>
#include <vector>

extern "C" {
void dtrsv_(const char*, const char*, const char*, const int*, const double*, const int*, double*, const int*);
void strsv_(const char*, const char*, const char*, const int*, const float*, const int*, float*, const int*);
void dgemv_(const char*, const int*, const int*, const double*, const double*, const int*, const double*, const int*, const double*,
            double*, const int*);
void sgemv_(const char*, const int*, const int*, const float*, const float*, const int*, const float*, const int*, const float*, float*,
            const int*);
void dtrmv_(const char*, const char*, const char*, const int*, const double*, const int*, double*, const int*);
}

namespace hilo::supernodal {

inline void solve_triangle(const char* transposed, int n, const double* L, int stride, double* x) {
  const int one = 1;
  dtrsv_("L", transposed, "N", &n, L, &stride, x, &one);
}
inline void solve_triangle(const char* transposed, int n, const float* L, int stride, float* x) {
  const int one = 1;
  strsv_("L", transposed, "N", &n, L, &stride, x, &one);
}
/// y := alpha op(A) x + beta y
inline void multiply(const char* transposed, int m, int n, double alpha, const double* A, int stride, const double* x, double beta,
                     double* y) {
  const int one = 1;
  dgemv_(transposed, &m, &n, &alpha, A, &stride, x, &one, &beta, y, &one);
}
inline void multiply(const char* transposed, int m, int n, float alpha, const float* A, int stride, const float* x, float beta, float* y) {
  const int one = 1;
  sgemv_(transposed, &m, &n, &alpha, A, &stride, x, &one, &beta, y, &one);
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

/// x[from .. to) := L_ft^-1 x, and the rows below follow: x_below -= L_below x.  `scratch`: at least L->maxesize + L->n.
template <class T>
void forward(const cholmod_factor* L, int from, int to, T* x, std::vector<T>& scratch) {
  if (from >= to) return;
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *px = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s);
  const auto* values = static_cast<const T*>(L->x);
  const int n_super = static_cast<int>(L->nsuper);
  scratch.resize(L->maxesize + L->n);
  for (int s = static_cast<int>(std::upper_bound(super, super + n_super, from) - super) - 1; s < n_super && super[s] < to; ++s) {
    const int a = std::max(from, super[s]), b = std::min(to, super[s + 1]), m = b - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    const T* D = values + px[s] + o + static_cast<size_t>(o) * stride;
    solve_triangle("N", m, D, stride, x + a);
    const int n_below = stride - o - m;
    if (n_below == 0) continue;
    multiply("N", n_below, m, T(-1), D + m, stride, x + a, T(0), scratch.data());
    const int* row = rows + pi[s] + o + m;
    for (int k = 0; k < n_below; ++k) x[row[k]] += scratch[k];
  }
}

/// x[from .. to) := L_ft^-T (x - L_below^T x_below)
template <class T>
void backward(const cholmod_factor* L, int from, int to, T* x, std::vector<T>& scratch) {
  if (from >= to) return;
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *px = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s);
  const auto* values = static_cast<const T*>(L->x);
  const int n_super = static_cast<int>(L->nsuper);
  scratch.resize(L->maxesize + L->n);
  for (int s = static_cast<int>(std::lower_bound(super, super + n_super, to) - super) - 1; s >= 0 && super[s + 1] > from; --s) {
    const int a = std::max(from, super[s]), b = std::min(to, super[s + 1]), m = b - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    const T* D = values + px[s] + o + static_cast<size_t>(o) * stride;
    const int n_below = stride - o - m;
    const int* row = rows + pi[s] + o + m;
    for (int k = 0; k < n_below; ++k) scratch[k] = x[row[k]];
    if (n_below > 0) multiply("T", n_below, m, T(-1), D + m, stride, scratch.data(), T(1), x + a);
    solve_triangle("T", m, D, stride, x + a);
  }
}

/// x[from .. n) := L L^T x, columns [from, n) only.
inline void multiply(const cholmod_factor* L, int from, double* x, std::vector<double>& scratch) {
  const auto* super = static_cast<const int*>(L->super);
  const auto *pi = static_cast<const int*>(L->pi), *px = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s);
  const auto* values = static_cast<const double*>(L->x);
  const int one = 1, n_super = static_cast<int>(L->nsuper);
  scratch.resize(L->maxesize + L->n);
  const int first = static_cast<int>(std::upper_bound(super, super + n_super, from) - super) - 1;
  const auto visit = [&](int s, auto&& f) {
    const int a = std::max(from, super[s]), m = super[s + 1] - a, o = a - super[s], stride = pi[s + 1] - pi[s];
    f(m, values + px[s] + o + static_cast<size_t>(o) * stride, stride, x + a, stride - o - m, rows + pi[s] + o + m);
  };
  for (int s = first; s < n_super; ++s)
    visit(s, [&](int m, const double* D, int stride, double* y, int n_below, const int* row) {
      dtrmv_("L", "T", "N", &m, D, &stride, y, &one);
      for (int k = 0; k < n_below; ++k) scratch[k] = x[row[k]];
      if (n_below > 0) multiply("T", n_below, m, 1., D + m, stride, scratch.data(), 1., y);
    });
  for (int s = n_super - 1; s >= first; --s)
    visit(s, [&](int m, const double* D, int stride, double* y, int n_below, const int* row) {
      if (n_below > 0) multiply("N", n_below, m, 1., D + m, stride, y, 0., scratch.data());
      for (int k = 0; k < n_below; ++k) x[row[k]] += scratch[k];
      dtrmv_("L", "N", "N", &m, D, &stride, y, &one);
    });
}

}  // namespace hilo::supernodal
