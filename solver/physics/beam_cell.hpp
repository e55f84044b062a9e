// SPDX-License-Identifier: GPL-3.0-or-later
// Forces and tangent of an arc element, for a number or one number in each lane: everything by the points of its two sections,
// y = (c, d1, d2, d3) of A and of B, which bodies carry at constant arms.
//
// Forces on the points have the second derivatives S_ij I, of the measures and of the mass, and with the levers l_i of the points (arm of
// c, d itself) the tangent of bodies is
//   G^T D G + sum_ij L_i^T S_ij L_j + slope sum_i [F_i]x [l_i]x,   L_c = (I, -[l]x),  L_d = (0, -[l]x)
// where [l]x [m]x = m l^T - l.m I makes sums of vectors of what would be products of matrices.
#pragma once
#include "physics/beam_kernel.hpp"
#include "physics/beam_strain.hpp"

namespace hilo::arc {

/// What a cell has for good.
template <class T>
struct ArcCell {
  LaneVector<T> arm[2], axis[2][3];  // of the sections, in axes of their bodies [m, 1]
  ArcStiffness<T> law;
  T linked[4][4];  // mass of c_A, d3_A, c_B, d3_B [kg, kg m, kg m^2]
  T across[3];     // a twelfth of L times J11, J22 and J12 [kg m^2]
  T alpha, beta;   // [1/s], [s]
};
/// A body's centre and directors, or rates of these.
template <class T>
struct BodyPose {
  LaneVector<T> c, R[3];
};

/// The points of both sections, and the arms of their origins.
template <class T>
struct SectionPoints {
  LaneVector<T> y[8], arm[2];
  const LaneVector<T>& lever(int i) const { return i % 4 == 0 ? arm[i / 4] : y[i]; }
};
template <class T>
[[gnu::always_inline]] inline LaneVector<T> turned(const BodyPose<T>& q, const LaneVector<T>& r) {
  LaneVector<T> out = r[0] * q.R[0];
  add_to(out, r[1], q.R[1]), add_to(out, r[2], q.R[2]);
  return out;
}
template <class T>
[[gnu::always_inline]] inline void points_of(const ArcCell<T>& cell, const BodyPose<T>* q, SectionPoints<T>& out) {
  for (int e = 0; e < 2; ++e) {
    out.arm[e] = turned(q[e], cell.arm[e]);
    out.y[4 * e] = q[e].c + out.arm[e];
    for (int i = 0; i < 3; ++i) out.y[4 * e + 1 + i] = turned(q[e], cell.axis[e][i]);
  }
}

template <class T>
[[gnu::always_inline]] inline Measures<T> measures_of(const LaneVector<T>* y) {
  const LaneVector<T>*A = y + 1, *B = y + 5, way = y[4] - y[0];
  Measures<T> m;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    m.a[i] = 0.5 * (dot(A[k], B[j]) - dot(A[j], B[k]));
    m.p[i] = dot(A[i], way);
  }
  m.t = dot(A[0], B[0]) + dot(A[1], B[1]) + dot(A[2], B[2]);
  return m;
}

/// How fast the measures change at rates dy of the points.
template <class T>
[[gnu::always_inline]] inline Measures<T> rates_of(const LaneVector<T>* y, const LaneVector<T>* dy) {
  const LaneVector<T>*A = y + 1, *B = y + 5, *dA = dy + 1, *dB = dy + 5, way = y[4] - y[0], dway = dy[4] - dy[0];
  Measures<T> m;
  m.t = T{};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    m.a[i] = 0.5 * (dot(dA[k], B[j]) + dot(A[k], dB[j]) - dot(dA[j], B[k]) - dot(A[j], dB[k]));
    m.p[i] = dot(dA[i], way) + dot(A[i], dway);
    m.t += dot(dA[i], B[i]) + dot(A[i], dB[i]);
  }
  return m;
}

