// SPDX-License-Identifier: GPL-3.0-or-later
// Nearly incompressible cells: what Poisson's ratio has above a bound acts on the mean dilatation of the cell, not at every point of it.
// Pressures that differ from point to point are more conditions than the nodes can meet, and the cell locks.
//
//   lambda = lambda_p + lambda_m,   lambda_p = the value at the same mu and the bound nu_p;   points have (lambda_p, mu), and the cell
//   U = V lambda_m/2 theta^2,   theta = mean of tr E     where the law has lambda/2 (tr E)^2
//   U = V lambda_m U(D),        D = mean of det C        where it has lambda U(det C) (material/dilatation.hpp)
//
// The rest at points keeps bending stiff where one cell is all there is across it.  tr E is quadratic in positions and det C1 - det C0 =
// A:(C1 - C0) exactly, so their means have exact discrete gradients and energy-momentum is kept.  Rate terms: lambda_m of the linear moduli
// on theta.  At nu_p and below nothing changes.
#pragma once
#include "physics/material/dilatation.hpp"
#include "physics/solid.hpp"

namespace hilo {

/// nu_p of a shape [1]: the largest for which it is within 2 % at nu = .4999 in bending, one cell high (docs/elements.md); 1/2 for shapes
/// of one point, whose dilatation is its mean already.
template <class S>
inline constexpr double pointwise_nu = S::n_points == 1          ? 0.5
                                       : S::n == 10 || S::n == 6 ? 0.40
                                                                 : 0.45;

/// lambda_m [Pa]; lambda_p is the rest.  Where a hexahedron of eight nodes flows all of the bulk modulus acts on the mean: flow keeps the
/// volume, and eight points would be more conditions than its nodes can meet [nagtegaal-1974].
template <class S, class Bulk, bool flows = false>
constexpr double mean_lambda(const Lame& c) {
  if constexpr (std::is_same_v<Bulk, NoBulk>) return 0;
  if constexpr (flows && S::n == 8) return c.lambda + 2 * c.mu / 3;
  constexpr double nu = pointwise_nu<S>;
  if constexpr (nu >= 0.5) return 0;
  const double most = 2 * c.mu * nu / (1 - 2 * nu);
  return c.lambda > most * (1 + 1e-12) ? c.lambda - most : 0;
}

/// The law of the points.
template <class M>
inline M without_mean(const M& law, double lambda_m) {
  if constexpr (requires { law.with_lambda(0.0); })
    return law.with_lambda(law.linear().lambda - lambda_m);
  else
    return law;
}

/// Stress of the mean at a point: S = theta I + 2 D A, A the gradient of det C over the step; a law for solid::add_point.
template <class T>
struct MeanStress {
  T theta, D;  // derivatives of the energy density by theta and by the mean of det C [Pa]

