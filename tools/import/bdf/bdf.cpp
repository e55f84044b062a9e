// Nastran bulk data: GRID, solids, rods and their properties and materials, in small, large and free fields.
// (gmsh loses names and the mid-side nodes of long fields, so the reader is ours.)  Shell elements are read where they lie on solids, as
// facet sets.
#include <fmt/format.h>

#include <stdexcept>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

std::vector<std::int64_t> rows(const BdfDeck& deck, const BdfDeck::Cell& r) {
  std::vector<std::int64_t> nodes;
  for (const auto id : r.nodes) {
    const auto a = deck.row.find(id);
    if (a == deck.row.end()) throw Error(r.place, fmt::format("element {} names node {}, which does not exist", r.id, id));
    nodes.push_back(a->second);
  }
  return nodes;
}

/// The lines of a scene for the regions whose material is more than elastic: the mesh carries no moduli of these.
void write_scene(const BdfDeck& deck, const std::map<std::int64_t, CellGroup>& by_property, const ImportOptions& options, Imported& in) {
  Mesh& m = in.mesh;
  std::map<std::int64_t, std::string> used;
  std::map<std::string, std::string> lines;  // by region
  for (const auto& [pid, g] : by_property) {
    const auto mid = deck.material_of.find(pid);
    const auto mat = mid == deck.material_of.end() ? deck.materials.end() : deck.materials.find(mid->second);
    if (mat == deck.materials.end() || mat->second.elastic() || g.cells.empty()) continue;
    const std::string& region = m.region_name[m.region[g.cells.front()]];
    if (!mat->second.no_law.empty()) {
      lines[region] =
          fmt::format("\n# region {}: material {} has no law here ({}), give it one\n", toml_text(region), mat->first, mat->second.no_law);
      continue;
    }
    used[mat->first] = mat->second.name;
    lines[region] = fmt::format("\n[region.{}]\nmaterial = {}\n", toml_text(region), toml_text(mat->second.name));
    in.notes.push_back(fmt::format("region \"{}\": its material \"{}\" ({}) stands in the scene lines alone (--scene-out)", region,
                                   mat->second.name, mat->second.kind));
  }
  if (lines.empty()) return;
  m.deck_scene = "units = \"m-kg-s\"\n";
  for (const auto& [id, name] : used) m.deck_scene += deck.materials.at(id).table(name, options.units);
  for (const auto& [region, text] : lines) m.deck_scene += text;
}

/// Cells by property, shells as sets of facets, supports as sets of nodes.
void build(BdfDeck& deck, const std::map<std::int64_t, std::string>& names_of, const std::string& path, const ImportOptions& options,
           Imported& in) {
  Mesh& m = in.mesh;
  m.X = std::move(deck.X);
  m.node_id = std::move(deck.node_id);
  const auto property_name = [&](std::int64_t property) {
    const auto n = names_of.find(property);
    return n == names_of.end() ? fmt::format("pid_{}", property) : n->second;
  };
  std::map<std::int64_t, CellGroup> by_property;
  for (const auto& r : deck.cells) {
    auto& g = by_property[r.property];
    g.name = property_name(r.property);
    g.cells.push_back(m.n_cells());
    m.add_cell(r.shape, rows(deck, r), -1, r.id);
  }
  std::vector<CellGroup> regions;
  for (auto& [pid, g] : by_property) regions.push_back(g);
  assign_regions(in, path, regions, false, {}, options);
  for (const auto& [pid, g] : by_property) {
    const auto mid = deck.material_of.find(pid);
    const auto mat = mid == deck.material_of.end() ? deck.materials.end() : deck.materials.find(mid->second);
    for (const auto c : g.cells)
      if (mat != deck.materials.end()) m.region_data[m.region[c]] = mat->second.carried();
  }
  write_scene(deck, by_property, options, in);
  SetNames names(in);
  std::vector<std::vector<std::int64_t>> faces;
  for (const auto& s : deck.shells) faces.push_back(rows(deck, s));
  const auto found = match_facets(m, faces);
  std::map<std::int64_t, std::vector<Facet>> facets;
  for (size_t i = 0; i < deck.shells.size(); ++i) {
    if (found[i].cell < 0)
      throw Error(deck.shells[i].place, fmt::format("shell element {} lies on no solid: shells are not read", deck.shells[i].id),
                  bdf_supported);
    facets[deck.shells[i].property].push_back(found[i]);
  }
  for (auto& [pid, f] : facets) names.facets(property_name(pid), std::move(f));
  for (auto& [name, ids] : deck.sets) {
    std::vector<std::int64_t> nodes;
    for (const auto id : ids)
      if (const auto a = deck.row.find(id); a != deck.row.end()) nodes.push_back(a->second);
    names.nodes(name, std::move(nodes));
  }
}

}  // namespace

void parse_bdf(BdfEntries& entries, BdfDeck& deck, Imported& in, const BdfCards& cards) {
  std::map<std::string_view, const BdfCard*> by_name;
  for (const auto& c : cards) by_name[c.name] = &c;
  BdfEntry e;
  while (entries.next(e))
    if (const auto known = by_name.find(e.name); known != by_name.end())
      known->second->read(e, deck, in);
    else
      in.skip(e.name.substr(0, 40), e.data.place());
}

Imported read_bdf(const std::string& path, const ImportOptions& options) {
  Imported in;
  BdfDeck deck;
  BdfEntries entries(path);
  parse_bdf(entries, deck, in, bdf_cards());
  if (deck.X.empty()) throw Error(path, "no GRID", "a Nastran file has GRID entries");
  if (deck.cells.empty()) throw Error(path, "no solid elements and no rods", bdf_supported);
  resolve_metals(deck, in);
  build(deck, entries.property_names(), path, options, in);
  return in;
}

}  // namespace hilo
