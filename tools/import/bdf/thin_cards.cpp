// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that make shells and beams, and their properties.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

std::int64_t property_of(const DataLine& d, size_t field) { return d.empty(field) ? d.integer(0) : d.integer(field); }

void add(BdfDeck& deck, BdfDeck::Thin c, std::vector<BdfDeck::Thin>& to) {
  if (!deck.cell_ids.insert(c.id).second) throw Error(c.place, fmt::format("element {} is given twice", c.id), "number each element once");
  to.push_back(std::move(c));
}

/// `offset`, `thickness`: where a shell entry has its offset and its own thicknesses.
template <size_t corners, size_t middles, size_t offset, size_t thickness>
void read_shell(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  BdfDeck::Thin s{{corners == 3 ? tri3 : quad4, d.integer(0), property_of(d, 1), {}, d.place(0)}};
  for (size_t i = 0; i < corners; ++i) s.nodes.push_back(d.integer(2 + i));
  size_t there = 0;
  for (size_t i = 0; i < middles; ++i) there += !d.empty(2 + corners + i);
  if (middles > 0 && there == middles) {
    s.shape = corners == 3 ? tri6 : quad8;
    for (size_t i = 0; i < middles; ++i) s.middles.push_back(d.integer(2 + corners + i));
  } else if (there > 0)
    in.skip(e.name + ": mid-side nodes on some edges only", d.place());
  if (!d.empty(offset)) s.offset = d.number(offset);
  for (size_t i = 0; i < corners; ++i)
    if (!d.empty(thickness + i)) {
      in.skip(e.name + ": thickness of its own, T1 to T4", d.place(thickness + i));
      break;
    }
  add(deck, std::move(s), deck.shells);
}

/// EID PID GA GB X1 X2 X3 (or G0) OFFT; PA PB W1A W2A W3A W1B W2B W3B
void read_beam(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  BdfDeck::Thin b{{Shape::bar2, d.integer(0), property_of(d, 1), {d.integer(2), d.integer(3)}, d.place(0)}};
  if (d.empty(5) && d.empty(6) && d.is_integer(4))
    b.towards = d.integer(4);
  else
    b.v = Vec3(d.number(4), d.number(5), d.number(6));
  if (!d.empty(7) && upper(d.text(7)) != "GGG") in.skip(e.name + ": OFFT " + upper(d.text(7)), d.place(7));
  if (d.number(8) != 0 || d.number(9) != 0) in.skip(e.name + ": pin flags PA, PB", d.place(8));
  for (int i = 0; i < 3; ++i) b.start[i] = d.number(10 + static_cast<size_t>(i)), b.end[i] = d.number(13 + static_cast<size_t>(i));
  add(deck, std::move(b), deck.beams);
}

void add_property(const BdfEntry& e, BdfDeck& deck, BdfThin section) {
  section.place = e.data.place();
  if (!deck.thin.try_emplace(e.data.integer(0), section).second)
    throw Error(e.data.place(0), fmt::format("property {} is given twice", e.data.integer(0)), "number each property once");
}

/// PID MID1 T MID2 12I/T3 MID3 TS/T NSM
void read_pshell(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  if (d.number(7) != 0) in.skip("PSHELL: mass per area NSM", d.place(7));
  BdfThin s;
  s.thickness = d.number(2);
  if (d.empty(3) || d.integer(3) != (d.empty(1) ? 0 : d.integer(1)))
    s.no_solid = "PSHELL with another material in bending, or none";
  else if ((!d.empty(4) && d.number(4) != 1) || !d.empty(10))
    s.no_solid = "PSHELL with 12I/T^3 other than 1, or MID4";
  add_property(e, deck, s);
  if (!d.empty(1)) deck.material_of.try_emplace(d.integer(0), d.integer(1));
}

/// PID Z0 NSM SB FT TREF GE LAM; MID1 T1 THETA1 SOUT1 MID2 T2 ...: a blank MID or T is that of the layer before.
void read_pcomp(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  if (d.number(2) != 0) in.skip("PCOMP: mass per area NSM", d.place(2));
  std::int64_t material = 0, first = 0;
  double t = 0, sum = 0;
  bool same = true;
  for (size_t i = 8; i < d.fields.size(); i += 4) {
    if (d.empty(i) && d.empty(i + 1) && d.empty(i + 2)) continue;
    if (!d.empty(i)) material = d.integer(i);
    if (!d.empty(i + 1)) t = d.number(i + 1);
    if (first == 0) first = material;
    same = same && material == first;
    sum += t;
  }
  const double layers = upper(d.text(7)) == "SYM" ? 2 : 1;
  BdfThin s;
  s.thickness = layers * sum;
  if (!d.empty(1)) s.offset = d.number(1) + s.thickness / 2;
  if (!same) s.no_solid = "PCOMP of several materials";
  add_property(e, deck, s);
  if (same)
    deck.material_of.try_emplace(d.integer(0), first);
  else
    in.skip("PCOMP of several materials: no density", d.place());
}

/// PID MID A I1 I2 J NSM; stress points; K1 K2 I12.  PBEAM: PID MID A I1 I2 I12 J NSM, then further stations.
void read_section(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  const bool beam = e.name == "PBEAM";
  BdfThin s;
  s.area = d.number(2), s.I1 = d.number(3), s.I2 = d.number(4), s.I12 = d.number(beam ? 5 : 18);
  if (d.number(beam ? 7 : 6) != 0) in.skip(e.name + ": mass per length NSM", d.place(beam ? 7 : 6));
  if (beam && !d.empty(18) && d.number(18) != s.area) in.skip("PBEAM that tapers: the section of end A is taken", d.place(18));
  add_property(e, deck, s);
  if (!d.empty(1)) deck.material_of.try_emplace(d.integer(0), d.integer(1));
}

