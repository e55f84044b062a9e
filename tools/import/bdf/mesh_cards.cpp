// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that make the mesh: grids and their coordinate systems, solids, rods, shells on solids, properties.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

std::optional<std::int64_t> system_in(const DataLine& d, size_t field) {
  return d.empty(field) ? std::nullopt : std::optional(d.integer(field));
}

/// "123": a support that goes with the grid; "0" is none, blank what GRDSET says.
std::string held_in(const DataLine& d, size_t field) {
  if (!d.empty(field)) components(d, field);
  return std::string(d.text(field));
}

void read_grid(const BdfEntry& d, BdfDeck& deck, Imported&) {
  const auto id = d.integer(0);
  if (id < 1) throw Error(d.place(0), fmt::format("GRID {} is not positive", id));
  if (!deck.row.try_emplace(id, static_cast<std::int64_t>(deck.X.size())).second)
    throw Error(d.place(0), fmt::format("node {} is given twice", id), "number each node once");
  deck.X.emplace_back(d.number(2), d.number(3), d.number(4));
  deck.node_id.push_back(id);
  deck.grids.resize(deck.X.size());
  deck.grids.back() = {system_in(d, 1), system_in(d, 5), held_in(d, 6), d.place(0)};
}

void read_grid_default(const BdfEntry& d, BdfDeck& deck, Imported&) {
  if (!deck.grid_default.place.empty()) throw Error(d.place(), "GRDSET is given twice", "give it once");
  deck.grid_default = {system_in(d, 1), system_in(d, 5), held_in(d, 6), d.place()};
}

BdfSystem::Kind kind_of(const BdfEntry& e) {
  const char last = e.name.back();
  return last == 'R' ? BdfSystem::Kind::rectangular : last == 'C' ? BdfSystem::Kind::cylindrical : BdfSystem::Kind::spherical;
}
void add_system(BdfDeck& deck, std::int64_t id, const BdfSystem& s) {
  if (id < 1) throw Error(s.place, fmt::format("coordinate system {} is not positive", id));
  if (!deck.systems.try_emplace(id, s).second)
    throw Error(s.place, fmt::format("coordinate system {} is given twice", id), "number each system once");
}
/// Three grids; two systems on a line.
void read_cord1(const BdfEntry& d, BdfDeck& deck, Imported&) {
  for (size_t from = 0; from < std::max<size_t>(d.fields.size(), 1); from += 4) {
    if (from > 0 && d.empty(from)) continue;
    BdfSystem s{kind_of(d), d.place(from)};
    for (size_t i = 0; i < 3; ++i)
      if (s.grids[i] = d.integer(from + 1 + i); s.grids[i] < 1)
        throw Error(d.place(from + 1 + i), fmt::format("GRID {} is not positive", s.grids[i]));
    add_system(deck, d.integer(from), s);
  }
}
/// Three points in another system.
void read_cord2(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfSystem s{kind_of(d), d.place(0)};
  s.reference = d.integer(1, 0);
  for (size_t i = 0; i < 9; ++i) s.points[i / 3][static_cast<Eigen::Index>(i % 3)] = d.number(2 + i);
  add_system(deck, d.integer(0), s);
}

void add(BdfDeck& deck, BdfDeck::Cell c) {
  if (!deck.cell_ids.insert(c.id).second) throw Error(c.place, fmt::format("element {} is given twice", c.id), "number each element once");
  deck.cell_row[c.id] = static_cast<std::int64_t>(deck.cells.size());
  deck.cells.push_back(std::move(c));
}
/// A property that is left blank has the number of the element.
std::int64_t property_in(const DataLine& d, size_t field) { return d.integer(field, d.integer(0)); }

struct SolidKind {
  const char* name;
  size_t corners, nodes;
  Shape linear, quadratic;
  std::vector<int> p;  // quadratic: ours[i] = Nastran's[p[i]]
};
const std::vector<SolidKind> solids = {
    {"CTETRA", 4, 10, Shape::tet4, Shape::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
    {"CPENTA", 6, 15, Shape::wedge6, Shape::wedge15, {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11}},
    {"CHEXA", 8, 20, Shape::hex8, Shape::hex20r, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15}},
};

void read_solid(const BdfEntry& d, BdfDeck& deck, Imported&) {
  const SolidKind& k = *std::find_if(solids.begin(), solids.end(), [&](const SolidKind& s) { return d.name == s.name; });
  const size_t given = d.fields.size() < 2 ? 0 : d.fields.size() - 2;
  BdfDeck::Cell r{k.linear, d.integer(0), property_in(d, 1), {}, d.place(0)};
  size_t filled = 0;
  std::vector<std::int64_t> n;
  for (size_t i = 0; i < k.nodes; ++i) {
    n.push_back(i < given && !d.empty(2 + i) ? d.integer(2 + i) : 0);
    if (n.back()) ++filled;
  }
  const bool corners = std::all_of(n.begin(), n.begin() + static_cast<std::ptrdiff_t>(k.corners), [](std::int64_t i) { return i != 0; });
  if (!corners || given > k.nodes)
    throw Error(d.place(), fmt::format("{} {} has {} nodes, {} or {} are due", k.name, r.id, given, k.corners, k.nodes));
  if (filled == k.corners)
    r.nodes.assign(n.begin(), n.begin() + static_cast<std::ptrdiff_t>(k.corners));
  else if (filled == k.nodes) {
    r.shape = k.quadratic;
    for (const int i : k.p) r.nodes.push_back(n[static_cast<size_t>(i)]);
  } else
    throw Error(d.place(), fmt::format("{} {} has mid-side nodes on some edges only", k.name, r.id), "give all of them or none");
  add(deck, std::move(r));
}

