// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that make shells and beams, and their properties.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

std::int64_t property_of(const DataLine& d, size_t field) { return d.empty(field) ? d.integer(0) : d.integer(field); }

void add(BdfDeck& deck, BdfDeck::Thin c, std::vector<BdfDeck::Thin>& to) {
  if (!deck.cell_ids.insert(c.id).second) throw Error(c.place, fmt::format("element {} is given twice", c.id), "number each element once");
  to.push_back(std::move(c));
}

/// `offset`, `thickness`, `flag`: where a shell entry has its offset, its own thicknesses and what they mean.
template <size_t corners, size_t middles, size_t offset, size_t thickness, size_t flag>
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
  if (d.is_integer(offset - 1))
    s.material_system = d.integer(offset - 1);
  else
    s.theta = d.number(offset - 1);
  for (size_t i = 0; i < corners; ++i) {
    if (d.empty(thickness + i)) continue;
    s.own[i] = d.number(thickness + i);
    if (!(s.own[i] > 0)) throw Error(d.place(thickness + i), fmt::format("{} {}: T{} {:g} is not above 0", e.name, s.id, i + 1, s.own[i]));
  }
  if (!d.empty(flag)) {
    if (d.integer(flag) != 0 && d.integer(flag) != 1)
      throw Error(d.place(flag), fmt::format("{} {}: TFLAG {} is neither 0 nor 1", e.name, s.id, d.integer(flag)));
    s.own_are_shares = d.integer(flag) == 1;
  }
  add(deck, std::move(s), deck.shells);
}

/// X1 X2 X3 (or G0) OFFT, from the fifth field on.
template <class Beam>
void read_orientation(const BdfEntry& e, Beam& b) {
  const auto& d = e.data;
  if (d.empty(5) && d.empty(6) && d.is_integer(4))
    b.towards = d.integer(4);
  else
    b.v = Vec3(d.number(4), d.number(5), d.number(6));
  if (!d.empty(7) && !d.is_integer(7)) b.axes = upper(d.text(7));
  if (!b.axes.empty() && (b.axes.size() != 3 || b.axes.find_first_not_of("GBO") != b.axes.npos || b.axes[0] == 'O'))
    throw Error(d.place(7), fmt::format("{}: OFFT {} is not three of G, B, O, the first of them G or B", e.name, b.axes));
}

/// EID PID GA GB X1 X2 X3 (or G0) OFFT; PA PB W1A W2A W3A W1B W2B W3B
void read_beam(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  BdfDeck::Thin b{{Shape::bar2, d.integer(0), d.empty(1) ? 0 : d.integer(1), {d.integer(2), d.integer(3)}, d.place(0)}};
  b.card = e.name;
  read_orientation(e, b);
  for (size_t k = 0; k < 2; ++k)
    if (!d.empty(8 + k) && d.text(8 + k) != "0") b.pins[k] = components(d, 8 + k);
  for (int i = 0; i < 3; ++i) b.start[i] = d.number(10 + static_cast<size_t>(i)), b.end[i] = d.number(13 + static_cast<size_t>(i));
  if (e.name == "CBEAM" && (d.number(16) != 0 || d.number(17) != 0)) in.skip("CBEAM: warping grids SA, SB", d.place(16));
  add(deck, std::move(b), deck.beams);
}

/// - PID - - X1 X2 X3 (or G0) OFFT
void read_beam_default(const BdfEntry& e, BdfDeck& deck, Imported&) {
  BdfBeamDefault& b = deck.beam_default[e.name == "BAROR" ? "CBAR" : "CBEAM"];
  if (!b.place.empty()) throw Error(e.data.place(), e.name + " is given twice", "give it once");
  b.place = e.data.place();
  if (!e.data.empty(1)) b.property = e.data.integer(1);
  read_orientation(e, b);
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
  s.bends_only = d.empty(1) && !d.empty(3);
  if (d.empty(3) || (d.integer(3) != (d.empty(1) ? 0 : d.integer(1)) && !s.bends_only))
    s.no_solid = "PSHELL with another material in bending, or none";
  else if ((!d.empty(4) && d.number(4) != 1) || !d.empty(10))
    s.no_solid = "PSHELL with 12I/T^3 other than 1, or MID4";
  else if (!d.empty(5) && d.integer(5) != d.integer(3))
    s.no_solid = "PSHELL with another material in transverse shear";
  if (!d.empty(6) && std::abs(d.number(6) - 5. / 6) > 0.01) in.skip("PSHELL: TS/T, other than 5/6", d.place(6));
  d.ignore_rest();  // where stresses are asked for
  add_property(e, deck, s);
  if (!d.empty(1) || s.bends_only) deck.material_of.try_emplace(d.integer(0), d.integer(s.bends_only ? 3 : 1));
}

