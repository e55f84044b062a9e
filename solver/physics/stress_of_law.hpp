// SPDX-License-Identifier: GPL-3.0-or-later
// Stress at the points of one cell, of each shape and law (physics/stress.hpp).
#pragma once
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "physics/cell_mean.hpp"
#include "physics/shape/shapes.hpp"
#include "physics/shell_stress.hpp"
#include "physics/solid_cell.hpp"
#include "physics/stress.hpp"

namespace hilo::stress {

template <class M>
Vec6 second_piola(const M& law, const double e[6]) {
  Vec6 s = Vec6::Zero();
  law.template stress<double>(e, e, s.data(), nullptr);
  return s;
}

template <class S>
constexpr Quadrature<S::n> nodes_in_the_tree() {
  Quadrature<S::n> r;
  auto& xi = r.xi;
  const auto middle = [&](int a, int from, int to) {
    for (int i = 0; i < 3; ++i) xi[a][i] = (xi[from][i] + xi[to][i]) / 2;
  };
  if constexpr (S::n == 8 || S::n == 20) {
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) xi[a][i] = hex_corner[a][i];
    if constexpr (S::n == 20)
      for (int e = 0; e < 12; ++e) middle(8 + e, S::edge[e][0], S::edge[e][1]);
  } else if constexpr (S::n == 4 || S::n == 10) {
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 3; ++i) xi[a][i] = a == i + 1;
    if constexpr (S::n == 10)
      for (int e = 0; e < 6; ++e) middle(4 + e, S::edge[e][0], S::edge[e][1]);
  } else {
    for (int a = 0; a < 6; ++a) xi[a][0] = a % 3 == 1, xi[a][1] = a % 3 == 2, xi[a][2] = a < 3 ? -1 : 1;
    if constexpr (S::n == 15)
      for (int e = 0; e < 9; ++e) middle(6 + e, e < 6 ? (e % 3) + (e < 3 ? 0 : 3) : e - 6, e < 6 ? (e + 1) % 3 + (e < 3 ? 0 : 3) : e - 3);
  }
  return r;
}

/// Local coordinates of the nodes of a shape: where N_a = 1.
template <class S>
constexpr Quadrature<S::n> node_points() {
  if constexpr (requires { S::nodes(); })
    return S::nodes();
  else
    return nodes_in_the_tree<S>();
}

/// Least squares from the points of a rule to the nodes.
template <class S, int P>
Eigen::MatrixXd fitted(const Quadrature<P>& rule, bool weighted = false) {
  const auto basis = [](const double* xi) {
    Eigen::VectorXd b(is_shell<S> || S::n == 20 ? 8 : S::n <= 8 ? 1 : S::n == 15 ? 6 : 4);
    b[0] = 1;
    if (b.size() > 1) b.segment(1, 3) << xi[0], xi[1], xi[2];
    if (S::n == 15) b.tail(2) << xi[0] * xi[2], xi[1] * xi[2];
    if (b.size() == 8) b.tail(4) << xi[1] * xi[2], xi[0] * xi[2], xi[0] * xi[1], xi[0] * xi[1] * xi[2];
    return b;
  };
  const Eigen::Index n = basis(rule.xi[0]).size();
  Eigen::MatrixXd at_points(P, n), at_nodes(S::n, n);
  const auto nodes = node_points<S>();
  Eigen::VectorXd w = Eigen::VectorXd::Ones(P);
  for (int p = 0; p < P; ++p) at_points.row(p) = basis(rule.xi[p]), w[p] = weighted ? rule.w[p] : 1;
  for (int a = 0; a < S::n; ++a) at_nodes.row(a) = basis(nodes.xi[a]);
  return at_nodes * (at_points.transpose() * w.asDiagonal() * at_points).inverse() * at_points.transpose() * w.asDiagonal();
}

/// Each face of a shell with four layers of points by the two next to it: what has yielded is not linear across.
inline Eigen::MatrixXd faces_of_shell() {
  constexpr auto rule = Shell8Full::rule();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(8, 16);
  for (const int face : {0, 1}) {
    Quadrature<8> near;
    for (int p = 0; p < 8; ++p) std::copy_n(rule.xi[8 * face + p], 3, near.xi[p]);
    out.block<4, 8>(4 * face, 8 * face) = fitted<Shell8>(near).middleRows(4 * face, 4);
  }
  return out;
}

