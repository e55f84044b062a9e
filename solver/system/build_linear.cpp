// Linear regions: their mean axes, and what they are welded to.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "system/builder.hpp"
#include "system/welds.hpp"

namespace hilo {

/// Linear regions joined by shared nodes are one, with common mean axes and modes.  Their nodes follow it, but those that a rigid neighbour
/// has.
void Builder::make_linear_bodies() {
  if (!mesh_) return;
  const auto n = static_cast<int>(regions_.size());
  std::vector<int> first(out_->X.size(), -1);
  std::vector<double> shared(static_cast<size_t>(n) * n, 0.0);  // regions that meet at a node
  for (int r = 0; r < n; ++r) {
    if (regions_[r].fidelity != Fidelity::linear) continue;
    for (const std::int64_t i : mesh_->nodes_of(regions_[r].name, regions_[r].where)) {
      if (out_->follower[i] >= 0) continue;
      if (first[i] < 0) first[i] = r;
      if (first[i] != r) shared[static_cast<size_t>(first[i]) * n + r] = 1;
    }
  }
  for (const auto& members : joined_regions(Fidelity::linear, shared)) {
    const Region& one = regions_[members.front()];
    for (const int r : members) {
      const Region& region = regions_[r];
      if (!(region.mass > 0))
        throw Error(region.where, fmt::format("linear region \"{}\" has no density", region.name), "give its material a density");
      if (region.modal_damping != one.modal_damping)
        throw Error(region.where,
                    fmt::format("linear regions \"{}\" and \"{}\" share nodes, so their modes are the same: give them one modal_damping",
                                one.name, region.name));
    }
    out_->bodies[new_body_of(members)].linear = true;
  }
  for (size_t i = 0; i < first.size(); ++i)
    if (first[i] >= 0) out_->follower[i] = regions_[first[i]].body;
}

/// Nodes of one region and body are one weld, whatever names them.  Collective.
void Builder::weld(int linear_body, int body, const std::string& name, const std::vector<int>& nodes) {
  auto& list = out_->part<Welds>().list;
  for (Weld& w : list)
    if (out_->modes[w.modes].body == linear_body && w.body == body) {
      for (const int i : nodes)
        if (std::find(w.nodes.begin(), w.nodes.end(), i) == w.nodes.end()) w.nodes.push_back(i);
      w.at = mean_of(w.nodes);
      return;
    }
  Weld w;
  w.name = name, w.body = body, w.nodes = nodes, w.at = mean_of(nodes);
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

}  // namespace hilo
