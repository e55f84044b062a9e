// SPDX-License-Identifier: GPL-3.0-or-later
// Cells to the ranks that compute them, and the nodes that they need.
#include <cmath>

#include "model/distribution.hpp"

namespace hilo::division {

void Distribution::send_cells(const std::vector<int>& part) {
  rank_of_cell_.assign(part.begin(), part.end());
  std::vector<Rows> send(comm_.size);
  const auto first = cells_.first(comm_.rank);
  for (size_t c = 0; c < part.size(); ++c) {
    auto& to = send[part[c]];
    to.insert(to.end(), {first + static_cast<std::int64_t>(c), shape_[c], region_[c], cell_id_[c]});
    to.insert(to.end(), cell_nodes_.begin() + (offset_[c] - offset_[0]), cell_nodes_.begin() + (offset_[c + 1] - offset_[0]));
  }
  Rows().swap(cell_nodes_), Rows().swap(offset_), Rows().swap(cell_id_), std::vector<std::uint8_t>().swap(shape_);
  for (const auto& list : comm_.exchange(send))  // slices come in the order of their ranks: rows stay sorted
    for (size_t k = 0; k < list.size();) {
      const auto shape = static_cast<Shape>(list[k + 1]);
      const auto n = static_cast<size_t>(info(shape).n_nodes);
      out_.cell_global.push_back(list[k]);
      out_.mesh.add_cell(shape, {&list[k + 4], n}, static_cast<std::int32_t>(list[k + 2]), list[k + 3]);
      k += 4 + n;
    }
}

void Distribution::collect_nodes() {
  Rows& rows = out_.node_global;
  rows = out_.mesh.nodes;
  sort_unique(rows);
  std::vector<Rows> tell(comm_.size);
  for (const auto row : rows) tell[nodes_.holder(row)].push_back(2 * row + 1);  // odd: has a cell
  for (const auto row : lone_nodes_)
    if (!std::binary_search(out_.node_global.begin(), out_.node_global.end(), row)) tell[nodes_.holder(row)].push_back(2 * row);
  rows.insert(rows.end(), lone_nodes_.begin(), lone_nodes_.end());
  sort_unique(rows);
  const auto told = comm_.exchange(tell);
  const auto first = nodes_.first(comm_.rank), n = nodes_.first(comm_.rank + 1) - first;
  holders_.resize(n), owner_.assign(n, -1);
  for (int r = 0; r < comm_.size; ++r)
    for (const auto word : told[r]) {
      const auto i = word / 2 - first;
      if (holders_[i].empty() || holders_[i].back() != r) holders_[i].push_back(r);
      if (word % 2 && owner_[i] < 0) owner_[i] = r;
    }
  // nodes of no cell belong to rank 0
  std::vector<Rows> orphans(comm_.size);
  for (std::int64_t i = 0; i < n; ++i) {
    if (owner_[i] >= 0) continue;
    owner_[i] = 0;
    if (!holders_[i].empty()) continue;
    holders_[i].push_back(0);
    orphans[0].push_back(first + i);
  }
  for (const auto& list : comm_.exchange(orphans)) rows.insert(rows.end(), list.begin(), list.end());
  sort_unique(rows);
  for (auto& i : out_.mesh.nodes) i = local_node(i);
}

void Distribution::find_owners() {
  const Rows& rows = out_.node_global;
  std::vector<std::int64_t> facts;  // owner, and whether several ranks have the node
  facts.reserve(2 * owner_.size());
  for (size_t i = 0; i < owner_.size(); ++i) facts.insert(facts.end(), {owner_[i], holders_[i].size() > 1});
  const auto known = fetch(rows, facts, 2);
  out_.node_owned.resize(rows.size()), shared_.resize(rows.size());
  for (size_t i = 0; i < rows.size(); ++i) out_.node_owned[i] = known[2 * i] == comm_.rank, shared_[i] = known[2 * i + 1] != 0;
  const auto X = fetch(rows, X_, 3);
  out_.mesh.X.resize(rows.size());
  for (size_t i = 0; i < rows.size(); ++i) out_.mesh.X[i] = Vec3(X[3 * i], X[3 * i + 1], X[3 * i + 2]);
  out_.mesh.node_id = fetch(rows, node_id_, 1);
  if (!out_.mesh.block_name.empty()) {
    out_.mesh.block = fetch(rows, block_, 1);
    comm_.together([&] { check_blocks(mesh_file(), out_.mesh); });
  }
  double box[6];
  for (int k = 0; k < 6; ++k) {
    double high = -1e300;
    for (size_t i = k % 3; i < X_.size(); i += 3) high = std::max(high, k < 3 ? -X_[i] : X_[i]);
    box[k] = comm_.max(high);
  }
  if (nodes_.n > 0) out_.length = std::hypot(box[0] + box[3], box[1] + box[4], box[2] + box[5]);
  std::vector<double>().swap(X_), Rows().swap(node_id_), Rows().swap(block_);
}

}  // namespace hilo::division
