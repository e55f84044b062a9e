// SPDX-License-Identifier: GPL-3.0-or-later
// Clusters of cells that can only move together.
#include <algorithm>
#include <limits>
#include <numeric>

#include "base/joined.hpp"
#include "system/solids.hpp"

namespace hilo {

/// Cells that share a face are a cluster, with the nodes that no earlier one has; a node that only bars have is one of its own.  Each rank
/// forms its own; a node that ranks share belongs to the lowest.
int Solids::clusters(std::vector<std::int64_t>& cluster_of) const {
  const auto& follower = points_.follower;
  const auto& node_owned = points_.node_owned;
  const Comm& comm = *points_.comm;
  const auto for_cells = [&](auto&& visit) {
    int cell = 0;
    for (const SolidBatch& b : batches)
      for (size_t e = 0; e < b.cells.size(); ++e, ++cell) {
        const auto n = static_cast<size_t>(info(b.shape).n_nodes);
        visit(cell, b, std::span<const int>(b.nodes.data() + e * n, n));
      }
  };
  int n_cells = 0;
  std::vector<std::pair<std::uint64_t, int>> faces;  // digest of the corners, cell
  for_cells([&](int cell, const SolidBatch& b, std::span<const int> nodes) {
    ++n_cells;
    for (const auto& corners : info(b.shape).facets) {
      std::uint64_t sum = 0;
      for (const int i : corners) {  // splitmix64 of each: any order gives the same sum
        std::uint64_t z = static_cast<std::uint64_t>(nodes[i] + 1) * 0x9e3779b97f4a7c15;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9, z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        sum += z ^ (z >> 31);
      }
      if (info(b.shape).dimension == 3) faces.emplace_back(sum, cell);
    }
  });
  Joined joined(n_cells);
  std::sort(faces.begin(), faces.end());
  for (size_t k = 1; k < faces.size(); ++k)
    if (faces[k].first == faces[k - 1].first) joined.join(faces[k].second, faces[k - 1].second);
  faces = {};
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
  cluster_of.assign(points_.X.size(), none);
  std::vector<int> number(n_cells, -1);
  int n_own = 0;
  for_cells([&](int cell, const SolidBatch& b, std::span<const int> nodes) {
    if (info(b.shape).dimension < 3) return;
    int& k = number[joined.root(cell)];
    if (k < 0) k = n_own++;
    for (const int i : nodes)
      if (follower[i] < 0) cluster_of[i] = std::min<std::int64_t>(cluster_of[i], k);
  });
  for_cells([&](int, const SolidBatch&, std::span<const int> nodes) {
    for (const int i : nodes)
      if (follower[i] < 0 && node_owned[i] && cluster_of[i] == none) cluster_of[i] = n_own++;
  });
  std::vector<double> counts(comm.size, 0.0);
  counts[comm.rank] = n_own;
  comm.sum(counts);
  const auto before = static_cast<int>(std::accumulate(counts.begin(), counts.begin() + comm.rank, 0.0));
  const auto n_clusters = static_cast<int>(std::accumulate(counts.begin(), counts.end(), 0.0));
  for (std::int64_t& c : cluster_of)
    if (c != none) c += before;
  points_.lowest_over_ranks(cluster_of);
  return n_clusters;
}

}  // namespace hilo
