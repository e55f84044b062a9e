// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that make shells and beams, and properties of shells.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

void add(BdfDeck& deck, BdfDeck::Thin c, std::vector<BdfDeck::Thin>& to) {
  if (!deck.cell_ids.insert(c.id).second) throw Error(c.place, fmt::format("element {} is given twice", c.id), "number each element once");
  to.push_back(std::move(c));
}

/// `offset`, `thickness`, `flag`: where a shell entry has its offset, its own thicknesses and what they mean.
template <size_t corners, size_t middles, size_t offset, size_t thickness, size_t flag>
void read_shell(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfDeck::Thin s{{corners == 3 ? tri3 : quad4, d.integer(0), d.integer(1, d.integer(0)), {}, d.place(0)}};
  s.card = d.name;
  for (size_t i = 0; i < corners; ++i) s.nodes.push_back(d.integer(2 + i));
  size_t there = 0;
  for (size_t i = 0; i < middles; ++i) there += !d.empty(2 + corners + i);
  if (middles > 0 && there == middles) {
    s.shape = corners == 3 ? tri6 : quad8;
    for (size_t i = 0; i < middles; ++i) s.middles.push_back(d.integer(2 + corners + i));
  } else if (there > 0)
    in.skip(d.name + ": mid-side nodes on some edges only", d.place());
  if (!d.empty(offset)) s.offset = d.number(offset);
  if (d.is_integer(offset - 1))
    s.material_system = d.integer(offset - 1);
  else
    s.theta = d.number(offset - 1);
  for (size_t i = 0; i < corners; ++i) {
    if (d.empty(thickness + i)) continue;
    s.own[i] = d.number(thickness + i);
    if (!(s.own[i] > 0)) throw Error(d.place(thickness + i), fmt::format("{} {}: T{} {:g} is not above 0", d.name, s.id, i + 1, s.own[i]));
  }
  if (!d.empty(flag)) {
    if (d.integer(flag) != 0 && d.integer(flag) != 1)
      throw Error(d.place(flag), fmt::format("{} {}: TFLAG {} is neither 0 nor 1", d.name, s.id, d.integer(flag)));
    s.own_are_shares = d.integer(flag) == 1;
  }
  add(deck, std::move(s), deck.shells);
}

/// X1 X2 X3 (or G0) OFFT, from the fifth field on.
template <class Beam>
void read_orientation(const BdfEntry& d, Beam& b) {
  if (d.empty(5) && d.empty(6) && d.is_integer(4))
    b.towards = d.integer(4);
  else
    b.v = d.vector(4);
  if (!d.empty(7) && !d.is_integer(7)) b.axes = upper(d.text(7));
  if (!b.axes.empty() && (b.axes.size() != 3 || b.axes.find_first_not_of("GBO") != b.axes.npos || b.axes[0] == 'O'))
    throw Error(d.place(7), fmt::format("{}: OFFT {} is not three of G, B, O, the first of them G or B", d.name, b.axes));
}

/// EID PID GA GB X1 X2 X3 (or G0) OFFT; PA PB W1A W2A W3A W1B W2B W3B
void read_beam(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfDeck::Thin b{{Shape::bar2, d.integer(0), d.integer(1, 0), {d.integer(2), d.integer(3)}, d.place(0)}};
  b.card = d.name;
  read_orientation(d, b);
  for (size_t k = 0; k < 2; ++k)
    if (!d.empty(8 + k) && d.text(8 + k) != "0") b.pins[k] = components(d, 8 + k);
  for (int i = 0; i < 3; ++i) b.start[i] = d.number(10 + static_cast<size_t>(i)), b.end[i] = d.number(13 + static_cast<size_t>(i));
  if (d.name == "CBEAM" && (d.number(16) != 0 || d.number(17) != 0)) in.skip("CBEAM: warping grids SA, SB", d.place(16));
  add(deck, std::move(b), deck.beams);
}

/// - PID - - X1 X2 X3 (or G0) OFFT
void read_beam_default(const BdfEntry& e, BdfDeck& deck, Imported&) {
  BdfBeamDefault& b = deck.beam_default[e.name == "BAROR" ? "CBAR" : "CBEAM"];
  if (!b.place.empty()) throw Error(e.place(), e.name + " is given twice", "give it once");
  b.place = e.place();
  if (!e.empty(1)) b.property = e.integer(1);
  read_orientation(e, b);
}

