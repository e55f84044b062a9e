// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid regions to bodies: those that share nodes, or that a set which a joint or spring holds has nodes of, are one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_set>

#include "base/joined.hpp"
#include "system/bodies.hpp"
#include "system/build/builder.hpp"

namespace hilo {

std::vector<std::vector<int>> Builder::joined_regions(Fidelity fidelity, Pairs& shared) const {
  agree(shared, comm_);
  const int n = static_cast<int>(regions_.size());
  Joined joined(n);
  for (const auto& [one, other] : shared) joined.join(one, other);
  std::map<int, std::vector<int>> groups;
  for (int r = 0; r < n; ++r)
    if (regions_[r].fidelity == fidelity) groups[joined.root(r)].push_back(r);
  std::vector<std::vector<int>> out;
  for (auto& [r, members] : groups) out.push_back(std::move(members));
  return out;
}

int Builder::new_body_of(const std::vector<int>& members) {
  std::string name;
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  Eigen::Matrix4d drag = Eigen::Matrix4d::Zero();  // about the origin of the integrals
  for (const int r : members) {
    const Region& region = regions_[r];
    name += (name.empty() ? "" : "+") + region.name;
    mass += region.mass, moment += region.moment, second += region.second;
    Eigen::Matrix4d of_region;
    of_region << region.mass, region.moment.transpose(), region.moment, region.second;
    drag += region.alpha * of_region;
  }
  const Vec3 com = moment / mass;
  const int b = new_body(name, origin_ + com);
  Body& body = out_->bodies[b];
  body.mass = mass;
  body.J = second - mass * com * com.transpose();
  body.size = std::sqrt(std::max(body.J.trace() / mass, 1e-300));
  Eigen::Matrix4d to_com = Eigen::Matrix4d::Identity();
  to_com.block<3, 1>(1, 0) = -com;
  auto& of_bodies = out_->part<Bodies>().drag;
  of_bodies.resize(out_->bodies.size(), Eigen::Matrix4d::Zero());
  of_bodies[b] = to_com * drag * to_com.transpose();
  for (const int r : members) regions_[r].body = b;
  return b;
}

/// A set that a joint or spring holds moves as one body, and so do the rigid regions that have nodes of it; not both ends of one, which it
/// would lock. `rigid`: region of each local node, or -1.  Collective.
void Builder::join_by_sets(const std::vector<int>& rigid, Pairs& shared) const {
  const auto n = static_cast<int>(regions_.size());
  if (std::ranges::none_of(regions_, [](const Region& r) { return r.fidelity == Fidelity::rigid; })) return;
  const auto first_of_body = [&] {  // by region
    std::vector<int> first(n, -1);
    auto joined = shared;
    for (const auto& members : joined_regions(Fidelity::rigid, joined))
      for (const int r : members) first[r] = members.front();
    return first;
  };
  const std::vector<int> apart = first_of_body();
  const auto all = mesh_->mesh.all_names();
  const std::unordered_set<std::string> names(all.begin(), all.end());
  struct End {
    const Entry* entry;
    const char* key;
    std::vector<int> bodies;  // that it has nodes of, by their first regions
  };
  std::vector<End> ends;
  Pairs met;  // an end, a body
  for (const char* section : {"joint", "spring"})
    for (const Entry& e : scene_.entries(section))
      for (const char* key : {"a", "b"}) {
        const std::string& name = e.text(key);
        const auto end = static_cast<int>(ends.size());
        if (const int region = mesh_->mesh.find_region(name); region >= 0) {
          if (apart[region] >= 0) met.insert({end, apart[region]});
        } else if (names.contains(name)) {
          for (const std::int64_t i : mesh_->nodes_of(name, e.where(key)))
            if (rigid[i] >= 0) met.insert({end, apart[rigid[i]]});
        }
        ends.push_back({&e, key, {}});
      }
  agree(met, comm_);
  for (const auto& [end, body] : met) ends[static_cast<size_t>(end)].bodies.push_back(body);
  std::vector<std::string> told;
  for (const End& end : ends)
    for (size_t k = 1; k < end.bodies.size(); ++k) {
      const int one = end.bodies[0], other = end.bodies[k];
      shared.insert({one, other});
      const std::string what = fmt::format("\"{}\" has nodes of the rigid regions \"{}\" and \"{}\", which move as one body",
                                           end.entry->text(end.key), regions_[one].name, regions_[other].name);
      if (comm_.rank == 0 && std::find(told.begin(), told.end(), what) == told.end())
        told.push_back(what), warn(end.entry->where(end.key), what);
    }
  const std::vector<int> joined = first_of_body();
  for (size_t k = 0; k < ends.size(); k += 2)
    for (const int a : ends[k].bodies)
      for (const int b : ends[k + 1].bodies)
        if (joined[a] == joined[b] && (ends[k].bodies.size() > 1 || ends[k + 1].bodies.size() > 1 || a != b))
          throw Error(
              ends[k + 1].entry->where("b"),
              fmt::format("{}: the rigid regions \"{}\" and \"{}\" at its ends move as one body, by a set that has nodes of both: it "
                          "would be locked",
                          ends[k].entry->label(), regions_[a].name, regions_[b].name),
              "sets of one part: [set.NAME] of");
}

void Builder::make_rigid_bodies() {
  if (!mesh_) return;
  const Mesh& mesh = mesh_->mesh;
  const int n = static_cast<int>(mesh.n_nodes());
  // rigid region of every local node, also where the rigid cell lives on another rank: rows are kept at rank (row mod ranks)
  std::vector<std::vector<std::int64_t>> tell(comm_.size), ask(comm_.size);
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
    if (regions_[mesh.region[e]].fidelity == Fidelity::rigid)
      for (std::int64_t node : mesh.cell(e)) {
        const std::int64_t row = mesh_->node_global[node];
        tell[row % comm_.size].push_back(row), tell[row % comm_.size].push_back(mesh.region[e]);
      }
  for (int i = 0; i < n; ++i) ask[mesh_->node_global[i] % comm_.size].push_back(mesh_->node_global[i]);
  std::map<std::int64_t, int> region_of_row;
  Pairs shared;  // regions that meet at a node
  for (const auto& list : comm_.exchange(tell))
    for (size_t k = 0; k + 1 < list.size(); k += 2) {
      const auto [it, fresh] = region_of_row.try_emplace(list[k], static_cast<int>(list[k + 1]));
      if (!fresh && it->second != list[k + 1]) shared.insert({it->second, static_cast<int>(list[k + 1])});
    }
  auto questions = comm_.exchange(ask);
  for (auto& list : questions)
    for (auto& row : list) {
      const auto it = region_of_row.find(row);
      row = it == region_of_row.end() ? -1 : it->second;
    }
  const auto answers = comm_.exchange(questions);
  std::vector<size_t> cursor(comm_.size, 0);
  std::vector<int> rigid(n);  // region of each local node, or -1
  for (int i = 0; i < n; ++i) {
    const int keeper = static_cast<int>(mesh_->node_global[i] % comm_.size);
    rigid[i] = static_cast<int>(answers[keeper][cursor[keeper]++]);
  }
  join_by_blocks(rigid, shared);
  join_by_sets(rigid, shared);

  for (const auto& members : joined_regions(Fidelity::rigid, shared)) {
    const Region& first = regions_[members.front()];
    const auto mass = [&](double sum, int r) { return sum + regions_[r].mass; };
    if (!(std::accumulate(members.begin(), members.end(), 0.0, mass) > 0))
      throw Error(first.where, fmt::format("rigid region \"{}\" has no density", first.name), "give its material a density");
    new_body_of(members);
  }
  for (int i = 0; i < n; ++i)
    if (rigid[i] >= 0) out_->follower[i] = regions_[rigid[i]].body;
}

}  // namespace hilo