/// Gradients of the measures by the turns of both bodies, and of p by the way of B; by the way of A it is the opposite.
template <class T>
struct Gradient {
  LaneVector<T> turn[n_measures][2], way[3];
};
/// At points y; `l` are those whose levers turn.
template <class T>
[[gnu::always_inline]] inline void gradient(const SectionPoints<T>& at, const SectionPoints<T>& l, Gradient<T>& g) {
  const LaneVector<T>*A = at.y + 1, *B = at.y + 5, *LA = l.y + 1, *LB = l.y + 5, way = at.y[4] - at.y[0];
  g.turn[3][0] = cross(LA[0], B[0]) + cross(LA[1], B[1]) + cross(LA[2], B[2]);
  g.turn[3][1] = cross(LB[0], A[0]) + cross(LB[1], A[1]) + cross(LB[2], A[2]);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    g.turn[i][0] = 0.5 * (cross(LA[k], B[j]) - cross(LA[j], B[k]));
    g.turn[i][1] = 0.5 * (cross(LB[j], A[k]) - cross(LB[k], A[j]));
    g.way[i] = A[i];
    g.turn[4 + i][0] = cross(LA[i], way) - cross(l.arm[0], A[i]);
    g.turn[4 + i][1] = cross(l.arm[1], A[i]);
  }
}

/// Adds s dy to the forces on the points.
template <class T>
[[gnu::always_inline]] inline void add_forces(const LaneVector<T>* y, const T* s, LaneVector<T>* F) {
  const LaneVector<T>*A = y + 1, *B = y + 5, way = y[4] - y[0];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const T h = 0.5 * s[i];
    add_to(F[1 + k], h, B[j]), add_to(F[5 + j], h, A[k]);
    add_to(F[1 + j], T(-h), B[k]), add_to(F[5 + k], T(-h), A[j]);
    add_to(F[1 + i], s[3], B[i]), add_to(F[5 + i], s[3], A[i]);
    add_to(F[1 + i], s[4 + i], way);
    add_to(F[0], T(-s[4 + i]), A[i]), add_to(F[4], s[4 + i], A[i]);
  }
}
/// Adds their second derivatives times `f`.
template <class T>
[[gnu::always_inline]] inline void add_second(const T* s, double f, T (*S)[8]) {
  const auto both = [&](int i, int j, const T& x) { S[i][j] += x, S[j][i] += x; };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const T h = (0.5 * f) * s[i], p = f * s[4 + i];
    both(1 + k, 5 + j, h), both(1 + j, 5 + k, T(-h)), both(1 + i, 5 + i, f * s[3]);
    both(1 + i, 0, T(-p)), both(1 + i, 4, p);
  }
}

inline constexpr int linked_points[] = {0, 3, 4, 7};
/// Inertia of accelerations on the points, added.
template <class T>
[[gnu::always_inline]] inline void add_inertia(const ArcCell<T>& cell, const LaneVector<T>* a, LaneVector<T>* F) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) add_to(F[linked_points[i]], cell.linked[i][j], a[linked_points[j]]);
  const LaneVector<T> one[2] = {5. * a[1] + a[5], a[1] + 5. * a[5]}, two[2] = {5. * a[2] + a[6], a[2] + 5. * a[6]};
  for (int e = 0; e < 2; ++e) {
    add_to(F[4 * e + 1], cell.across[0], one[e]), add_to(F[4 * e + 1], cell.across[2], two[e]);
    add_to(F[4 * e + 2], cell.across[2], one[e]), add_to(F[4 * e + 2], cell.across[1], two[e]);
  }
}
/// The mass on the points times f, added.
template <class T>
[[gnu::always_inline]] inline void add_mass(const ArcCell<T>& cell, const T& f, T (*S)[8]) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) S[linked_points[i]][linked_points[j]] += f * cell.linked[i][j];
  for (const int a : {0, 4})
    for (const int b : {0, 4}) {
      const T share = (a == b ? 5. : 1.) * f;
      S[a + 1][b + 1] += share * cell.across[0], S[a + 2][b + 2] += share * cell.across[1];
      S[a + 1][b + 2] += share * cell.across[2], S[a + 2][b + 1] += share * cell.across[2];
    }
}

