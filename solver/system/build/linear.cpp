// SPDX-License-Identifier: GPL-3.0-or-later
// Linear regions: their mean axes, and what they are welded to.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "system/build/builder.hpp"
#include "system/linear_regions.hpp"
#include "system/welds.hpp"

namespace hilo {

/// Linear regions joined by shared nodes are one, with common mean axes and modes.  Their nodes follow it, but those that a rigid neighbour
/// has.
void Builder::make_linear_bodies() {
  if (!mesh_) return;
  const auto n = static_cast<int>(regions_.size());
  std::vector<int> first(out_->X.size(), -1);
  Pairs shared;  // regions that meet at a node
  for (int r = 0; r < n; ++r) {
    if (regions_[r].fidelity != Fidelity::linear) continue;
    for (const std::int64_t i : mesh_->nodes_of(regions_[r].name, regions_[r].where)) {
      if (out_->follower[i] >= 0) continue;
      if (first[i] < 0) first[i] = r;
      if (first[i] != r) shared.insert({first[i], r});
    }
  }
  join_by_blocks(first, shared);
  for (const auto& members : joined_regions(Fidelity::linear, shared)) {
    const Region& one = regions_[members.front()];
    for (const int r : members) {
      const Region& region = regions_[r];
      if (!(region.mass > 0))
        throw Error(region.where, fmt::format("linear region \"{}\" has no density", region.name), "give its material a density");
      if (region.stiffening != one.stiffening)
        throw Error(region.where,
                    fmt::format("linear regions \"{}\" and \"{}\" share nodes, but differ in stiffening", one.name, region.name),
                    "give both the same value");
      if (region.modal_damping != one.modal_damping)
        throw Error(
            region.where,
            fmt::format("linear regions \"{}\" and \"{}\" share nodes and modes, but differ in modal_damping", one.name, region.name),
            "give both the same value");
    }
    out_->bodies[new_body_of(members)].linear = true;
  }
  for (size_t i = 0; i < first.size(); ++i)
    if (first[i] >= 0) out_->follower[i] = regions_[first[i]].body;
}

/// Nodes of one region and body are one weld, whatever names them.  Collective.
void Builder::weld(int linear_body, int body, const std::string& name, const std::vector<int>& nodes) {
  auto& list = out_->part<Welds>().list;
  const auto& names = mesh_->mesh.block_name;
  const bool of_block =
      comm_.max(!names.empty() && std::ranges::any_of(nodes, [&](int i) { return mesh_->mesh.block[i] >= 0; }) ? 1 : 0) > 0;
  for (Weld& w : list)
    if (out_->modes[w.modes].body == linear_body && w.body == body) {
      for (const int i : nodes)
        if (std::find(w.nodes.begin(), w.nodes.end(), i) == w.nodes.end()) w.nodes.push_back(i);
      w.at = mean_of(w.nodes);
      w.of_block = w.of_block || of_block;
      return;
    }
  Weld w;
  w.name = name, w.body = body, w.nodes = nodes, w.at = mean_of(nodes), w.of_block = of_block;
  w.modes = out_->modes_of[linear_body];
  list.push_back(std::move(w));
}

/// Where linear regions share nodes with rigid ones.  Collective.
void Builder::weld_neighbours() {
  out_->modes_of.assign(out_->bodies.size(), -1);
  const int n_bodies = static_cast<int>(out_->bodies.size());
  for (int linear = 0; linear < n_bodies; ++linear) {
    if (!out_->bodies[linear].linear) continue;
    out_->modes_of[linear] = static_cast<int>(out_->modes.size());
    out_->modes.emplace_back().body = linear;
    std::map<int, std::vector<int>> shared;  // by the body that has them
    for (const Region& region : regions_) {
      if (region.fidelity != Fidelity::linear || region.body != linear) continue;
      for (const std::int64_t i : mesh_->nodes_of(region.name, region.where))
        if (const int b = out_->follower[i]; b != linear && b >= 0) shared[b].push_back(static_cast<int>(i));
    }
    for (int b = 0; b < n_bodies; ++b) {
      auto& nodes = shared[b];
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      if (comm_.max(nodes.empty() ? 0 : 1) > 0) weld(linear, b, out_->bodies[b].name, nodes);
    }
  }
}

/// Mean axes and modes are orthogonal in mass: each takes its own share of M v.
void Builder::set_modal_velocity(int body, const std::vector<Vec3>& nodal, Config& v) const {
  const Body& axes = out_->bodies[body];
  const Modes& modes = out_->modes[out_->modes_of[body]];
  const LinearRegions& linear = out_->part<LinearRegions>();
  const StVenantKirchhoff no_matter{{1, 1}};
  struct alignas(64) Line {  // as the widest kernels load them
    double value[8];
  };
  std::vector<Line> scratch;
  std::vector<double> sum(6 + 3 * static_cast<size_t>(modes.n_blocks), 0.0);  // momentum, angular momentum about the centre, of modes
  for (size_t k = 0; k < linear.cells.size(); ++k) {
    if (linear.body_of_cells[k] != body) continue;
    const SolidBatch& cells = linear.cells[k];
    const SolidKernel kernel = solid_kernel(cells.shape, place_of<StVenantKirchhoff>);
    const size_t n = static_cast<size_t>(info(cells.shape).n_nodes), w = static_cast<size_t>(kernel.width);
    scratch.resize(9 * n);
    double *X = scratch[0].value, *a = scratch[3 * n].value, *f = scratch[6 * n].value;
    for (size_t first = 0; first < cells.nodes.size(); first += n) {
      for (size_t i = 0; i < 3 * n; ++i)
        for (size_t l = 0; l < w; ++l) {
          const int node = cells.nodes[first + i / 3];
          X[i * w + l] = out_->X[node][i % 3], a[i * w + l] = nodal[node][i % 3];
        }
      kernel.call({X, X, X, 0, 0, &no_matter, f, nullptr, nullptr, nullptr, nullptr, cells.density, a, 0, cells.area});
      for (size_t i = 0; i < n; ++i) {
        const int node = cells.nodes[first + i];
        const Vec3 p(f[3 * i * w], f[(3 * i + 1) * w], f[(3 * i + 2) * w]), L = (out_->X[node] - axes.Xc).cross(p);
        for (int c = 0; c < 3; ++c) sum[c] += p[c], sum[3 + c] += L[c];
        const auto shapes = out_->shapes_at(node);
        for (size_t j = 0; j < shapes.size(); ++j) sum[6 + j] += shapes[j].dot(p);
      }
    }
  }
  comm_.sum(sum);
  set_velocity(body, sum, v);
}

void Builder::set_velocity(int body, std::span<const double> sum, Config& v) const {
  const Body& axes = out_->bodies[body];
  const Modes& modes = out_->modes[out_->modes_of[body]];
  const Mat3 inertia = axes.J.trace() * Mat3::Identity() - axes.J;
  v.c[body] = Vec3(sum[0], sum[1], sum[2]) / axes.mass;
  v.R[body] = skew(inertia.ldlt().solve(Vec3(sum[3], sum[4], sum[5])));
  for (int j = 0; j < 3 * modes.n_blocks; ++j) {
    v.eta[modes.first + j / 3][j % 3] = sum[6 + j];
    v.Y[3 * modes.first + j] = sum[6 + j] * Mat3::Identity();
  }
}

}  // namespace hilo
