// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry and strains of a solid-shell.  Its mid-surface c = (top + bottom)/2 and half-thickness D = (top - bottom)/2 are bilinear:
//
//   x = c(r, s) + z D(r, s),   c = c_0 + r c_r + s c_s + r s c_d,   D = D_0 + r D_r + s D_s + r s D_d
//
// Covariant strains E_ij = (x_i.x_j - X_i.X_j)/2 are linear in 26 measures, sums of products of c_r c_s c_d D_0 D_r D_s D_d.  Assumed are
//   E_13, E_23   linear between the middles of opposite edges of the mid-surface [dvorkin-bathe-1984]
//   E_33         bilinear between the corners
//   E_11, E_22, E_12 of the mid-surface: c_d.c_d by what the edges and the centre see (MITC4+) [ko-lee-bathe-2017]
// and the rest is as it is.  Added modes: z in E_33; r in E_11, s in E_22, r and s in E_12, of the centre's axes [simo-rifai-1990].
#pragma once
#include <array>

#include "physics/anisotropic.hpp"
#include "physics/shape/shell8.hpp"
#include "physics/solid_strain.hpp"

namespace hilo::shell {

inline constexpr int n_vectors = 7, n_measures = 26, n_modes = 5, n_resultants = 12;

/// u_k = sum_a node_weight(k, a) x_a of the vectors c_r c_s c_d D_0 D_r D_s D_d.
constexpr double node_weight(int k, int a) {
  const double r = hex_corner[a][0], s = hex_corner[a][1], z = hex_corner[a][2];
  const double of[n_vectors] = {r, s, r * s, z, z * r, z * s, z * r * s};
  return of[k] / 8;
}

/// Measures are sums of products u.v, and of squares u.u/2.
struct Product {
  int measure, u, v;
};
inline constexpr Product products[] = {
    {0, 0, 0},  {1, 1, 1},  {2, 2, 2},  {3, 0, 2},  {4, 1, 2},  {5, 0, 1},                                                    // membrane
    {6, 0, 4},  {7, 1, 5},  {8, 2, 6},  {9, 0, 6},  {9, 2, 4},  {10, 1, 6}, {10, 2, 5}, {11, 0, 5}, {11, 1, 4},               // times z
    {12, 4, 4}, {13, 5, 5}, {14, 6, 6}, {15, 4, 6}, {16, 5, 6}, {17, 4, 5},                                                   // times z^2
    {18, 0, 3}, {18, 2, 5}, {19, 0, 5}, {19, 2, 3}, {20, 1, 3}, {20, 2, 4}, {21, 1, 4}, {21, 2, 3},                           // 13, 23
    {22, 3, 3}, {22, 4, 4}, {22, 5, 5}, {22, 6, 6}, {23, 3, 4}, {23, 5, 6}, {24, 3, 5}, {24, 4, 6}, {25, 3, 6}, {25, 4, 5}};  // 33

/// d measure/d u_k has u_with; those of k are terms[first_term[k]] to terms[first_term[k + 1]].
struct MapTerm {
  int measure, with;
};
inline constexpr int n_terms = 68;
struct Terms {
  MapTerm of[n_terms]{};
  int first[n_vectors + 1]{};
};
inline constexpr Terms terms = [] {
  Terms t;
  int n = 0;
  for (int k = 0; k < n_vectors; ++k) {
    for (const Product& p : products) {
      if (p.u == k) t.of[n++] = {p.measure, p.v};
      if (p.v == k && p.u != p.v) t.of[n++] = {p.measure, p.u};
    }
    t.first[k + 1] = n;
  }
  return t;
}();
/// f(term) for those of u_k.
template <int k, class F>
[[gnu::always_inline]] inline void each_term(const F& f) {
  constexpr int from = terms.first[k], n = terms.first[k + 1] - from;
  [&]<int... t>(std::integer_sequence<int, t...>) {
    (f(std::integral_constant<int, terms.of[from + t].measure>{}, std::integral_constant<int, terms.of[from + t].with>{}), ...);
  }
  (std::make_integer_sequence<int, n>{});
}
/// f<k>() of every vector.
template <class F>
[[gnu::always_inline]] inline void each_vector(const F& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) { (f.template operator()<k>(), ...); }
  (std::make_integer_sequence<int, n_vectors>{});
}