/// `law` without what the mean has of it.
template <class S, int P, class M>
void points_of(const Tabulated<S, P>& table, const M& law, const CellMean<typename M::Bulk>& mean, std::span<const Vec3> X,
               std::span<const Vec3> x, std::vector<StressPoint>& out) {
  out.resize(P);
  for (int p = 0; p < P; ++p) {
    StressPoint& at = out[p];
    double g[S::n][3], F[3][3], e[6];
    at.w = table.w[p] * solid::reference_gradients<S::n>(table.dN[p], X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F);
    solid::green_lagrange(F, e);
    at.S = second_piola(law, e);
    mean.add(e, at.S);
    at.X.setZero();
    for (int a = 0; a < S::n; ++a) at.X += table.N[p][a] * X[a];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) at.F(i, j) = F[i][j];
    at.N = table.N[p];
  }
}

inline constexpr Tabulated<Hex20, 8> barlow_table{hex_rule<2>()};
inline constexpr Tabulated<Hex8, 8> hex8_table{hex_rule<2>()};

/// At the integration points, where the state is.
template <class S, class M>
void remembered_points(const M& law, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, std::vector<StressPoint>& out) {
  constexpr const auto& table = stiffness_table<S>;
  CellMean<typename M::Bulk> mean{mean_lambda<S, typename M::Bulk, true>(law.linear()), 0};
  static const std::vector<double> nothing(M::n_state, 0.0);
  double volume = 0, swelling = 0;
  out.resize(S::n_points);
  for (int p = 0; p < S::n_points; ++p) {
    StressPoint& at = out[p];
    double g[S::n][3], F[3][3];
    at.w = table.w[p] * solid::reference_gradients<S::n>(table.dN[p], X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F);
    at.X.setZero();
    for (int a = 0; a < S::n; ++a) at.X += table.N[p][a] * X[a];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) at.F(i, j) = F[i][j];
    at.N = table.N[p];
    volume += at.w, swelling += at.w * std::pow(at.F.determinant(), 2);
  }
  mean.dilatation = swelling / volume;
  for (int p = 0; p < S::n_points; ++p) {
    StressPoint& at = out[p];
    double F[3][3], e[6];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F[i][j] = at.F(i, j);
    solid::green_lagrange(F, e);
    const double* own = state ? state + p * M::n_state : nothing.data();
    PointStep step{e, e, own, 0, false, mean.lambda};
    step.s = at.S.data();
    law.respond(step);
    at.plastic = own[M::plastic_strain];
    mean.add(e, at.S);
  }
}

template <class S, class M>
void solid_points(const M& whole, std::span<const Vec3> X, std::span<const Vec3> x, StressPoints which, std::vector<StressPoint>& out) {
  const Lame c = whole.linear();
  const CellMean mean = mean_of<S, typename M::Bulk>(c, X, x);
  const M law = without_mean(whole, mean.lambda);
  if (which == StressPoints::everywhere) return points_of(mass_table<S>, law, mean, X, x, out);
  if constexpr (std::is_base_of_v<Hex20, S>)
    if (which == StressPoints::samples) return points_of(barlow_table, law, mean, X, x, out);
  points_of(stiffness_table<S>, law, mean, X, x, out);
}

inline Mat3 tensor_of_strain(const double e[6]) {
  Mat3 m;
  m << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return m;
}

/// Second Piola-Kirchhoff stress to first order in the strain, where nothing is remembered.
template <class M>
Vec6 linear_stress(const M& law, const double e[6]) {
  constexpr double part = 1e-3;  // of the strain: small, and far above round-off
  double there[6], back[6];
  for (int i = 0; i < 6; ++i) there[i] = part * e[i], back[i] = -part * e[i];
  return (second_piola(law, there) - second_piola(law, back)) / (2 * part);
}

