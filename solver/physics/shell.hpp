// SPDX-License-Identifier: GPL-3.0-or-later
// The solid-shell of eight nodes over a step (conventions of SolidCall; strains of physics/shell_cell.hpp).
//
// The strains of its points are E_p = L_p e + M_p alpha of measures e, quadratic in positions, and of five modes alpha that the cell
// keeps for itself: int M^T S = 0.  With the discrete gradient S_p of each point and force B(q_mid)^T s, s = sum w L_p^T S_p,
//
//   s.(e1 - e0) = sum w S_p.(E1 - E0) - (int M^T S).(alpha1 - alpha0) = W1 - W0,      B(q_mid)(q1 - q0) = e1 - e0
//
// so energy and momenta are kept with any law.  Where stress is linear in strain, the modes are eliminated once for all: s = D* e.  Else
// alpha1 is found at each evaluation, and a cell remembers alpha behind the state of its points.
#pragma once
#include <cmath>

#include "physics/lane_functions.hpp"
#include "physics/shell_cell.hpp"
#include "physics/solid_stress.hpp"

namespace hilo {

/// A law whose stress is linear in the strain.
template <class M>
concept LinearLaw = !Remembers<M> && (std::is_same_v<typename M::Bulk, SquareOfTrace> || Directed<M>);
template <class S>
inline constexpr bool is_shell = std::is_base_of_v<Shell8, S>;

namespace shell {

/// Vectors and strains of the measures at the two ends of a step.
template <class T>
struct Ends {
  T u1[n_vectors][3], um[n_vectors][3], e0[n_measures], e1[n_measures];

