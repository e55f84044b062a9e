// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes to the rank that evaluates what joins them.
#include <algorithm>
#include <map>
#include <numeric>

#include "model/local_mesh.hpp"

namespace hilo {

void bring_to_first(LocalMesh& local, const std::vector<char>& marked, const Comm& comm) {
  if (comm.size == 1) return;
  struct Sent {
    std::int64_t row, id, block;
    double x[3];
  };
  struct Member {
    std::int64_t row, name;
  };
  Mesh& mesh = local.mesh;
  const std::vector<std::string> names = mesh.all_names();
  std::vector<Sent> nodes;
  std::vector<Member> members;
  for (size_t i = 0; i < marked.size(); ++i)
    if (marked[i])
      nodes.push_back(
          {local.node_global[i], mesh.node_id[i], mesh.block.empty() ? -1 : mesh.block[i], {mesh.X[i][0], mesh.X[i][1], mesh.X[i][2]}});
  for (size_t k = 0; k < names.size() && !nodes.empty(); ++k)
    for (const std::int64_t i : local.nodes_of(names[k], ""))
      if (marked[i]) members.push_back({local.node_global[i], static_cast<std::int64_t>(k)});
  nodes = comm.to_first(nodes), members = comm.to_first(members);
  if (comm.rank != 0) return;
  std::map<std::int64_t, std::int64_t> added;  // local number of each row
  std::vector<std::int64_t> had = local.node_global;
  std::sort(had.begin(), had.end());
  for (const Sent& node : nodes) {
    if (std::binary_search(had.begin(), had.end(), node.row) || !added.try_emplace(node.row, mesh.n_nodes()).second) continue;
    mesh.X.emplace_back(node.x[0], node.x[1], node.x[2]);
    if (!mesh.block.empty()) mesh.block.push_back(node.block);
    mesh.node_id.push_back(node.id), local.node_global.push_back(node.row), local.node_owned.push_back(0);
  }
  for (const Member& member : members) {
    const auto at = added.find(member.row);
    if (at == added.end()) continue;
    const std::string& name = names[member.name];
    const bool is_set = mesh.find_region(name) < 0 && mesh.node_sets.contains(name);
    (is_set ? mesh.node_sets : local.elsewhere)[name].push_back(at->second);
  }
  for (auto* sets : {&mesh.node_sets, &local.elsewhere})
    for (auto& [name, list] : *sets) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  std::vector<std::int64_t> order(local.node_global.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::int64_t i) { return local.node_global[i]; });
  local.reorder(order);
}

}  // namespace hilo
