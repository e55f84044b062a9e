#include "physics/stress.hpp"

#include <Eigen/LU>
#include <cmath>

#include "physics/hourglass.hpp"
#include "physics/material/neo_hookean.hpp"
#include "physics/material/stvk.hpp"
#include "physics/shape/hex20.hpp"
#include "physics/shape/tet10.hpp"
#include "physics/shape/wedge15.hpp"

namespace hilo {
namespace {

/// sigma = F S F^T / J for the second Piola-Kirchhoff stress of strain e.
Vec6 cauchy(Law law, const Lame& c, const double F_[3][3], const double e[6]) {
  double s[6] = {};
  if (law == Law::stvk)
    StVenantKirchhoff{c}.stress<double>(e, e, s, nullptr);
  else
    NeoHookean{c}.stress<double>(e, e, s, nullptr);
  Mat3 F, S;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F(i, j) = F_[i][j];
  S << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  const Mat3 t = F * S * F.transpose() / F.determinant();
  Vec6 out;
  out << t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1);
  return out;
}

/// Local coordinates of the nodes of a shape: where N_a = 1.
template <class S>
void node_coordinates(double (*xi)[3]) {
  if constexpr (S::n == 8 || S::n == 20) {
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) xi[a][i] = hex_corner[a][i];
    if constexpr (S::n == 20)
      for (int e = 0; e < 12; ++e)
        for (int i = 0; i < 3; ++i) xi[8 + e][i] = (xi[S::edge[e][0]][i] + xi[S::edge[e][1]][i]) / 2;
  } else if constexpr (S::n == 4 || S::n == 10) {
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 3; ++i) xi[a][i] = a == i + 1;
    if constexpr (S::n == 10)
      for (int e = 0; e < 6; ++e)
        for (int i = 0; i < 3; ++i) xi[4 + e][i] = (xi[S::edge[e][0]][i] + xi[S::edge[e][1]][i]) / 2;
  } else {
    for (int a = 0; a < 6; ++a) xi[a][0] = a % 3 == 1, xi[a][1] = a % 3 == 2, xi[a][2] = a < 3 ? -1 : 1;
    if constexpr (S::n == 15)
      for (int e = 0; e < 9; ++e) {
        const int from = e < 6 ? (e % 3) + (e < 3 ? 0 : 3) : e - 6, to = e < 6 ? (e + 1) % 3 + (e < 3 ? 0 : 3) : e - 3;
        for (int i = 0; i < 3; ++i) xi[6 + e][i] = (xi[from][i] + xi[to][i]) / 2;
      }
  }
}

template <class S>
void recover(Law law, const Lame& c, std::span<const Vec3> X, std::span<const Vec3> x, std::span<Vec6> out) {
  const auto rule = S::rule();
  Eigen::Matrix<double, S::n_points, 6> sigma;
  Eigen::Matrix<double, S::n_points, 4> A;
  for (int p = 0; p < S::n_points; ++p) {
    double g[S::n][3], F[3][3], e[6];
    solid::point_gradients<S>(p, X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F);
    solid::green_lagrange(F, e);
    sigma.row(p) = cauchy(law, c, F, e).transpose();
    A.row(p) << 1, rule.xi[p][0], rule.xi[p][1], rule.xi[p][2];
  }
  if constexpr (S::n_points < 4) {
    for (auto& s : out) s = sigma.colwise().mean().transpose();
  } else {
    const Eigen::Matrix4d normal = A.transpose() * A;
    const Eigen::Matrix<double, 4, 6> fit = normal.inverse() * (A.transpose() * sigma);
    double xi[S::n][3];
    node_coordinates<S>(xi);
    for (int a = 0; a < S::n; ++a)
      out[a] = (fit.row(0) + xi[a][0] * fit.row(1) + xi[a][1] * fit.row(2) + xi[a][2] * fit.row(3)).transpose();
  }
}

/// Strain at the corners: the centroid's, plus the bending strains the hourglass measures stand for (physics/hourglass.hpp).
void recover_hex8(Law law, const Lame& c, std::span<const Vec3> X, std::span<const Vec3> x, std::span<Vec6> out) {
  const Hourglass<double> h(X[0].data(), c);
  double g[8][3], F[3][3], e[6], u[3][3], modes[4][3], b[4][3];
  solid::point_gradients<Hex8>(0, X[0].data(), g);
  solid::gradient<8>(x[0].data(), g, F);
  solid::green_lagrange(F, e);
  h.measure(x[0].data(), u, modes, b);
  for (int a = 0; a < 8; ++a) {
    Mat3 local = Mat3::Zero();  // additional strain in the cell's axes
    for (int r = 0; r < 3; ++r) {
      const int p = (r + 1) % 3, q = (r + 2) % 3;
      const double xi = hex_corner[a][r], e1 = b[q][p] / h.half[p], e2 = b[p][q] / h.half[q],
                   e3 = b[q][q] / h.half[p] + b[p][p] / h.half[q];
      local(p, p) += e1 * xi, local(q, q) += e2 * xi, local(r, r) -= h.nu / (1 - h.nu) * (e1 + e2) * xi;
      local(p, q) += e3 * xi / 2, local(q, p) += e3 * xi / 2;
    }
    Mat3 axes;
    for (int i = 0; i < 3; ++i)
      for (int A = 0; A < 3; ++A) axes(i, A) = h.axes[i][A];
    const Mat3 extra = axes * local * axes.transpose();
    const double total[6] = {e[0] + extra(0, 0),     e[1] + extra(1, 1),     e[2] + extra(2, 2),
                             e[3] + 2 * extra(1, 2), e[4] + 2 * extra(0, 2), e[5] + 2 * extra(0, 1)};
    out[a] = cauchy(law, c, F, total);
  }
}

}  // namespace

double von_mises(const Vec6& s) {
  return std::sqrt(((s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) + (s[2] - s[0]) * (s[2] - s[0])) / 2 +
                   3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

void nodal_stress(Shape shape, Law law, const Lame& c, std::span<const Vec3> X, std::span<const Vec3> x, std::span<Vec6> out) {
  switch (shape) {
    case Shape::tet4:
      return recover<Tet4>(law, c, X, x, out);
    case Shape::tet10:
      return recover<Tet10>(law, c, X, x, out);
    case Shape::wedge6:
      return recover<Wedge6>(law, c, X, x, out);
    case Shape::wedge15:
      return recover<Wedge15>(law, c, X, x, out);
    case Shape::hex8:
      return recover_hex8(law, c, X, x, out);
    case Shape::hex20:
      return recover<Hex20>(law, c, X, x, out);
    case Shape::bar2: {
      const Vec3 d0 = X[1] - X[0], d = x[1] - x[0];
      const double E = c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu), strain = (d.squaredNorm() / d0.squaredNorm() - 1) / 2;
      const Vec3 n = d.normalized();
      const double s = E * strain * d.norm() / d0.norm();
      out[0] << s * n[0] * n[0], s * n[1] * n[1], s * n[2] * n[2], s * n[1] * n[2], s * n[0] * n[2], s * n[0] * n[1];
      out[1] = out[0];
    }
  }
}

}  // namespace hilo
