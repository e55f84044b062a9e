// SPDX-License-Identifier: GPL-3.0-or-later
// Abaqus and CalculiX decks: the cards in turn, then the mesh they make.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "base/error.hpp"
#include "import/inp/card.hpp"
#include "import/inp/passes.hpp"
#include "import/sheets.hpp"

namespace hilo {
namespace {

void check_names(const InpDeck& d) {
  for (const auto& s : d.sections) {
    if (!d.elset.count(s.elset))
      throw Error(s.place, fmt::format("{}: no element set \"{}\"", s.card, s.elset_name), suggest_name(s.elset, d.elset));
    if (!s.material.empty() && !d.materials.count(s.material))
      throw Error(s.material_place, fmt::format("{}: no material \"{}\"", s.card, s.material_name), suggest_name(s.material, d.materials));
    if (!s.orientation.empty() && !d.orientations.count(s.orientation))
      throw Error(s.orientation_place, fmt::format("{}: no orientation \"{}\"", s.card, s.orientation_name),
                  suggest_name(s.orientation, d.orientations));
  }
}

/// Sets that have a pyramid have both halves of it.
void complete_pyramids(InpDeck& d) {
  if (d.pyramids.empty()) return;
  for (auto& [name, set] : d.elset) {
    std::vector<std::int64_t> more;
    for (const auto id : set.members)
      if (d.pyramids.contains(id)) more.push_back(id + second_half);
    set.members.insert(set.members.end(), more.begin(), more.end());
  }
}
/// A face of a pyramid by its number would be one of a half.
void refuse_face(const InpDeck& d, std::int64_t element, const std::string& place) {
  if (d.pyramids.contains(element))
    throw Error(place, fmt::format("element {} is a pyramid, whose faces by number are not read", element), "a surface of element sets");
}

/// Node numbers of the cells become rows; nodes that no cell uses go.
void resolve_cells(InpDeck& d, Imported& in) {
  Mesh& m = in.mesh;
  std::vector<char> used(d.X.size(), 0);
  m.nodes.resize(d.cell_nodes.size());
  for (size_t c = 0; c < d.shape.size(); ++c)
    for (auto i = d.offset[c]; i < d.offset[c + 1]; ++i) {
      const auto it = d.node.find(d.cell_nodes[i]);
      if (it == d.node.end())
        throw Error(fmt::format("{}:{}", *d.cell_file[c], d.cell_line[c]),
                    fmt::format("element {} names node {}, which does not exist", d.cell_id[c], d.cell_nodes[i]));
      m.nodes[i] = it->second;
      used[it->second] = 1;
    }
  std::vector<std::int64_t> row(d.X.size(), -1);
  for (size_t a = 0; a < d.X.size(); ++a)
    if (used[a]) {
      row[a] = static_cast<std::int64_t>(m.X.size());
      d.node[d.node_id[a]] = row[a];
      m.X.push_back(d.X[a]);
      m.node_id.push_back(d.node_id[a]);
    } else {
      d.loose[d.node_id[a]] = d.X[a];
      d.node.erase(d.node_id[a]);
      d.unused.insert(d.node_id[a]);
    }
  for (auto& a : m.nodes) a = row[a];
  std::set<std::int64_t> dropped(d.unused.begin(), d.unused.end());
  for (const auto& [id, b] : d.beams)
    for (const auto node : b.nodes) dropped.erase(node);
  for (const auto& [id, node] : d.towards) dropped.erase(node);
  if (d.shape.empty() && d.beams.empty())
    in.notes.push_back("masses, springs and dampers stand in the scene lines alone (--scene-out)");
  else if (!dropped.empty())
    in.notes.push_back(fmt::format("{} nodes belong to no cell: dropped, the first is {}", dropped.size(), *dropped.begin()));
  m.shape = d.shape;
  m.cell_id = d.cell_id;
  m.offset = d.offset;
  m.region.assign(d.shape.size(), -1);
}

/// Sections of shells and beams; a cell of these without one is an Error.
void thin_sections(const InpDeck& d, Imported& in, bool thicken) {
  const Mesh& m = in.mesh;
  for (const auto& s : d.sections)
    for (const auto id : d.elset.at(s.elset).members) {
      const auto found = d.cell.find(id);
      if (found == d.cell.end()) continue;
      const auto c = found->second;
      const bool shell = info(m.shape[c]).dimension == 2, beam = d.beam_cells.contains(id);
      const char* due = shell ? "*SHELL SECTION" : beam ? "*BEAM SECTION" : "*SOLID SECTION";
      if (upper(s.card) != upper(due) && !(beam && s.own))
        throw Error(s.place, fmt::format("{} on element {}", s.card, id), fmt::format("it needs {}", due));
      if (!shell && !beam) continue;
      ThinSection t;
      t.thickness = s.thickness, t.offset = s.offset, t.no_solid = s.no_solid;
      if (beam) {
        const SectionArea area = s.beam.area(0.3, s.place);
        t.area = area.A;
        const Vec3 along = m.X[m.cell(c)[1]] - m.X[m.cell(c)[0]];
        const Vec3 v = direction_1(d, m, s, id, m.X[m.cell(c)[0]]);
        if (!(along.cross(v).norm() > 1e-6 * along.norm() * v.norm()))
          throw Error(s.place, fmt::format("{}: element {} lies along the direction 1 of its section", s.card, id));
        // it may be askew: its part across the beam counts
        const Vec3 up = s.along_n2 ? Vec3(along.cross(v)) : v, n1 = (v - along * along.dot(v) / along.squaredNorm()).normalized();
        t.second = second_of_section(along, up, area.I1, area.I2, -s.beam.I12);
        t.start = t.end = s.off[0] * n1 + s.off[1] * along.normalized().cross(n1);
      }
      in.thin[c] = t;
    }
  std::unordered_set<std::int64_t> nodes;
  for (const auto& [c, t] : in.thin) nodes.insert(m.cell(c).begin(), m.cell(c).end());
  if (thicken) {
    in.sheets = std::make_shared<Sheets>(in);
    std::erase_if(nodes, [&](std::int64_t a) { return !in.sheets->at(a).empty(); });  // bodies where they have to turn
  }
  for (const auto* lines : {&d.supports, &d.forces})
    for (const auto& l : *lines) {
      const auto rows = l.last > 3 && !nodes.empty() ? inp_nodes(d, l) : std::vector<std::int64_t>{};
      if (const auto n = std::ranges::count_if(rows, [&](std::int64_t a) { return nodes.contains(a); }))
        in.skip("turns and moments of nodes of shells and beams", l.place, n);
    }
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    if ((info(m.shape[c]).dimension == 2 || d.beam_cells.contains(m.cell_id[c])) && !in.thin.contains(c))
      throw Error(fmt::format("{}:{}", *d.cell_file[c], d.cell_line[c]), fmt::format("element {} has no section", m.cell_id[c]),
                  "shells need *SHELL SECTION, beams *BEAM SECTION");
}

/// Members of a set that exist; the others are counted and said.
std::vector<std::int64_t> rows(const InpSet& s, const std::unordered_map<std::int64_t, std::int64_t>& of,
                               const std::unordered_set<std::int64_t>* unused, const char* what, Imported& in) {
  std::vector<std::int64_t> r;
  r.reserve(s.members.size());
  std::int64_t missing = 0;
  for (const auto id : s.members)
    if (const auto it = of.find(id); it != of.end())
      r.push_back(it->second);
    else if (!unused->count(id))
      ++missing;
  if (missing) in.notes.push_back(fmt::format("set \"{}\": {} of its numbers are no {}: left out", s.name, missing, what));
  return r;
}

/// The material of every cell goes to the data of its region.
void region_materials(const InpDeck& d, Imported& in, const std::string& file) {
  Mesh& m = in.mesh;
  std::vector<const DeckMaterial*> of_region(m.region_name.size(), nullptr);
  const auto section = section_of_cells(d);
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto*& r = of_region[m.region[c]];
    const DeckMaterial* law = section[c] ? &d.laws.at(section[c]->law) : nullptr;
    if (r && law && r != law)
      throw Error(file,
                  fmt::format("region \"{}\" holds cells of materials \"{}\" and \"{}\"", m.region_name[m.region[c]], r->name, law->name),
                  "choose --regions within one material");
    if (law) r = law;
  }
  for (size_t r = 0; r < of_region.size(); ++r)
    if (of_region[r]) {
      m.region_data[r] = of_region[r]->carried();
      if (!of_region[r]->elastic() && of_region[r]->no_law.empty())
        in.notes.push_back(fmt::format("region \"{}\": its material \"{}\" ({}) stands in the scene lines alone (--scene-out)",
                                       m.region_name[r], of_region[r]->name, of_region[r]->kind));
    }
}

/// A Nastran deck under the name of an .inp: bulk data, and no keyword with a star before it.
bool is_nastran(const std::string& path) {
  const std::string text = read_gz(path, "");
  bool bulk = false;
  for (const std::string_view whole : lines_of(text)) {
    const std::string line = upper(whole.substr(0, 16));
    if (line.starts_with("*") && line.size() > 1 && std::isalpha(static_cast<unsigned char>(line[1]))) return false;
    bulk = bulk || line.starts_with("BEGINBULK") || line.starts_with("GRID,") || line.starts_with("GRID*") ||
           (line.starts_with("GRID") && line.size() > 4 && std::isdigit(static_cast<unsigned char>(line[4])));
  }
  return bulk;
}

/// `did you mean *ELASTIC?` where one letter is wrong, missing, too many, or two are swapped.  No farther: most unknown cards are cards
/// that other programs have.
std::string slip_of(std::string_view word, const InpCards& cards) {
  for (const auto& card : cards) {
    std::string_view a = word, b = card.name;
    while (!a.empty() && !b.empty() && a.front() == b.front()) a.remove_prefix(1), b.remove_prefix(1);
    while (!a.empty() && !b.empty() && a.back() == b.back()) a.remove_suffix(1), b.remove_suffix(1);
    const bool swapped = a.size() == 2 && b.size() == 2 && a[0] == b[1] && a[1] == b[0];
    if (swapped || std::max(a.size(), b.size()) < 2) return fmt::format("did you mean *{}?", card.name);
  }
  return "";
}

/// Sets, surfaces and orientations of one of several instances have its name in front.
void qualify(Card& card, const std::string& prefix) {
  for (auto& [key, param] : card.params) {
    const bool defines = key == "NAME" && (card.key == "SURFACE" || card.key == "ORIENTATION");
    const bool number = !param.value.empty() && param.value.find_first_not_of("0123456789") == std::string::npos;
    if (defines || key == "NSET" || key == "ELSET" || key == "SURFACE" || key == "TIENSET" || key == "ORIENTATION" ||
        ((key == "REFNODE" || key == "ROTNODE") && !number))
      param.value = prefix + param.value;
  }
}

}  // namespace

