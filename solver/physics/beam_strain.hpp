// SPDX-License-Identifier: GPL-3.0-or-later
// Strains of the arc element and their discrete gradient, with slopes, for a number or one number in each lane (physics/beam_arc.hpp has
// the formulas).  All slopes are by hand: of the seven measures a, t, p a strain has simple ones, and a chain of dual numbers took ten
// times as long.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "physics/lane_functions.hpp"

namespace hilo::arc {

inline constexpr int n_measures = 7, n_strains = 6;  // a, t, p; shear along 1 and 2, stretch, bending about 1 and 2, twist

template <class T>
[[gnu::always_inline]] inline T constant(double x) {
  if constexpr (sizeof(T) == sizeof(double))
    return T(x);
  else
    return T{} + x;
}

template <class T>
struct LaneVector {
  T v[3];
  T& operator[](int i) { return v[i]; }
  const T& operator[](int i) const { return v[i]; }
};
template <class T>
[[gnu::always_inline]] inline LaneVector<T> operator+(const LaneVector<T>& a, const LaneVector<T>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
[[gnu::always_inline]] inline LaneVector<T> operator-(const LaneVector<T>& a, const LaneVector<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class S, class T>
[[gnu::always_inline]] inline LaneVector<T> operator*(const S& s, const LaneVector<T>& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
template <class T>
[[gnu::always_inline]] inline void add_to(LaneVector<T>& to, const T& s, const LaneVector<T>& a) {
  for (int i = 0; i < 3; ++i) to[i] += s * a[i];
}
template <class T>
[[gnu::always_inline]] inline T dot(const LaneVector<T>& a, const LaneVector<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
[[gnu::always_inline]] inline LaneVector<T> cross(const LaneVector<T>& a, const LaneVector<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// m[i][j] is entry (i, j).
template <class T>
struct Matrix {
  T m[3][3];
};
/// M += s [a]x.
template <class T>
[[gnu::always_inline]] inline void add_skew(Matrix<T>& M, const T& s, const LaneVector<T>& a) {
  const T x = s * a[0], y = s * a[1], z = s * a[2];
  M.m[0][1] -= z, M.m[1][0] += z, M.m[0][2] += y, M.m[2][0] -= y, M.m[1][2] -= x, M.m[2][1] += x;
}
/// M += s [a]x [b]x.
template <class T>
[[gnu::always_inline]] inline void add_skew2(Matrix<T>& M, const T& s, const LaneVector<T>& a, const LaneVector<T>& b) {
  const LaneVector<T> sb = s * b;
  const T trace = dot(a, sb);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) M.m[i][j] += sb[i] * a[j];
    M.m[i][i] -= trace;
  }
}

// f and k as power series in x = 1 - c below `series`, in closed form above
inline constexpr int n_terms = 26;
inline constexpr double series = 0.3;
struct TurnSeries {
  std::array<double, n_terms> f{}, k{};
  constexpr TurnSeries() {
    f[0] = 1;
    for (int n = 1; n < n_terms; ++n) f[n] = f[n - 1] * n / (2 * n + 1);
    for (int i = 0; i < n_terms - 1; ++i) {  // of q(x)/(2 - x)
      double half = 0.5;
      for (int j = i; j >= 0; --j, half /= 2) k[i] += (f[j] / 2 - f[j + 1]) * half;
    }
  }
};
inline constexpr TurnSeries by_x;

/// f and k at both ends of a step.
template <class T>
struct TurnFunctions {
  T f0, k0, f1, k1;
  T f1_c, k1_c;          // slopes by c at the second end
  T df, dk, df_c, dk_c;  // divided differences by c, and their slopes by c at the second end
};
/// Where a series will not do.
TurnFunctions<double> far_turning(double c0, double c1);

/// Terms of the series by the largest x: what is left out is below 1e-17 of the sum, in slopes of divided differences too.
[[gnu::always_inline]] inline int terms_for(double x) { return x < 0.01 ? 10 : x < 0.08 ? 16 : n_terms; }

/// The value at x0 and x1 = x0 + dx, the slope at x1, the divided difference and its slope by x1, of a power series.
template <class T>
[[gnu::always_inline]] inline void expand(const std::array<double, n_terms>& co, int terms, const T& x0, const T& x1, T& v0, T& v1, T& v1_x,
                                          T& d, T& d_x) {
  T b = constant<T>(co[terms - 1]);
  d = T{}, d_x = T{};
  for (int n = terms - 2; n >= 0; --n) d_x = d + x1 * d_x, d = b + x1 * d, b = co[n] + x0 * b;
  const T dx = x1 - x0;
  v0 = b, v1 = b + dx * d, v1_x = d + dx * d_x;
}

template <class T>
[[gnu::always_inline]] inline TurnFunctions<T> turning(const T& c0, const T& c1) {
  constexpr unsigned W = sizeof(T) / sizeof(double);
  const T x0 = 1 - c0, x1 = 1 - c1;
  double most = 0;
  bool far = false;
  for (unsigned l = 0; l < W; ++l)
    for (const double x : {lane(x0, l), lane(x1, l)}) {
      if (!(x < series)) far = true;  // or no number
      most = std::max(most, std::abs(x));
    }
  const int terms = terms_for(most);
  TurnFunctions<T> t;
  expand(by_x.f, terms, x0, x1, t.f0, t.f1, t.f1_c, t.df, t.df_c);
  expand(by_x.k, terms, x0, x1, t.k0, t.k1, t.k1_c, t.dk, t.dk_c);
  t.f1_c = -t.f1_c, t.k1_c = -t.k1_c, t.df = -t.df, t.dk = -t.dk;  // dx = -dc
  if (far)
    for (unsigned l = 0; l < W; ++l) {
      if (lane(x0, l) < series && lane(x1, l) < series) continue;
      const TurnFunctions<double> of = far_turning(lane(c0, l), lane(c1, l));
      lane(t.f0, l) = of.f0, lane(t.k0, l) = of.k0, lane(t.f1, l) = of.f1, lane(t.k1, l) = of.k1;
      lane(t.f1_c, l) = of.f1_c, lane(t.k1_c, l) = of.k1_c;
      lane(t.df, l) = of.df, lane(t.dk, l) = of.dk, lane(t.df_c, l) = of.df_c, lane(t.dk_c, l) = of.dk_c;
    }
  return t;
}

template <class T>
struct Measures {
  LaneVector<T> a;
  T t;
  LaneVector<T> p;
};

/// Products of measures that strains are made of.
template <class T>
struct End {
  LaneVector<T> a, p, w, b;  // w = a x p, b = a x w
  T c;
  [[gnu::always_inline]] explicit End(const Measures<T>& m) : a(m.a), p(m.p), w(cross(m.a, m.p)), b(cross(m.a, w)), c(0.5 * (m.t - 1)) {}
  /// L times the strains.
  [[gnu::always_inline]] void strain(const T& f, const T& k, T* x) const {
    for (int i = 0; i < 3; ++i) x[i] = p[i] - 0.5 * (f * w[i]) + k * b[i], x[3 + i] = f * a[i];
  }
};
/// Half the sum.
template <class T>
[[gnu::always_inline]] inline LaneVector<T> mean(const LaneVector<T>& a, const LaneVector<T>& b) {
  return 0.5 * (a + b);
}

/// L times the strains.
template <class T>
[[gnu::always_inline]] inline void strain(const Measures<T>& m, T* x) {
  const End<T> e(m);
  const TurnFunctions<T> t = turning(e.c, e.c);
  e.strain(t.f1, t.k1, x);
}

/// What an element is made of: C* [N, N m, N m^2]; 1, or 0 where nothing is known of fibres; what half the square of its twist counts as,
/// stretch and bending about 1 and 2 [m^2, m], and stiffness against it beside these [N m^4]; its strains of fibres without stress
/// [1, 1/m], its length [m].
template <class T>
struct ArcStiffness {
  T C[n_strains][n_strains], fibres, by_twist[3], warp, reference[n_strains + 1], length;
};

/// The strains h of fibres along the beam, of second degree in those of the arc e, and half the square of the twist.  A fibre at (X1, X2)
/// has the strain h2 + X2 h3 - X1 h4 where its way is (e0 - X2 e5, e1 + X1 e5, 1 + e2 + X2 e3 - X1 e4): that a twist inclines it counts too
/// [wagner-1936].
template <class T>
[[gnu::always_inline]] inline void fibre_strain(const ArcStiffness<T>& law, const T* e, T* h) {
  const T twist2 = 0.5 * (e[5] * e[5]);
  h[0] = e[0], h[1] = e[1], h[5] = e[5], h[6] = twist2;
  h[2] = e[2] + 0.5 * law.fibres * (e[0] * e[0] + e[1] * e[1]) + law.by_twist[0] * twist2;
  for (int i = 0; i < 2; ++i) h[3 + i] = e[3 + i] - law.fibres * (e[i] * e[5]) + law.by_twist[1 + i] * twist2;
}
/// dh/de at e where it is not that of e itself: of h2, h3 and h4 by the twist.
template <class T>
[[gnu::always_inline]] inline LaneVector<T> fibre_slopes(const ArcStiffness<T>& law, const T* e) {
  return {law.by_twist[0] * e[5], law.by_twist[1] * e[5] - law.fibres * e[0], law.by_twist[2] * e[5] - law.fibres * e[1]};
}
/// (dh/de)^T S at e: the forces and moments of the arc of those of its fibres.
template <class T>
[[gnu::always_inline]] inline void of_fibres(const ArcStiffness<T>& law, const LaneVector<T>& slopes, const T* e, const T* S, T* n) {
  for (int i = 0; i < 2; ++i) n[i] = S[i] + law.fibres * (e[i] * S[2] - e[5] * S[3 + i]);
  n[2] = S[2], n[3] = S[3], n[4] = S[4];
  n[5] = S[5] + slopes[0] * S[2] + slopes[1] * S[3] + slopes[2] * S[4];
}

/// d (L Gamma)/d a and d (L Gamma)/d p of f, k, a, p, w.
template <class T>
[[gnu::always_inline]] inline void strain_slopes(const T& f, const T& k, const LaneVector<T>& a, const LaneVector<T>& p,
                                                 const LaneVector<T>& w, Matrix<T>& by_a, Matrix<T>& by_p) {
  by_a = {}, by_p = {};
  const T half_f = 0.5 * f;
  add_skew(by_a, half_f, p), add_skew(by_a, T(-k), w), add_skew2(by_a, T(-k), a, p);
  add_skew(by_p, T(-half_f), a), add_skew2(by_p, k, a, a);
  for (int i = 0; i < 3; ++i) by_p.m[i][i] += 1;
}

/// L times the rates of the strains at m, x = J dm, where the measures change at the rates dm; with J, and E = dx/dm, where they are
/// wanted.
template <class T>
[[gnu::noinline]] void strain_rates(const Measures<T>& m, const Measures<T>& dm, T* x, T (*J)[n_measures], T (*E)[n_measures]) {
  const End<T> e(m);
  const TurnFunctions<T> turn = turning(e.c, e.c);
  Matrix<T> by_a, by_p;
  strain_slopes(turn.f1, turn.k1, e.a, e.p, e.w, by_a, by_p);
  const T dc = 0.5 * dm.t, half_f = 0.5 * turn.f1, half_f_c = 0.5 * turn.f1_c;
  LaneVector<T> by_c;
  for (int i = 0; i < 3; ++i) {
    by_c[i] = turn.k1_c * e.b[i] - half_f_c * e.w[i];
    x[i] = dc * by_c[i], x[3 + i] = turn.f1 * dm.a[i] + dc * (turn.f1_c * e.a[i]);
    for (int j = 0; j < 3; ++j) x[i] += by_a.m[i][j] * dm.a[j] + by_p.m[i][j] * dm.p[j];
  }
  if (!J) return;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      J[i][j] = by_a.m[i][j], J[i][4 + j] = by_p.m[i][j];
      J[3 + i][j] = i == j ? turn.f1 : T{}, J[3 + i][4 + j] = T{};
    }
    J[i][3] = 0.5 * by_c[i], J[3 + i][3] = half_f_c * e.a[i];
  }
  const LaneVector<T> dw = cross(dm.a, e.p) + cross(e.a, dm.p), db = cross(dm.a, e.w) + cross(e.a, dw);
  const T f_cc = 2. * turn.df_c, k_cc = 2. * turn.dk_c;  // of a divided difference, the slope by one of two equal places is half of it
  for (int i = 0; i < 3; ++i) {
    E[i][3] = 0.5 * (turn.k1_c * db[i] - half_f_c * dw[i] + dc * (k_cc * e.b[i] - 0.5 * (f_cc * e.w[i])));
    E[3 + i][3] = 0.5 * (turn.f1_c * dm.a[i] + dc * (f_cc * e.a[i]));
  }
  for (int j = 0; j < 3; ++j) {
    LaneVector<T> one{};
    one[j] = constant<T>(1);
    const LaneVector<T> wa = cross(one, e.p), wp = cross(e.a, one), dwa = cross(one, dm.p), dwp = cross(dm.a, one);
    const LaneVector<T> ba = cross(one, e.w) + cross(e.a, wa), bp = cross(e.a, wp);
    const LaneVector<T> dba = cross(dm.a, wa) + cross(one, dw) + cross(e.a, dwa), dbp = cross(dm.a, wp) + cross(e.a, dwp);
    for (int i = 0; i < 3; ++i) {
      E[i][j] = turn.k1 * dba[i] - half_f * dwa[i] + dc * (turn.k1_c * ba[i] - half_f_c * wa[i]);
      E[i][4 + j] = turn.k1 * dbp[i] - half_f * dwp[i] + dc * (turn.k1_c * bp[i] - half_f_c * wp[i]);
      E[3 + i][j] = i == j ? dc * turn.f1_c : T{}, E[3 + i][4 + j] = T{};
    }
  }
}

/// L times the strains at m and what dm changes of them to first order.
template <class T>
[[gnu::noinline]] void strain_ahead(const Measures<T>& m, const Measures<T>& dm, T* x) {
  T more[n_strains];
  strain(m, x);
  strain_rates<T>(m, dm, more, nullptr, nullptr);
  for (int i = 0; i < n_strains; ++i) x[i] += more[i];
}

/// Adds (dh/de)^T C* dh/de1 share, at the mean strains e from the left and at those of the end from the right, and what S has of second
/// derivatives, half_L times.
template <class T>
[[gnu::always_inline]] inline void add_fibre_slopes(const ArcStiffness<T>& law, const T* e, const T* e_end, const LaneVector<T>& left,
                                                    const T* S, const T& share, const T& half_L, T (*A)[n_strains]) {
  const LaneVector<T> right = fibre_slopes(law, e_end);
  T by_e[n_strains][n_strains], column[n_strains], out[n_strains];
  for (int i = 0; i < n_strains; ++i) of_fibres(law, right, e_end, law.C[i], by_e[i]);
  for (int j = 0; j < n_strains; ++j) {
    for (int i = 0; i < n_strains; ++i) column[i] = by_e[i][j];
    of_fibres(law, left, e, column, out);
    for (int i = 0; i < n_strains; ++i) A[i][j] += share * out[i];
  }
  A[5][5] += share * (law.warp * e[5] * e_end[5]);
  const T of_fibre = half_L * law.fibres;
  for (int i = 0; i < 2; ++i) A[i][i] += of_fibre * S[2], A[i][5] -= of_fibre * S[3 + i], A[5][i] -= of_fibre * S[3 + i];
  A[5][5] += half_L * (law.by_twist[0] * S[2] + law.by_twist[1] * S[3] + law.by_twist[2] * S[4] + S[6]);
}

/// What an element has over a step: L times the strains at both ends, and the forces and moments.
template <class T>
struct Resultants {
  T x0[n_strains], x1[n_strains], n[n_strains];
};

/// The forces s and, where D is wanted, ds/de1, set: by the resultants (dh/deps)^T C* elastic (mean h - reference) + C* rate (eps1 -
/// eps0 - recalled).
/// `recalled`: L times strains; null: none.  `ahead`: L times strains that take the place of their mean; null: none.
template <class T>
[[gnu::always_inline]] inline void respond(const ArcStiffness<T>& law, const Measures<T>& m0, const Measures<T>& m1, double elastic,
                                           const T& rate, const T* recalled, const T* ahead, Resultants<T>& r, T* s, T (*D)[n_measures]) {
  const End<T> e0(m0), e1(m1);
  const TurnFunctions<T> turn = turning(e0.c, e1.c);
  e0.strain(turn.f0, turn.k0, r.x0), e1.strain(turn.f1, turn.k1, r.x1);
  const T by_L = 1 / law.length, rate_L = rate * by_L;
  T change[n_strains];
  for (int i = 0; i < n_strains; ++i) change[i] = rate_L * (r.x1[i] - r.x0[i] - (recalled ? recalled[i] : T{}));
  for (int i = 0; i < n_strains; ++i) {
    r.n[i] = law.C[i][0] * change[0];
    for (int j = 1; j < n_strains; ++j) r.n[i] += law.C[i][j] * change[j];
  }
  T e[n_strains], e_end[n_strains], S[n_strains + 1];  // mean strains, those at the end; forces and moments of fibres
  LaneVector<T> slopes;
  if (elastic != 0) {
    T h[n_strains + 1], h_end[n_strains + 1], elastic_n[n_strains];
    for (int i = 0; i < n_strains; ++i) {
      e[i] = (0.5 * by_L) * (r.x0[i] + r.x1[i]), e_end[i] = by_L * r.x1[i];
      elastic_n[i] = by_L * (ahead ? ahead[i] : r.x0[i]);
    }
    fibre_strain(law, elastic_n, h);
    if (!ahead) fibre_strain(law, e_end, h_end);
    for (int i = 0; i <= n_strains; ++i) h[i] = elastic * ((ahead ? h[i] : 0.5 * (h[i] + h_end[i])) - law.reference[i]);
    for (int i = 0; i < n_strains; ++i) {
      S[i] = law.C[i][0] * h[0];
      for (int j = 1; j < n_strains; ++j) S[i] += law.C[i][j] * h[j];
    }
    S[6] = law.warp * h[6];
    slopes = fibre_slopes(law, e);
    of_fibres(law, slopes, e, S, elastic_n);
    elastic_n[5] += e[5] * S[6];
    for (int i = 0; i < n_strains; ++i) r.n[i] += elastic_n[i];
  }
  const LaneVector<T> N{r.n[0], r.n[1], r.n[2]}, M{r.n[3], r.n[4], r.n[5]};

  const LaneVector<T> a = mean(e0.a, e1.a), p = mean(e0.p, e1.p), w = mean(e0.w, e1.w), b = mean(e0.b, e1.b);
  const T f = 0.5 * (turn.f0 + turn.f1), k = 0.5 * (turn.k0 + turn.k1);
  const LaneVector<T> aN = cross(a, N), Np = cross(N, p), wN = cross(w, N) - cross(p, aN), aaN = cross(a, aN);
  const T bN = dot(b, N), wdN = dot(w, N), aM = dot(a, M);
  for (int i = 0; i < 3; ++i) {
    s[i] = 0.5 * (f * Np[i]) + k * wN[i] + f * M[i];
    s[4 + i] = N[i] + 0.5 * (f * aN[i]) + k * aaN[i];
  }
  s[3] = 0.5 * (turn.dk * bN - 0.5 * (turn.df * wdN) + turn.df * aM);
  if (!D) return;

  // of the discrete gradient, at the resultants as they are
  const T k_half = 0.5 * k, f_quarter = 0.25 * f, fc = 0.25 * turn.f1_c, kc = 0.25 * turn.k1_c;
  Matrix<T> aa{}, ap{}, pa{};
  add_skew2(aa, k_half, N, e1.p), add_skew2(aa, k_half, p, N);
  add_skew(ap, f_quarter, N), add_skew2(ap, T(-k_half), N, e1.a), add_skew(ap, k_half, aN);
  add_skew(pa, T(-f_quarter), N), add_skew(pa, T(-k_half), aN), add_skew2(pa, T(-k_half), a, N);
  const LaneVector<T> Na = cross(N, e1.a), pN = cross(e1.p, N);
  const LaneVector<T> of_b = cross(e1.w, N) + cross(e1.p, Na), aNa = cross(e1.a, Na);
  const T dk_quarter = 0.25 * turn.dk, df_quarter = 0.25 * turn.df, df_eighth = 0.125 * turn.df;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      D[i][j] = aa.m[i][j], D[i][4 + j] = ap.m[i][j];
      D[4 + i][j] = pa.m[i][j], D[4 + i][4 + j] = T{};
    }
    D[i][3] = fc * (0.5 * Np[i] + M[i]) + kc * wN[i];
    D[4 + i][3] = fc * (0.5 * aN[i]) + kc * aaN[i];
    D[3][i] = dk_quarter * of_b[i] - df_eighth * pN[i] + df_quarter * M[i];
    D[3][4 + i] = -dk_quarter * aNa[i] - df_eighth * Na[i];
  }
  D[3][3] = 0.25 * (turn.dk_c * bN - 0.5 * (turn.df_c * wdN) + turn.df_c * aM);