  Ends(const Cell<T>& cell, const SolidCall<T>& c) {
    T u0[n_vectors][3];
    vectors(c.x0, u0), vectors(c.x1, u1);
    for (int k = 0; k < n_vectors; ++k)
      for (int i = 0; i < 3; ++i) um[k][i] = (1 - c.weight) * u0[k][i] + c.weight * u1[k][i];
    measures(u0, e0), measures(u1, e1);
    for (int k = 0; k < n_measures; ++k) e0[k] -= cell.m[k], e1[k] -= cell.m[k];
  }
};

/// Strain that Newton's last correction foresaw (solid::foresee).
template <class T>
inline void foreseen(const Cell<T>& cell, const SolidCall<T>& c, T* e) {
  T u[n_vectors][3], du[n_vectors][3], by[n_measures];
  vectors(c.before, u), vectors(c.along, du);
  measures(u, e), measures_along(u, du, by);
  for (int k = 0; k < n_measures; ++k) e[k] += by[k] - cell.m[k];
}

/// Adds the force of s and the tangent of its slope D, with the stress `ahead` in the geometric part.
template <class T>
inline void add_force(const SolidCall<T>& c, const Ends<T>& x, const T* s, const T* ahead, const T (*D)[n_measures]) {
  constexpr int n = 3 * n_vectors;
  if (c.f) {
    T f[n], out[24];
    each_vector([&]<int k>() {
      T sum[3] = {0 * s[0], 0 * s[0], 0 * s[0]};
      each_term<k>([&](auto m, auto with) {
        for (int i = 0; i < 3; ++i) sum[i] += s[m] * x.um[with][i];
      });
      for (int i = 0; i < 3; ++i) f[3 * k + i] = sum[i];
    });
    for (int i = 0; i < 3; ++i) to_nodes(f + i, 3, out + i, 3);
    for (int i = 0; i < 24; ++i) c.f[i] += out[i];
  }
  if (!c.K) return;
  T DB[n_measures][n], K[n][n], rows[n][24];
  for (int i = 0; i < n_measures; ++i)
    each_vector([&]<int k>() {
      T sum[3] = {0 * s[0], 0 * s[0], 0 * s[0]};
      each_term<k>([&](auto m, auto with) {
        for (int j = 0; j < 3; ++j) sum[j] += D[i][m] * x.u1[with][j];
      });
      for (int j = 0; j < 3; ++j) DB[i][3 * k + j] = sum[j];
    });
  each_vector([&]<int k>() {
    for (int j = 0; j < n; ++j) {
      T sum[3] = {0 * s[0], 0 * s[0], 0 * s[0]};
      each_term<k>([&](auto m, auto with) {
        for (int i = 0; i < 3; ++i) sum[i] += x.um[with][i] * DB[m][j];
      });
      for (int i = 0; i < 3; ++i) K[3 * k + i][j] = sum[i];
    }
    each_term<k>([&](auto m, auto with) {
      for (int i = 0; i < 3; ++i) K[3 * k + i][3 * with + i] += c.weight * ahead[m];
    });
  });
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 3; ++j) to_nodes(K[i] + j, 3, rows[i] + j, 3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 24; ++j) {
      T column[8];
      to_nodes(rows[i] + j, 3 * 24, column, 1);
      for (int a = 0; a < 8; ++a) c.K[(3 * a + i) * 24 + j] += column[a];
    }
}

template <class T>
inline void lower_least_det(const Cell<T>& cell, const SolidCall<T>& c, const T (*u)[3]) {
  if (!c.least_det) return;
  constexpr auto rule = Shell8::rule();
  for (int p = 0; p < 8; ++p) {
    T g[3][3], G[3][3], unused[3][3];
    Cell<T>::tangents(u, rule.xi[p], g), Cell<T>::tangents(cell.u, rule.xi[p], G);
    const T J = Cell<T>::inverted(g[0], g[1], g[2], unused) / Cell<T>::inverted(G[0], G[1], G[2], unused);
    *c.least_det = J < *c.least_det ? J : *c.least_det;
  }
}

/// With stress linear in strain: elastic, viscous, or both.
template <class S, class Moduli, class T>
inline void add_linear(const Moduli& moduli, const SolidCall<T>& c, const Cell<T>& cell, const Ends<T>& x, double elastic) {
  CellModuli<T> k = linear_stiffness<S>(cell, moduli);
  k.condense();
  const auto times = [&](const T* e, T* s) {
    for (int i = 0; i < n_measures; ++i) {
      s[i] = k.D[i][0] * e[0];
      for (int j = 1; j < n_measures; ++j) s[i] += k.D[i][j] * e[j];
    }
  };
  const auto product = [&](const T* e) {
    T s[n_measures], sum = 0 * e[0];
    times(e, s);
    for (int i = 0; i < n_measures; ++i) sum += e[i] * s[i];
    return sum;
  };
  T from[n_measures];
  for (int i = 0; i < n_measures; ++i) from[i] = x.e0[i];
  if (c.viscous != 0)
    solid::add_recalled<n_measures>(c, from, [&](const T* at, T* to) {
      T u[n_vectors][3];
      vectors(at, u), measures(u, to);
      for (int i = 0; i < n_measures; ++i) to[i] -= cell.m[i];
    });
  const auto mean = [&](const T* end, T* e) {
    for (int i = 0; i < n_measures; ++i) e[i] = elastic * ((1 - c.weight) * x.e0[i] + c.weight * end[i]) + c.viscous * (end[i] - from[i]);
  };
  T e[n_measures], s[n_measures], ahead[n_measures];
  if (c.energy) *c.energy += 0.5 * product(x.e1);
  if (c.dissipated && c.viscous != 0) {
    T rate[n_measures];
    for (int i = 0; i < n_measures; ++i) rate[i] = x.e1[i] - from[i];
    times(rate, e);
    for (int i = 0; i < n_measures; ++i) *c.dissipated += c.viscous * e[i] * (x.e1[i] - x.e0[i]);
  }
  if (!c.f && !c.K) return;
  mean(x.e1, e), times(e, s);
  if (c.K && c.before) {
    T end[n_measures];
    foreseen(cell, c, end), mean(end, e), times(e, ahead);
  }
  const double slope = elastic * c.weight + c.viscous;
  for (int i = 0; i < n_measures && c.K; ++i)
    for (int j = 0; j < n_measures; ++j) k.D[i][j] = slope * k.D[i][j];
  add_force(c, x, s, c.K && c.before ? ahead : s, k.D);
}

/// With a law of any kind: elastic stress.
template <class S, class M, class T>
class Nonlinear {
 public:
  Nonlinear(const M& law, const SolidCall<T>& c, const Cell<T>& cell, const T* e0) : law_(law), c_(c), cell_(cell) {
    constexpr auto rule = S::rule();
    if constexpr (Remembers<M>) n_state_ = S::n_points * M::n_state;
    for (int a = 0; a < n_modes; ++a) alpha0_[a] = c.h0 ? c.h0[n_state_ + a] : 0 * cell.det;
    for (int p = 0; p < S::n_points; ++p) point_strain(p, rule.xi[p], e0, alpha0_, E0_[p]);
  }