  T energy(const T e[6]) const { return 0 * e[0]; }
  void stress(const T e0[6], const T e1[6], T s[6], T (*tangent)[6]) const {
    T M[6], A[6], cof1[6], D0, D1;
    volume::over_step(e0, e1, M, A, cof1, D0, D1);
    for (int i = 0; i < 3; ++i) s[i] = theta + 2 * D * A[i], s[i + 3] = 2 * D * A[i + 3];
    if (tangent) volume::add_cofactor_slope(M, T(4 * D), tangent);
  }
};

/// Adds the energy of the mean to f, K, energy and dissipated (conventions of SolidCall); `lambda` is lambda_m.
template <class S, class Bulk, class T>
inline void add_mean_dilatation(double lambda, const SolidCall<T>& c) {
  constexpr int n = S::n, n3 = 3 * n;
  constexpr bool by_trace = std::is_same_v<Bulk, SquareOfTrace>;
  const double w = c.weight;
  const T zero = 0 * c.X[0];
  T size = zero, theta0 = zero, theta1 = zero, D0 = zero, D1 = zero, D_end = zero;
  T theta_m[n3], theta_1[n3], D_m[n3], D_1[n3];  // gradients of the sums over the points: at the middle, and that by x1
  for (int i = 0; i < n3; ++i) theta_m[i] = theta_1[i] = D_m[i] = D_1[i] = zero;
  const auto add_gradient = [](const T F[3][3], const T s[6], const T(*g)[3], const T& weight, T* f) {
    for (int i = 0; i < 3; ++i) {
      const T P[3] = {weight * (F[i][0] * s[0] + F[i][1] * s[5] + F[i][2] * s[4]),
                      weight * (F[i][0] * s[5] + F[i][1] * s[1] + F[i][2] * s[3]),
                      weight * (F[i][0] * s[4] + F[i][1] * s[3] + F[i][2] * s[2])};
      for (int a = 0; a < n; ++a) f[3 * a + i] += P[0] * g[a][0] + P[1] * g[a][1] + P[2] * g[a][2];
    }
  };
  for (int p = 0; p < S::n_points; ++p) {
    T g[n][3], F0[3][3], F1[3][3], Fm[3][3], e0[6], e1[6];
    const T weight = solid::point_gradients<S>(p, c.X, g);
    solid::gradient<n>(c.x0, g, F0);
    solid::gradient<n>(c.x1, g, F1);
    solid::green_lagrange(F0, e0);
    solid::green_lagrange(F1, e1);
    size += weight, theta0 += weight * (e0[0] + e0[1] + e0[2]), theta1 += weight * (e1[0] + e1[1] + e1[2]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) Fm[i][j] = (1 - w) * F0[i][j] + w * F1[i][j];
    if (c.K) {
      const T one = 1 + zero, unit[6] = {one, one, one, zero, zero, zero};
      add_gradient(Fm, unit, g, weight, theta_m);
      add_gradient(F1, unit, g, weight, theta_1);
    }
    if constexpr (!by_trace) {
      T M[6], A[6], cof1[6], d0, d1;
      const T J = solid::determinant(F1);
      D_end += weight * J * J;
      if (w != 0.5)
        for (int i = 0; i < 6; ++i) e0[i] = e1[i] = (1 - w) * e0[i] + w * e1[i];
      volume::over_step(e0, e1, M, A, cof1, d0, d1);
      D0 += weight * d0, D1 += weight * d1;
      if (c.K) {
        add_gradient(Fm, A, g, T(2 * weight), D_m);
        add_gradient(F1, cof1, g, T(2 * weight), D_1);
      }
    }
  }
  theta0 = theta0 / size, theta1 = theta1 / size;
  T from = theta0;
  if (c.viscous != 0)
    solid::add_recalled<1>(c, &from, [&](const T* x, T* to) {
      *to = zero;
      for (int p = 0; p < S::n_points; ++p) {
        T g[n][3], F[3][3], e[6];
        const T weight = solid::point_gradients<S>(p, c.X, g);
        solid::gradient<n>(x, g, F);
        solid::green_lagrange(F, e);
        *to += weight * (e[0] + e[1] + e[2]) / size;
      }
    });
  const T rate = lambda * c.viscous * (theta1 - from);
  MeanStress<T> mean{rate, zero};
  if (c.dissipated) *c.dissipated += size * rate * (theta1 - theta0);
  double slope_theta = lambda * c.viscous;
  T slope_D = zero;
  if constexpr (by_trace) {
    mean.theta += lambda * c.elastic * ((1 - w) * theta0 + w * theta1);
    slope_theta += lambda * c.elastic * w;
    if (c.energy) *c.energy += size * (lambda / 2) * theta1 * theta1;
  } else {
    D0 = D0 / size, D1 = D1 / size;
    if (c.elastic != 0) {
      Bulk::quotient(D0, D1, mean.D, slope_D);
      mean.D *= lambda * c.elastic, slope_D *= lambda * c.elastic * (w == 0.5 ? 1 : 2 * w);
    }
    if (c.energy) *c.energy += size * lambda * Bulk::energy(T(D_end / size));
  }
  SolidCall<T> stress_only = c;
  stress_only.elastic = 1, stress_only.viscous = 0;
  stress_only.energy = stress_only.dissipated = stress_only.least_det = nullptr;
  MeanStress<T> foreseen = mean;  // by the last correction to first order, for K (solid::foresee)
  if (c.before && c.K) {
    T theta = zero, by_theta = zero, start = zero, to = zero, by = zero;
    for (int p = 0; p < S::n_points; ++p) {
      T g[n][3], F0[3][3], e0[6], e1[6], step[6];
      const T weight = solid::point_gradients<S>(p, c.X, g);
      solid::strain_along<n>(c, g, e1, step);
      theta += weight * (e1[0] + e1[1] + e1[2]), by_theta += weight * (step[0] + step[1] + step[2]);
      if constexpr (!by_trace) {
        T M[6], A[6], cof1[6], d0, d1;
        solid::gradient<n>(c.x0, g, F0);
        solid::green_lagrange(F0, e0);
        if (w != 0.5)
          for (int i = 0; i < 6; ++i) e0[i] = e1[i] = (1 - w) * e0[i] + w * e1[i];
        volume::over_step(e0, e1, M, A, cof1, d0, d1);
        start += weight * d0, to += weight * d1;
        for (int i = 0; i < 6; ++i) by += 2 * weight * cof1[i] * step[i];
      }
    }
    const T theta_ahead = (theta + by_theta) / size;
    foreseen.theta = lambda * c.viscous * (theta_ahead - from);
    if constexpr (by_trace) {
      foreseen.theta += lambda * c.elastic * ((1 - w) * theta0 + w * theta_ahead);
    } else if (c.elastic != 0) {
      T q = zero, q_1 = zero;
      Bulk::quotient(T(start / size), T(to / size), q, q_1);
      foreseen.D = lambda * c.elastic * (q + (w == 0.5 ? 1 : 2 * w) * q_1 * by / size);
    }
  }
  const bool apart = c.before && c.f && c.K;
  for (int p = 0; p < S::n_points && (c.f || c.K); ++p) {
    T g[n][3];
    const T weight = solid::point_gradients<S>(p, c.X, g);
    stress_only.f = c.f, stress_only.K = apart ? nullptr : c.K;
    solid::add_point<n>(apart ? mean : foreseen, stress_only, g, weight);
    stress_only.f = nullptr, stress_only.K = c.K;
    if (apart) solid::add_point<n>(foreseen, stress_only, g, weight);
  }
  if (!c.K) return;
  for (int i = 0; i < n3; ++i) {
    const T by_theta = slope_theta / size * theta_m[i], by_D = slope_D / size * D_m[i];
    for (int j = 0; j < n3; ++j) c.K[n3 * i + j] += by_theta * theta_1[j] + by_D * D_1[j];
  }
}

}  // namespace hilo
