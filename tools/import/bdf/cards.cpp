// The table of contents of the Nastran reader.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

void read_grid(const BdfEntry& e, BdfDeck& deck, Imported&) {
  const auto& d = e.data;
  const auto id = d.integer(0);
  if (!d.empty(1) && d.integer(1) != 0)
    throw Error(d.place(1), fmt::format("GRID {} is in coordinate system {}", id, d.integer(1)), "write the grids in the basic system");
  if (!deck.row.try_emplace(id, static_cast<std::int64_t>(deck.X.size())).second)
    throw Error(d.place(0), fmt::format("node {} is given twice", id), "number each node once");
  deck.X.emplace_back(d.number(2), d.number(3), d.number(4));
  deck.node_id.push_back(id);
}

void add(BdfDeck& deck, BdfDeck::Cell c) {
  if (!deck.cell_ids.insert(c.id).second) throw Error(c.place, fmt::format("element {} is given twice", c.id), "number each element once");
  deck.cells.push_back(std::move(c));
}

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

void read_solid(const BdfEntry& e, BdfDeck& deck, Imported&) {
  const SolidKind& k = *std::find_if(solids.begin(), solids.end(), [&](const SolidKind& s) { return e.name == s.name; });
  const auto& d = e.data;
  const size_t given = d.fields.size() < 2 ? 0 : d.fields.size() - 2;
  BdfDeck::Cell r{k.linear, d.integer(0), d.integer(1), {}, d.place(0)};
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

void read_rod(const BdfEntry& e, BdfDeck& deck, Imported&) {
  const auto& d = e.data;
  add(deck, {Shape::bar2, d.integer(0), d.integer(1), {d.integer(2), d.integer(3)}, d.place(0)});
}
/// Carries its material itself.
void read_conrod(const BdfEntry& e, BdfDeck& deck, Imported&) {
  const auto& d = e.data;
  add(deck, {Shape::bar2, d.integer(0), 0, {d.integer(1), d.integer(2)}, d.place(0)});
}

/// Shells are kept where they lie on solids: a set of facets for each property.
template <size_t corners>
void read_shell(const BdfEntry& e, BdfDeck& deck, Imported&) {
  const auto& d = e.data;
  BdfDeck::Cell r{Shape::tet4, d.integer(0), d.integer(1), {}, d.place(0)};
  for (size_t i = 0; i < corners; ++i) r.nodes.push_back(d.integer(2 + i));
  deck.shells.push_back(std::move(r));
}

void read_property(const BdfEntry& e, BdfDeck& deck, Imported&) { deck.material_of[e.data.integer(0)] = e.data.integer(1); }

// Supports: which nodes they hold is a set, what they hold them to is not read.
void read_spc1(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  auto& set = deck.sets[fmt::format("SPC_{}", d.integer(0))];
  if (upper(d.text(3)) == "THRU" && d.integer(4) - d.integer(2) > 1'000'000'000) throw Error(d.place(4), "SPC1: no usable range");
  if (upper(d.text(3)) == "THRU")
    for (auto i = d.integer(2); i <= d.integer(4); ++i) set.push_back(i);
  else
    for (size_t i = 2; i < d.fields.size(); ++i)
      if (d.is_integer(i)) set.push_back(d.integer(i));
  in.skip("SPC1 (its nodes are a set)", d.place());
}
void read_spc(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  auto& set = deck.sets[fmt::format("SPC_{}", d.integer(0))];
  set.push_back(d.integer(1));
  if (d.is_integer(4)) set.push_back(d.integer(4));
  in.skip("SPC (its nodes are a set)", d.place());
}

[[noreturn]] void refuse(const BdfEntry& e, const char* why) {
  throw Error(e.data.place() + ":1", fmt::format("{}: {}", e.name, why), bdf_supported);
}
void pyramid(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "pyramids are not read"); }
void beam(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "beams are not read"); }
void axisymmetric(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "axisymmetric elements are not three-dimensional"); }
void spring(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "springs are not read; say [[spring]] in the scene"); }
void bushing(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "bushings are not read; say [[spring]] in the scene"); }
void include(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "INCLUDE is not read; paste the file"); }
void point_mass(const BdfEntry& e, BdfDeck&, Imported&) { refuse(e, "point masses are not read; say [[point_mass]] in the scene"); }
void rigid_element(const BdfEntry& e, BdfDeck&, Imported&) {
  refuse(e, "rigid elements are not read; a set serves as a patch in the scene");
}

}  // namespace

BdfCards& bdf_cards() {
  static constexpr BdfCard cards[] = {
      {"GRID", read_grid},
      {"CTETRA", read_solid},
      {"CPENTA", read_solid},
      {"CHEXA", read_solid},
      {"CROD", read_rod},
      {"CONROD", read_conrod},
      {"CTRIA3", read_shell<3>},
      {"CTRIA6", read_shell<3>},
      {"CQUAD4", read_shell<4>},
      {"CQUAD8", read_shell<4>},
      {"PSOLID", read_property},
      {"PROD", read_property},
      {"SPC1", read_spc1},
      {"SPC", read_spc},
      {"CPYRAM", pyramid},
      {"CBEAM", beam},
      {"CBAR", beam},
      {"CTRAX3", axisymmetric},
      {"CTRAX6", axisymmetric},
      {"CELAS1", spring},
      {"CELAS2", spring},
      {"CBUSH", bushing},
      {"INCLUDE", include},
      {"CONM2", point_mass},
      {"RBE2", rigid_element},
      {"RBE3", rigid_element},
  };
  static BdfCards all = [] {
    BdfCards list("entry of .bdf decks", {});
    for (const auto& family : {std::span<const BdfCard>(cards), bdf_material_cards()})
      for (const BdfCard& card : family) list.add(card);
    return list;
  }();
  return all;
}

}  // namespace hilo