  /// Of the modes at the end: such that their force vanishes; not a number where there are none.
  void find_modes(const T* e1) {
    for (int a = 0; a < n_modes; ++a) alpha1_[a] = alpha0_[a];
    const Lame moduli = law_.linear();
    const T scale = 8 * moduli.mu * cell_.det;
    double worst = NAN;
    for (int it = 0; it < most_iterations && !(worst < small); ++it) {
      sweep(e1, false);
      T a[n_modes][n_modes], x[n_modes][1], squares = 0 * scale;
      for (int i = 0; i < n_modes; ++i) {
        x[i][0] = force_[i];
        for (int j = 0; j < n_modes; ++j) a[i][j] = modes_[i][j];
      }
      CellModuli<T>::template solve<1>(a, x);
      for (int i = 0; i < n_modes; ++i) alpha1_[i] -= x[i][0], squares += force_[i] * x[i][0] / scale;
      worst = 0;
      for (unsigned l = 0; l < sizeof(T) / sizeof(double); ++l)
        if (!(std::abs(lane(squares, l)) <= worst)) worst = std::abs(lane(squares, l));
    }
    if (!(worst < small))
      for (int a = 0; a < n_modes; ++a) alpha1_[a] = alpha1_[a] * NAN;
  }

  const T* modes(bool at_start) const { return at_start ? alpha0_ : alpha1_; }

  void add(const Ends<T>& x) {
    if (c_.elastic == 0) {  // energy of a state
      for (int a = 0; a < n_modes; ++a) alpha1_[a] = alpha0_[a];
      for (int p = 0; p < S::n_points; ++p) at_point(c_, p, x.e1);
      return;
    }
    find_modes(x.e1);
    for (int a = 0; a < n_modes && c_.h1; ++a) c_.h1[n_state_ + a] = alpha1_[a];
    T s[n_measures], ahead[n_measures];
    sweep(x.e1, true);
    for (int i = 0; i < n_measures; ++i) s[i] = stress_[i];
    if (!c_.f && !c_.K) return;
    CellModuli<T> k(cell_.det);
    if (c_.K) {
      constexpr auto rule = S::rule();
      add_stiffness<S>(
          cell_,
          [&](int p, T(*to)[6]) {
            for (int i = 0; i < 6; ++i)
              for (int j = 0; j < 6; ++j) to[i][j] = D_[p][i][j];
            return Point<T>(cell_, rule.xi[p]);
          },
          k);
      k.condense();
    }
    if (c_.K && c_.before) {
      T end[n_measures];
      foreseen(cell_, c_, end);
      find_modes(end), sweep(end, false);
      for (int i = 0; i < n_measures; ++i) ahead[i] = stress_[i];
    }
    add_force(c_, x, s, c_.K && c_.before ? ahead : s, k.D);
  }

 private:
  // of the correction: square of a strain; it converges quadratically
  static constexpr double small = 1e-18;
  static constexpr int most_iterations = 25;