/// PID Z0 NSM SB FT TREF GE LAM; MID1 T1 THETA1 SOUT1 MID2 T2 ...: a blank MID or T is that of the layer before.
void read_pcomp(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
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
  add_property(e, deck, s);
  if (same)
    deck.material_of.try_emplace(d.integer(0), first);
  else
    in.skip("PCOMP of several materials: no density", d.place());
}

/// K1 and K2 along plane 1 and 2; blank or 0: no shear strain where `stiff`, else 1.
void set_shear(DeckSection& s, double K1, double K2, bool stiff) {
  s.shear = {K2 > 0 ? K2 : 1, K1 > 0 ? K1 : 1};
  s.no_shear_strain = {stiff && !(K2 > 0), stiff && !(K1 > 0)};
}

/// That of the section at each end by its neutral axis: axis 1 is against z, axis 2 along y.
void set_shear_centre(BdfThin& s) {
  const auto at = [&](size_t end) { return std::array{s.neutral[end][1], s.neutral[end][0] == 0 ? 0 : -s.neutral[end][0]}; };
  if (s.neutral[0] != s.neutral[1] && !s.end.given()) s.end = s.section;
  s.section.shear_centre = at(0);
  if (s.end.given()) s.end.shear_centre = at(1);
}

/// PID MID A I1 I2 J NSM; stress points; K1 K2 I12.
void read_pbar(const BdfEntry& e, BdfDeck& deck, Imported&) {
  const auto& d = e.data;
  BdfThin s;
  s.section = general_section(d.number(2), d.number(3), d.number(4), d.number(5));
  s.section.line_mass = d.number(6), s.section.I12 = -d.number(18);
  for (size_t i = 8; i < 16; ++i) d.number(i);  // where stresses are asked for
  set_shear(s.section, d.number(16), d.number(17), true);
  add_property(e, deck, s);
  if (!d.empty(1)) deck.material_of.try_emplace(d.integer(0), d.integer(1));
}

/// A taper is even between the ends; tells where stations between them say otherwise.
template <class Numbers>
void check_even(const std::vector<std::pair<double, Numbers>>& stations, const Numbers& a, const Numbers& b, const std::string& card,
                const std::string& place, Imported& in) {
  for (const auto& [x, there] : stations)
    for (size_t i = 0; i < a.size(); ++i)
      if (std::abs(there[i] - std::lerp(a[i], b[i], x)) > 1e-3 * std::max(std::abs(a[i]), std::abs(b[i])))
        return in.skip(card + " with stations between its ends: it varies evenly from end to end", place);
}

/// PID MID A I1 I2 I12 J NSM, stress points; stations of SO X/XB A I1 I2 I12 J NSM, with stress points where SO is YES; K1 K2 S1 S2 NSI CW;
/// M1 M2 of both ends, N1 N2 of both ends.
void read_pbeam(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  std::array<double, 6> at_a, at_b;
  for (size_t i = 0; i < 6; ++i) at_a[i] = at_b[i] = d.number(2 + i);
  const auto word = [&](size_t i) { return upper(d.text(i)); };
  const auto is_station = [&](size_t i) { return word(i) == "YES" || word(i) == "YESA" || word(i) == "NO"; };
  size_t line = is_station(8) ? 8 : 16;
  std::vector<std::pair<double, std::array<double, 6>>> stations;  // X/XB, and the section there
  for (; is_station(line); line += word(line) == "YES" ? 16 : 8) {
    auto& there = stations.emplace_back(d.number(line + 1), at_a).second;
    for (size_t i = 0; i < 6; ++i) there[i] = d.number(line + 2 + i, at_a[i]);
    if (stations.back().first == 1) at_b = there;
  }
  check_even(stations, at_a, at_b, "PBEAM", d.place(), in);
  const auto section = [&](const std::array<double, 6>& v) {
    DeckSection out = general_section(v[0], v[1], v[2], v[4]);
    out.line_mass = v[5], out.I12 = -v[3];
    set_shear(out, d.number(line, 1), d.number(line + 1, 1), true);
    return out;
  };
  BdfThin s;
  s.section = section(at_a);
  if (at_b != at_a) s.end = section(at_b);
  for (size_t i = 4; i < 8; ++i)
    if (d.number(line + i) != 0) in.skip(i < 6 ? "PBEAM: inertia NSI of its NSM" : "PBEAM: warping CW", d.place(line + i));
  bool apart = false;  // NSM from the neutral axis
  for (size_t k = 0; k < 4; ++k) {
    const double M = d.number(line + 8 + k, k < 2 ? 0 : d.number(line + 6 + k)),
                 N = d.number(line + 12 + k, k < 2 ? 0 : d.number(line + 10 + k));
    s.neutral[k / 2][k % 2] = N;
    apart = apart || M != N;
  }
  if (apart && s.section.line_mass != 0) in.skip("PBEAM: NSM off the neutral axis", d.place(line + 8));
  set_shear_centre(s);
  add_property(e, deck, s);
  if (!d.empty(1)) deck.material_of.try_emplace(d.integer(0), d.integer(1));
}