template <class T>
inline void vectors(const T* x, T (*u)[3]) {
  for (int k = 0; k < n_vectors; ++k)
    for (int i = 0; i < 3; ++i) {
      u[k][i] = x[i] * node_weight(k, 0);
      for (int a = 1; a < 8; ++a) u[k][i] += x[3 * a + i] * node_weight(k, a);
    }
}

/// What acts on the vectors acts on the nodes: out_a = sum_k node_weight(k, a) v_k, by sums and differences.
template <class T>
[[gnu::always_inline]] inline void to_nodes(const T* v, int stride, T* out, int out_stride) {
  const T r = v[0], s = v[stride], d = v[2 * stride], D0 = v[3 * stride], Dr = v[4 * stride], Ds = v[5 * stride], Dd = v[6 * stride];
  const T both = r + s, apart = r - s, Both = Dr + Ds, Apart = Dr - Ds, plus = D0 + Dd, minus = D0 - Dd;
  const T c[4] = {d - both, apart - d, d + both, -apart - d}, D[4] = {plus - Both, minus + Apart, plus + Both, minus - Apart};
  for (int a = 0; a < 4; ++a) out[a * out_stride] = 0.125 * (c[a] - D[a]), out[(a + 4) * out_stride] = 0.125 * (c[a] + D[a]);
}

template <class T>
inline void measures(const T (*u)[3], T* m) {
  for (int k = 0; k < n_measures; ++k) m[k] = 0 * u[0][0];
  for (const Product& p : products) {
    const T dot = u[p.u][0] * u[p.v][0] + u[p.u][1] * u[p.v][1] + u[p.u][2] * u[p.v][2];
    m[p.measure] += (p.u == p.v ? 0.5 : 1) * dot;
  }
}
/// Their change with u by du, to first order.
template <class T>
inline void measures_along(const T (*u)[3], const T (*du)[3], T* m) {
  for (int k = 0; k < n_measures; ++k) m[k] = 0 * u[0][0];
  for (int k = 0; k < n_vectors; ++k)
    for (int t = terms.first[k]; t < terms.first[k + 1]; ++t) {
      const T* with = u[terms.of[t].with];
      m[terms.of[t].measure] += du[k][0] * with[0] + du[k][1] * with[1] + du[k][2] * with[2];
    }
}

/// What of the strain 11 22 33 23 13 12 a resultant of one station (r, s) has, and times which power of z.
inline constexpr int strain_of[n_resultants] = {0, 1, 5, 0, 1, 5, 0, 1, 5, 2, 3, 4};
inline constexpr int power_of[n_resultants] = {0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0};