  void point_strain(int p, const double* xi, const T* e, const T* alpha, T* E) const {
    T n[n_resultants];
    strains_at(xi[0], xi[1], cell_.p, e, n);
    point_[p].strain(xi[2], n, alpha, E);
  }
  /// Stress of a point, and its slope into D_.
  void at_point(const SolidCall<T>& c, int p, const T* e1) {
    constexpr auto rule = S::rule();
    const Point<T>& at = point_[p];
    const T w = at.det * rule.w[p], zero = 0 * w;
    T E1[6], s[6], D[6][6], own[6];
    point_strain(p, rule.xi[p], e1, alpha1_, E1);
    for (int i = 0; i < 6; ++i) {
      s[i] = zero;
      for (int j = 0; j < 6; ++j) D[i][j] = zero;
    }
    if (c.elastic != 0 || Remembers<M>) solid::add_elastic(law_, c, p, w, E0_[p], E1, s, c.elastic != 0 ? D : nullptr);
    if constexpr (!Remembers<M>)
      if (c.energy) *c.energy += w * law_.energy(E1);
    if (c.elastic == 0) return;
    covariant(at, D, w, D_[p]);
    for (int i = 0; i < 6; ++i) {
      own[i] = at.turn[0][i] * s[0];
      for (int k = 1; k < 6; ++k) own[i] += at.turn[k][i] * s[k];
      own[i] *= w;
    }
    for (int a = 0; a < n_modes; ++a) {
      T left[6];
      for (int i = 0; i < 6; ++i) {
        force_[a] += at.modes[i][a] * own[i];
        left[i] = at.modes[0][a] * D_[p][0][i];
        for (int k = 1; k < 6; ++k) left[i] += at.modes[k][a] * D_[p][k][i];
      }
      for (int b = 0; b < n_modes; ++b)
        for (int i = 0; i < 6; ++i) modes_[a][b] += left[i] * at.modes[i][b];
    }
    T n[n_resultants];
    for (int j = 0; j < n_resultants; ++j) n[j] = Point<T>::power(j, rule.xi[p][2]) * own[strain_of[j]];
    add_resultants(rule.xi[p][0], rule.xi[p][1], cell_.p, n, stress_);
  }
  /// All points; state, energy and dissipation are written in the last sweep of a call alone.
  void sweep(const T* e1, bool last) {
    const T zero = 0 * cell_.det;
    for (T& s : stress_) s = zero;
    for (int a = 0; a < n_modes; ++a) {
      force_[a] = zero;
      for (int b = 0; b < n_modes; ++b) modes_[a][b] = zero;
    }
    SolidCall<T> call = c_;
    call.f = stress_;  // the stress is wanted
    if (!last) call.energy = call.dissipated = call.h1 = nullptr;
    for (int p = 0; p < S::n_points; ++p) at_point(call, p, e1);
  }

  const M& law_;
  const SolidCall<T>& c_;
  const Cell<T>& cell_;
  int n_state_ = 0;
  std::array<Point<T>, S::n_points> point_ = points(cell_, std::make_index_sequence<S::n_points>{});
  T alpha0_[n_modes], alpha1_[n_modes], E0_[S::n_points][6], D_[S::n_points][6][6];
  T stress_[n_measures], force_[n_modes], modes_[n_modes][n_modes];

  template <size_t... p>
  static std::array<Point<T>, S::n_points> points(const Cell<T>& cell, std::index_sequence<p...>) {
    constexpr auto rule = S::rule();
    return {Point<T>(cell, rule.xi[p])...};
  }
};

}  // namespace shell

/// Adds to f, K, energy, dissipated and lowers least_det; the caller clears them.
template <class S, class M, class T>
inline void add_shell(const M& law, const SolidCall<T>& c) {
  const shell::Cell<T> cell(c.X);
  const shell::Ends<T> x(cell, c);
  shell::lower_least_det(cell, c, x.u1);
  if constexpr (LinearLaw<M>) {
    shell::add_linear<S>(moduli_of(law), c, cell, x, c.elastic);
  } else {
    if (c.viscous != 0) {
      SolidCall<T> rates = c;
      rates.energy = nullptr;
      shell::add_linear<S>(c.linear, rates, cell, x, 0);
    }
    if (c.elastic != 0 || c.energy) shell::Nonlinear<S, M, T>(law, c, cell, x.e0).add(x);
  }
}

}  // namespace hilo
