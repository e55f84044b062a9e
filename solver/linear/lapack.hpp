// SPDX-License-Identifier: GPL-3.0-or-later
// BLAS and LAPACK: the one place where their Fortran symbols are declared.  Matrices by columns, `stride` apart; triangles are lower ones.
#pragma once

#include <vector>

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
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*, double*, const int*);
void dpotrf_(const char*, const int*, double*, const int*, int*);
void dpotrs_(const char*, const int*, const int*, const double*, const int*, double*, const int*, int*);
void sgetrf_(const int*, const int*, float*, const int*, int*, int*);
void sgetrs_(const char*, const int*, const int*, const float*, const int*, const int*, float*, const int*, int*);
void dtrtri_(const char*, const char*, const int*, double*, const int*, int*);
void dsyevr_(const char*, const char*, const char*, const int*, double*, const int*, const double*, const double*, const int*, const int*,
             const double*, int*, double*, double*, const int*, int*, double*, const int*, int*, const int*, int*);
void dgeev_(const char*, const char*, const int*, double*, const int*, double*, double*, double*, const int*, double*, const int*, double*,
            const int*, int*);
}
#undef HILO_BLAS

namespace hilo::lapack {

/// X := op(L)^-1 X, (n x columns) with columns `next` apart; `transposed`: 'N' or 'T'.
#define HILO_SOLVE_TRIANGLE(T, p)                                                                           \
  inline void solve_triangle(char transposed, int n, const T* L, int stride, T* X, int next, int columns) { \
    const int one = 1;                                                                                      \
    const T unit = 1;                                                                                       \
    columns == 1 ? p##trsv_("L", &transposed, "N", &n, L, &stride, X, &one)                                 \
                 : p##trsm_("L", "L", &transposed, "N", &n, &columns, &unit, L, &stride, X, &next);         \
  }
HILO_SOLVE_TRIANGLE(double, d)
HILO_SOLVE_TRIANGLE(float, s)
#undef HILO_SOLVE_TRIANGLE

/// Y := alpha op(A) X + beta Y; A: (m x n).
#define HILO_MULTIPLY(T, p)                                                                                                              \
  inline void multiply(char transposed, int m, int n, T alpha, const T* A, int stride, const T* X, int next_X, T beta, T* Y, int next_Y, \
                       int columns) {                                                                                                    \
    const int one = 1, rows = transposed == 'T' ? n : m, inner = transposed == 'T' ? m : n;                                              \
    columns == 1 ? p##gemv_(&transposed, &m, &n, &alpha, A, &stride, X, &one, &beta, Y, &one)                                            \
                 : p##gemm_(&transposed, "N", &rows, &columns, &inner, &alpha, A, &stride, X, &next_X, &beta, Y, &next_Y);               \
  }
HILO_MULTIPLY(double, d)
HILO_MULTIPLY(float, s)
#undef HILO_MULTIPLY

/// X := op(L) X, (n x columns) with columns `next` apart.
inline void multiply_triangle(char transposed, int n, const double* L, int stride, double* X, int next, int columns) {
  const int one = 1;
  const double unit = 1;
  columns == 1 ? dtrmv_("L", &transposed, "N", &n, L, &stride, X, &one)
               : dtrmm_("L", "L", &transposed, "N", &n, &columns, &unit, L, &stride, X, &next);
}

/// G := M M^T, lower triangle; M: (n x m), G: (n x n).
inline void gram(int n, int m, const double* M, double* G) {
  const double one = 1, zero = 0;
  dsyrk_("L", "N", &n, &m, &one, M, &n, &zero, G, &n);
}

/// A := its Cholesky factor, (n x n).  False when it is not positive definite.
inline bool factor(int n, double* A, int stride) {
  int info = 0;
  dpotrf_("L", &n, A, &stride, &info);
  return info == 0;
}

/// X := X L^-T, (n x m); L: (m x m).
inline void solve_triangle_right(int n, int m, const double* L, int stride, double* X, int next) {
  const double unit = 1;
  dtrsm_("R", "L", "T", "N", &n, &m, &unit, L, &stride, X, &next);
}

/// G -= M M^T, lower triangle; M: (n x m), G: (n x n).
inline void subtract_gram(int n, int m, const double* M, int stride, double* G) {
  const double minus = -1, one = 1;
  dsyrk_("L", "N", &n, &m, &minus, M, &stride, &one, G, &n);
}

/// X := (L L^T)^-1 X, (n x columns).
inline void solve(int n, int columns, const double* L, double* X) {
  int info = 0;
  dpotrs_("L", &n, &columns, L, &n, X, &n, &info);
}

/// A := its LU factors, (n x n), by rows exchanged.  False when it is singular.
inline bool factor_whole(int n, float* A, std::vector<int>& pivots) {
  int info = 0;
  pivots.resize(static_cast<size_t>(n));
  sgetrf_(&n, &n, A, &n, pivots.data(), &info);
  return info == 0;
}
/// x := A^-1 x, by these.
inline void solve_whole(int n, const float* LU, const std::vector<int>& pivots, float* x) {
  const int one = 1;
  int info = 0;
  sgetrs_("N", &n, &one, LU, &n, pivots.data(), x, &n, &info);
}

/// L := L^-1, (n x n).
inline void invert_triangle(int n, double* L) {
  int info = 0;
  dtrtri_("L", "N", &n, L, &n, &info);
}

/// Eigenvalues and, by columns, eigenvectors of A (n x n), which is lost; of a complex pair the real and the imaginary part of one vector
/// stand in its two columns.  False where the iteration does not end.
inline bool eigen_pairs(int n, double* A, double* re, double* im, double* V) {
  const int one = 1, ask = -1;
  int info = 0;
  double size = 0, none = 0;
  dgeev_("N", "V", &n, A, &n, re, im, &none, &one, V, &n, &size, &ask, &info);
  std::vector<double> room(static_cast<size_t>(size));
  const int length = static_cast<int>(size);
  dgeev_("N", "V", &n, A, &n, re, im, &none, &one, V, &n, room.data(), &length, &info);
  return info == 0;
}

}  // namespace hilo::lapack