/// PID MID1 T MID2 12I/T3 MID3 TS/T NSM
void read_pshell(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  if (d.number(7) != 0) in.skip("PSHELL: mass per area NSM", d.place(7));
  BdfThin s;
  s.thickness = d.number(2);
  s.bends_only = d.empty(1) && !d.empty(3);
  if (d.empty(3) || (d.integer(3) != d.integer(1, 0) && !s.bends_only))
    s.no_solid = "PSHELL with another material in bending, or none";
  else if ((!d.empty(4) && d.number(4) != 1) || !d.empty(10))
    s.no_solid = "PSHELL with 12I/T^3 other than 1, or MID4";
  else if (!d.empty(5) && d.integer(5) != d.integer(3))
    s.no_solid = "PSHELL with another material in transverse shear";
  if (!d.empty(6) && std::abs(d.number(6) - 5. / 6) > 0.01) in.skip("PSHELL: TS/T, other than 5/6", d.place(6));
  d.ignore_rest();  // where stresses are asked for
  add_property(d, deck, s, s.bends_only ? 3 : 1);
}

/// PID Z0 NSM SB FT TREF GE LAM; MID1 T1 THETA1 SOUT1 MID2 T2 ...: a blank MID or T is that of the layer before.
void read_pcomp(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  if (d.number(2) != 0) in.skip("PCOMP: mass per area NSM", d.place(2));
  std::int64_t material = 0, first = 0;
  double t = 0, sum = 0;
  bool same = true;
  BdfThin s;
  for (size_t i = 8; i < d.fields.size(); i += 4) {
    if (d.empty(i) && d.empty(i + 1) && d.empty(i + 2)) continue;
    if (!d.empty(i)) material = d.integer(i);
    if (!d.empty(i + 1)) t = d.number(i + 1);
    if (first == 0) first = material, s.angle = d.number(i + 2);
    if (std::abs(std::remainder(d.number(i + 2) - s.angle, 180)) > 0.05 && s.turned_layers.empty()) s.turned_layers = d.place(i + 2);
    same = same && material == first;
    sum += t;
  }
  for (size_t i = 3; i < 6; ++i) d.text(i);                    // limits of failure, temperature of reference
  for (size_t i = 11; i < d.fields.size(); i += 4) d.text(i);  // where stresses are asked for
  if (d.number(6) != 0) in.skip("PCOMP: structural damping GE", d.place(6));
  const double layers = upper(d.text(7)) == "SYM" ? 2 : 1;
  s.thickness = layers * sum;
  if (!d.empty(1)) s.offset = d.number(1) + s.thickness / 2;
  if (!same) s.no_solid = "PCOMP of several materials";
  add_property(d, deck, s, std::nullopt);
  if (same)
    deck.material_of.try_emplace(d.integer(0), first);
  else
    in.skip("PCOMP of several materials: no density", d.place());
}

}  // namespace

void add_property(const BdfEntry& e, BdfDeck& deck, BdfThin section, std::optional<size_t> material) {
  section.place = e.place();
  if (!deck.thin.try_emplace(e.integer(0), section).second)
    throw Error(e.place(0), fmt::format("property {} is given twice", e.integer(0)), "number each property once");
  if (material && !e.empty(*material)) deck.material_of.try_emplace(e.integer(0), e.integer(*material));
}

void resolve_beams(BdfDeck& deck) {
  for (BdfDeck::Thin& b : deck.beams) {
    const BdfBeamDefault& otherwise = deck.beam_default[b.card];
    if (b.property == 0) b.property = otherwise.property != 0 ? otherwise.property : b.id;
    if (b.towards == 0 && b.v == Vec3::Zero()) b.towards = otherwise.towards, b.v = otherwise.v;
    if (b.axes.empty()) b.axes = otherwise.axes.empty() ? "GGG" : otherwise.axes;
  }
}

const BdfThin& section_of_beam(const BdfDeck& deck, const BdfDeck::Thin& b) {
  const auto found = deck.thin.find(b.property);
  if (found == deck.thin.end())
    throw Error(b.place, fmt::format("beam {}: no property {}", b.id, b.property), "PBAR, PBARL, PBEAM, PBEAML");
  const BdfThin& p = found->second;
  if (!p.section.given() || !(p.section.area(0.3, p.place).A > 0)) throw Error(p.place, fmt::format("property {} has no area", b.property));
  return p;
}