/// K += f left^T D right, over translation and turn of A, of B.
template <class T>
[[gnu::always_inline]] inline void add_stiffness(const T (*D)[n_measures], double f, const Gradient<T>& left, const Gradient<T>& right,
                                                 T* K) {
  const auto column = [&](const T* x, int to, int opposite) {  // x = f D right of a column
    for (int i = 0; i < 3; ++i) {
      T way = left.way[0][i] * x[4] + left.way[1][i] * x[5] + left.way[2][i] * x[6], A = left.turn[0][0][i] * x[0],
        B = left.turn[0][1][i] * x[0];
      for (int m = 1; m < n_measures; ++m) A += left.turn[m][0][i] * x[m], B += left.turn[m][1][i] * x[m];
      K[12 * i + to] -= way, K[12 * (3 + i) + to] += A, K[12 * (6 + i) + to] += way, K[12 * (9 + i) + to] += B;
      if (opposite < 0) continue;
      K[12 * i + opposite] += way, K[12 * (3 + i) + opposite] -= A, K[12 * (6 + i) + opposite] -= way, K[12 * (9 + i) + opposite] -= B;
    }
  };
  T x[n_measures];
  for (int c = 0; c < 3; ++c) {
    for (int m = 0; m < n_measures; ++m) x[m] = f * (D[m][4] * right.way[0][c] + D[m][5] * right.way[1][c] + D[m][6] * right.way[2][c]);
    column(x, 6 + c, c);
    for (int e = 0; e < 2; ++e) {
      for (int m = 0; m < n_measures; ++m) {
        x[m] = D[m][0] * right.turn[0][e][c];
        for (int n = 1; n < n_measures; ++n) x[m] += D[m][n] * right.turn[n][e][c];
        x[m] = f * x[m];
      }
      column(x, 6 * e + 3 + c, -1);
    }
  }
}

/// K += sum_ij L_i^T S_ij L_j + slope sum_i [F_i]x [l_i]x, levers of the left and of the end.
template <class T>
[[gnu::always_inline]] inline void add_points(const T (*S)[8], const LaneVector<T>* F, double slope, const SectionPoints<T>& left,
                                              const SectionPoints<T>& end, T* K) {
  const auto skew = [&](int row, int column, const LaneVector<T>& a) {
    T* k = K + 12 * row + column;
    k[1] -= a[2], k[12] += a[2], k[2] += a[1], k[24] -= a[1], k[14] -= a[0], k[25] += a[0];
  };
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      Matrix<T> X{};
      LaneVector<T> of_left{};  // sum_i S_ic l_i
      for (int i = 4 * a; i < 4 * a + 4; ++i) {
        LaneVector<T> u{};  // sum_j S_ij l_j
        for (int j = 4 * b; j < 4 * b + 4; ++j) add_to(u, S[i][j], end.lever(j));
        const LaneVector<T>& l = left.lever(i);
        add_to(of_left, S[i][4 * b], l);
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) X.m[r][c] -= u[r] * l[c];
        if (i == 4 * a) skew(6 * a, 6 * b + 3, -1. * u);
        if (a != b) continue;
        const LaneVector<T> f = slope * F[i];
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) X.m[r][c] += end.lever(i)[r] * f[c];
      }
      const T trace = X.m[0][0] + X.m[1][1] + X.m[2][2];
      skew(6 * a + 3, 6 * b, of_left);
      for (int r = 0; r < 3; ++r) {
        K[12 * (6 * a + r) + 6 * b + r] += S[4 * a][4 * b];
        for (int c = 0; c < 3; ++c) K[12 * (6 * a + 3 + r) + 6 * b + 3 + c] += X.m[r][c];
        K[12 * (6 * a + 3 + r) + 6 * b + 3 + r] -= trace;
      }
    }
}