/// PID MID GROUP TYPE; DIM1 DIM2 ...
void read_shape_of_section(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  const std::string type = upper(d.text(3));
  const auto dim = [&](size_t i) { return d.number(7 + i); };
  constexpr double pi = std::numbers::pi;
  BdfThin s;
  size_t n = 2;
  if (type == "ROD") {
    s.area = pi * dim(1) * dim(1), s.I1 = s.I2 = pi * std::pow(dim(1), 4) / 4, n = 1;
  } else if (type == "TUBE") {
    s.area = pi * (dim(1) * dim(1) - dim(2) * dim(2)), s.I1 = s.I2 = pi * (std::pow(dim(1), 4) - std::pow(dim(2), 4)) / 4;
  } else if (type == "BAR") {
    s.area = dim(1) * dim(2), s.I1 = dim(1) * std::pow(dim(2), 3) / 12, s.I2 = dim(2) * std::pow(dim(1), 3) / 12;
  } else if (type == "BOX") {
    const double w = dim(1) - 2 * dim(4), h = dim(2) - 2 * dim(3);
    s.area = dim(1) * dim(2) - w * h, n = 4;
    s.I1 = (dim(1) * std::pow(dim(2), 3) - w * h * h * h) / 12, s.I2 = (dim(2) * std::pow(dim(1), 3) - h * w * w * w) / 12;
  } else
    throw Error(d.place(3), fmt::format("{} {}: TYPE {} is not read", e.name, d.integer(0), type),
                "ROD, TUBE, BAR and BOX are; write the others as PBAR");
  if (e.name == "PBARL" && d.number(8 + n) != 0) in.skip("PBARL: mass per length NSM", d.place(8 + n));
  if (e.name == "PBEAML" && d.number(8 + n) != 0) in.skip("PBEAML: mass per length NSM", d.place(8 + n));
  add_property(e, deck, s);
  if (!d.empty(1)) deck.material_of.try_emplace(d.integer(0), d.integer(1));
}

}  // namespace

void add_thin_cell(const BdfDeck& deck, const BdfDeck::Thin& c, std::span<const std::int64_t> rows, Imported& in) {
  const auto found = deck.thin.find(c.property);
  const bool beam = c.shape == Shape::bar2;
  if (found == deck.thin.end())
    throw Error(c.place, fmt::format("{} {}: no property {}", beam ? "beam" : "shell", c.id, c.property),
                beam ? "PBAR, PBARL, PBEAM, PBEAML" : "PSHELL, PCOMP");
  const BdfThin& p = found->second;
  if (beam ? !(p.area > 0) : !(p.thickness > 0))
    throw Error(p.place, fmt::format("property {} has no {}", c.property, beam ? "area" : "thickness"));
  ThinSection s;
  s.no_solid = p.no_solid;
  s.thickness = p.thickness, s.offset = p.offset + c.offset, s.area = p.area, s.start = c.start, s.end = c.end;
  if (beam) {
    const auto& X = in.mesh.X;
    const Vec3 along = X[static_cast<size_t>(rows[1])] + c.end - X[static_cast<size_t>(rows[0])] - c.start;
    Vec3 v = c.v;
    if (c.towards != 0) {
      const auto grid = deck.row.find(c.towards);
      if (grid == deck.row.end()) throw Error(c.place, fmt::format("beam {} names node {}, which does not exist", c.id, c.towards));
      v = deck.X[static_cast<size_t>(grid->second)] - X[static_cast<size_t>(rows[0])];
    }
    if (!(along.cross(v).norm() > 1e-9 * along.norm() * v.norm())) {
      if (p.I1 != p.I2 || p.I12 != 0) throw Error(c.place, fmt::format("beam {}: its orientation lies along it, or is none", c.id));
      v = along.unitOrthogonal();
    }
    if ((deck.grids[static_cast<size_t>(rows[0])].output.value_or(0) != 0 ||
         deck.grids[static_cast<size_t>(rows[1])].output.value_or(0) != 0) &&
        (c.towards == 0 || c.start.norm() + c.end.norm() > 0))
      in.skip("CBAR, CBEAM: orientation and offsets in the displacement axes of a grid, taken as those of the model", c.place);
    s.second = second_of_section(along, v, p.I1, p.I2, p.I12);
  }
  in.thin[in.mesh.n_cells()] = s;
  in.mesh.add_cell(c.shape, rows, -1, c.id);
}

std::span<const BdfCard> bdf_thin_cards() {
  static constexpr BdfCard cards[] = {
      {"CTRIA3", read_shell<3, 0, 6, 10>},
      {"CTRIAR", read_shell<3, 0, 6, 10>},
      {"CTRIA6", read_shell<3, 3, 9, 10>},
      {"CQUAD4", read_shell<4, 0, 7, 10>},
      {"CQUADR", read_shell<4, 0, 7, 10>},
      {"CQUAD8", read_shell<4, 4, 15, 10>},
      {"CBAR", read_beam},
      {"CBEAM", read_beam},
      {"PSHELL", read_pshell},
      {"PCOMP", read_pcomp},
      {"PBAR", read_section},
      {"PBEAM", read_section},
      {"PBARL", read_shape_of_section},
      {"PBEAML", read_shape_of_section},
  };
  return cards;
}

}  // namespace hilo
