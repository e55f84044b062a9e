// SPDX-License-Identifier: GPL-3.0-or-later
// Flexible cells among the unknowns: blocks, cliques, names, turns, ties.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/shell_shape.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

/// Of a cell whose edges at one corner go from D0 to D1: det((D0 + D1)/2)/sqrt(det D0 det D1) is cos^2(angle/2) of a rotation, and larger
/// where the cell is stretched besides; a corner that is folded over stays so while it turns.  Of a bar, by its direction.
double half_cosine2(const Mat3& D0, const Mat3& D1, int dimension) {
  if (dimension == 1) return (1 + D0.col(0).dot(D1.col(0)) / std::sqrt(D0.col(0).squaredNorm() * D1.col(0).squaredNorm())) / 2;
  const double before = D0.determinant(), both = before * D1.determinant();
  return both > 0 ? ((D0 + D1) / 2).determinant() / std::copysign(std::sqrt(both), before) : 1;
}

/// Distances of the far ends of a cell's first edges from the plane, or the line, of the others: the least [m].
double least_height(const SolidBatch& b, const int* nodes, const std::vector<Vec3>& X) {
  Mat3 D = Mat3::Identity();
  const auto& edges = info(b.shape).edges;
  for (size_t k = 0; k < edges.size(); ++k) D.col(k) = X[nodes[edges[k]]] - X[nodes[0]];
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max(most, D.col(k).cross(D.col((k + 1) % 3)).norm());
  return std::abs(D.determinant()) / most;
}

}  // namespace

Traits Solids::traits() const { return {.deforms = some_, .has_rates = some_, .remembers = remembers_, .is_thin = is_thin_}; }

std::string Solids::count() const {
  std::int64_t cells = 0;
  for (const SolidBatch& b : batches) cells += static_cast<std::int64_t>(b.cells.size());
  return fmt::format("{} flexible cells", points_.comm->sum(cells));
}

void Solids::prepare() {
  some_ = points_.comm->max(batches.empty() ? 0 : 1) > 0;  // cells are on their ranks
  const auto remembers = [](const SolidBatch& b) { return b.kernel.n_state > 0; };
  least_height_ = 1e300;
  for (SolidBatch& b : batches) {
    b.height.clear();
    if (info(b.shape).dimension < 3) continue;  // a bar has no inside
    for (size_t e = 0; e < b.cells.size(); ++e) {
      b.height.push_back(least_height(b, b.nodes.data() + e * static_cast<size_t>(info(b.shape).n_nodes), points_.X));
      least_height_ = std::min(least_height_, b.height.back());
    }
  }
  remembers_ = points_.comm->max(std::any_of(batches.begin(), batches.end(), remembers) ? 1 : 0) > 0;
  const auto is_shell = [](const SolidBatch& b) { return b.shape == shell8; };
  is_thin_ = points_.comm->max(std::any_of(batches.begin(), batches.end(), is_shell) ? 1 : 0) > 0;
  nodes_.assign(points_.mesh ? points_.mesh->mesh.region_name.size() : 0, {});  // every rank has an entry for every region
  // the lowest region, the same on all ranks that share a node
  std::vector<std::int64_t> region(points_.X.size(), std::numeric_limits<std::int64_t>::max());
  for (const SolidBatch& b : batches)
    for (int i : b.nodes) region[i] = std::min<std::int64_t>(region[i], b.region);
  points_.lowest_over_ranks(region);
  for (size_t i = 0; i < region.size(); ++i)
    if (points_.follower[i] < 0 && region[i] < static_cast<std::int64_t>(nodes_.size())) nodes_[region[i]].push_back(static_cast<int>(i));
}

void Solids::number(Layout& layout) {
  for (SolidBatch& b : batches) {
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    b.first_clique = layout.cliques.size();
    for (size_t e = 0; e < b.cells.size(); ++e) layout.cliques.add(points_.blocks_of({b.nodes.data() + e * n, n}), true);
  }
}

std::string Solids::owner(int block) const {
  for (size_t i = 0; i < points_.X.size(); ++i) {
    if (points_.node_block[i] != block) continue;
    const Mesh& mesh = points_.mesh->mesh;
    for (size_t r = 0; r < nodes_.size(); ++r)
      if (std::find(nodes_[r].begin(), nodes_[r].end(), static_cast<int>(i)) != nodes_[r].end())
        return fmt::format("region \"{}\", at node {},", mesh.region_name[r], mesh.node_id[i]);
    return fmt::format("node {}", mesh.node_id[i]);
  }
  return "";
}

void Solids::look_at_turn(const Config& q0, const Config& q1, int part, Turned& most) const {
  for (const SolidBatch& batch : batches) {
    const ShapeInfo& shape = info(batch.shape);
    for (size_t e = 0; e < batch.cells.size(); ++e) {
      const int* nodes = batch.nodes.data() + e * static_cast<size_t>(shape.n_nodes);
      Mat3 D0 = Mat3::Zero(), D1 = Mat3::Zero();
      for (size_t k = 0; k < shape.edges.size(); ++k) {
        const int far = nodes[shape.edges[k]];
        D0.col(k) = q0.x[far] - q0.x[nodes[0]], D1.col(k) = q1.x[far] - q1.x[nodes[0]];
      }
      most.look(half_cosine2(D0, D1, shape.dimension), part, batch.region);
    }
  }
}

std::string Solids::name(int region) const { return "a cell of region \"" + points_.mesh->mesh.region_name[region] + "\""; }

void Solids::commit(const Config& q, const Config*) {
  if (some_) watch_strain(q);
}

void Solids::tie(Ties& ties) const {
  for (const SolidBatch& b : batches)
    for (const int node : b.nodes)
      if (const int body = points_.follower[node]; body >= 0 && points_.body_block[body] >= 0) ties.exclude(body);
}

}  // namespace hilo
