// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that say the sections of beams: by numbers, or by a shape and its sizes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

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
void read_pbar(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfThin s;
  s.section = general_section(d.number(2), d.number(3), d.number(4), d.number(5));
  s.section.line_mass = d.number(6), s.section.I12 = -d.number(18);
  for (size_t i = 8; i < 16; ++i) d.number(i);  // where stresses are asked for
  set_shear(s.section, d.number(16), d.number(17), true);
  add_property(d, deck, s);
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
void read_pbeam(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  std::array<double, 6> at_a, at_b;
  for (size_t i = 0; i < 6; ++i) at_a[i] = at_b[i] = d.number(2 + i);
  const auto word = [&](size_t i) { return upper(d.text(i)); };
  const auto is_station = [&](size_t i) { return word(i) == "YES" || word(i) == "YESA" || word(i) == "NO"; };
  size_t line = is_station(8) ? 8 : 16;
  std::vector<std::pair<double, std::array<double, 6>>> stations;  // X/XB, and the section there
  for (; is_station(line); line += word(line) == "YES" ? 16 : 8) {
    auto& [x, there] = stations.emplace_back(d.number(line + 1), at_a);
    for (size_t i = 0; i < 6; ++i) there[i] = d.number(line + 2 + i, x == 1 ? at_a[i] : std::nan(""));  // blank between: even
    if (x == 1) at_b = there;
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
  add_property(d, deck, s);
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

using Dims = std::vector<double>;

/// Shapes that [section.NAME] has too, and others of rectangles: DIM1 is across plane 1 where the shape has a width.
struct BeamShape {
  std::string_view type;
  size_t dims;
  DeckSection (*of)(const Dims&);
};
const BeamShape beam_shapes[] = {
    {"ROD", 1, [](const Dims& v) { return circle_section(2 * v[0]); }},
    {"TUBE", 2, [](const Dims& v) { return tube_section(2 * v[0], v[0] - v[1]); }},
    {"TUBE2", 2, [](const Dims& v) { return tube_section(2 * v[0], v[1]); }},
    {"BAR", 2, [](const Dims& v) { return rectangle_section(v[0], v[1]); }},
    {"BOX", 4,
     [](const Dims& v) {
       if (v[2] == v[3]) return box_section(v[0], v[1], v[2]);
       const double w = v[0] - 2 * v[3], h = v[1] - 2 * v[2], thin = std::min(v[2], v[3]);
       if (!(thin > 0 && w > 0 && h > 0)) return DeckSection{};
       const double wm = v[0] - v[3], hm = v[1] - v[2];
       return general_section(v[0] * v[1] - w * h, (v[0] * std::pow(v[1], 3) - w * h * h * h) / 12,
                              (v[1] * std::pow(v[0], 3) - h * w * w * w) / 12, 2 * wm * wm * hm * hm / (wm / v[2] + hm / v[3]));
     }},
    {"BOX1", 6,
     [](const Dims& v) {                                        // width, height, walls above, below, left, right
       if (v[2] != v[3] && v[4] != v[5]) return DeckSection{};  // askew, and which is left not the same in all sources
       const double w = v[0], h = v[1];
       return rectangles({{0, v[4], 0, h}, {w - v[5], w, 0, h}, {v[4], w - v[5], 0, v[3]}, {v[4], w - v[5], h - v[2], h}});
     }},
    {"I", 6,
     [](const Dims& v) {
       if (v[1] == v[2] && v[4] == v[5]) return I_section(v[1], v[0], v[4], v[3]);
       return rectangles(  // the flange below is the first
           {{-v[1] / 2, v[1] / 2, 0, v[4]}, {-v[3] / 2, v[3] / 2, v[4], v[0] - v[5]}, {-v[2] / 2, v[2] / 2, v[0] - v[5], v[0]}});
     }},
    // flanges beyond the web, web, height of the web, whole height
    {"I1", 4, [](const Dims& v) { return I_section(v[0] + v[1], v[3], (v[3] - v[2]) / 2, v[1]); }},
    {"H", 4,
     [](const Dims& v) {  // width between the flanges, width of both, their height, thickness of the web between
       const double w = v[0] / 2, out = (v[0] + v[1]) / 2;
       return rectangles({{-out, -w, -v[2] / 2, v[2] / 2}, {-w, w, -v[3] / 2, v[3] / 2}, {w, out, -v[2] / 2, v[2] / 2}});
     }},
    {"CROSS", 4,
     [](const Dims& v) {  // width of both arms, width of the upright, its height, thickness of the arms
       const double w = v[1] / 2, out = (v[0] + v[1]) / 2;
       return rectangles({{-w, w, -v[2] / 2, v[2] / 2}, {-out, -w, -v[3] / 2, v[3] / 2}, {w, out, -v[3] / 2, v[3] / 2}});
     }},
    {"T", 4, [](const Dims& v) { return with_shear_centre("T", v); }},
    {"T1", 4,
     [](const Dims& v) {  // height of the flange, length of the web across, thickness of the flange, of the web
       return rectangles({{0, v[2], -v[0] / 2, v[0] / 2}, {v[2], v[2] + v[1], -v[3] / 2, v[3] / 2}});
     }},
    {"T2", 4,
     [](const Dims& v) {  // width of the flange below, whole height, thickness of the flange, of the web
       return rectangles({{-v[0] / 2, v[0] / 2, 0, v[2]}, {-v[3] / 2, v[3] / 2, v[2], v[1]}});
     }},
    {"CHAN", 4,
     [](const Dims& v) {
       return with_shear_centre("C", {v[0], v[1], v[3], v[2]});
     }},
    {"CHAN1", 4,
     [](const Dims& v) {  // flanges beyond the web, web, height of the web between them, whole height
       return rectangles(
           {{0, v[1], -v[3] / 2, v[3] / 2}, {v[1], v[1] + v[0], -v[3] / 2, -v[2] / 2}, {v[1], v[1] + v[0], v[2] / 2, v[3] / 2}});
     }},
    {"CHAN2", 4,
     [](const Dims& v) {  // thickness of the legs, of the web across, whole height, whole width
       const double w = v[3] / 2, in = w - v[0];
       return rectangles({{-w, -in, 0, v[2]}, {in, w, 0, v[2]}, {-in, in, v[2] - v[1], v[2]}});
     }},
    {"L", 4,
     [](const Dims& v) {  // width, towards +z, height, towards +y, thickness of the leg along z, of that along y
       return rectangles({{-v[3], 0, 0, v[1]}, {-v[0], -v[3], 0, v[2]}});
     }},
    {"Z", 4,
     [](const Dims& v) {  // flanges beyond the web, web, height of the web between them, whole height; above towards -z
       const double t = (v[3] - v[2]) / 2;
       return rectangles({{-v[1], 0, 0, v[3]}, {0, v[0], v[3] - t, v[3]}, {-v[1] - v[0], -v[1], 0, t}});
     }},
    {"HAT", 4,
     [](const Dims& v) {  // height, thickness, width of the top, brims beyond it
       const double w = v[2] / 2, t = v[1], h = v[0];
       if (!(w > t)) return DeckSection{};
       return rectangles(
           {{-w, w, h - t, h}, {-w, -w + t, t, h - t}, {w - t, w, t, h - t}, {-w - v[3], -w + t, 0, t}, {w - t, w + v[3], 0, t}});
     }},
    {"HAT1", 5,
     [](const Dims& v) {  // width of the plate below, whole height, width of the top, thickness of the hat, of the plate
       const double w = v[2] / 2, out = v[0] / 2, t = v[3], h = v[1], p = v[4];
       if (!(w > t)) return DeckSection{};
       return rectangles({{-out, out, 0, p},
                          {-out, -w + t, p, p + t},
                          {w - t, out, p, p + t},
                          {-w, -w + t, p + t, h - t},
                          {w - t, w, p + t, h - t},
                          {-w, w, h - t, h}});
     }},
};

/// The same by its numbers.
DeckSection general_of(const DeckSection& s, const std::string& place) {
  const SectionArea a = s.area(0.3, place);
  DeckSection out = general_section(a.A, a.I1, a.I2, a.J);
  out.I12 = s.I12, out.line_mass = s.line_mass, out.shear = {a.shear_1, a.shear_2}, out.shear_centre = s.shear_centre;
  return out;
}

/// PID MID GROUP TYPE; DIM1 DIM2 ... NSM
void read_shape_of_section(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  const std::string type = upper(d.text(3));
  d.text(2);  // the library that has the type
  const auto shape = std::ranges::find(beam_shapes, type, &BeamShape::type);
  const auto refuse = [&](const std::string& what) {
    return Error(d.place(3), fmt::format("{} {}: {} is not read", d.name, d.integer(0), what),
                 "ROD, TUBE, TUBE2, BAR, BOX, BOX1, I, I1, H, CROSS, T, T1, T2, CHAN, CHAN1, CHAN2, L, Z, HAT and HAT1 are; write the "
                 "others as PBAR");
  };
  if (shape == std::end(beam_shapes)) throw refuse("TYPE " + type);
  std::vector<double> dims;
  for (size_t i = 0; i < shape->dims; ++i) {
    if (d.empty(8 + i)) throw refuse(fmt::format("TYPE {} without DIM{}", type, i + 1));
    dims.push_back(d.number(8 + i));
  }
  BdfThin s;
  s.section = shape->of(dims);
  if (!s.section.given())
    throw refuse("TYPE " + type + (type == "BOX1" && dims[2] != dims[3] && dims[4] != dims[5] ? " that is askew" : " with such walls"));
  const auto end_of = [](const DeckSection& section) { return std::array{-section.shear_centre[1], section.shear_centre[0]}; };
  s.neutral = {end_of(s.section), end_of(s.section)};
  s.section.line_mass = d.number(8 + dims.size());
  std::vector<double> at_a = dims;
  at_a.push_back(s.section.line_mass);
  std::vector<double> at_b = at_a;
  std::vector<std::pair<double, std::vector<double>>> stations;  // X/XB, and the numbers there
  for (size_t station = 11 + dims.size(); d.name == "PBEAML" && station < d.fields.size(); station += dims.size() + 3) {  // behind SO, X/XB
    auto& there = stations.emplace_back(d.number(station - 1), at_a).second;
    for (size_t i = 0; i < at_a.size(); ++i) there[i] = d.number(station + i, at_a[i]);
    if (stations.back().first == 1) at_b = there;
  }
  check_even(stations, at_a, at_b, "PBEAML", d.place(), in);
  if (at_b != at_a) {
    s.end = shape->of({at_b.begin(), at_b.end() - 1});
    if (!s.end.given()) throw refuse("TYPE " + type + " with such walls at end B");
    s.end.line_mass = at_b.back();
    if (s.end.kind != s.section.kind) s.section = general_of(s.section, d.place()), s.end = general_of(s.end, d.place());
    s.neutral[1] = end_of(s.end);
  }
  if (d.name == "PBARL") s.neutral = {};  // CBAR takes both centres as one
  set_shear_centre(s);
  if (s.section.line_mass != 0 && s.section.shear_centre != std::array{0., 0.})
    in.skip("PBEAML: NSM off the neutral axis", d.place(8 + dims.size()));
  add_property(d, deck, s);
}

}  // namespace

std::vector<BdfCard> bdf_section_cards() {
  return {
      {"PBAR", read_pbar},
      {"PBEAM", read_pbeam},
      {"PBARL", read_shape_of_section},
      {"PBEAML", read_shape_of_section},
  };
}

}  // namespace hilo
