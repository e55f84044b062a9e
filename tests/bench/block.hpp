// SPDX-License-Identifier: GPL-3.0-or-later
// What the benches of cells share: a clock, and a block of cells of one shape as a system.
#pragma once
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <tuple>

#include "../model/block.hpp"
#include "base/shell_shape.hpp"
#include "physics/solid_kernel.hpp"
#include "system/solids.hpp"
#include "system/system.hpp"

namespace hilo::bench {

/// Of the processor: what else runs on the machine hardly matters.
inline double seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Best of five timings of `body` run n times, in microseconds per run.
template <class F>
double microseconds(int n, F body) {
  double best = 1e300;
  for (int k = 0; k < 5; ++k) {
    const double start = seconds();
    for (int i = 0; i < n; ++i) body();
    best = std::min(best, seconds() - start);
  }
  return best / n * 1e6;
}

/// The first corners of the cells of a shape that fill a cube: an affine map of the reference cell each.
inline std::vector<std::array<Vec3, 4>> cells_of_cube(int n_corners) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  if (n_corners == 8 || n_corners == 2) return {{o, x, y, z}};
  if (n_corners == 6) return {{o, x, y, z}, {Vec3(x + y), y, x, Vec3(x + y + z)}};
  std::vector<std::array<Vec3, 4>> out;  // one tetrahedron for each way from corner to opposite corner
  for (const auto& [a, b] : {std::pair{x, y}, {y, z}, {z, x}}) out.push_back({o, a, Vec3(a + b), Vec3(x + y + z)});
  for (const auto& [a, b] : {std::pair{y, x}, {z, y}, {x, z}}) out.push_back({o, Vec3(a + b), a, Vec3(x + y + z)});
  return out;
}

/// Nodes of the reference cell; those of a shell lie as in hex8.
inline std::vector<Vec3> reference_nodes(Shape shape) { return test::reference_nodes(shape == shell8 ? Shape::hex8 : shape); }

inline const Material laws[] = {StVenantKirchhoff{lame(1e9, 0.3)}, NeoHookean{lame(1e9, 0.3)}};

/// n x n x n cubes filled with cells of one shape and law, as a system.
struct Block {
  LocalMesh local;
  System system;
  Block(Shape shape, const Material& law, int n) {
    SolidBatch b{};
    b.shape = shape, b.material = law, b.density = 1000, b.area = 0.1, b.kernel = solid_kernel(shape, law.index());
    const auto reference = reference_nodes(shape);
    std::map<std::tuple<int, int, int>, int> node;  // by twice the position
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          for (const auto& c : cells_of_cube(info(shape).n_corners)) {
            for (const Vec3& r : reference) {
              const Vec3 x = Vec3(i, j, k) + c[0] + r[0] * (c[1] - c[0]) + r[1] * (c[2] - c[0]) + r[2] * (c[3] - c[0]);
              const std::tuple key(static_cast<int>(std::lround(2 * x[0])), static_cast<int>(std::lround(2 * x[1])),
                                   static_cast<int>(std::lround(2 * x[2])));
              const auto [it, is_new] = node.try_emplace(key, static_cast<int>(system.X.size()));
              if (is_new) system.X.push_back(x);
              b.nodes.push_back(it->second);
            }
            b.cells.push_back(static_cast<int>(b.cells.size()));
          }
    local.mesh.region_name = {"block"};
    system.comm = &Comm::world();
    system.mesh = &local;
    system.follower.assign(system.X.size(), -1);
    system.fixed.assign(system.X.size(), {false, false, false});
    system.node_owned.assign(system.X.size(), 1);
    Body ground;
    ground.ground = true;
    system.bodies.push_back(ground);
    system.start.x = system.X, system.start.c = {Vec3::Zero()}, system.start.R = {Mat3::Identity()};
    system.add<Solids>(system).batches.push_back(std::move(b));
    system.prepare();
  }
};

/// A system at rest between two instants: what an assembly is asked for in a dynamic step.
struct AtRest {
  Config a, mid;
  Stage stage{};
  Residual residual;
  std::vector<double> lambda;
  explicit AtRest(const System& system)
      : a(system.start), mid(system.start), lambda(3 * static_cast<size_t>(system.n_joint_blocks()), 0.0) {
    for (auto* list : {&a.x, &a.c})
      for (Vec3& x : *list) x.setZero();
    for (Mat3& R : a.R) R.setZero();
    Stage& s = stage;
    s.e0 = s.w0 = s.e1 = s.w1 = s.end = &system.start, s.left = &mid, s.a = &a, s.h = 1e-3, s.mass_slope = 2e6;
  }
  AtRest(const AtRest&) = delete;
};

}  // namespace hilo::bench
