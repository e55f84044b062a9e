// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of surfaces that meet or are tied may have facets on any rank: rank 0 evaluates them, and has their nodes beside its own.
#include <algorithm>
#include <tuple>
#include <unordered_map>

#include "model/region_surface.hpp"
#include "system/build/builder.hpp"
#include "system/contact/contact_entries.hpp"

namespace hilo {

void Builder::bring_pairs_together() {
  if (comm_.size == 1) return;
  const Mesh& mesh = mesh_->mesh;
  std::vector<char> marked(mesh.X.size(), 0);
  const auto mark = [&](const Facet& f) {
    for (const std::int64_t i : mesh.facet_nodes(f)) marked[i] = 1;
  };
  std::vector<int> regions;
  bool some = false;
  const auto mark_sides = [&](const Entry& e) {
    for (const char* side : {"a", "b"}) {
      const std::string& name = e.text(side);
      if (const auto set = mesh.facet_sets.find(name); set != mesh.facet_sets.end()) {
        some = true;
        for (const Facet& f : set->second) mark(f);
      } else if (const int region = mesh.find_region(name); region >= 0) {
        regions.push_back(region);
      }
    }
  };
  for (const ContactEntry& pair : contact_entries(scene_, mesh_, comm_)) {
    const auto is_a = [&](const Entry& obstacle) { return obstacle.name == pair.entry.text("a"); };
    if (std::ranges::none_of(scene_.entries("obstacle"), is_a)) mark_sides(pair.entry);
  }
  for (const Entry& e : scene_.entries("tie")) mark_sides(e);
  if (!regions.empty())
    for (const Facet& f : outer_surface(*mesh_, comm_))
      if (std::ranges::find(regions, mesh.region[f.cell]) != regions.end()) mark(f);
  if (some || !regions.empty()) bring_to_first(*mesh_, marked, comm_);
}

std::vector<PairFacet> Builder::on_first_rank(const std::vector<Facet>& facets) const {
  struct Sent {
    std::int64_t cell, facet;
    std::array<std::int64_t, 8> row;
    PairFacet made;
  };
  const Mesh& mesh = mesh_->mesh;
  std::vector<Sent> sent;
  for (const Facet& f : facets) {
    if (info(mesh.shape[f.cell]).dimension != 3) continue;
    Sent& its = sent.emplace_back(Sent{mesh_->cell_global[f.cell], f.facet, {}, {}});
    const std::vector<std::int64_t> nodes = mesh.facet_nodes(f);
    for (size_t a = 0; a < nodes.size(); ++a) its.row[a] = mesh_->node_global[nodes[a]];
    its.made.region = mesh.region[f.cell], its.made.n = static_cast<int>(nodes.size());
    its.made.area = facet_area(mesh, f).norm();
    its.made.depth = std::abs(quality(mesh, f.cell).volume) / std::max(its.made.area, 1e-300);
  }
  sent = comm_.to_first(sent);
  if (comm_.rank != 0) return {};
  std::ranges::sort(sent, {}, [](const Sent& x) { return std::pair(x.cell, x.facet); });
  std::unordered_map<std::int64_t, int> local;
  for (size_t i = 0; i < mesh_->node_global.size(); ++i) local[mesh_->node_global[i]] = static_cast<int>(i);
  std::vector<PairFacet> out;
  for (Sent& its : sent) {
    for (int a = 0; a < its.made.n; ++a) its.made.node[a] = local.at(its.row[a]);
    out.push_back(its.made);
  }
  return out;
}

}  // namespace hilo