/// What a rod carries besides its area: a constant of torsion and a mass per length.
void rod_extras(const BdfEntry& e, size_t J, size_t nsm, Imported& in) {
  if (e.number(J) != 0) in.skip(e.name + ": torsional constant J", e.place(J));
  if (e.number(nsm) != 0) in.skip(e.name + ": mass per length NSM", e.place(nsm));
}

void read_rod(const BdfEntry& d, BdfDeck& deck, Imported&) {
  add(deck, {Shape::bar2, d.integer(0), property_in(d, 1), {d.integer(2), d.integer(3)}, d.place(0)});
}
/// Carries its material and its area itself: each pair of them is a property with a number below zero.
void read_conrod(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  rod_extras(d, 5, 7, in);
  const auto material = d.integer(3);
  const double area = d.number(4);
  std::int64_t property = -1;
  int same = 1;
  while (deck.material_of.count(property) && (deck.material_of[property] != material || deck.area_of[property] != area))
    same += deck.material_of[property--] == material;
  if (deck.material_of.try_emplace(property, material).second)
    deck.property_name[property] = fmt::format("conrod_{}{}", material, same > 1 ? fmt::format("_{}", same) : "");
  deck.area_of[property] = area;
  add(deck, {Shape::bar2, d.integer(0), property, {d.integer(1), d.integer(2)}, d.place(0)});
}

void read_property(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  if (d.name == "PSOLID") {
    if (!d.empty(2) && d.text(2) != "0") in.skip("PSOLID: axes of its material CORDM", d.place(2));
    d.ignore_rest();  // how it is integrated there, and where stresses are asked for
  }
  if (d.name == "PSOLID" && !d.empty(6) && upper(d.text(6)) != "SMECH")
    throw Error(d.place(6), fmt::format("PSOLID {}: cells of {} are no solids", d.integer(0), d.text(6)), "remove them");
  if (!deck.material_of.try_emplace(d.integer(0), d.integer(1)).second)
    throw Error(d.place(0), fmt::format("property {} is given twice", d.integer(0)), "number each property once");
}
void read_rod_property(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  read_property(e, deck, in);
  rod_extras(e, 3, 5, in);
  if (!e.empty(2)) deck.area_of[e.integer(0)] = e.number(2);
}

/// PID MID OD T NSM OD2: a pipe; T 0 or blank is a full rod.
void read_pipe(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  read_property(d, deck, in);
  const double at_a = d.number(2), at_b = d.number(5, at_a), t = d.number(3);
  if (!(at_a > 0 && at_b > 0 && t >= 0 && 2 * t <= std::min(at_a, at_b)))
    throw Error(d.place(2),
                fmt::format("PTUBE {}: no pipe has the diameters {:g} and {:g} and the wall {:g}", d.integer(0), at_a, at_b, t));
  const auto area = [&](double D) { return std::numbers::pi * (t > 0 ? t * (D - t) : D * D / 4); };
  deck.area_of[d.integer(0)] = (area(at_a) + area(at_b)) / 2;
  if (at_a != at_b) in.skip("PTUBE that tapers: the mean of the areas at its ends is taken", d.place());
  in.skip("PTUBE: torsion", d.place());
  if (d.number(4) != 0) in.skip("PTUBE: mass per length NSM", d.place(4));
}

void read_param(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  if (upper(d.text(0)) != "WTMASS") return in.skip("PARAM " + upper(d.text(0)).substr(0, 40), d.place());
  deck.mass_factor = d.number(1);
  if (!(deck.mass_factor > 0)) throw Error(d.place(1), fmt::format("PARAM WTMASS: {:g} is not positive", deck.mass_factor));
  in.notes.push_back(fmt::format("{}: PARAM WTMASS: densities and masses times {:g}", d.place(), deck.mass_factor));
}

[[noreturn]] void refuse_card(const BdfEntry& e, const char* why) {
  throw Error(e.place() + ":1", fmt::format("{}: {}", e.name, why), bdf_supported);
}
/// EID PID G1 to G5, the base first: two tetrahedra.
void read_pyramid(const BdfEntry& d, BdfDeck& deck, Imported&) {
  std::vector<std::int64_t> n;
  for (size_t i = 2; i < 7; ++i) n.push_back(d.integer(i));
  for (size_t i = 7; i < d.fields.size(); ++i)
    if (!d.empty(i)) refuse_card(d, "pyramids of mid-side nodes are not read");
  std::int64_t id = d.integer(0);
  for (const auto& half : halves_of_pyramid(n)) {
    add(deck, {Shape::tet4, id, property_in(d, 1), half, d.place(0)});
    deck.pyramids.insert(id);
    id += second_half;
  }
}
void axisymmetric(const BdfEntry& e, BdfDeck&, Imported&) { refuse_card(e, "axisymmetric elements are not three-dimensional"); }

}  // namespace

std::vector<BdfCard> bdf_mesh_cards() {
  return {
      {"GRID", read_grid},      {"GRDSET", read_grid_default}, {"CORD1R", read_cord1},      {"CORD1C", read_cord1},
      {"CORD1S", read_cord1},   {"CORD2R", read_cord2},        {"CORD2C", read_cord2},      {"CORD2S", read_cord2},
      {"CTETRA", read_solid},   {"CPENTA", read_solid},        {"CHEXA", read_solid},       {"CROD", read_rod},
      {"CONROD", read_conrod},  {"PSOLID", read_property},     {"PROD", read_rod_property}, {"PARAM", read_param},
      {"CTUBE", read_rod},      {"PTUBE", read_pipe},          {"CPYRAM", read_pyramid},    {"CTRAX3", axisymmetric},
      {"CTRAX6", axisymmetric},
  };
}

}  // namespace hilo
