// SPDX-License-Identifier: GPL-3.0-or-later
// Nastran bulk data: GRID, solids, rods and their properties and materials, in small, large and free fields.
// (gmsh loses names and the mid-side nodes of long fields, so the reader is ours.)  Shell elements that lie on solids are
// facet sets; others are cells of regions that can be rigid alone.  Beams stand in the scene, or beside such shells are cells too.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <ranges>
#include <unordered_set>

#include "base/error.hpp"
#include "import/bdf/card.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {
namespace {

std::vector<std::int64_t> rows(const BdfDeck& deck, const std::vector<std::int64_t>& ids, const BdfDeck::Cell& r) {
  std::vector<std::int64_t> nodes;
  for (const auto id : ids) nodes.push_back(deck.row_of(id, r.place, "element", r.id));
  return nodes;
}

/// Materials without a density are told once; PARAM WTMASS turns weights into masses.
void settle_densities(BdfDeck& deck, Imported& in) {
  for (auto& [id, m] : deck.materials) m.data.density *= deck.mass_factor;
  for (auto& [id, p] : deck.thin) p.section.line_mass *= deck.mass_factor, p.end.line_mass *= deck.mass_factor;
  for (auto& m : deck.masses) m.mass *= deck.mass_factor, m.inertia *= deck.mass_factor;
  for (auto& m : deck.scalar_masses) {
    const auto p = deck.mass_of.find(m.property);
    if (m.property != 0 && p == deck.mass_of.end()) throw Error(m.place, fmt::format("{} {}: no PMASS {}", m.name, m.id, m.property));
    m.mass = deck.mass_factor * (m.property != 0 ? p->second : m.mass);
  }
  if (deck.without_density.empty()) return;
  in.notes.push_back(fmt::format("{}: RHO is 0 or blank in {} of {} materials ({}): no density", deck.without_density.begin()->second,
                                 deck.without_density.size(), deck.materials.size(),
                                 some(std::views::keys(deck.without_density), 5, ", ", ", ...")));
}

/// The sets of one kind that no subcase takes.
template <class Line>
void tell_unused(const BdfSets<Line>& sets, const std::set<std::int64_t>& chosen, const char* what, Imported& in) {
  for (const auto& [id, list] : sets.lines)
    if (std::ranges::none_of(chosen, [&, id = id](std::int64_t one) { return sets.takes(one, id); }))
      in.skip(fmt::format("{} of a set that no subcase uses", what), list.front().place, static_cast<std::int64_t>(list.size()));
}

/// What is told of all subcases, each thing once; what one of them does not take another one may.
void join_told(const BdfDeck& deck, const std::vector<BdfCase>& cases, Imported& in) {
  std::vector<NotRead> all;
  std::set<std::pair<std::string, std::string>> said;  // what, and its place
  for (const DeckCase& c : in.cases)
    for (const NotRead& n : c.not_read)
      if (n.what.find(" of a set that the subcase does not use") == std::string::npos && said.insert({n.what, n.place}).second)
        all.push_back(n);
  in.not_read = std::move(all);
  std::set<std::int64_t> load, spc, mpc, glue, contact;
  for (const BdfCase& c : cases) load.insert(c.load), spc.insert(c.spc), mpc.insert(c.mpc), glue.insert(c.glue), contact.insert(c.contact);
  tell_unused(deck.loads, load, "loads", in);
  tell_unused(deck.supports, spc, "supports", in);
  tell_unused(deck.ties, mpc, "MPC", in);
  tell_unused(deck.glue, glue, "BGSET", in);
  tell_unused(deck.contacts, contact, "BCTSET", in);
  std::set<std::string> notes;
  std::erase_if(in.notes, [&](const std::string& note) { return !notes.insert(note).second; });
}

/// Shells that have no stiffness in their plane bend as solids do where they lie in one plane; elsewhere no solid stands for them.
void settle_bending(BdfDeck& deck, Imported& in) {
  for (auto& [id, p] : deck.thin) {
    if (!p.bends_only || !p.no_solid.empty()) continue;
    std::vector<Vec3> x;
    for (const auto& s : deck.shells)
      if (s.property == id)
        for (const auto a : rows(deck, s.nodes, s)) x.push_back(deck.X[static_cast<size_t>(a)]);
    if (in_a_plane(x))
      in.notes.push_back(fmt::format("{}: PSHELL {} without MID1 is flat: it is given the stiffness in its plane too", p.place, id));
    else
      p.no_solid = "PSHELL without MID1, and not in one plane";
  }
}

/// Cells by property, shells as sets of facets, supports as sets of nodes.
void build(BdfDeck& deck, const std::string& path, const std::vector<BdfCaseLine>& case_lines, const ImportOptions& options, Imported& in) {
  Mesh& m = in.mesh;
  m.X = deck.X;
  m.node_id = deck.node_id;
  std::map<std::int64_t, CellGroup> by_property;
  const auto group_of = [&](std::int64_t property) -> CellGroup& {
    auto& g = by_property[property];
    g.name = deck.name_of(property);
    return g;
  };
  for (const auto& r : deck.cells) {
    group_of(r.property).cells.push_back(m.n_cells());
    m.add_cell(r.shape, rows(deck, r.nodes, r), -1, r.id);
  }
  tell_pyramids(in, static_cast<std::int64_t>(deck.pyramids.size()) / 2);
  // shells whose property has them on solids alone are sets of facets, the others cells of a rigid region, as beams are
  std::vector<std::vector<std::int64_t>> faces;
  for (const auto& s : deck.shells) faces.push_back(rows(deck, s.nodes, s));
  const auto found = match_facets(m, faces);
  std::set<std::int64_t> apart;
  for (size_t i = 0; i < deck.shells.size(); ++i)
    if (found[i].cell < 0) apart.insert(deck.shells[i].property);
  std::map<std::int64_t, std::vector<Facet>> facets;
  for (size_t i = 0; i < deck.shells.size(); ++i) {
    const auto& s = deck.shells[i];
    if (!apart.contains(s.property)) {
      if (deck.thin.contains(s.property))
        in.skip(fmt::format("{} of a PSHELL or PCOMP on faces of solids: stiffness and mass", s.card), s.place);
      facets[s.property].push_back(found[i]);
      continue;
    }
    auto nodes = faces[i];
    for (const auto a : rows(deck, s.middles, s)) nodes.push_back(a);
    group_of(s.property).cells.push_back(m.n_cells());
    add_thin_cell(deck, s, nodes, in);
  }
  if (options.rigid_beams || (!apart.empty() && !options.thicken)) {
    for (const auto& b : deck.beams) {
      group_of(b.property).cells.push_back(m.n_cells());
      add_thin_cell(deck, b, rows(deck, b.nodes, b), in);
    }
    deck.beams.clear();
  }
  in.n_beams = static_cast<std::int64_t>(deck.beams.size());
  if (m.n_cells() == 0 && deck.beams.empty()) in.notes.push_back("masses and springs stand in the scene lines alone (--scene-out)");
  if (options.thicken) in.sheets = std::make_shared<Sheets>(in);
  std::unordered_set<std::int64_t> of_thin;
  for (const auto& [c, t] : in.thin) of_thin.insert(m.cell(c).begin(), m.cell(c).end());
  const auto tell_turn = [&](std::int64_t grid, const std::string& place) {
    const auto a = deck.row.find(grid);
    if (a == deck.row.end() || !of_thin.contains(a->second)) return;
    if (sheets_at(in, a->second).empty())  // a grid of shells that become pairs is a body where it has to turn
      in.skip("turns and moments of grids of shells and beams", place);
  };
  for (const auto& [sid, lines] : deck.supports.lines)
    for (const auto& l : lines)
      if (l.components & ~7u)
        for (const auto id : l.grids) tell_turn(id, l.place);
  for (const auto& [sid, loads] : deck.loads.lines)
    for (const auto& l : loads)
      if (l.kind == BdfLoad::Kind::moment) tell_turn(l.grid, l.place);
  std::vector<CellGroup> regions;
  for (auto& [pid, g] : by_property) regions.push_back(g);
  assign_regions(in, path, regions, false, {}, options);
  for (const auto& [pid, g] : by_property) {
    const auto* material = deck.material(pid);
    for (const auto c : g.cells)
      if (material) m.region_data[m.region[c]] = material->second.carried();
  }
  SetNames names(in);
  for (auto& [pid, f] : facets) names.facets(deck.name_of(pid), std::move(f));
  const std::unordered_set<std::int64_t> of_cells(m.nodes.begin(), m.nodes.end());
  const bool all = in.n_beams == 0 && m.n_cells() > 0;  // beside bodies alone sets of their grids say nothing
  for (const auto& [sid, lines] : deck.supports.lines) {
    std::vector<std::int64_t> nodes;
    for (const auto& l : lines)
      for (const auto id : l.grids)
        if (const auto a = deck.row.find(id); a != deck.row.end() && (all || of_cells.contains(a->second))) nodes.push_back(a->second);
    if (all || !nodes.empty()) names.nodes(fmt::format("SPC_{}", sid), std::move(nodes));
  }
  if (!options.every_subcase) return write_bdf_scene(deck, in, names, options);
  const std::vector<NotRead> told = in.not_read;
  std::vector<BdfCase> cases;
  for (const auto number : subcases_of(case_lines, path)) {
    in.not_read = told;
    deck.chosen = {};
    read_case(case_lines, deck, in, number);
    std::erase_if(in.not_read, [](const NotRead& n) { return n.what.starts_with("SUBCASE but "); });
    write_bdf_scene(deck, in, names, options);
    const BdfCase& c = cases.emplace_back(deck.chosen);
    in.cases.push_back({number, !c.label.empty() ? c.label : !c.subtitle.empty() ? c.subtitle : c.title, in.scene, in.not_read});
  }
  join_told(deck, cases, in);
}

}  // namespace