/// Off whose centre of area the shear centre lies.
DeckSection with_shear_centre(const char* kind, const std::vector<double>& v) {
  const SectionArea a =
      DeckSection{kind, {{"width", v[0]}, {"height", v[1]}, {"flange", v[2]}, {"web", v[3]}}}.area(0.3, fmt::format("TYPE {}", kind));
  DeckSection out = general_section(a.A, a.I1, a.I2, a.J);
  out.shear = {a.shear_1, a.shear_2};
  out.shear_centre = {a.s1, a.s2};
  return out;
}

/// Shapes that [section.NAME] does not have, along axes 1, against z of the element, and 2, along its y.
DeckSection rectangles(const std::vector<DeckRectangle>& parts) { return section_of_rectangles(parts, "a TYPE of sections"); }

/// Shapes that [section.NAME] has too, and others of rectangles: DIM1 is across plane 1 where the shape has a width.
struct BeamShape {
  size_t dims;
  DeckSection (*of)(const std::vector<double>& dim);
};
const std::map<std::string, BeamShape> beam_shapes{
    {"ROD",
     {1,
      [](const std::vector<double>& v) {
        return DeckSection{"circle", {{"diameter", 2 * v[0]}}};
      }}},
    {"TUBE",
     {2,
      [](const std::vector<double>& v) {
        return DeckSection{"tube", {{"diameter", 2 * v[0]}, {"thickness", v[0] - v[1]}}};
      }}},
    {"BAR",
     {2,
      [](const std::vector<double>& v) {
        return DeckSection{"rectangle", {{"width", v[0]}, {"height", v[1]}}};
      }}},
    {"BOX",
     {4,
      [](const std::vector<double>& v) {
        if (v[2] == v[3]) return DeckSection{"box", {{"width", v[0]}, {"height", v[1]}, {"thickness", v[2]}}};
        const double w = v[0] - 2 * v[3], h = v[1] - 2 * v[2], thin = std::min(v[2], v[3]);
        if (!(thin > 0 && w > 0 && h > 0)) return DeckSection{};
        const double wm = v[0] - v[3], hm = v[1] - v[2];
        return general_section(v[0] * v[1] - w * h, (v[0] * std::pow(v[1], 3) - w * h * h * h) / 12,
                               (v[1] * std::pow(v[0], 3) - h * w * w * w) / 12, 2 * wm * wm * hm * hm / (wm / v[2] + hm / v[3]));
      }}},
    {"I",
     {6,
      [](const std::vector<double>& v) {
        if (v[1] != v[2] || v[4] != v[5])  // the flange below is the first
          return rectangles(
              {{-v[1] / 2, v[1] / 2, 0, v[4]}, {-v[3] / 2, v[3] / 2, v[4], v[0] - v[5]}, {-v[2] / 2, v[2] / 2, v[0] - v[5], v[0]}});
        return DeckSection{"I", {{"width", v[1]}, {"height", v[0]}, {"flange", v[4]}, {"web", v[3]}}};
      }}},
    {"T", {4, [](const std::vector<double>& v) { return with_shear_centre("T", v); }}},
    {"CHAN",
     {4,
      [](const std::vector<double>& v) {
        return with_shear_centre("C", {v[0], v[1], v[3], v[2]});
      }}},
    {"I1",
     {4,
      [](const std::vector<double>& v) {  // flanges beyond the web, web, height of the web, whole height
        return DeckSection{"I", {{"width", v[0] + v[1]}, {"height", v[3]}, {"flange", (v[3] - v[2]) / 2}, {"web", v[1]}}};
      }}},
    {"TUBE2",
     {2,
      [](const std::vector<double>& v) {
        return DeckSection{"tube", {{"diameter", 2 * v[0]}, {"thickness", v[1]}}};
      }}},
    {"H",
     {4,
      [](const std::vector<double>& v) {  // width between the flanges, width of both, their height, thickness of the web between
        const double w = v[0] / 2, out = (v[0] + v[1]) / 2;
        return rectangles({{-out, -w, -v[2] / 2, v[2] / 2}, {-w, w, -v[3] / 2, v[3] / 2}, {w, out, -v[2] / 2, v[2] / 2}});
      }}},
    {"CROSS",
     {4,
      [](const std::vector<double>& v) {  // width of both arms, width of the upright, its height, thickness of the arms
        const double w = v[1] / 2, out = (v[0] + v[1]) / 2;
        return rectangles({{-w, w, -v[2] / 2, v[2] / 2}, {-out, -w, -v[3] / 2, v[3] / 2}, {w, out, -v[3] / 2, v[3] / 2}});
      }}},
    {"T1",
     {4,
      [](const std::vector<double>& v) {  // height of the flange, length of the web across, thickness of the flange, of the web
        return rectangles({{0, v[2], -v[0] / 2, v[0] / 2}, {v[2], v[2] + v[1], -v[3] / 2, v[3] / 2}});
      }}},
    {"T2",
     {4,
      [](const std::vector<double>& v) {  // width of the flange below, whole height, thickness of the flange, of the web
        return rectangles({{-v[0] / 2, v[0] / 2, 0, v[2]}, {-v[3] / 2, v[3] / 2, v[2], v[1]}});
      }}},
    {"CHAN1",
     {4,
      [](const std::vector<double>& v) {  // flanges beyond the web, web, height of the web between them, whole height
        return rectangles(
            {{0, v[1], -v[3] / 2, v[3] / 2}, {v[1], v[1] + v[0], -v[3] / 2, -v[2] / 2}, {v[1], v[1] + v[0], v[2] / 2, v[3] / 2}});
      }}},
    {"CHAN2",
     {4,
      [](const std::vector<double>& v) {  // thickness of the legs, of the web across, whole height, whole width
        const double w = v[3] / 2, in = w - v[0];
        return rectangles({{-w, -in, 0, v[2]}, {in, w, 0, v[2]}, {-in, in, v[2] - v[1], v[2]}});
      }}},
    {"BOX1",
     {6,
      [](const std::vector<double>& v) {                         // width, height, walls above, below, left, right
        if (v[2] != v[3] && v[4] != v[5]) return DeckSection{};  // askew, and which is left not the same in all sources
        const double w = v[0], h = v[1];
        return rectangles({{0, v[4], 0, h}, {w - v[5], w, 0, h}, {v[4], w - v[5], 0, v[3]}, {v[4], w - v[5], h - v[2], h}});
      }}},
    {"L",
     {4,
      [](const std::vector<double>& v) {  // width, towards +z, height, towards +y, thickness of the leg along z, of that along y
        return rectangles({{-v[3], 0, 0, v[1]}, {-v[0], -v[3], 0, v[2]}});
      }}},
    {"Z",
     {4,
      [](const std::vector<double>& v) {  // flanges beyond the web, web, height of the web between them, whole height; above towards -z
        const double t = (v[3] - v[2]) / 2;
        return rectangles({{-v[1], 0, 0, v[3]}, {0, v[0], v[3] - t, v[3]}, {-v[1] - v[0], -v[1], 0, t}});
      }}},
    {"HAT",
     {4,
      [](const std::vector<double>& v) {  // height, thickness, width of the top, brims beyond it
        const double w = v[2] / 2, t = v[1], h = v[0];
        if (!(w > t)) return DeckSection{};
        return rectangles(
            {{-w, w, h - t, h}, {-w, -w + t, t, h - t}, {w - t, w, t, h - t}, {-w - v[3], -w + t, 0, t}, {w - t, w + v[3], 0, t}});
      }}},
    {"HAT1",
     {5,
      [](const std::vector<double>& v) {  // width of the plate below, whole height, width of the top, thickness of the hat, of the plate
        const double w = v[2] / 2, out = v[0] / 2, t = v[3], h = v[1], p = v[4];
        if (!(w > t)) return DeckSection{};
        return rectangles({{-out, out, 0, p},
                           {-out, -w + t, p, p + t},
                           {w - t, out, p, p + t},
                           {-w, -w + t, p + t, h - t},
                           {w - t, w, p + t, h - t},
                           {-w, w, h - t, h}});
      }}},
};

