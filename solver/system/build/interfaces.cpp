// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of linear regions that have modes of their own, as those that ties hold: of the sets that `interface` names, and what contacts may
// touch besides.  Few: many would move by smooth functions, and do not give way where they are pressed in.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "system/build/builder.hpp"
#include "system/build/region_parcel.hpp"
#include "system/contact/contacts.hpp"
#include "system/linear_regions.hpp"

namespace hilo {

struct Builder::Interfaces {
  struct List {
    std::string name;
    bool of_contact;
    std::set<std::int64_t> rows = {};  // on the first rank
  };
  struct Mark {
    std::int64_t list, row;
  };
  const Builder& builder;
  int body;
  std::vector<List> lists = {};
  std::vector<Mark> marks = {};  // that this rank has seen
  std::vector<char> may = {};    // by region: have modes of what contacts may touch

  bool has(const Region& region) const { return region.fidelity == Fidelity::linear && region.body == body; }

  void mark(std::int64_t node) {
    const Mesh& mesh = builder.mesh_->mesh;
    const bool of_block = !mesh.block.empty() && mesh.block[node] >= 0;
    if (builder.out_->follower[node] == body && !of_block) marks.push_back({std::ssize(lists) - 1, builder.mesh_->node_global[node]});
  }

  /// The sets that the scene names.
  void mark_named(bool has_shapes) {
    std::set<const Entry*> read;  // of several regions where its name is a glob
    for (const Region& region : builder.regions_) {
      const Entry* e = has(region) ? region.interface : nullptr;
      const std::vector<std::string> named = e ? e->texts("interface") : std::vector<std::string>{};
      const bool none = named == std::vector<std::string>{"none"};
      may.push_back(has(region) && !has_shapes && !none);
      if (named.empty() || none || !read.insert(e).second) continue;
      if (has_shapes)
        e->refuse("interface", fmt::format("region \"{}\" has shapes of a file: no node has modes of its own", region.name),
                  "leave shapes or interface out");
      for (const std::string& name : named) mark_set(name, *e);
    }
  }

  void mark_set(const std::string& name, const Entry& e) {
    const Mesh& mesh = builder.mesh_->mesh;
    const auto set = mesh.facet_sets.find(name);
    if (set == mesh.facet_sets.end()) e.refuse("interface", fmt::format("no set of facets \"{}\"", name), suggest(name, mesh.all_names()));
    lists.push_back({fmt::format("set \"{}\"", name), false});
    double of_entry = 0;
    for (const Facet& f : set->second) {
      of_entry += builder.regions_[mesh.region[f.cell]].interface == &e;
      if (builder.is_of(f.cell, body))
        for (const std::int64_t i : mesh.facet_nodes(f)) mark(i);
    }
    if (builder.comm_.sum(of_entry) == 0) e.refuse("interface", fmt::format("set \"{}\" has no facets of the region \"{}\"", name, e.name));
  }

  void mark_touched() {
    for (const TouchedNodes& touched : touched_nodes(*builder.out_)) {
      lists.push_back({fmt::format("contact \"{}\"", touched.contact), true});
      for (const int i : touched.nodes) mark(i);
    }
  }

  /// To the first rank.  Where a contact lies is known there alone, and its cells need not be.
  void gather() {
    const Mesh& mesh = builder.mesh_->mesh;
    bool all_may = true;  // of the regions that are one body
    for (size_t r = 0; r < may.size(); ++r) all_may = all_may && (may[r] || !has(builder.regions_[r]));
    std::vector<std::int64_t> rows;
    for (std::int64_t e = 0; e < mesh.n_cells() && !all_may; ++e)
      if (may[mesh.region[e]])
        for (const std::int64_t i : mesh.cell(e)) rows.push_back(builder.mesh_->node_global[i]);
    rows = builder.comm_.to_first(rows);
    const std::set<std::int64_t> asked(rows.begin(), rows.end());
    for (const Mark& m : builder.comm_.to_first(marks))
      if (List& list = lists[m.list]; !list.of_contact || all_may || asked.contains(m.row)) list.rows.insert(m.row);
  }

  /// Named nodes are left to their set; of touched ones all have modes or none.
  void choose(const RegionParcel& parcel) {
    std::set<std::int64_t> named, touched, told;
    for (const List& list : lists)
      if (!list.of_contact && list.rows.size() <= most_free) named.insert(list.rows.begin(), list.rows.end());
    const auto is_named = [&](std::int64_t row) { return named.contains(row); };
    for (List& list : lists) {
      if (!list.of_contact) continue;
      const bool where_named = std::ranges::any_of(list.rows, is_named);
      std::erase_if(list.rows, is_named);
      touched.insert(list.rows.begin(), list.rows.end());
      if (!where_named) told.insert(list.rows.begin(), list.rows.end());
    }
    if (touched.size() <= most_free && !parcel.stiffening) return;
    if (!told.empty())
      warn(parcel.where,
           fmt::format("linear region \"{}\": contacts may touch {} of its nodes, which move by its modes alone: it gives way too "
                       "little where it is pressed in (give the sets of facets that are touched as interface{})",
                       builder.out_->bodies[body].name, told.size(), parcel.stiffening ? ", without stiffening" : ""));
    std::erase_if(lists, [](const List& list) { return list.of_contact; });
  }
};

/// Collective.
void Builder::add_interfaces(int body, RegionParcel& parcel) const {
  Interfaces its{*this, body};
  its.mark_named(!parcel.shapes.empty());
  its.mark_touched();
  its.gather();
  its.choose(parcel);
  std::ranges::stable_sort(its.lists, {}, [](const auto& list) { return list.rows.size(); });  // many move together: few come first
  for (const auto& list : its.lists)
    if (!list.rows.empty()) parcel.tied.emplace_back(list.name, std::vector(list.rows.begin(), list.rows.end()));
}

}  // namespace hilo