/// A station's strains from measures, and its transpose: measures' conjugates from its resultants, added.  `p` is of MITC4+.
template <class T>
inline void strains_at(double r, double s, const T* p, const T* m, T* n) {
  const double rr = r * r, ss = s * s, rs = r * s;
  const T P = p[0] * m[0] + p[1] * m[1] + p[2] * m[2] + p[3] * m[3] + p[4] * m[4] + p[5] * m[5];
  n[0] = m[0] + m[2] + s * m[3] + (ss - 1) * P, n[1] = m[1] + m[2] + r * m[4] + (rr - 1) * P;
  n[2] = m[5] + r * m[3] + s * m[4] + 2 * rs * P;
  for (int q = 0; q < 2; ++q) {
    const T* b = m + 6 + 6 * q;
    n[3 + 3 * q] = b[0] + s * b[3] + ss * b[2], n[4 + 3 * q] = b[1] + r * b[4] + rr * b[2];
    n[5 + 3 * q] = b[5] + r * b[3] + s * b[4] + 2 * rs * b[2];
  }
  n[9] = m[22] + r * m[23] + s * m[24] + rs * m[25];
  n[10] = m[20] + r * m[21], n[11] = m[18] + s * m[19];
}
template <class T>
inline void add_resultants(double r, double s, const T* p, const T* n, T* m) {
  const double rr = r * r, ss = s * s, rs = r * s;
  const T P = (ss - 1) * n[0] + (rr - 1) * n[1] + 2 * rs * n[2];
  m[0] += n[0] + p[0] * P, m[1] += n[1] + p[1] * P, m[2] += n[0] + n[1] + p[2] * P;
  m[3] += s * n[0] + r * n[2] + p[3] * P, m[4] += r * n[1] + s * n[2] + p[4] * P, m[5] += n[2] + p[5] * P;
  for (int q = 0; q < 2; ++q) {
    const T* b = n + 3 + 3 * q;
    T* to = m + 6 + 6 * q;
    to[0] += b[0], to[1] += b[1], to[2] += ss * b[0] + rr * b[1] + 2 * rs * b[2];
    to[3] += s * b[0] + r * b[2], to[4] += r * b[1] + s * b[2], to[5] += b[2];
  }
  m[22] += n[9], m[23] += r * n[9], m[24] += s * n[9], m[25] += rs * n[9];
  m[20] += n[10], m[21] += r * n[10], m[18] += n[11], m[19] += s * n[11];
}

/// Reference geometry of a cell.
template <class T>
struct Cell {
  T u[n_vectors][3], m[n_measures];  // vectors and measures of the reference
  T p[6];                            // MITC4+: c_d.c_d/2 by the first six measures
  T inverse[3][3], det;              // of the map at the centre

  explicit Cell(const T* X) {
    vectors(X, u);
    measures(u, m);
    T n[3], nn = 0 * X[0], cr = nn, cs = nn;
    cross(u[0], u[1], n);
    for (int i = 0; i < 3; ++i) nn += n[i] * n[i];
    T a[3], b[3];
    cross(u[1], n, a), cross(n, u[0], b);
    for (int i = 0; i < 3; ++i) cr += a[i] * u[2][i] / nn, cs += b[i] * u[2][i] / nn;
    const T d = cr * cr + cs * cs - 1;
    p[0] = cr * cr / d, p[1] = cs * cs / d, p[2] = p[0] + p[1], p[3] = -cr / d, p[4] = -cs / d, p[5] = cr * cs / d;
    det = inverted(u[0], u[1], u[3], inverse);
  }

  static void cross(const T* a, const T* b, T* c) {
    for (int i = 0; i < 3; ++i) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  }
  /// Rows of the inverse of the matrix with these columns, and its determinant.
  static T inverted(const T* a, const T* b, const T* c, T out[3][3]) {
    cross(b, c, out[0]), cross(c, a, out[1]), cross(a, b, out[2]);
    const T det = a[0] * out[0][0] + a[1] * out[0][1] + a[2] * out[0][2];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out[i][j] = out[i][j] / det;
    return det;
  }
  /// Columns of dx/d(r, s, z) at a point, of vectors u.
  static void tangents(const T (*u)[3], const double* xi, T g[3][3]) {
    const double r = xi[0], s = xi[1], z = xi[2];
    for (int i = 0; i < 3; ++i) {
      g[0][i] = u[0][i] + s * u[2][i] + z * (u[4][i] + s * u[6][i]);
      g[1][i] = u[1][i] + r * u[2][i] + z * (u[5][i] + r * u[6][i]);
      g[2][i] = u[3][i] + r * u[4][i] + s * u[5][i] + r * s * u[6][i];
    }
  }
};

/// A point of a cell: what turns covariant strains into those of space, and the modes' covariant strains.
template <class T>
struct Point {
  T det, turn[6][6], modes[6][n_modes];

