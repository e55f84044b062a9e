// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact/contact_entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "system/facet.hpp"

namespace hilo {
namespace {

/// What may meet something: an obstacle, or a surface of the mesh.
struct Party {
  std::string name;
  const Entry* obstacle = nullptr;
  int region = -1;  // -1: a set of facets, or an obstacle
  bool is_on(const std::string& body) const { return obstacle ? obstacle->text("on") == body : name == body; }
  bool is_hollow() const { return obstacle && obstacle->has("inside") && obstacle->boolean("inside"); }
  bool is_ball() const { return obstacle && obstacle->kind == "sphere" && !is_hollow() && obstacle->text("on") != "ground"; }
  bool is_box() const { return obstacle && obstacle->kind == "box" && !is_hollow() && obstacle->text("on") != "ground"; }
  bool is_seen_by_corners() const { return is_hollow() || (obstacle && obstacle->kind == "plane"); }
};

/// Names that have a facet in common: sets that contacts and ties name, with each other and with regions.
class Overlaps {
 public:
  Overlaps(const Scene& scene, const LocalMesh* mesh, const Comm& comm) {
    if (!mesh) return;
    const Mesh& m = mesh->mesh;
    std::map<std::string, std::set<std::pair<std::int64_t, int>>> sets;
    for (const char* section : {"contact", "tie"})
      for (const Entry& e : scene.entries(section))
        for (const char* key : {"a", "b"})
          if (const auto set = m.facet_sets.find(e.text(key)); set != m.facet_sets.end())
            for (auto& facets = sets[set->first]; const Facet& f : set->second) facets.emplace(f.cell, f.facet);
    for (const Entry& e : scene.entries("obstacle")) sets.erase(e.name);
    const size_t n = sets.size(), n_regions = m.region_name.size();
    std::vector<double> common(n * (n + n_regions), 0.0);
    std::vector<std::string> names;
    for (const auto& [name, facets] : sets) {
      double* const mine = common.data() + names.size() * (n + n_regions);
      for (const auto& [cell, facet] : facets) mine[n + m.region[cell]] = 1;
      for (size_t k = 0; k < names.size(); ++k)
        mine[k] = std::ranges::any_of(sets.at(names[k]), [&](const auto& f) { return facets.contains(f); });
      names.push_back(name);
    }
    comm.max(common);
    for (size_t i = 0; i < n; ++i)
      for (size_t k = 0; k < n + n_regions; ++k)
        if (common[i * (n + n_regions) + k] > 0) take(names[i], k < n ? names[k] : m.region_name[k - n]);
  }
  bool has(const std::string& name) const { return with_.contains(name); }
  bool operator()(const std::string& a, const std::string& b) const {
    const auto it = with_.find(a);
    return a == b || (it != with_.end() && it->second.contains(b));
  }

 private:
  void take(const std::string& a, const std::string& b) { with_[a].insert(b), with_[b].insert(a); }
  std::map<std::string, std::set<std::string>> with_;
};

/// Pairs of names that entries take.
class Taken {
 public:
  explicit Taken(const Overlaps& overlap) : overlap_(overlap) {}
  struct Other {
    std::string label;
    bool by_name = false;
  };
  /// The entry that has such a pair already, by its names or by sets of its facets, or nothing.
  std::optional<Other> take(const std::string& a, const std::string& b, const std::string& label) {
    const auto [at, fresh] = by_name_.emplace(std::minmax(a, b), label);
    if (!fresh) return Other{at->second, true};
    if (!overlap_.has(a) && !overlap_.has(b)) return {};
    const auto other = std::ranges::find_if(
        of_sets_, [&](const Pair& p) { return (overlap_(a, p.a) && overlap_(b, p.b)) || (overlap_(a, p.b) && overlap_(b, p.a)); });
    if (other != of_sets_.end()) return Other{other->label};
    of_sets_.push_back({a, b, label});
    return {};
  }
  std::vector<std::pair<std::string, std::string>> names() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& [pair, label] : by_name_) out.push_back(pair);
    return out;
  }

 private:
  struct Pair {
    std::string a, b, label;
  };
  const Overlaps& overlap_;
  std::map<std::pair<std::string, std::string>, std::string> by_name_;
  std::vector<Pair> of_sets_;  // those of names that have facets in common with others
};