void parse_inp(const std::string& path, InpDeck& d, Imported& in, const InpCards& cards) {
  std::map<std::string_view, const InpCard*> by_key;
  for (const auto& c : cards) by_key[c.name] = &c;
  InpReading r{InpLines(path), d, in};
  bool any = false;
  r.several = r.lines.count("*INSTANCE") > 1 || r.lines.count("*PART") > 1;
  const auto tell_unread = [&r](const std::string& of) {
    const auto [lines, place] = r.lines.take_unread();
    if (lines > 0 && !r.skipped) r.in.skip(of.empty() ? "text before the first keyword" : "some data of " + of, place, lines);
    r.skipped = false;
  };
  for (std::string before; r.lines.next_card(r.card); before = r.card.name) {
    tell_unread(before);
    any = true;
    const auto known = by_key.find(r.card.key);
    if (r.step > 1 && (known == by_key.end() || known->second->first_step_only)) {
      r.skip(r.card.name + " in step 2 and later");
      if (r.card.key != "CONTROLS" && d.steps.back().not_read.empty()) d.steps.back().not_read = r.card.name;
    } else if (known == by_key.end())
      in.skip(r.card.name, r.card.place(), 1, false, slip_of(r.card.key, cards)), r.skipped = true;
    else {
      if (!d.prefix.empty()) qualify(r.card, d.prefix);
      if (r.step > 1 && known->second->of_step) d.step_cards.push_back({r.card.name, r.card.place(), r.step});
      known->second->read(r);
      for (const auto& [key, p] : r.card.params)
        if (!p.asked && !r.skipped)
          in.skip(fmt::format("{}, {}{}", r.card.name, key, p.value.empty() ? "" : "=" + p.value), r.card.place(key));
    }
  }
  tell_unread(r.card.name);
  if (!any) throw Error(path, "no keyword in it", "an Abaqus or CalculiX deck has lines such as *NODE");
}

