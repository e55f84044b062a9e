// SPDX-License-Identifier: GPL-3.0-or-later
// Stress at the points of a solid-shell (physics/shell.hpp).  Its deformation gradient is the rotation of the nodes' and the stretch of the
// assumed strain: the nodes alone would shear what is bent.
#pragma once
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <span>
#include <vector>

#include "physics/shell.hpp"
#include "physics/stress.hpp"

namespace hilo::stress {

/// A cell at positions x.
struct ShellState {
  shell::Cell<double> cell;
  double u[shell::n_vectors][3], e[shell::n_measures];

  ShellState(std::span<const Vec3> X, std::span<const Vec3> x) : cell(X[0].data()) {
    shell::vectors(x[0].data(), u);
    shell::measures(u, e);
    for (int k = 0; k < shell::n_measures; ++k) e[k] -= cell.m[k];
  }
  /// Strain xx yy zz yz xz xy at xi, and the reference volume by that of the cell's coordinates.
  double strain(const double* xi, const double* modes, double E[6]) const {
    const shell::Point<double> at(cell, xi);
    double n[shell::n_resultants];
    shell::strains_at(xi[0], xi[1], cell.p, e, n);
    at.strain(xi[2], n, modes, E);
    return at.det;
  }
  Mat3 gradient(const double* xi, const double E[6]) const {
    Mat3 g, G, stretched;
    shell::Cell<double>::tangents(u, xi, reinterpret_cast<double(*)[3]>(g.data()));
    shell::Cell<double>::tangents(cell.u, xi, reinterpret_cast<double(*)[3]>(G.data()));
    const Mat3 F = g * G.inverse();
    stretched << 1 + 2 * E[0], E[5], E[4], E[5], 1 + 2 * E[1], E[3], E[4], E[3], 1 + 2 * E[2];
    const Eigen::SelfAdjointEigenSolver<Mat3> nodes(F.transpose() * F), assumed(stretched);
    if (!(assumed.eigenvalues()[0] > 0 && nodes.eigenvalues()[0] > 0)) return F;
    return F * nodes.operatorInverseSqrt() * assumed.operatorSqrt();
  }
};

template <class S, class M>
void shell_points(const M& law, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, std::vector<StressPoint>& out) {
  constexpr const auto& table = stiffness_table<S>;
  constexpr auto rule = S::rule();
  const ShellState at(X, x);
  double modes[shell::n_modes];
  if constexpr (LinearLaw<M>) {
    const auto k = shell::linear_stiffness<S>(at.cell, moduli_of(law));
    double a[shell::n_modes][shell::n_modes], b[shell::n_modes][1];
    for (int i = 0; i < shell::n_modes; ++i) {
      b[i][0] = 0;
      for (int j = 0; j < shell::n_modes; ++j) a[i][j] = k.modes[i][j];
      for (int j = 0; j < shell::n_measures; ++j) b[i][0] -= k.of_modes[i][j] * at.e[j];
    }
    shell::CellModuli<double>::solve<1>(a, b);
    for (int i = 0; i < shell::n_modes; ++i) modes[i] = b[i][0];
  } else {
    SolidCall<double> call{};
    call.X = X[0].data(), call.x0 = call.x1 = x[0].data(), call.elastic = call.weight = 1, call.linear = law.linear(), call.h0 = state;
    if constexpr (Remembers<M>) {
      static const std::vector<double> as_new(S::n_points * M::n_state + shell::n_modes, 0.0);
      if (!state) call.h0 = as_new.data();
    }
    shell::Nonlinear<S, M, double> cell(law, call, at.cell, at.e);
    if (!state) cell.find_modes(at.e);
    for (int i = 0; i < shell::n_modes; ++i) modes[i] = cell.modes(state != nullptr)[i];
  }
  out.resize(S::n_points);
  for (int p = 0; p < S::n_points; ++p) {
    StressPoint& to = out[p];
    double E[6];
    to.w = table.w[p] * at.strain(rule.xi[p], modes, E);
    to.F = at.gradient(rule.xi[p], E);
    to.X.setZero();
    to.N = table.N[p];
    for (int a = 0; a < 8; ++a) to.X += to.N[a] * X[a];
    if constexpr (Remembers<M>) {
      static const std::vector<double> nothing(M::n_state, 0.0);
      const double* own = state ? state + p * M::n_state : nothing.data();
      PointStep step{E, E, own, 0, false};
      step.s = to.S.data();
      law.respond(step);
      to.plastic = own[M::plastic_strain];
    } else {
      law.template stress<double>(E, E, to.S.data(), nullptr);
    }
  }
}

/// Without the modes, which vanish in the mean.
inline void shell_gradients_at_nodes(std::span<const Vec3> X, std::span<const Vec3> x, std::span<Mat3> F) {
  const ShellState at(X, x);
  const double none[shell::n_modes] = {};
  for (int a = 0; a < 8; ++a) {
    double E[6];
    at.strain(hex_corner[a], none, E);
    F[a] = at.gradient(hex_corner[a], E);
  }
}

}  // namespace hilo::stress