class Parties {
 public:
  Parties(const Scene& scene, const LocalMesh* mesh, const Comm& comm, const Overlaps& overlap) : mesh_(mesh), overlap_(overlap) {
    for (const Entry& e : scene.entries("obstacle")) all_.push_back({e.name, &e, -1});
    if (!mesh) return;
    const Mesh& m = mesh->mesh;
    std::vector<double> solid(m.region_name.size(), 0.0);
    for (std::int64_t c = 0; c < m.n_cells(); ++c)
      if (info(m.shape[c]).dimension == 3) solid[m.region[c]] = 1;
    comm.max(solid);
    for (size_t r = 0; r < solid.size(); ++r)
      if (solid[r] > 0) all_.push_back({m.region_name[r], nullptr, static_cast<int>(r)});
    std::vector<std::vector<int>> regions_of(m.X.size());
    for (std::int64_t c = 0; c < m.n_cells(); ++c)
      for (const auto i : m.cell(c))
        if (auto& list = regions_of[i]; std::ranges::find(list, m.region[c]) == list.end()) list.push_back(m.region[c]);
    std::vector<std::array<std::int64_t, 2>> touching;  // by the rows of nodes that other ranks may have in other regions
    for (size_t i = 0; i < regions_of.size(); ++i)
      for (const int r : regions_of[i]) touching.push_back({mesh->node_global[i], r});
    for (const auto& list : regions_of)
      for (const int a : list)
        for (const int b : list) shared_.insert({a, b});
    if (comm.size == 1) return;
    touching = comm.gather(touching);
    std::ranges::sort(touching);
    for (size_t i = 0; i < touching.size();) {
      size_t end = i;
      while (end < touching.size() && touching[end][0] == touching[i][0]) ++end;
      for (size_t a = i; a < end; ++a)
        for (size_t b = i; b < end; ++b) shared_.insert({static_cast<int>(touching[a][1]), static_cast<int>(touching[b][1])});
      i = end;
    }
  }
  bool has(const std::string& name) const {
    return std::ranges::any_of(all_, [&](const Party& p) { return p.name == name; }) || (mesh_ && mesh_->mesh.facet_sets.contains(name));
  }
  std::vector<Party> named(const Entry& e, std::string_view key) const {
    const std::string& name = e.text(key);
    if (name == "all" && !has(name)) return all_;
    for (const Party& p : all_)
      if (p.name == name) return {p};
    if (has(name)) return {{name, nullptr, -1}};
    std::vector<std::string> names;
    for (const Party& p : all_) names.push_back(p.name);
    throw Error(e.where(key), fmt::format("{}: no obstacle{} \"{}\"", e.label(), mesh_ ? ", region or set of facets" : "", name),
                suggest(name, names));
  }
  bool hang_together(const Party& a, const Party& b) const {
    for (const int i : regions(a))
      for (const int j : regions(b))
        if (shared_.contains({i, j})) return true;
    return false;
  }
  bool is_rigid(const Party& p) const {
    return std::ranges::any_of(regions(p), [&](int r) { return mesh_->fidelity[r] == Fidelity::rigid; });
  }

 private:
  /// The region itself, or those of the facets of a set.
  std::vector<int> regions(const Party& p) const {
    if (p.region >= 0 || !mesh_) return {p.region};
    std::vector<int> out;
    for (size_t r = 0; r < mesh_->mesh.region_name.size(); ++r)
      if (overlap_(p.name, mesh_->mesh.region_name[r])) out.push_back(static_cast<int>(r));
    return out;
  }

  const LocalMesh* mesh_;
  std::vector<Party> all_;
  std::set<std::pair<int, int>> shared_;  // regions that have a node in common, or are the same
  const Overlaps& overlap_;
};

/// The pair in the order of an entry, obstacle first; nothing where they cannot meet.
std::optional<std::pair<Party, Party>> ordered(const Party& x, const Party& y, const Parties& parties) {
  if (x.name == y.name) return {};
  if (!x.obstacle && !y.obstacle) return parties.hang_together(x, y) ? std::nullopt : std::optional(std::pair(x, y));
  if (!x.obstacle) return ordered(y, x, parties);
  if (!y.obstacle) return x.is_on(y.name) ? std::nullopt : std::optional(std::pair(x, y));
  if (x.obstacle->text("on") == y.obstacle->text("on")) return {};
  if (y.is_ball() || (y.is_box() && x.is_seen_by_corners())) return std::pair(x, y);
  if (x.is_ball() || (x.is_box() && y.is_seen_by_corners())) return std::pair(y, x);
  return {};
}

}  // namespace

bool meets_all(const Scene& scene) {
  return std::ranges::any_of(scene.entries("contact"), [](const Entry& e) { return e.text("a") == "all" || e.text("b") == "all"; });
}