  // of the resultants: the discrete gradient B from the left, C* and the slopes of the strains at the second end from the right
  Matrix<T> Ba, Bp, Ja, Jp;
  strain_slopes(f, k, a, p, w, Ba, Bp);
  strain_slopes(turn.f1, turn.k1, e1.a, e1.p, e1.w, Ja, Jp);
  const T f1_t = 0.5 * turn.f1_c, k1_t = 0.5 * turn.k1_c, dk_half = 0.5 * turn.dk, df_half = 0.5 * turn.df;
  LaneVector<T> Bt, Jt;
  for (int i = 0; i < 3; ++i) {
    Bt[i] = dk_half * b[i] - 0.5 * (df_half * w[i]);
    Jt[i] = k1_t * e1.b[i] - 0.5 * (f1_t * e1.w[i]);
  }
  T A[n_strains][n_strains];  // dn/dx1
  for (int i = 0; i < n_strains; ++i)
    for (int j = 0; j < n_strains; ++j) A[i][j] = rate_L * law.C[i][j];
  if (elastic != 0) add_fibre_slopes(law, e, e_end, slopes, S, T((0.5 * elastic) * by_L), T(0.5 * by_L), A);
  T CJ[n_strains][n_measures];
  for (int i = 0; i < n_strains; ++i) {
    const T* c = A[i];
    for (int j = 0; j < 3; ++j) {
      CJ[i][j] = c[0] * Ja.m[0][j] + c[1] * Ja.m[1][j] + c[2] * Ja.m[2][j] + turn.f1 * c[3 + j];
      CJ[i][4 + j] = c[0] * Jp.m[0][j] + c[1] * Jp.m[1][j] + c[2] * Jp.m[2][j];
    }
    CJ[i][3] = c[0] * Jt[0] + c[1] * Jt[1] + c[2] * Jt[2] + f1_t * (c[3] * e1.a[0] + c[4] * e1.a[1] + c[5] * e1.a[2]);
  }
  for (int j = 0; j < n_measures; ++j) {
    const T n0 = CJ[0][j], n1 = CJ[1][j], n2 = CJ[2][j];
    for (int i = 0; i < 3; ++i) {
      D[i][j] += Ba.m[0][i] * n0 + Ba.m[1][i] * n1 + Ba.m[2][i] * n2 + f * CJ[3 + i][j];
      D[4 + i][j] += Bp.m[0][i] * n0 + Bp.m[1][i] * n1 + Bp.m[2][i] * n2;
    }
    D[3][j] += Bt[0] * n0 + Bt[1] * n1 + Bt[2] * n2 + df_half * (a[0] * CJ[3][j] + a[1] * CJ[4][j] + a[2] * CJ[5][j]);
  }
}

