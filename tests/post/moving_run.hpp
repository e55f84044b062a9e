// SPDX-License-Identifier: GPL-3.0-or-later
// A run made of formulas: two blocks, "arm" moving as told and "base" at rest, with a joint, a spring and a probe.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "cli.hpp"
#include "model/mesh.hpp"
#include "model/store.hpp"
#include "scene_parts.hpp"

namespace hilo::test {

/// Where a point of the arm is at a time.
using Law = std::function<Vec3(const Vec3& X, double t)>;

/// "base" is the unit cube at the origin, "arm" 2 x 0.5 x 0.5 from (2, 0, 0); n cells along each axis; set "tip" of the arm's end.
inline Mesh two_blocks(int n) {
  Mesh mesh;
  const auto block = [&](const char* name, const Vec3& from, const Vec3& size) {
    const auto region = static_cast<std::int32_t>(mesh.region_name.size());
    mesh.region_name.emplace_back(name);
    mesh.region_data.push_back({});
    const std::int64_t first = mesh.n_nodes();
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          mesh.X.push_back(from + Vec3(i, j, k).cwiseProduct(size) / n);
          mesh.node_id.push_back(mesh.n_nodes());
        }
    const auto at = [&](int i, int j, int k) { return first + (k * (n + 1) + j) * (n + 1) + i; };
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          mesh.add_cell(Shape::hex8,
                        std::array{at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
                                   at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)},
                        region, mesh.n_cells() + 1);
  };
  block("base", {0, 0, 0}, {1, 1, 1});
  block("arm", {2, 0, 0}, {2, 0.5, 0.5});
  for (std::int64_t node = 0; node < mesh.n_nodes(); ++node)
    if (mesh.X[static_cast<size_t>(node)].x() > 3.999) mesh.node_sets["tip"].push_back(node);
  return mesh;
}

/// run.h5 with outputs at 0, 1, ... `steps`.  Joint "pin" between arm (a) and base (b) has the force (5, 0, 0) in its frame, spring
/// "pull" the force (0, 0, -40) in inertial axes.
inline std::string write_moving_run(const Workplace& place, const Law& law, int steps, int n = 2) {
  const Mesh mesh = two_blocks(n);
  write_mesh(place / "mesh.h5", mesh, {"test"});
  const std::string path = place / "run.h5";
  Store run = Store::create_growing(path);
  run.set("/", "format", "hilo run");
  run.set("/", "complete", std::int64_t{1});
  run.set("/", "title", std::string("Two blocks"));
  run.link("/mesh", place / "mesh.h5", "/mesh");
  run.write_text("/scene", solid(2e11, 0.3, 7850) + axial("revolute", "pin", "arm", "base", {0.5, 0.5, 1}, {0, 0, 1}, "x = [0, 1, 0]") +
                               spring("axial", "pull", "ground", "tip", "at_a = [4, 0.25, -3]\nat_b = [4, 0.25, 0.25]\nstiffness = 1") +
                               R"([[sensor]]
name = "eye"
on = "tip"
[history.gone]
file = "gone.csv"
)" + force("push", "tip", {1, 0, 0}, "history = \"gone\"") +
                               in_time(1, 0.1));
  run.start_rows<double>("/history/t", {}, "s");
  for (const char* name : {"joint/pin", "spring/pull"}) run.start_rows<double>(std::string("/history/") + name, {6}, "N, N m");
  run.start_rows<double>("/history/sensor/eye", {3}, "1");
  run.start_rows<double>("/history/probe/end", {9}, "m, m/s, m/s^2");
  for (int k = 0; k <= 10 * steps; ++k) {
    const double t = 0.1 * k;
    const Vec3 p = law({4, 0.25, 0.25}, t);
    run.append<double>("/history/t", std::array{t});
    run.append<double>("/history/joint/pin", std::array{5., 0., 0., 0., 0., 1.});
    run.append<double>("/history/spring/pull", std::array{0., 0., -40., 0., 0., 0.});
    run.append<double>("/history/sensor/eye", std::array{0., 0., 1.});
    run.append<double>("/history/probe/end", std::array{p.x(), p.y(), p.z(), 0., 0., 0., 0., 0., 0.});
  }
  for (int k = 0; k <= steps; ++k) {
    const std::string group = "/field/00000" + std::to_string(k);
    std::vector<double> u, s;
    for (size_t i = 0; i < mesh.X.size(); ++i) {
      const Vec3& X = mesh.X[i];
      const Vec3 d = X.x() > 1.5 ? Vec3(law(X, k) - X) : Vec3(Vec3::Zero());
      u.insert(u.end(), {d.x(), d.y(), d.z()});
      s.push_back(1e6 * (2 * X.x() + 3 * X.y() + X.z()));
    }
    run.write<double>(group + "/displacement", u, {mesh.n_nodes(), 3}, "m");
    run.write<double>(group + "/von_mises", s, {mesh.n_nodes()}, "Pa");
    run.set(group, "t", static_cast<double>(k));
  }
  run.flush();
  return path;
}

}  // namespace hilo::test
