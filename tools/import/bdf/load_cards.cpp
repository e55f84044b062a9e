// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that say supports and loads, and the sets of them that case control names.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

void read_spc1(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfSupport s{{}, components(d, 1), 0, d.place()};
  if (const size_t end = grid_list(d, 2, s.grids, s.ranges); end < d.fields.size())
    throw Error(d.place(end), fmt::format("SPC1: expected a grid, found \"{}\"", d.text(end)));
  deck.supports.lines[d.integer(0)].push_back(std::move(s));
}
void read_spc(const BdfEntry& d, BdfDeck& deck, Imported&) {
  for (size_t i = 1; i < 7; i += 3)
    if (!d.empty(i)) deck.supports.lines[d.integer(0)].push_back({{d.integer(i)}, components(d, i + 1), d.number(i + 2), d.place()});
}
void add_sum(const BdfEntry& d, std::map<std::int64_t, BdfSum>& sums, BdfSum sum) {
  if (!sums.try_emplace(d.integer(0), std::move(sum)).second)
    throw Error(d.place(0), fmt::format("{} {} is given twice", d.name, d.integer(0)));
}
template <auto sets>
void read_sum(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfSum sum{1, {}, d.place()};
  std::vector<std::int64_t> ids;
  grid_list(d, 1, ids);
  for (const auto id : ids) sum.parts.emplace_back(1, id);
  add_sum(d, (deck.*sets).sums, sum);
}
void read_mpc(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfEquation m{{}, d.place()};
  for (size_t line = 0; 8 * line < d.fields.size(); ++line)  // two terms a line, behind an empty field
    for (const size_t i : {8 * line + 1, 8 * line + 4})
      if (i < d.fields.size() && !d.empty(i)) m.terms.push_back({d.integer(i), d.integer(i + 1, 0), d.number(i + 2)});
  deck.ties.lines[d.integer(0)].push_back(m);
}

Vec3 vector_at(const DataLine& d, size_t field) { return {d.number(field), d.number(field + 1), d.number(field + 2)}; }
/// The same where a load has no direction without it.
Vec3 direction_at(const BdfEntry& e, size_t field) {
  const Vec3 v = vector_at(e, field);
  if (!(v.norm() > 0)) throw Error(e.place(field), e.name + ": the direction has no length");
  return v;
}

/// Behind the others of its set.
BdfLoad& new_load(const BdfEntry& d, BdfDeck& deck, BdfLoad::Kind kind) {
  BdfLoad& l = deck.loads.lines[d.integer(0)].emplace_back(BdfLoad{kind});
  l.place = d.place();
  return l;
}

void read_force(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfLoad& l = new_load(d, deck, d.name.front() == 'F' ? BdfLoad::Kind::force : BdfLoad::Kind::moment);
  l.grid = d.integer(1);
  if (d.name.back() == '1') {
    l.size = d.number(2), l.towards = {d.integer(3), d.integer(4)};
  } else {
    l.system = d.integer(2, 0);
    l.size = d.number(3), l.direction = direction_at(d, 4);
  }
}
void read_spcd(const BdfEntry& d, BdfDeck& deck, Imported&) {
  for (size_t i = 1; i < 7; i += 3)
    if (!d.empty(i)) {
      BdfLoad& l = new_load(d, deck, BdfLoad::Kind::displacement);
      l.grid = d.integer(i), l.components = components(d, i + 1), l.size = d.number(i + 2);
    }
}
void read_gravity(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfLoad& l = new_load(d, deck, BdfLoad::Kind::gravity);
  l.system = d.integer(1, 0), l.size = d.number(2), l.direction = direction_at(d, 3);
}

/// SID G CID A R1 R2 R3 METHOD RACC: the whole turns about an axis through a grid.
void read_rforce(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  if (d.number(8) != 0) in.skip("RFORCE: angular acceleration", d.place(8));
  BdfLoad& l = new_load(d, deck, BdfLoad::Kind::rotation);
  l.grid = d.integer(1, 0), l.system = d.integer(2, 0);
  l.size = d.number(3), l.direction = direction_at(d, 4);
}

/// Pressure on a face of a solid, or on a shell: SID EID P1 P2 P3 P4 G1 G3|G4, or SID EID P1 - - - THRU EID2; then CID N1 N2 N3 SORL LDIR.
void read_pload4(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfLoad l{BdfLoad::Kind::pressure};
  l.place = d.place(), l.size = d.number(2), l.elements = {d.integer(1)};
  for (size_t i = 2; i < 6; ++i) l.at_corners.push_back(d.number(i, l.size));
  if (std::ranges::all_of(l.at_corners, [&](double p) { return p == l.size; })) l.at_corners.clear();
  if (upper(d.text(6)) == "THRU") {
    const auto last = d.integer(7);
    if (last < l.elements[0] || last - l.elements[0] > 100'000'000)
      throw Error(d.place(7), fmt::format("PLOAD4: {} THRU {} names no usable range", l.elements[0], last));
    l.ranges = {{l.elements[0], last, 1}}, l.elements.clear();
  } else {
    l.face = {d.integer(6, 0), d.integer(7, 0)};
  }
  l.system = d.integer(8, 0);
  l.direction = vector_at(d, 9);
  for (size_t i = 12; i < 14; ++i)
    if (!d.empty(i) && upper(d.text(i)) != (i == 12 ? "SURF" : "NORM"))
      return in.skip(fmt::format("PLOAD4, {}", upper(d.text(i)).substr(0, 8)), d.place(i));
  deck.loads.lines[d.integer(0)].push_back(std::move(l));
}
/// SID P and three or four grids, positive along the normal that they turn about.
void read_pload(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfLoad& l = new_load(d, deck, BdfLoad::Kind::pressure);
  l.size = d.number(1);
  for (size_t i = 2; i < 6; ++i)
    if (!d.empty(i)) l.corners.push_back(d.integer(i));
  if (l.corners.size() < 3) throw Error(d.place(), "PLOAD names three or four grids");
}
/// SID P and shells.
void read_pload2(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfLoad& l = new_load(d, deck, BdfLoad::Kind::pressure);
  l.size = d.number(1);
  grid_list(d, 2, l.elements, l.ranges);
}