Imported read_inp(const std::string& path, const ImportOptions& options) {
  if (is_nastran(path)) {
    Imported in = read_bdf(path, options);
    in.notes.push_back(path + " is a Nastran deck, and read as one");
    return in;
  }
  if (options.subcase || options.every_subcase)
    throw Error("", fmt::format("--subcase is for a Nastran file, {} is none", path), "", Exit::usage);
  Imported in;
  InpDeck d;
  parse_inp(path, d, in, inp_cards());
  if (d.X.empty()) throw Error(path, "no nodes", "a deck has *NODE");
  if (d.shape.empty() && d.beams.empty() && d.points.empty()) throw Error(path, "no elements", "a deck has *ELEMENT");
  unqualify(d);
  for (auto& [name, set] : d.elset) {  // *ELGEN gives its first element to the set that *ELEMENT gave it to
    sort_unique(set.members);
  }
  complete_pyramids(d);
  take_modal(d, in);
  find_motions(d, in, options.scale);
  join_steps(d, in);
  check_names(d);
  if (options.rigid_beams ||
      (!options.thicken && std::ranges::any_of(d.shape, [](auto s) { return info(static_cast<Shape>(s)).dimension == 2; })))
    beams_as_cells(d);
  resolve_cells(d, in);
  turn_materials(d, in, options.thicken);
  tell_pyramids(in, static_cast<std::int64_t>(d.pyramids.size()) / 2);
  find_beams(d, in);
  thin_sections(d, in, options.thicken);
  if (in.sheets)
    find_bodies_of_shells(d, in);
  else
    for (const InpThickness& t : d.thicknesses) in.skip("*NODAL THICKNESS of regions that are rigid", t.place);

  std::unordered_set<std::int64_t> points;  // elements that are no cells
  for (const auto& [id, p] : d.points) points.insert(id);
  for (const auto& [id, b] : d.beams) points.insert(id);
  std::vector<CellGroup> regions, groups;
  std::set<std::string> in_section;
  for (const auto& s : d.sections) {
    const auto& set = d.elset.at(s.elset);
    if (!in_section.insert(s.elset).second) continue;
    if (auto cells = rows(set, d.cell, &points, "element", in); !cells.empty() || s.beam.sizes.empty())
      regions.push_back({set.name, std::move(cells)});
  }
  for (const auto& key : d.elset_order)
    if (!in_section.count(key)) groups.push_back({d.elset.at(key).name, rows(d.elset.at(key), d.cell, &points, "element", in)});
  assign_regions(in, path, regions, true, groups, options);
  region_materials(d, in, path);

  SetNames names(in);
  std::map<std::string, std::string> surface, node_set;
  for (const auto& s : d.surfaces) {
    if (s.of_nodes) continue;
    std::vector<Facet> facets;
    bool below = false;  // the faces of shells against their normals
    for (const auto& line : s.lines) {
      const auto cells = inp_cells(d, line);
      if (line.face == 0) {
        const auto free = free_facets(in.mesh, cells);
        facets.insert(facets.end(), free.begin(), free.end());
      } else
        for (const auto c : cells) {
          refuse_face(d, in.mesh.cell_id[c], line.place);
          if (const bool shell = info(in.mesh.shape[c]).dimension == 2;
              line.face <= 2 && (shell || line.of_shell)) {  // against its normal, along it
            if (!shell)
              throw Error(line.place, fmt::format("*SURFACE {}: element {} is no shell", s.name, in.mesh.cell_id[c]),
                          "S1 to S6 of a solid");
            if (!facets.empty() && below != (line.face == 1))
              throw Error(line.place, fmt::format("*SURFACE {}: both faces of shells, or shells and solids", s.name), "a surface of each");
            below = line.face == 1;
            facets.push_back({c, 0});
            continue;
          }
          if (below)
            throw Error(line.place, fmt::format("*SURFACE {}: the faces of shells against their normals, and of solids", s.name),
                        "a surface of each");
          const int f = inp_facet(static_cast<Shape>(in.mesh.shape[c]), line.face);
          if (f < 0) throw Error(line.place, fmt::format("*SURFACE {}: element {} has no face S{}", s.name, in.mesh.cell_id[c], line.face));
          facets.push_back({c, f});
        }
    }
    surface[upper(s.name)] = names.facets(s.name, std::move(facets));
    if (below) in.below.insert(surface[upper(s.name)]);
  }
  for (const auto& key : d.nset_order) {
    auto nodes = rows(d.nset.at(key), d.node, &d.unused, "node", in);
    const bool of_beams = nodes.empty() && std::ranges::any_of(d.nset.at(key).members, [&](auto id) { return d.bodies.contains(id); });
    node_set[key] = of_beams ? "" : names.nodes(d.nset.at(key).name, std::move(nodes));
  }
  for (const auto& s : d.surfaces) {
    if (!s.of_nodes) continue;
    std::vector<std::int64_t> nodes;
    for (const auto& line : s.lines) {
      const auto more = inp_nodes(d, line);
      nodes.insert(nodes.end(), more.begin(), more.end());
    }
    // whole faces of them are what a *TIE or *CONTACT PAIR can speak of
    const auto names_it = [key = upper(s.name)](const InpPair& t) { return t.slave == key || t.master == key; };
    if (std::ranges::any_of(d.tied, names_it) || std::ranges::any_of(d.contacts, names_it))
      surface[upper(s.name)] = names.facets(s.name + "_faces", facets_within(in.mesh, nodes));
    names.nodes(s.name, std::move(nodes));
  }
  for (const auto& g : groups)
    if (const auto& ids = d.elset.at(upper(g.name)).members;
        !g.cells.empty() || ids.empty() || !std::ranges::all_of(ids, [&](std::int64_t id) { return points.contains(id); }))
      names.cells(g.name, g.cells);
  find_equations(d, in);
  find_ties(d, in, surface);
  for (const auto& [id, body] : d.bodies)
    if (is_of_pairs(d, in, id)) in.body_of_node[d.node.at(id)] = body_name(d, id);
  write_inp_scene(d, in, names, node_set, surface, options);
  return in;
}

}  // namespace hilo