/// Strain of the centroid, plus the bending strains that the hourglass measures stand for (physics/hourglass.hpp), linear in the cell.
/// `small`: to first order in the displacements x - X; then u_A = (x - X) n_A, and b_rA = axis_A . h_r, since X gamma_r = 0.
template <bool small, class M>
void hex8_points(const M& law, std::span<const Vec3> X, std::span<const Vec3> x, std::vector<StressPoint>& out) {
  const Hourglass<double, decltype(moduli_of(law))> h(X[0].data(), moduli_of(law));
  double y[24], F[3][3], e[6], u[3][3], modes[4][3], b[4][3];
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i) y[3 * a + i] = small ? x[a][i] - X[a][i] : x[a][i];
  h.measure(y, u, modes, b);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      F[i][j] = u[0][i] * h.axes[j][0] + u[1][i] * h.axes[j][1] + u[2][i] * h.axes[j][2];
      if (small) F[i][j] += i == j;
    }
  if constexpr (small) {
    for (int i = 0; i < 3; ++i) e[i] = F[i][i] - 1, e[3 + i] = F[(i + 1) % 3][(i + 2) % 3] + F[(i + 2) % 3][(i + 1) % 3];
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) b[r][A] = h.axes[0][A] * modes[r][0] + h.axes[1][A] * modes[r][1] + h.axes[2][A] * modes[r][2];
  } else {
    solid::green_lagrange(F, e);
  }
  Mat3 axes;
  for (int i = 0; i < 3; ++i)
    for (int A = 0; A < 3; ++A) axes(i, A) = h.axes[i][A];
  Mat3 bent[3];  // strain by each coordinate of the cell
  for (int r = 0; r < 3; ++r) {
    const int p = (r + 1) % 3, q = (r + 2) % 3;
    const double measures[3] = {b[q][p] / h.half[p], b[p][q] / h.half[q], b[q][q] / h.half[p] + b[p][p] / h.half[q]};
    double all[6];
    h.moduli.across(r, measures, all);
    bent[r] = axes * tensor_of_strain(all) * axes.transpose();
  }
  constexpr auto rule = hex_rule<2>();
  out.resize(8);
  for (int k = 0; k < 8; ++k) {
    StressPoint& at = out[k];
    const Mat3 extra = rule.xi[k][0] * bent[0] + rule.xi[k][1] * bent[1] + rule.xi[k][2] * bent[2];
    const double total[6] = {e[0] + extra(0, 0),     e[1] + extra(1, 1),     e[2] + extra(2, 2),
                             e[3] + 2 * extra(1, 2), e[4] + 2 * extra(0, 2), e[5] + 2 * extra(0, 1)};
    at.S = small ? linear_stress(law, total) : second_piola(law, total);
    at.w = h.volume / 8;
    at.X.setZero();
    at.N = hex8_table.N[k];
    for (int a = 0; a < 8; ++a) at.X += at.N[a] * X[a];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) at.F(i, j) = F[i][j];
  }
}

template <class S>
void gradients_at_nodes(std::span<const Vec3> X, std::span<const Vec3> x, std::span<Mat3> out) {
  if constexpr (is_shell<S>) return shell_gradients_at_nodes(X, x, out);
  static constexpr Tabulated<S, S::n> table{node_points<S>()};
  Mat3 mean = Mat3::Zero();
  double volume = 0, det[S::n];
  for (int p = 0; p < S::n_points; ++p) {
    double g[S::n][3], F[3][3];
    const double w = solid::point_gradients<S>(p, X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) mean(i, j) += w * F[i][j];
    volume += w;
  }
  mean /= volume;
  for (int a = 0; a < S::n; ++a) {
    double g[S::n][3], F[3][3];
    det[a] = solid::reference_gradients<S::n>(table.dN[a], X[0].data(), g);
    if (!(det[a] > 1e-3 * volume / 8)) {
      out[a] = mean;
      continue;
    }
    solid::gradient<S::n>(x[0].data(), g, F);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out[a](i, j) = F[i][j];
  }
}

/// Stress points of a shape S; of the one-point hexahedron, and where the law remembers, as the kernels take it.
template <class S, class M>
void points_of_cell(const M& law, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, StressPoints which,
                    std::vector<StressPoint>& out) {
  if constexpr (is_shell<S>)
    shell_points<Integrated<S, Remembers<M>>>(law, X, x, state, out);
  else if constexpr (Remembers<M>)
    remembered_points<Integrated<S, true>>(law, X, x, state, out);
  else if constexpr (std::is_same_v<S, Hex8>)
    hex8_points<false>(law, X, x, out);
  else
    solid_points<S>(law, X, x, which, out);
}

/// Of a bar none.
template <class M>
void points_of_law(Shape shape, const M& law, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, StressPoints which,
                   std::vector<StressPoint>& out) {
  const bool solid = of_shape(shape, false, [&]<class S>() {
    points_of_cell<S>(law, X, x, state, which, out);
    return true;
  });
  if (!solid) out.clear();
}

/// Values at the nodes from those at the samples.
template <class S>
Eigen::MatrixXd samples_to_nodes() {
  if constexpr (!std::is_same_v<S, Shell8> && is_shell<S>)
    return faces_of_shell();
  else if constexpr (std::is_same_v<S, Hex8> || std::is_base_of_v<Hex20, S>)
    return fitted<S>(hex_rule<2>());
  else
    return fitted<S>(S::rule());
}

}  // namespace hilo::stress