void read_load(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfSum sum{d.number(1, 1), {}, d.place()};
  for (size_t i = 2; i < d.fields.size(); i += 2)
    if (!d.empty(i + 1)) sum.parts.emplace_back(d.number(i, 1), d.integer(i + 1));
  add_sum(d, deck.loads.sums, sum);
}

/// EIGRL: SID V1 V2 ND; EIGR: SID METHOD F1 F2 NE ND.  A band of frequencies is not asked for.
void read_modes(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  const size_t field = d.name == "EIGRL" ? 3 : 5, band = d.name == "EIGRL" ? 2 : 3;
  d.ignore_rest();  // how they are found and scaled
  const auto n = d.integer(field, 0);
  if (d.number(band - 1) > 0) in.skip(d.name + " from a frequency (the lowest modes are looked for)", d.place(band - 1));
  if (n == 0 && !d.empty(band)) in.skip(d.name + " up to a frequency", d.place(band));
  deck.modes[d.integer(0)] = static_cast<int>(std::min<std::int64_t>(std::max<std::int64_t>(n, 0), 1000));
}
/// SID N1 DT1 NO1, and on further lines other steps.
void read_tstep(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  double end = 0;
  for (size_t i = 1; i < d.fields.size(); i += 8) end += d.number(i) * d.number(i + 1);
  if (d.fields.size() > 8) in.skip("TSTEP whose steps change", d.place());
  deck.steps[d.integer(0)] = {end, d.number(2)};
}

/// A force per length of a beam or of a part of it; a force or moment at a point of it.
void read_pload1(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  const std::string type = upper(d.text(2)), scale = upper(d.text(3));
  const bool known_scale = scale == "LE" || scale == "FR" || scale == "LEPR" || scale == "FRPR";
  if (type.size() < 2 || (type[0] != 'F' && type[0] != 'M') || type[1] < 'X' || type[1] > 'Z' || (type.size() > 2 && type.substr(2) != "E"))
    throw Error(d.place(2), fmt::format("PLOAD1: no type \"{}\"", d.text(2)), "FX, FY, FZ, FXE, FYE, FZE or moments");
  if (!known_scale) throw Error(d.place(3), fmt::format("PLOAD1: no scale \"{}\"", d.text(3)), "LE, FR, LEPR or FRPR");
  const double from = d.number(4), to = d.empty(6) ? from : d.number(6), at_end = d.number(7);  // the last says nothing at a point
  BdfLoad l{BdfLoad::Kind::line};
  l.turns = type[0] == 'M';
  if (l.turns && from != to) return in.skip("PLOAD1 of moments per length", d.place());
  if (to < from) throw Error(d.place(6), fmt::format("PLOAD1: it ends at {:g}, before it begins at {:g}", to, from), "X2 from X1 on");
  l.elements = {d.integer(1)}, l.size = d.number(5), l.size_end = from == to ? l.size : at_end, l.place = d.place(),
  l.direction = Vec3::Unit(type[1] - 'X');
  l.own_axes = type.size() > 2, l.projected = scale.size() > 2, l.as_share = scale.starts_with("FR"), l.from_to = {from, to};
  deck.loads.lines[d.integer(0)].push_back(l);
}

}  // namespace

std::vector<BdfCard> bdf_load_cards() {
  return {
      {"SPC1", read_spc1},
      {"SPC", read_spc},
      {"SPCD", read_spcd},
      {"SPCADD", read_sum<&BdfDeck::supports>},
      {"FORCE", read_force},
      {"FORCE1", read_force},
      {"MOMENT", read_force},
      {"MOMENT1", read_force},
      {"GRAV", read_gravity},
      {"RFORCE", read_rforce},
      {"PLOAD1", read_pload1},
      {"PLOAD4", read_pload4},
      {"PLOAD", read_pload},
      {"PLOAD2", read_pload2},
      {"LOAD", read_load},
      {"EIGRL", read_modes},
      {"EIGR", read_modes},
      {"TSTEP", read_tstep},
      {"MPC", read_mpc},
      {"MPCADD", read_sum<&BdfDeck::ties>},
      {"BGADD", read_sum<&BdfDeck::glue>},
      {"BCTADD", read_sum<&BdfDeck::contacts>},
  };
}

}  // namespace hilo
