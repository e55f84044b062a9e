// SPDX-License-Identifier: GPL-3.0-or-later
#include "part/graph.hpp"

#include <fmt/format.h>
#include <metis.h>

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "model/partition.hpp"

namespace hilo {
namespace {

static_assert(sizeof(idx_t) == sizeof(std::int32_t));

constexpr std::int32_t joint_work = 16;  // with its share of the bodies it joins, by costs-bench
/// What it costs to part two cells: unknowns are exchanged between nonlinear ones, next to nothing where one is rigid or linear.
constexpr std::int32_t between_nonlinear = 8, beside_other = 1, through_joint = 4;

void build_dual(const Mesh& mesh, CellGraph& g) {
  std::vector<idx_t> start{0}, corner;
  if (mesh.nodes.size() > static_cast<size_t>(std::numeric_limits<idx_t>::max()))
    throw Error("", fmt::format("{} cell nodes are too many for 32-bit METIS", mesh.nodes.size()), "", Exit::resources);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const auto cell = mesh.cell(c);
    corner.insert(corner.end(), cell.begin(), cell.begin() + info(mesh.shape[c]).n_corners);  // mid-side nodes would join over edges
    start.push_back(static_cast<idx_t>(corner.size()));
  }
  idx_t cells = static_cast<idx_t>(mesh.n_cells()), nodes = static_cast<idx_t>(mesh.n_nodes()), common = 3, from_zero = 0;
  idx_t *first = nullptr, *next = nullptr;
  if (METIS_MeshToDual(&cells, &nodes, start.data(), corner.data(), &common, &from_zero, &first, &next) != METIS_OK) throw std::bad_alloc();
  g.first.assign(first, first + cells + 1);
  g.next.assign(next, next + first[cells]);
  METIS_Free(first);
  METIS_Free(next);
}

/// The cell that has a node of `nodes` and lies nearest to `at`; nonlinear ones are preferred.
std::int32_t nearest_cell(const Mesh& mesh, const CellGraph& g, const std::vector<std::int64_t>& nodes, const Vec3& at) {
  std::vector<char> in(mesh.X.size(), 0);
  for (const auto n : nodes) in[n] = 1;
  std::int32_t best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const auto cell = mesh.cell(c);
    if (!std::ranges::any_of(cell, [&](auto n) { return in[n] != 0; })) continue;
    Vec3 centre = Vec3::Zero();
    for (const auto n : cell) centre += mesh.X[n] / static_cast<double>(cell.size());
    const double distance = (centre - at).squaredNorm();
    const bool better_kind = best >= 0 && g.is_nonlinear[c] && !g.is_nonlinear[best];
    const bool worse_kind = best >= 0 && !g.is_nonlinear[c] && g.is_nonlinear[best];
    if (better_kind || (distance < least && !worse_kind)) best = static_cast<std::int32_t>(c), least = distance;
  }
  return best;
}

void add_edges(CellGraph& g, const std::vector<std::pair<std::int32_t, std::int32_t>>& edges) {
  std::vector<std::vector<std::int32_t>> more(g.nonlinear.size());
  const auto neighbours = [&](std::int32_t c) { return std::span(g.next).subspan(g.first[c], g.first[c + 1] - g.first[c]); };
  for (const auto& [a, b] : edges) {
    if (a == b || std::ranges::count(neighbours(a), b) || std::ranges::count(more[a], b)) continue;
    more[a].push_back(b), more[b].push_back(a);
  }
  std::vector<std::int32_t> first{0}, next, joined;
  for (std::int32_t c = 0; c < g.n(); ++c) {
    for (auto k = g.first[c]; k < g.first[c + 1]; ++k) next.push_back(g.next[k]), joined.push_back(g.joined[k]);
    for (const auto b : more[c]) next.push_back(b), joined.push_back(through_joint);
    first.push_back(static_cast<std::int32_t>(next.size()));
  }
  g.first = std::move(first), g.next = std::move(next), g.joined = std::move(joined);
}

void add_joints(const Mesh& mesh, const Scene& scene, CellGraph& g) {
  const auto names = mesh.all_names();
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (const std::string_view section : {"joint", "spring"})
    for (const Entry& e : scene.entries(section)) {
      std::vector<std::int32_t> ends;
      for (const std::string end : {"a", "b"}) {
        const std::string name = e.text(end), point = e.has("at") ? "at" : "at_" + end;
        if (std::find(names.begin(), names.end(), name) == names.end()) continue;  // ground, or a body without a mesh
        const auto nodes = mesh.nodes_of(name, e.where(end));
        if (nodes.empty()) continue;
        const auto cell = nearest_cell(mesh, g, nodes, e.has(point) ? e.vector3(point) : mesh.X[nodes[0]]);
        if (cell >= 0) ends.push_back(cell);
      }
      if (ends.empty()) continue;
      (g.is_nonlinear[ends[0]] ? g.nonlinear : g.other)[ends[0]] += joint_work;
      if (ends.size() == 2) edges.emplace_back(ends[0], ends[1]);
      ++g.joints;
    }
  add_edges(g, edges);
}

}  // namespace

CellGraph cell_graph(const Mesh& mesh, const std::vector<Fidelity>& fidelity, const Scene* scene) {
  CellGraph g;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const bool nonlinear = fidelity[mesh.region[c]] == Fidelity::nonlinear;
    g.is_nonlinear.push_back(nonlinear);
    g.nonlinear.push_back(nonlinear ? work_of_cell(static_cast<Shape>(mesh.shape[c])) : 0);
    g.other.push_back(nonlinear ? 0 : 1);
  }
  build_dual(mesh, g);
  for (std::int32_t c = 0; c < g.n(); ++c)
    for (auto k = g.first[c]; k < g.first[c + 1]; ++k)
      g.joined.push_back(g.is_nonlinear[c] && g.is_nonlinear[g.next[k]] ? between_nonlinear : beside_other);
  if (scene) add_joints(mesh, *scene, g);
  return g;
}

std::vector<int> pieces_of_parts(const CellGraph& g, const std::vector<std::int32_t>& part, int n_parts, bool nonlinear_only) {
  std::vector<int> pieces(n_parts, 0);
  std::vector<char> seen(part.size(), 0);
  std::vector<std::int32_t> stack;
  const auto skip = [&](std::int32_t c) { return seen[c] || (nonlinear_only && !g.is_nonlinear[c]); };
  for (std::int32_t start = 0; start < g.n(); ++start) {
    if (skip(start)) continue;
    ++pieces[part[start]];
    seen[start] = 1;
    stack.push_back(start);
    while (!stack.empty()) {
      const auto c = stack.back();
      stack.pop_back();
      for (auto k = g.first[c]; k < g.first[c + 1]; ++k)
        if (const auto b = g.next[k]; !skip(b) && part[b] == part[start]) seen[b] = 1, stack.push_back(b);
    }
  }
  return pieces;
}

}  // namespace hilo
