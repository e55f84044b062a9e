// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes, laws and bent cells to run the solid kernels on.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "physics/material/materials.hpp"
#include "physics/shape/tet10.hpp"
#include "physics/shape/wedge15.hpp"
#include "physics/solid_cell.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {

template <class S>
struct ShapeOf;
template <>
struct ShapeOf<Tet4> {
  static constexpr Shape shape = Shape::tet4;
};
template <>
struct ShapeOf<Tet10> {
  static constexpr Shape shape = Shape::tet10;
};
template <>
struct ShapeOf<Wedge6> {
  static constexpr Shape shape = Shape::wedge6;
};
template <>
struct ShapeOf<Wedge15> {
  static constexpr Shape shape = Shape::wedge15;
};
template <>
struct ShapeOf<Hex8> {
  static constexpr Shape shape = Shape::hex8;
};
template <>
struct ShapeOf<Hex20> {
  static constexpr Shape shape = Shape::hex20;
};
template <>
struct ShapeOf<Hex20R> {
  static constexpr Shape shape = Shape::hex20r;
};
template <>
struct ShapeOf<Shell8> {
  static constexpr Shape shape = shell8;
};

template <class S>
inline constexpr bool is_tet = S::n == 4 || S::n == 10;
template <class S>
inline constexpr bool is_wedge = S::n == 6 || S::n == 15;

/// Corners of the reference cell, from the definition of the cell and not from its shape functions.
template <class S>
std::vector<Vec3> local_corners() {
  if (is_tet<S>) return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (is_wedge<S>) return {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
}

/// Middles of the edges of a list of corners, in VTK's order; nothing for linear shapes.
template <class S>
void add_middles(std::vector<Vec3>& x) {
  using Edges = std::vector<std::pair<int, int>>;
  Edges edges;
  if (S::n == 10) edges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  if (S::n == 15) edges = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  if (S::n == 20) edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  for (const auto& [a, b] : edges) x.push_back((x[a] + x[b]) / 2);
}

template <class S>
std::vector<Vec3> local_nodes() {
  auto x = local_corners<S>();
  add_middles<S>(x);
  return x;
}

/// The reference cell under a linear map (scaled, sheared, turned), its corners then moved by up to `distortion`.
template <class S>
std::vector<Vec3> some_cell(double distortion, int seed = 0) {
  Mat3 A;
  A << 1.1, 0.3, -0.1, 0.2, 0.8, 0.25, -0.15, 0.1, 0.6;
  auto x = local_corners<S>();
  for (size_t a = 0; a < x.size(); ++a) {
    x[a] = A * x[a] + Vec3(0.7, -0.4, 2);
    for (int i = 0; i < 3; ++i) x[a][i] += distortion * scatter(seed + static_cast<int>(3 * a) + i);
  }
  add_middles<S>(x);
  return x;
}

/// x = R F X + noise: a large strain and a turn about a skew axis.
inline std::vector<Vec3> bent(const std::vector<Vec3>& X, double angle, double strain, int seed) {
  Mat3 U = Mat3::Identity();
  for (int i = 0; i < 9; ++i) U(i / 3, i % 3) += strain * scatter(100 + seed + i);
  const Mat3 F = Eigen::AngleAxisd(angle, Vec3(1, -2, 0.5).normalized()).toRotationMatrix() * U;
  std::vector<Vec3> x;
  for (size_t a = 0; a < X.size(); ++a) {
    x.push_back(F * X[a] + Vec3(0.2, 1, -0.3));
    for (int i = 0; i < 3; ++i) x.back()[i] += 0.3 * strain * scatter(500 + seed + static_cast<int>(3 * a) + i);
  }
  return x;
}

inline std::vector<double> flat(const std::vector<Vec3>& x) {
  std::vector<double> out;
  for (const Vec3& p : x) out.insert(out.end(), p.data(), p.data() + 3);
  return out;
}

/// What the kernel of one cell gives.
template <class T>
struct Evaluated {
  std::vector<T> f, K;
  T energy, dissipated, least_det;
};

struct Wish {
  double elastic = 1, viscous = 0, density = 0, mass_slope = 0, weight = 0.5;
  bool tangent = true;
};

/// A law of these moduli at small strain; of those that are not isotropic one of this softness.
template <class M>
M law_of(const Lame& c) {
  if constexpr (std::is_same_v<M, MooneyRivlin>) {
    return {0.35 * c.mu, 0.15 * c.mu, c.lambda + 2 * c.mu / 3};
  } else if constexpr (std::is_same_v<M, Orthotropic>) {
    Mat6 own = Mat6::Zero();
    own.diagonal() << 1 / 5., 1, 2, 4, 3, 2.5;
    own(0, 1) = own(1, 0) = -0.06, own(0, 2) = own(2, 0) = -0.08, own(1, 2) = own(2, 1) = -0.4;
    M law;
    law.moduli = Anisotropic(own / young_of(c), Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix());
    law.mean = law.moduli.near_isotropic();
    return law;
  } else {
    return {c};
  }
}

/// The cell kernel through the same templates as the solver, for any number type.
template <class S, class Material, class T>
Evaluated<T> evaluate_cell(const Lame& c, const std::vector<T>& X, const std::vector<T>& x0, const std::vector<T>& x1,
                           const Wish& wish = {}, const std::vector<T>* a = nullptr) {
  Evaluated<T> out{std::vector<T>(3 * S::n, T(0.0)), std::vector<T>(wish.tangent ? 9 * S::n * S::n : 0, T(0.0)), T(0.0), T(0.0), T(1e300)};
  const SolidCall<T> call{X.data(),
                          x0.data(),
                          x1.data(),
                          wish.elastic,
                          wish.viscous,
                          c,
                          out.f.data(),
                          wish.tangent ? out.K.data() : nullptr,
                          &out.energy,
                          &out.dissipated,
                          &out.least_det,
                          wish.density,
                          a ? a->data() : nullptr,
                          wish.mass_slope,
                          wish.weight};
  evaluate_strain<S>(law_of<Material>(c), call);
  if (a) add_mass<S>(call);
  return out;
}

inline double largest(const std::vector<double>& v) {
  double top = 0;
  for (double x : v) top = std::max(top, std::abs(x));
  return top;
}

inline constexpr Lame rubber = lame(2.5e6, 0.3), nearly_incompressible = lame(2.5e6, 0.4999);
inline const Material both_laws[] = {StVenantKirchhoff{rubber}, NeoHookean{rubber}};

}  // namespace hilo::test