/// One call: see ArcCall.
template <class T>
inline void run(const ArcCall& call) {
  const auto lanes_of = [](const double* p) { return reinterpret_cast<const T*>(p); };
  const auto pose_of = [](const double* p) { return reinterpret_cast<const BodyPose<T>*>(p); };
  const ArcCell<T>& cell = *reinterpret_cast<const ArcCell<T>*>(call.cells);
  T *f = reinterpret_cast<T*>(call.f), *K = reinterpret_cast<T*>(call.K);
  const auto points_at = [&](const double* q) {
    SectionPoints<T> at;
    points_of(cell, pose_of(q), at);
    return at;
  };
  const SectionPoints<T> left = points_at(call.left);
  SectionPoints<T> end;
  if (K) {
    end = points_at(call.end);
    for (int i = 0; i < 144; ++i) K[i] = T{};
  }
  Gradient<T> g;
  if (K) gradient(left, left, g);

  // Newton on measures and resultants as independent unknowns, of which the resultants are eliminated (physics/solid_stress has why)
  T x_ahead[n_strains];
  const bool foresees = K && call.before;
  if (foresees) {
    const SectionPoints<T> before = points_at(call.before), along = points_at(call.along);
    strain_ahead(measures_of(before.y), rates_of(before.y, along.y), x_ahead);
  }

  T s_all[n_measures]{}, s_change[n_measures]{};  // and what the foreseen resultants change of it in the tangent
  const auto add_slopes = [&](const T(*D)[n_measures], double slope, const SectionPoints<T>& at) {
    Gradient<T> right;
    gradient(at, end, right);
    add_stiffness(D, slope, g, right, K);
  };
  for (int n = 0; n < call.n_pairs; ++n) {
    const ArcCall::Pair& pair = call.pairs[n];
    T s_pair[n_measures], D_pair[n_measures][n_measures];
    const T* s = s_pair;
    const T(*D)[n_measures] = D_pair;
    double slope = pair.slope;
    SectionPoints<T> at1;
    const bool at_end = K && pair.q1 == call.end;
    if (!at_end) points_of(cell, pose_of(pair.q1), at1);
    const SectionPoints<T>& p1 = at_end ? end : at1;
    if (pair.is_instant) {
      const SectionPoints<T> p0 = points_at(pair.q0);
      const Measures<T> m0 = measures_of(p0.y), m1 = measures_of(p1.y);
      T D_rate[n_measures][n_measures];
      respond_to_rates(cell.law, measures_of(left.y), {m1.a - m0.a, m1.t - m0.t, m1.p - m0.p}, T(pair.by_beta * cell.beta), s_pair,
                       K ? D_pair : nullptr, D_rate);
      for (int m = 0; m < n_measures; ++m) s_all[m] += s_pair[m];
      if (K) add_slopes(D_pair, call.slope, left), add_slopes(D_rate, slope, p1), add_slopes(D_rate, -pair.slope0, p0);
      continue;
    }
    if (pair.s) {
      s = lanes_of(pair.s), D = reinterpret_cast<const T(*)[n_measures]>(pair.D);
    } else {
      Measures<T> m1 = measures_of(p1.y), m0 = m1;
      if (pair.q0 != pair.q1) m0 = measures_of(points_at(pair.q0).y);
      if (pair.mean) {
        const double w = pair.weight;
        const double by0 = pair.end_slopes ? 2 * (1 - w) : 1 - w, by1 = pair.end_slopes ? 2 * w - 1 : w;  // m1 stays: 2 mean - m1
        for (int i = 0; i < 3; ++i) m0.a[i] = by0 * m0.a[i] + by1 * m1.a[i], m0.p[i] = by0 * m0.p[i] + by1 * m1.p[i];
        m0.t = by0 * m0.t + by1 * m1.t;
        if (!pair.end_slopes) m1 = m0;
        slope *= 2 * w;  // so far the derivative by the second argument alone
      }
      T recalled[n_strains];
      const bool recalls = pair.past[0] != nullptr;
      if (recalls) {
        T x[3][n_strains];
        for (int k = 0; k < 3; ++k) strain(measures_of(points_at(k == 0 ? pair.q0 : pair.past[k - 1]).y), x[k]);
        for (int i = 0; i < n_strains; ++i) recalled[i] = pair.recall[0] * (x[0][i] - x[1][i]) + pair.recall[1] * (x[1][i] - x[2][i]);
      }
      const T rate = pair.by_beta * cell.beta + pair.kappa;
      Resultants<T> r;
      const bool ahead = foresees && pair.q0 == pair.q1;
      respond(cell.law, m0, m1, pair.elastic, rate, recalls ? recalled : nullptr, static_cast<const T*>(nullptr), r, s_pair,
              K && !ahead ? D_pair : nullptr);
      if (ahead) {
        T s_ahead[n_measures];
        respond_ahead(cell.law, m1, pair.elastic, x_ahead, s_ahead, D_pair);
        for (int m = 0; m < n_measures; ++m) s_change[m] += s_ahead[m] - s_pair[m];
      }
    }
    if (pair.acts)
      for (int m = 0; m < n_measures; ++m) s_all[m] += s[m];
    if (K && slope != 0) add_slopes(D, slope, p1);
  }

  LaneVector<T> F[8]{}, inertia[8]{};
  add_forces(left.y, s_all, F);
  LaneVector<T> y[8];  // accelerations of the points, with weight and drag
  {
    BodyPose<T> rates[2] = {pose_of(call.a)[0], pose_of(call.a)[1]};
    for (int e = 0; e < 2; ++e)
      for (int i = 0; i < 3; ++i) {
        rates[e].c[i] -= call.gravity[i];
        if (!call.v) continue;
        const BodyPose<T>& v = pose_of(call.v)[e];
        rates[e].c[i] += cell.alpha * v.c[i];
        for (int k = 0; k < 3; ++k) rates[e].R[k][i] += cell.alpha * v.R[k][i];
      }
    SectionPoints<T> of_rates;
    points_of(cell, rates, of_rates);
    for (int i = 0; i < 8; ++i) y[i] = of_rates.y[i];
  }
  add_inertia(cell, y, inertia);
  if (call.line_F)
    for (int i = 0; i < 8; ++i) {
      inertia[i] = inertia[i] - reinterpret_cast<const LaneVector<T>*>(call.line_F)[i];
      for (int j = 0; j < 8; ++j) add_to(inertia[i], T(-lanes_of(call.line_K)[8 * i + j]), left.y[j]);
    }
  T* scale2 = reinterpret_cast<T*>(call.scale2);
  for (int e = 0; e < 2; ++e) scale2[2 * e] = dot(F[4 * e], F[4 * e]), scale2[2 * e + 1] = dot(inertia[4 * e], inertia[4 * e]);
  for (int e = 0; e < 2; ++e) {
    LaneVector<T> moment{};
    for (int i = 4 * e; i < 4 * e + 4; ++i) F[i] = F[i] + inertia[i], moment = moment + cross(left.lever(i), F[i]);
    for (int i = 0; i < 3; ++i) f[6 * e + i] = F[4 * e][i], f[6 * e + 3 + i] = moment[i];
  }
  if (!K) return;
  if (foresees) {
    add_forces(left.y, s_change, F);
    for (int m = 0; m < n_measures; ++m) s_all[m] += s_change[m];
  }
  T S[8][8]{};
  add_second(s_all, call.slope, S);
  add_mass(cell, T(call.alpha_slope * cell.alpha + call.mass_slope), S);
  if (call.line_K)
    for (int i = 0; i < 64; ++i) S[i / 8][i % 8] -= call.slope * lanes_of(call.line_K)[i];
  add_points(S, F, call.slope, left, end, K);
}

}  // namespace hilo::arc
