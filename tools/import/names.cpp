// SPDX-License-Identifier: GPL-3.0-or-later
// Names of regions and sets, one meaning each.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/utf8.hpp"
#include "import/imported.hpp"

namespace hilo {

void Imported::skip(const std::string& what, const std::string& place, std::int64_t count, bool output, const std::string& hint) {
  for (auto& n : not_read)
    if (n.what == what) {
      n.count += count;
      return;
    }
  not_read.push_back({what, place, count, output, hint});
}

std::string clean_name(const std::string& name) {
  std::string s = as_utf8(name);
  std::replace(s.begin(), s.end(), '/', '_');
  for (auto& c : s)
    if (static_cast<unsigned char>(c) < 32) c = '_';
  const auto first = s.find_first_not_of(' ');
  s = first == std::string::npos ? "" : s.substr(first, s.find_last_not_of(' ') - first + 1);
  return s.empty() || s == "." || s == ".." ? "unnamed" : s;
}

void assign_regions(Imported& in, const std::string& file, const std::vector<CellGroup>& regions, bool later_wins,
                    const std::vector<CellGroup>& groups, const ImportOptions& options) {
  Mesh& m = in.mesh;
  m.region.assign(m.n_cells(), -1);
  m.region_name.clear();
  const auto find_or_add = [&](const std::string& name) {
    const int r = m.find_region(name);
    if (r >= 0) return r;
    m.region_name.push_back(name);
    return static_cast<int>(m.region_name.size()) - 1;
  };
  std::vector<std::string> offered;
  for (const auto* list : {&regions, &groups})
    for (const auto& g : *list) offered.push_back(g.name);

  for (const auto& g : regions) {
    const int r = find_or_add(clean_name(g.name));
    for (const auto c : g.cells)
      if (later_wins || m.region[c] < 0) m.region[c] = r;
  }
  // --regions speaks before the deck; among themselves the later name wins.
  for (const auto& name : options.regions) {
    const CellGroup* found = nullptr;
    for (const auto* list : {&regions, &groups})
      for (const auto& g : *list)
        if (g.name == name) found = found ? found : &g;
    if (!found) {
      const std::string near = suggest(name, offered);
      throw Error(file, fmt::format("--regions: no element set \"{}\"", name),
                  !near.empty()     ? near
                  : offered.empty() ? "the file has none"
                                    : "there are " + some(offered, 8));
    }
    const int r = find_or_add(clean_name(name));
    for (const auto c : found->cells) m.region[c] = r;
  }

  std::vector<std::int64_t> lost;
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    if (m.region[c] < 0) lost.push_back(c);
  if (!lost.empty()) {
    const bool named = !options.rest.empty();
    std::string name = named ? clean_name(options.rest) : "rest";
    while (!named && m.find_region(name) >= 0) name += "_cells";  // a region of its own, whatever others are called
    const int r = find_or_add(name);
    for (const auto c : lost) m.region[c] = r;
    std::string note = fmt::format("{} of {} cells are in no region{}: they are region \"{}\"", lost.size(), m.n_cells(),
                                   named ? "" : fmt::format(", the first is cell {}", m.cell_id[lost.front()]), name);
    if (!named)
      note += offered.empty() || !regions.empty()
                  ? "; --rest gives it another name"
                  : "; --rest gives it another name, --regions makes regions of element sets: " + some(offered, 8);
    in.notes.push_back(note);
  }

  // Regions that lost all their cells go.
  std::vector<std::int64_t> size(m.region_name.size(), 0);
  for (const auto r : m.region) ++size[r];
  std::vector<std::int32_t> number(size.size(), -1);
  std::vector<std::string> kept;
  for (size_t r = 0; r < size.size(); ++r)
    if (size[r] > 0) {
      number[r] = static_cast<std::int32_t>(kept.size());
      kept.push_back(m.region_name[r]);
    }
  for (auto& r : m.region) r = number[r];
  m.region_name = kept;
  m.region_data.assign(kept.size(), {});

  for (const auto& g : regions) {
    const int r = m.find_region(clean_name(g.name));
    const auto away = std::count_if(g.cells.begin(), g.cells.end(), [&](std::int64_t c) { return m.region[c] != r; });
    if (away == 0) continue;
    const std::string set = SetNames(in).cells(g.name, g.cells);
    in.notes.push_back(fmt::format("{} of {} cells of \"{}\" belong to another region too; all of them are cell set \"{}\"", away,
                                   g.cells.size(), g.name, set));
  }
}

bool SetNames::taken(const std::string& name) const {
  const Mesh& m = in_.mesh;
  return m.find_region(name) >= 0 || m.node_sets.count(name) || m.facet_sets.count(name) || m.cell_sets.count(name);
}

std::string SetNames::free_name(const std::string& raw, const std::string& suffix) {
  const std::string name = clean_name(raw);
  if (!taken(name)) return name;
  std::string free = name + suffix;
  for (int i = 2; taken(free); ++i) free = fmt::format("{}{}_{}", name, suffix, i);
  in_.notes.push_back(
      fmt::format("the name \"{}\" is taken by another kind of set or a region: its {} are \"{}\"", name, suffix.substr(1), free));
  return free;
}

template <class Members>
std::string SetNames::add(std::map<std::string, Members>& sets, const char* kind, const std::string& name, Members members,
                          const char* suffix) {
  if (members.empty()) {
    in_.notes.push_back(fmt::format("{} set \"{}\" is empty: left out", kind, name));
    return "";
  }
  const std::string free = free_name(name, suffix);
  sets[free] = std::move(members);
  return free;
}

std::string SetNames::facets(const std::string& name, std::vector<Facet> members) {
  sort_unique(members, [](const Facet& f) { return std::pair(f.cell, f.facet); });
  return add(in_.mesh.facet_sets, "facet", name, std::move(members), "_facets");
}

std::string SetNames::nodes(const std::string& name, std::vector<std::int64_t> members) {
  sort_unique(members);
  const std::string same = clean_name(name);
  if (!members.empty() && in_.mesh.find_region(same) >= 0 && in_.mesh.nodes_of(same, name) == members) return same;
  return add(in_.mesh.node_sets, "node", name, std::move(members), "_nodes");
}

std::string SetNames::cells(const std::string& name, std::vector<std::int64_t> members) {
  sort_unique(members);
  const Mesh& m = in_.mesh;
  if (const int r = m.find_region(clean_name(name)); r >= 0 && !members.empty())
    if (std::ranges::count(m.region, r) == std::ssize(members) && std::ranges::all_of(members, [&](auto c) { return m.region[c] == r; }))
      return clean_name(name);
  return add(in_.mesh.cell_sets, "element", name, std::move(members), "_cells");
}

}  // namespace hilo