  Point(const Cell<T>& cell, const double* xi) {
    T g[3][3], inverse[3][3], Q[3][3], B[2][3];
    Cell<T>::tangents(cell.u, xi, g);
    det = Cell<T>::inverted(g[0], g[1], g[2], inverse);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) Q[i][j] = inverse[j][i];
    strain_turn(Q, turn);
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 3; ++j) B[k][j] = cell.inverse[k][0] * g[j][0] + cell.inverse[k][1] * g[j][1] + cell.inverse[k][2] * g[j][2];
    constexpr int I[6] = {0, 1, 2, 1, 0, 0}, J[6] = {0, 1, 2, 2, 2, 1};
    const T share = cell.det / det;
    for (int k = 0; k < 6; ++k) {
      const double twice = k < 3 ? 1 : 2;
      const T both = (B[0][I[k]] * B[1][J[k]] + B[1][I[k]] * B[0][J[k]]) * (share * (twice / 2));
      modes[k][0] = 0 * det + (k == 2 ? xi[2] : 0);
      modes[k][1] = B[0][I[k]] * B[0][J[k]] * (share * (twice * xi[0]));
      modes[k][2] = B[1][I[k]] * B[1][J[k]] * (share * (twice * xi[1]));
      modes[k][3] = both * xi[0], modes[k][4] = both * xi[1];
    }
  }
  /// Strain of space from a station's, at this z, and from the modes'.
  void strain(double z, const T* n, const T* alpha, T* e) const {
    T c[6];
    for (int k = 0; k < 6; ++k) {
      c[k] = modes[k][0] * alpha[0];
      for (int a = 1; a < n_modes; ++a) c[k] += modes[k][a] * alpha[a];
    }
    for (int j = 0; j < n_resultants; ++j) c[strain_of[j]] += power(j, z) * n[j];
    for (int k = 0; k < 6; ++k) {
      e[k] = turn[k][0] * c[0];
      for (int i = 1; i < 6; ++i) e[k] += turn[k][i] * c[i];
    }
  }
  static constexpr double power(int j, double z) { return power_of[j] == 0 ? 1 : power_of[j] == 1 ? z : z * z; }
};

/// Moduli of measures, and what couples them to the modes.
template <class T>
struct CellModuli {
  T D[n_measures][n_measures], by_modes[n_modes][n_measures], of_modes[n_modes][n_measures], modes[n_modes][n_modes];

  explicit CellModuli(const T& like) {
    const T zero = 0 * like;
    for (int i = 0; i < n_measures; ++i)
      for (int j = 0; j < n_measures; ++j) D[i][j] = zero;
    for (int a = 0; a < n_modes; ++a) {
      for (int j = 0; j < n_measures; ++j) by_modes[a][j] = of_modes[a][j] = zero;
      for (int b = 0; b < n_modes; ++b) modes[a][b] = zero;
    }
  }
  /// Eliminates the modes.
  void condense() {
    T x[n_modes][n_measures], a[n_modes][n_modes];
    for (int i = 0; i < n_modes; ++i) {
      for (int j = 0; j < n_modes; ++j) a[i][j] = modes[i][j];
      for (int j = 0; j < n_measures; ++j) x[i][j] = of_modes[i][j];
    }
    solve<n_measures>(a, x);
    for (int i = 0; i < n_measures; ++i)
      for (int a_ = 0; a_ < n_modes; ++a_)
        for (int j = 0; j < n_measures; ++j) D[i][j] -= by_modes[a_][i] * x[a_][j];
  }
  /// a x = x in place; a is near to symmetric and positive.
  template <int columns>
  static void solve(T (*a)[n_modes], T (*x)[columns]) {
    for (int k = 0; k < n_modes; ++k) {
      const T pivot = 1 / a[k][k];
      for (int i = 0; i < n_modes; ++i) {
        if (i == k) continue;
        const T by = a[i][k] * pivot;
        for (int j = k; j < n_modes; ++j) a[i][j] -= by * a[k][j];
        for (int j = 0; j < columns; ++j) x[i][j] -= by * x[k][j];
      }
    }
    for (int k = 0; k < n_modes; ++k)
      for (int j = 0; j < columns; ++j) x[k][j] = x[k][j] / a[k][k];
  }
};