std::vector<ContactEntry> contact_entries(const Scene& scene, const LocalMesh* mesh, const Comm& comm, std::vector<ContactNote>* told) {
  std::vector<ContactEntry> out;
  const auto entries = scene.entries("contact");
  const Overlaps overlap(scene, mesh, comm);
  std::optional<Parties> parties;
  if (meets_all(scene)) parties.emplace(scene, mesh, comm, overlap);
  const auto is_all = [&](const Entry& e) { return parties && (e.text("a") == "all" || e.text("b") == "all") && !parties->has("all"); };
  const auto tell = [&](const Entry& e, const std::string& what) {
    if (told) told->push_back({e.place.text(), fmt::format("{}: {}", e.label(), what)});
  };
  const auto is_contact = [](const Taken::Other& other) { return other.label.starts_with("contact"); };
  Taken taken(overlap);
  std::set<std::string> names;
  bool has_heap = false;
  for (const Entry& e : entries) {
    if (is_all(e)) continue;
    names.insert(e.name);
    if (const auto other = taken.take(e.text("a"), e.text("b"), e.label()))
      throw Error(
          e.place.text(),
          fmt::format("{}: {} has {}both sides too, which would meet twice", e.label(), other->label, other->by_name ? "" : "facets of "),
          "leave one of the two out, or name sets without common facets");
  }
  for (const Entry& e : scene.entries("tie")) {
    names.insert(e.name);
    if (const auto other = taken.take(e.text("a"), e.text("b"), e.label()); other && is_contact(*other))
      tell(e, fmt::format("{} names facets of both sides too: they share the force there", other->label));
  }
  if (!parties) {
    for (const Entry& e : entries) out.push_back({.entry = e});
    return out;
  }
  for (const Entry& e : entries) {
    if (!is_all(e)) {
      out.push_back({.entry = e});
      continue;
    }
    size_t n = 0;
    bool others_have = false;  // by sets
    const std::vector<Party> of_a = parties->named(e, "a"), of_b = parties->named(e, "b");
    if (e.text("a") == e.text("b") && !has_heap) {
      ContactEntry heap{.entry = e, .of_all = true};
      for (const Party& p : of_a)
        if (p.is_ball()) heap.balls.push_back(p.name);
      has_heap = heap.balls.size() * (heap.balls.size() - 1) / 2 > most_pairs_of_balls;
      if (has_heap) {
        heap.never = taken.names();
        names.insert(e.name);
        for (const char* key : {"layer", e.has("modulus") ? "stiffness" : ""}) heap.entry.values.erase(key);
        out.push_back(std::move(heap)), ++n;
      }
    }
    for (const Party& x : of_a)
      for (const Party& y : of_b) {
        if (has_heap && x.is_ball() && y.is_ball()) continue;
        const auto pair = ordered(x, y, *parties);
        if (!pair) continue;
        if (const auto other = taken.take(x.name, y.name, fmt::format("{} of \"{}\" and \"{}\"", e.label(), x.name, y.name))) {
          others_have = others_have || !other->by_name;
          if (!other->by_name && is_contact(*other))
            tell(e, fmt::format("\"all\" leaves out \"{}\" with \"{}\", as {} names facets of both", x.name, y.name, other->label));
          continue;
        }
        ++n;
        const auto& [a, b] = *pair;
        Entry one = e;
        one.name = fmt::format("{}_{}_{}", e.name, a.name, b.name);
        for (int k = 2; !names.insert(one.name).second; ++k) one.name = fmt::format("{}_{}_{}_{}", e.name, a.name, b.name, k);
        one.values.at("a").texts = {a.name}, one.values.at("b").texts = {b.name};
        // keys of the entry that are for pairs of another kind
        const bool of_surface = !b.obstacle, rigid = of_surface && parties->is_rigid(b) && (a.obstacle || parties->is_rigid(a));
        const auto drop = [&](const char* key) { one.values.erase(key); };
        if (of_surface) drop("stiffness");
        if (!of_surface || !rigid) drop("layer");
        if (of_surface && !rigid) drop("modulus");
        if (!of_surface && one.has("modulus") && one.has("stiffness")) {
          const bool hertz = b.is_ball() && (a.obstacle->kind == "plane" || a.obstacle->kind == "sphere");
          drop(hertz ? "stiffness" : "modulus");
        }
        out.push_back({.entry = std::move(one), .of_all = true});
      }
    if (n == 0 && !others_have)
      throw Error(e.where(e.text("a") == "all" ? "a" : "b"), fmt::format("{}: \"all\" stands for no pair", e.label()),
                  "an [[obstacle]] and a region, or two regions without a common node, that no other [[contact]] or [[tie]] names");
  }
  return out;
}

std::string told_pairs(const Scene& scene, const LocalMesh* mesh, const Comm& comm) {
  std::string out;
  std::vector<ContactNote> notes;
  for (const ContactEntry& pair : contact_entries(scene, mesh, comm, &notes))
    if (!pair.balls.empty())
      out += fmt::format("# {}: {} balls, in pairs as they come near each other\n", pair.entry.label(), pair.balls.size());
    else if (pair.of_all)
      out += fmt::format("# {}: a = \"{}\", b = \"{}\"\n", pair.entry.label(), pair.entry.text("a"), pair.entry.text("b"));
  for (const ContactNote& note : notes) out += fmt::format("# {}\n", note.what);
  return out;
}

}  // namespace hilo