/// The same by its numbers.
DeckSection general_of(const DeckSection& s, const std::string& place) {
  const SectionArea a = s.area(0.3, place);
  DeckSection out = general_section(a.A, a.I1, a.I2, a.J);
  out.I12 = s.I12, out.line_mass = s.line_mass, out.shear = {a.shear_1, a.shear_2}, out.shear_centre = s.shear_centre;
  return out;
}

/// PID MID GROUP TYPE; DIM1 DIM2 ... NSM
void read_shape_of_section(const BdfEntry& e, BdfDeck& deck, Imported& in) {
  const auto& d = e.data;
  const std::string type = upper(d.text(3));
  d.text(2);  // the library that has the type
  const auto shape = beam_shapes.find(type);
  const auto refuse = [&](const std::string& what) {
    return Error(d.place(3), fmt::format("{} {}: {} is not read", e.name, d.integer(0), what),
                 "ROD, TUBE, TUBE2, BAR, BOX, BOX1, I, I1, H, CROSS, T, T1, T2, CHAN, CHAN1, CHAN2, L, Z, HAT and HAT1 are; write the "
                 "others as PBAR");
  };
  if (shape == beam_shapes.end()) throw refuse("TYPE " + type);
  std::vector<double> dims;
  for (size_t i = 0; i < shape->second.dims; ++i) {
    if (d.empty(8 + i)) throw refuse(fmt::format("TYPE {} without DIM{}", type, i + 1));
    dims.push_back(d.number(8 + i));
  }
  BdfThin s;
  s.section = shape->second.of(dims);
  if (!s.section.given())
    throw refuse("TYPE " + type + (type == "BOX1" && dims[2] != dims[3] && dims[4] != dims[5] ? " that is askew" : " with such walls"));
  const auto end_of = [](const DeckSection& section) { return std::array{-section.shear_centre[1], section.shear_centre[0]}; };
  s.neutral = {end_of(s.section), end_of(s.section)};
  s.section.line_mass = d.number(8 + dims.size());
  std::vector<double> at_a = dims;
  at_a.push_back(s.section.line_mass);
  std::vector<double> at_b = at_a;
  std::vector<std::pair<double, std::vector<double>>> stations;  // X/XB, and the numbers there
  for (size_t station = 11 + dims.size(); e.name == "PBEAML" && station < d.fields.size(); station += dims.size() + 3) {  // behind SO, X/XB
    auto& there = stations.emplace_back(d.number(station - 1), at_a).second;
    for (size_t i = 0; i < at_a.size(); ++i) there[i] = d.number(station + i, at_a[i]);
    if (stations.back().first == 1) at_b = there;
  }
  check_even(stations, at_a, at_b, "PBEAML", d.place(), in);
  if (at_b != at_a) {
    s.end = shape->second.of({at_b.begin(), at_b.end() - 1});
    if (!s.end.given()) throw refuse("TYPE " + type + " with such walls at end B");
    s.end.line_mass = at_b.back();
    if (s.end.kind != s.section.kind) s.section = general_of(s.section, d.place()), s.end = general_of(s.end, d.place());
    s.neutral[1] = end_of(s.end);
  }
  if (e.name == "PBARL") s.neutral = {};  // CBAR takes both centres as one
  set_shear_centre(s);
  if (s.section.line_mass != 0 && s.section.shear_centre != std::array{0., 0.})
    in.skip("PBEAML: NSM off the neutral axis", d.place(8 + dims.size()));
  add_property(e, deck, s);
  if (!d.empty(1)) deck.material_of.try_emplace(d.integer(0), d.integer(1));
}

}  // namespace

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
  for (size_t k = 0; k < 2; ++k) {
    const auto at = deck.row.find(b.nodes[k]);
    if (at == deck.row.end()) throw Error(b.place, fmt::format("element {} names node {}, which does not exist", b.id, b.nodes[k]));
    rows[k] = at->second;
  }
  const auto X = [&](size_t k) { return deck.X[static_cast<size_t>(rows[k])]; };
  const auto turned = [&](size_t letter, size_t k, const Vec3& v) -> Vec3 {
    if (v.norm() == 0 || b.axes[letter] == 'B') return v;
    const BdfGrid& g = deck.grids[static_cast<size_t>(rows[k])];
    return axes_at(deck, g.output.value_or(0), X(k), g.place) * v;
  };
  BdfBeamPlace out{X(0), X(1), turned(0, 0, b.v)};
  if (b.towards != 0) {
    const auto grid = deck.row.find(b.towards);
    if (grid == deck.row.end()) throw Error(b.place, fmt::format("beam {} names node {}, which does not exist", b.id, b.towards));
    out.up = deck.X[static_cast<size_t>(grid->second)] - X(0);
  }
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

std::span<const BdfCard> bdf_thin_cards() {
  static constexpr BdfCard cards[] = {
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
      {"PBAR", read_pbar},
      {"PBEAM", read_pbeam},
      {"PBARL", read_shape_of_section},
      {"PBEAML", read_shape_of_section},
  };
  return cards;
}

}  // namespace hilo