/// The forces of C* rate times the rates of the strains, at m where the measures change at the rates dm; with the slopes by m, and those by
/// dm, where they are wanted.
template <class T>
[[gnu::noinline]] void respond_to_rates(const ArcStiffness<T>& law, const Measures<T>& m, const Measures<T>& dm, const T& rate, T* s,
                                        T (*by_m)[n_measures], T (*by_dm)[n_measures]) {
  T x[n_strains], back[n_strains], J[n_strains][n_measures], E[n_strains][n_measures];
  strain_rates(m, dm, x, by_m ? J : nullptr, by_m ? E : nullptr);
  for (int i = 0; i < n_strains; ++i) back[i] = -x[i];
  Resultants<T> r;
  respond(law, m, m, 0, rate, back, static_cast<const T*>(nullptr), r, s, by_m ? by_dm : nullptr);
  if (!by_m) return;
  // D is half of what the slopes of J do at these resultants and rate J^T C* J; with -rate and -x it has the latter's opposite
  T same[n_measures];
  respond(law, m, m, 0, T(-rate), x, static_cast<const T*>(nullptr), r, same, by_m);
  const T rate_L = rate / law.length;
  for (int j = 0; j < n_measures; ++j) {
    T n[n_strains];
    for (int i = 0; i < n_strains; ++i) {
      n[i] = law.C[i][0] * E[0][j];
      for (int k = 1; k < n_strains; ++k) n[i] += law.C[i][k] * E[k][j];
    }
    for (int i = 0; i < n_measures; ++i) {
      const T both = by_dm[i][j] + by_m[i][j];
      by_dm[i][j] = 0.5 * (by_dm[i][j] - by_m[i][j]), by_m[i][j] = both;
      for (int k = 0; k < n_strains; ++k) by_m[i][j] += rate_L * (J[k][i] * n[k]);
    }
  }
}

/// The same at the mean strains `ahead` (L times them), apart as strain_ahead is.
template <class T>
[[gnu::noinline]] void respond_ahead(const ArcStiffness<T>& law, const Measures<T>& m, double elastic, const T* ahead, T* s,
                                     T (*D)[n_measures]) {
  Resultants<T> r;
  respond(law, m, m, elastic, T{}, static_cast<const T*>(nullptr), ahead, r, s, D);
}

}  // namespace hilo::arc
