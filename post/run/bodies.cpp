// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of bodies alone: ellipsoids of their inertia stand for a mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "post/run/ellipsoid.hpp"
#include "post/run/marker.hpp"
#include "post/run/run_beams.hpp"
#include "post/run/run_file.hpp"
#include "post/run/swept_beams.hpp"

namespace hilo {
namespace {

/// Tetrahedra from the centre to a grid of the surface.
void add_ellipsoid(Mesh& mesh, const Ellipsoid& body, double smallest) {
  constexpr int around = 24, rows = 12;
  const Vec3 r = body.radii.cwiseMax(std::max(0.04 * body.radii.maxCoeff(), smallest));
  const auto region = static_cast<std::int32_t>(mesh.region_name.size());
  mesh.region_name.push_back(body.name);
  mesh.region_data.emplace_back();
  const std::int64_t first = mesh.n_nodes();
  const auto add = [&](const Vec3& unit) {
    mesh.node_id.push_back(mesh.n_nodes() + 1);
    mesh.X.push_back(body.centre + body.axes * r.cwiseProduct(unit));
  };
  add(Vec3::Zero()), add(Vec3::UnitZ()), add(-Vec3::UnitZ());
  for (int j = 1; j < rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * M_PI * i / around, b = M_PI * j / rows;
      add({std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)});
    }
  const auto at = [&](int j, int i) { return first + (j == 0 ? 1 : j == rows ? 2 : 3 + (j - 1) * around + i % around); };
  const auto tet = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    if (a != b && b != c && a != c) mesh.add_cell(Shape::tet4, std::array{a, b, c, first}, region, mesh.n_cells() + 1);
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < around; ++i) tet(at(j, i), at(j, i + 1), at(j + 1, i + 1)), tet(at(j, i), at(j + 1, i + 1), at(j + 1, i));
}

}  // namespace

void RunFile::stand_in_bodies() {
  if (has_mesh() || mesh_) return;
  const auto names = store_->read_strings("/body/name");
  const auto points = store_->read<double>("/body/points");
  const Scene scene = scene_of(*this);
  std::vector<Ellipsoid> ellipsoids;
  for (const Entry& e : scene.entries("body")) ellipsoids.push_back(ellipsoid_of(e));
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double largest = 0;
  for (const Ellipsoid& e : ellipsoids)
    low = low.cwiseMin(e.centre), high = high.cwiseMax(e.centre), largest = std::max(largest, e.radii.maxCoeff());
  const double size = std::max(largest, ellipsoids.size() > 1 ? (high - low).norm() : 0), smallest = size > 0 ? 0.02 * size : 0.05;
  MeshFile file;
  for (const Ellipsoid& e : ellipsoids) {
    const auto k = static_cast<size_t>(std::find(names.begin(), names.end(), e.name) - names.begin());
    if (k == names.size()) continue;
    Body body;
    for (size_t i = 0; i < 4; ++i) body.X.emplace_back(&points[12 * k + 3 * i]);
    body.way = series("body." + e.name);
    body.first = file.mesh.X.size();
    add_ellipsoid(file.mesh, e, smallest);
    body.last = file.mesh.X.size();
    bodies_.push_back(std::move(body));
  }
  if (bodies_.empty() && beams().empty())
    throw Error(path, "holds neither a mesh nor bodies to draw", "its histories are there: hilo-post series --list");
  file.fidelity.assign(file.mesh.region_name.size(), Fidelity::rigid);
  file.tagged = true;
  mesh_ = std::move(file);
  steps.clear();
  const std::vector<double> t = bodies_.empty() ? store_->read<double>("/history/t") : bodies_.front().way.t;
  for (size_t row = 0; row < t.size(); ++row) steps.push_back({fmt::format("{:06}", row), t[row]});
}

RunFile::Field RunFile::bodies_displacement(const Step& step) const {
  const auto row = static_cast<size_t>(std::stoul(step.key));
  Field u{std::vector<double>(3 * (swept_ ? swept_->first_node() : mesh_->mesh.X.size())), 3};
  for (const Body& body : bodies_) {
    std::vector<Vec3> now;
    for (size_t i = 0; i < 4; ++i) now.emplace_back(body.way.at(row, 3 * i), body.way.at(row, 3 * i + 1), body.way.at(row, 3 * i + 2));
    Pose pose = best_pose(body.X, now);
    pose.from = body.X[0], pose.to = now[0];
    for (size_t n = body.first; n < body.last; ++n) {
      const Vec3 d = pose(mesh_->mesh.X[n]) - mesh_->mesh.X[n];
      std::copy_n(d.data(), 3, u.value.begin() + static_cast<std::ptrdiff_t>(3 * n));
    }
  }
  return u;
}

}  // namespace hilo