/// Adds the moduli of all points, covariant and times their volumes (n_points x 6 x 6): of(p) for Point p.
template <class S, class T, class Moduli>
inline void add_stiffness(const Cell<T>& cell, const Moduli& of, CellModuli<T>& to) {
  constexpr auto rule = S::rule();
  for (int q = 0; q < 4; ++q) {
    T N[n_resultants][n_resultants], A[n_modes][n_resultants], B[n_modes][n_resultants];
    const T zero = 0 * cell.det;
    for (int i = 0; i < n_resultants; ++i) {
      for (int j = 0; j < n_resultants; ++j) N[i][j] = zero;
      for (int a = 0; a < n_modes; ++a) A[a][i] = B[a][i] = zero;
    }
    for (int p = q; p < S::n_points; p += 4) {
      T C[6][6], left[n_modes][6], right[n_modes][6];
      const Point<T> at = of(p, C);
      const double z = rule.xi[p][2];
      for (int a = 0; a < n_modes; ++a)
        for (int i = 0; i < 6; ++i) {
          left[a][i] = at.modes[0][a] * C[0][i], right[a][i] = C[i][0] * at.modes[0][a];
          for (int k = 1; k < 6; ++k) left[a][i] += at.modes[k][a] * C[k][i], right[a][i] += C[i][k] * at.modes[k][a];
        }
      for (int a = 0; a < n_modes; ++a) {
        for (int b = 0; b < n_modes; ++b)
          for (int k = 0; k < 6; ++k) to.modes[a][b] += left[a][k] * at.modes[k][b];
        for (int j = 0; j < n_resultants; ++j) {
          const double power = Point<T>::power(j, z);
          A[a][j] += power * left[a][strain_of[j]], B[a][j] += power * right[a][strain_of[j]];
        }
      }
      for (int i = 0; i < n_resultants; ++i)
        for (int j = 0; j < n_resultants; ++j) N[i][j] += (Point<T>::power(i, z) * Point<T>::power(j, z)) * C[strain_of[i]][strain_of[j]];
    }
    const double r = rule.xi[q][0], s = rule.xi[q][1];
    T rows[n_resultants][n_measures];
    for (int i = 0; i < n_resultants; ++i) {
      for (int j = 0; j < n_measures; ++j) rows[i][j] = zero;
      add_resultants(r, s, cell.p, N[i], rows[i]);
    }
    for (int j = 0; j < n_measures; ++j) {
      T column[n_resultants], out[n_measures];
      for (int i = 0; i < n_resultants; ++i) column[i] = rows[i][j];
      for (int i = 0; i < n_measures; ++i) out[i] = zero;
      add_resultants(r, s, cell.p, column, out);
      for (int i = 0; i < n_measures; ++i) to.D[i][j] += out[i];
    }
    for (int a = 0; a < n_modes; ++a)
      add_resultants(r, s, cell.p, A[a], to.of_modes[a]), add_resultants(r, s, cell.p, B[a], to.by_modes[a]);
  }
}

/// w turn^T C turn
template <class T>
inline void covariant(const Point<T>& at, const T (*C)[6], const T& w, T (*to)[6]) {
  T half[6][6];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      half[i][j] = C[i][0] * at.turn[0][j];
      for (int k = 1; k < 6; ++k) half[i][j] += C[i][k] * at.turn[k][j];
    }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      T v = at.turn[0][i] * half[0][j];
      for (int k = 1; k < 6; ++k) v += at.turn[k][i] * half[k][j];
      to[i][j] = w * v;
    }
}

/// Of moduli that are the same at every point.
template <class S, class T, class Law>
inline CellModuli<T> linear_stiffness(const Cell<T>& cell, const Law& moduli) {
  constexpr auto rule = S::rule();
  T C[6][6];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) C[i][j] = 0 * cell.det;
  if constexpr (std::is_same_v<Law, Lame>)
    add_linear_tangent(moduli, 1, C);
  else
    moduli.add_tangent(1, C);
  CellModuli<T> out(cell.det);
  add_stiffness<S>(
      cell,
      [&](int p, T(*to)[6]) {
        const Point<T> at(cell, rule.xi[p]);
        covariant(at, C, T(at.det * rule.w[p]), to);
        return at;
      },
      out);
  return out;
}

}  // namespace hilo::shell
