// SPDX-License-Identifier: GPL-3.0-or-later
// Shells over a patch of a surface, run as a user would.
#pragma once
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

/// A point of the mid-surface and its normal, along X_u x X_v.
using Surface = std::function<std::pair<Vec3, Vec3>(double u, double v)>;

/// n_u x n_v cells over the unit square, `layers` through the thickness h; facet sets xmin xmax (of u), ymin ymax (of v), zmin zmax.
inline Mesh shell_mesh(const Surface& surface, int n_u, int n_v, double h, int layers = 1) {
  return block_mesh({.n = {n_u, n_v, layers},
                     .map = [&](const Vec3& x) -> Vec3 {
                       const auto [P, N] = surface(x[0], x[1]);
                       return P + h * (x[2] - 0.5) * N;
                     },
                     .regions = {"shell"}});
}
/// Set of the nodes across the thickness at grid point (i, j).
inline void add_stack(Mesh& m, const std::string& name, int i, int j, int n_u, int n_v, int layers = 1) {
  for (int k = 0; k <= layers; ++k) m.node_sets[name].push_back(i + (n_u + 1) * (j + (n_v + 1) * k));
}
inline Surface plate(double a, double b) {
  return [=](double u, double v) { return std::pair(Vec3(a * u, b * v, 0), Vec3(0, 0, 1)); };
}
/// From the top, z, of a cylinder about y by an angle to x, and along y.
inline Surface cylinder(double R, double angle, double length) {
  return [=](double u, double v) {
    const Vec3 n(std::sin(angle * u), 0, std::cos(angle * u));
    return std::pair(Vec3(R * n + length * v * Vec3::UnitY()), n);
  };
}
/// An eighth of a sphere with a hole of 18 degrees about z; u goes around.
inline Surface sphere(double R) {
  return [=](double u, double v) {
    const double t = M_PI / 2 - (M_PI / 2 - M_PI / 10) * v, p = M_PI / 2 * u;
    const Vec3 n(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
    return std::pair(Vec3(R * n), n);
  };
}

inline std::string shell_of(double E, double nu, const std::string& more = "density = 1") {
  return fmt::format("[material.m]\nE = {}\nnu = {}\n{}\n[region.shell]\nmaterial = \"m\"\nshell = true\n", E, nu, more);
}

class ShellPlace : public ScenePlace {
 protected:
  /// How far a probe has gone at the end.
  static Vec3 way(const Results& r, const std::string& probe) {
    const Eigen::MatrixXd x = r.history("probe/" + probe);
    return (x.bottomRows(1) - x.topRows(1)).leftCols<3>().transpose();
  }
};

}  // namespace hilo::test