BdfBeamPlace place_of_beam(const BdfDeck& deck, const BdfDeck::Thin& b) {
  std::array<std::int64_t, 2> rows;
  for (size_t k = 0; k < 2; ++k) rows[k] = deck.row_of(b.nodes[k], b.place, "element", b.id);
  const auto X = [&](size_t k) { return deck.X[static_cast<size_t>(rows[k])]; };
  const auto turned = [&](size_t letter, size_t k, const Vec3& v) -> Vec3 {
    if (v.norm() == 0 || b.axes[letter] == 'B') return v;
    const BdfGrid& g = deck.grids[static_cast<size_t>(rows[k])];
    return axes_at(deck, g.output.value_or(0), X(k), g.place) * v;
  };
  BdfBeamPlace out{X(0), X(1), turned(0, 0, b.v)};
  if (b.towards != 0) out.up = deck.X[static_cast<size_t>(deck.row_of(b.towards, b.place, "beam", b.id))] - X(0);
  const auto offset = [&](size_t letter, size_t k, const Vec3& v) -> Vec3 {
    if (b.axes[letter] != 'O' || v.norm() == 0) return turned(letter, k, v);
    const Vec3 x = X(1) - X(0), z = x.cross(out.up);  // x from grid to grid
    if (!(z.norm() > 1e-9 * x.norm() * out.up.norm()))
      throw Error(b.place,
                  fmt::format("{} {}: OFFT {}, and its orientation lies along the line of its grids, or is none", b.card, b.id, b.axes));
    Mat3 own;
    own << x.normalized(), z.cross(x).normalized(), z.normalized();
    return own * v;
  };
  out.a += offset(1, 0, b.start), out.b += offset(2, 1, b.end);
  const Vec3 along = out.b - out.a;
  if (!(along.norm() > 0)) throw Error(b.place, fmt::format("beam {} has no length", b.id));
  if (!(along.cross(out.up).norm() > 1e-9 * along.norm() * out.up.norm())) {
    const DeckSection& s = section_of_beam(deck, b).section;
    const SectionArea area = s.area(0.3, b.place);
    if (area.I1 != area.I2 || s.I12 != 0 || area.shear_1 != area.shear_2)
      throw Error(b.place, fmt::format("beam {}: its orientation lies along it, or is none", b.id));
    out.up = along.unitOrthogonal();
  }
  const Vec3 z = along.cross(out.up).normalized(), y = z.cross(along).normalized();
  const auto& neutral = section_of_beam(deck, b).neutral;
  out.a += neutral[0][0] * y + neutral[0][1] * z, out.b += neutral[1][0] * y + neutral[1][1] * z;
  return out;
}

void add_thin_cell(const BdfDeck& deck, const BdfDeck::Thin& c, std::span<const std::int64_t> rows, Imported& in) {
  ThinSection s;
  if (c.shape == Shape::bar2) {
    const DeckSection& section = section_of_beam(deck, c).section;
    const BdfBeamPlace at = place_of_beam(deck, c);
    const SectionArea area = section.area(0.3, c.place);
    s.area = area.A;
    s.start = at.a - in.mesh.X[static_cast<size_t>(rows[0])], s.end = at.b - in.mesh.X[static_cast<size_t>(rows[1])];
    s.second = second_of_section(at.b - at.a, at.up, area.I1, area.I2, -section.I12);
    if (section.line_mass != 0) in.skip("PBAR, PBEAM: mass per length NSM", section_of_beam(deck, c).place);
    if (c.pins[0] || c.pins[1]) in.skip(c.card + ": pin flags PA, PB", c.place);
  } else {
    const auto found = deck.thin.find(c.property);
    if (found == deck.thin.end()) throw Error(c.place, fmt::format("shell {}: no property {}", c.id, c.property), "PSHELL, PCOMP");
    const BdfThin& p = found->second;
    const size_t corners = static_cast<size_t>(info(c.shape).n_corners);
    const bool needs_property = c.own_are_shares || std::ranges::count(std::span(c.own).first(corners), 0.) > 0;
    if (needs_property && !(p.thickness > 0)) throw Error(p.place, fmt::format("property {} has no thickness", c.property));
    s.no_solid = p.no_solid;
    s.thickness = p.thickness, s.offset = p.offset + c.offset;
    if (std::ranges::any_of(c.own, [](double t) { return t > 0; })) {
      s.thickness = 0;
      for (size_t i = 0; i < corners; ++i) {
        s.own[i] = c.own[i] == 0 ? p.thickness : c.own[i] * (c.own_are_shares ? p.thickness : 1);
        s.thickness += s.own[i] / static_cast<double>(corners);
      }
    }
  }
  in.thin[in.mesh.n_cells()] = s;
  in.mesh.add_cell(c.shape, rows, -1, c.id);
}

std::vector<BdfCard> bdf_thin_cards() {
  return {
      {"CTRIA3", read_shell<3, 0, 6, 10, 9>},
      {"CTRIAR", read_shell<3, 0, 6, 10, 9>},
      {"CTRIA6", read_shell<3, 3, 9, 10, 13>},
      {"CQUAD4", read_shell<4, 0, 7, 10, 9>},
      {"CQUADR", read_shell<4, 0, 7, 10, 9>},
      {"CQUAD8", read_shell<4, 4, 15, 10, 16>},
      {"CBAR", read_beam},
      {"CBEAM", read_beam},
      {"BAROR", read_beam_default},
      {"BEAMOR", read_beam_default},
      {"PSHELL", read_pshell},
      {"PCOMP", read_pcomp},
  };
}

}  // namespace hilo