void parse_bdf(BdfEntries& entries, BdfDeck& deck, Imported& in, const BdfCards& cards) {
  std::map<std::string_view, const BdfCard*> by_name;
  for (const auto& c : cards) by_name[c.name] = &c;
  BdfEntry e;
  std::uint64_t asked;
  const auto told = [&in] {
    return std::accumulate(in.not_read.begin(), in.not_read.end(), std::int64_t{0}, [](auto n, const NotRead& r) { return n + r.count; });
  };
  while (entries.next(e)) {
    const auto known = by_name.find(e.name);
    if (known == by_name.end()) {
      in.skip(e.name.substr(0, 40), e.place());
      continue;
    }
    const auto before = told();
    asked = 0, e.asked.bits = &asked;
    known->second->read(e, deck, in);
    for (size_t i = 0; i < std::min<size_t>(e.fields.size(), 64); ++i)
      if (!e.fields[i].text.empty() && (asked >> i & 1) == 0 && told() == before) {
        in.skip(fmt::format("{}: its field {}", e.name, i + 2), e.place(i));
        break;
      }
  }
}

/// Of ranges of grids the grids that are there, of ranges of elements under a pressure the shells and solids; of an empty one its first.
void resolve_ranges(BdfDeck& deck) {
  std::set<std::int64_t> pressed;
  for (const auto& s : deck.shells) pressed.insert(s.id);
  for (const auto& [id, r] : deck.cell_row) pressed.insert(id);
  for (auto& [sid, loads] : deck.loads.lines)
    for (BdfLoad& l : loads)
      for (const BdfRange& r : l.ranges) {
        const size_t before = l.elements.size();
        for (auto id = pressed.lower_bound(r.first); id != pressed.end() && *id <= r.last; ++id)
          if ((*id - r.first) % r.by == 0) l.elements.push_back(*id);
        if (l.elements.size() == before) l.elements.push_back(r.first);
      }
  std::vector<std::int64_t> ids = deck.node_id;
  std::ranges::sort(ids);
  for (auto& [sid, lines] : deck.supports.lines)
    for (BdfSupport& s : lines)
      for (const BdfRange& r : s.ranges)
        for (auto id = std::ranges::lower_bound(ids, r.first); id != ids.end() && *id <= r.last; ++id)
          if ((*id - r.first) % r.by == 0) s.grids.push_back(*id);
}

Imported read_bdf(const std::string& path, const ImportOptions& options) {
  Imported in;
  BdfDeck deck;
  BdfEntries entries(path);
  parse_bdf(entries, deck, in, bdf_cards());
  if (deck.X.empty()) throw Error(path, "no GRID", "a Nastran file has GRID entries");
  if (deck.cells.empty() && deck.shells.empty() && deck.beams.empty() && deck.masses.empty() && deck.springs.empty())
    throw Error(path, "no elements", bdf_supported);
  std::set<std::string> taken;
  for (const auto& [id, name] : entries.property_names())  // one name for two properties would make one region of two materials
    deck.property_name[id] = taken.insert(name).second ? name : fmt::format("{}_{}", name, id);
  resolve_axes(deck);
  resolve_ranges(deck);
  resolve_beams(deck);
  settle_bending(deck, in);
  resolve_metals(deck, in);
  settle_densities(deck, in);
  const auto& case_lines = entries.case_lines();
  if (options.every_subcase)
    subcases_of(case_lines, path);
  else
    read_case(case_lines, deck, in, options.subcase);
  build(deck, path, case_lines, options, in);
  return in;
}

}  // namespace hilo
