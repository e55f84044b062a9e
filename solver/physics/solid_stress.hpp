// SPDX-License-Identifier: GPL-3.0-or-later
// Stress at a point of a solid cell: that of its strains, and that which Newton's last correction foresaw.
#pragma once
#include "physics/material/dilatation.hpp"
#include "physics/material/point_step.hpp"
#include "physics/solid_strain.hpp"

namespace hilo::solid {

/// Stress, slope, state and energies of point p under a law that remembers: lane by lane, in a function of the law's own.
template <class M, class T>
inline void step_point(const M& law, const SolidCall<T>& c, int p, const T& w, const T e0[6], const T e1[6], T s[6], T (*D)[6]) {
  constexpr int lanes = sizeof(T) / sizeof(double), n = M::n_state;
  const auto get = [](const T& x, int lane) { return reinterpret_cast<const double*>(&x)[lane]; };
  const auto put = [](T& x, int lane, double value) { reinterpret_cast<double*>(&x)[lane] = value; };
  for (int l = 0; l < lanes; ++l) {
    double start[6], end[6], before[n], after[n], stress[6], slope[36];
    for (int i = 0; i < 6; ++i) start[i] = get(e0[i], l), end[i] = get(e1[i], l);
    for (int i = 0; i < n; ++i) before[i] = get(c.h0[p * n + i], l);
    PointStep step{start, end, before, c.elapsed, c.weight == 0.5, c.mean};
    if (c.elastic != 0 && (c.f || c.K)) step.s = stress, step.D = D ? slope : nullptr;
    if (c.h1) step.h1 = after;
    law.respond(step);
    for (int i = 0; i < 6 && step.s; ++i) {
      put(s[i], l, stress[i]);
      for (int j = 0; j < 6 && step.D; ++j) put(D[i][j], l, slope[6 * i + j]);
    }
    for (int i = 0; i < n && c.h1; ++i) put(c.h1[p * n + i], l, after[i]);
    if (c.energy) put(*c.energy, l, get(*c.energy, l) + get(w, l) * step.energy);
    if (c.elastic != 0 && c.dissipated) put(*c.dissipated, l, get(*c.dissipated, l) + get(w, l) * step.dissipated);
  }
}

/// Adds the rate terms to the stress, and to D where given; `from`: e0 with what is recalled.
template <class Material, class T>
inline void add_viscous(const Material& material, const SolidCall<T>& c, const T& w, const T e0[6], const T from[6], const T e1[6], T s[6],
                        T (*D)[6], T* dissipated) {
  T rate[6], q[6];
  for (int i = 0; i < 6; ++i) rate[i] = e1[i] - from[i];
  if constexpr (Directed<Material>)
    material.moduli.stress(rate, q);
  else
    linear_stress(c.linear, rate, q);
  for (int i = 0; i < 6; ++i) {
    s[i] += c.viscous * q[i];
    if (dissipated) *dissipated += w * c.viscous * q[i] * (e1[i] - e0[i]);
  }
  if (!D) return;
  if constexpr (Directed<Material>)
    material.moduli.add_tangent(c.viscous, D);
  else
    add_linear_tangent(c.linear, c.viscous, D);
}

/// Adds the elastic stress of strains e0 and e1, and its derivative by e1 to D where given.
template <class Material, class T>
inline void add_elastic(const Material& material, const SolidCall<T>& c, int p, const T& w, const T e0[6], const T e1[6], T s[6],
                        T (*D)[6]) {
  if constexpr (Remembers<Material>) {
    step_point(material, c, p, w, e0, e1, s, D);
  } else if (c.weight == 0.5) {
    material.stress(e0, e1, s, D);
  } else {
    T e[6];
    for (int i = 0; i < 6; ++i) e[i] = (1 - c.weight) * e0[i] + c.weight * e1[i];
    material.stress(e, e, s, D);  // D holds half the derivative: that by the second argument
    for (int i = 0; i < 6 && D; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] *= 2 * c.weight;
  }
}

/// Strain at `before` and what the correction added to it to first order.
template <int n, class T>
inline void strain_along(const SolidCall<T>& c, const T (*g)[3], T e[6], T by[6]) {
  T F[3][3], dF[3][3];
  gradient<n>(c.before, g, F);
  gradient<n>(c.along, g, dF);
  green_lagrange(F, e);
  constexpr int I[6] = {0, 1, 2, 1, 0, 0}, J[6] = {0, 1, 2, 2, 2, 1};
  for (int k = 0; k < 6; ++k) {
    const T dot = F[0][I[k]] * dF[0][J[k]] + F[1][I[k]] * dF[1][J[k]] + F[2][I[k]] * dF[2][J[k]];
    if (k < 3)
      by[k] = dot;
    else
      by[k] = dot + (F[0][J[k]] * dF[0][I[k]] + F[1][J[k]] * dF[1][I[k]] + F[2][J[k]] * dF[2][I[k]]);
  }
}

/// Stress for the geometric part of the tangent: that of the strain that Newton's last correction foresaw.  Strain is quadratic in
/// positions; a correction that turns a stiff cell leaves a spurious strain of second order, whose stress would fill the next tangent with
/// forces that are not there.  With the stress foreseen the iteration is Newton's on positions and stresses as independent unknowns, of
/// which the stresses are eliminated at each point [magisano-2017]; it ends at the same solution, and as fast.
///
/// Where volume is all but kept, the pressure is foreseen likewise, from det C to first order; D gets what it changes.
template <int n, class Material, class T>
inline void foresee(const Material& material, const SolidCall<T>& c, const T (*g)[3], const T& w, int p, const T e0[6], const T from[6],
                    const T e1[6], T s[6], [[maybe_unused]] T (*D)[6]) {
  T e[6], by[6];
  strain_along<n>(c, g, e, by);
  T ahead[6];
  for (int i = 0; i < 6; ++i) ahead[i] = e[i] + by[i], s[i] = 0 * w;
  SolidCall<T> quiet = c;
  quiet.energy = quiet.dissipated = quiet.h1 = nullptr;
  if (c.elastic != 0) add_elastic(material, quiet, p, w, e0, ahead, s, static_cast<T(*)[6]>(nullptr));
  if (c.viscous != 0) add_viscous(material, c, w, e0, from, ahead, s, static_cast<T(*)[6]>(nullptr), static_cast<T*>(nullptr));
  if constexpr (requires { typename Material::Bulk; } && !Remembers<Material>) {
    using Bulk = typename Material::Bulk;
    if constexpr (!std::is_same_v<Bulk, NoBulk> && !std::is_same_v<Bulk, SquareOfTrace>) {
      if (c.elastic == 0) return;
      const double lambda = material.linear().lambda, slope_share = c.weight == 0.5 ? 1 : 2 * c.weight;
      T M[6], A[6], cof[6], D0 = 0 * w, D1 = D0, q = D0, q_1 = D0;
      const auto at = [&](const T end[6]) {
        T start[6], to[6];
        for (int i = 0; i < 6; ++i) {
          const T mean = (1 - c.weight) * e0[i] + c.weight * end[i];
          start[i] = c.weight == 0.5 ? e0[i] : mean, to[i] = c.weight == 0.5 ? end[i] : mean;
        }
        volume::over_step(start, to, M, A, cof, D0, D1);
        Bulk::quotient(D0, D1, q, q_1);
      };
      at(e);
      T change = 0 * w;
      for (int i = 0; i < 6; ++i) change += 2 * cof[i] * by[i];
      const T foreseen = q + slope_share * q_1 * change;
      at(ahead);
      for (int i = 0; i < 6; ++i) s[i] += 2 * lambda * (foreseen - q) * A[i];
      at(e1);
      volume::add_cofactor_slope(M, T(4 * lambda * slope_share * (foreseen - q)), D);
    }
  }
}

}  // namespace hilo::solid
