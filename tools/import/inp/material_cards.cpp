// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that say materials and which cells are of them.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {

DeckMaterial& material_of(InpReading& r) {
  if (r.deck.material.empty()) throw Error(r.card.place() + ":1", fmt::format("{} stands before any *MATERIAL", r.card.name));
  return r.deck.materials[r.deck.material];
}
DeckMaterial& material_of(InpReading& r, DataLine& l, const char* expected) {
  first_line(r, l, expected);
  return material_of(r);
}

namespace {

void read_material(InpReading& r) {
  const std::string name = r.card.need("NAME");
  r.deck.material = upper(name);
  // of one place: a part that each instance reads, or a file that is included twice
  if (const auto [at, fresh] = r.deck.material_at.emplace(r.deck.material, r.card.place()); !fresh && at->second != r.card.place())
    throw Error(r.card.place("NAME"), fmt::format("*MATERIAL {} is given twice, first at {}", name, at->second), "name each once");
  r.deck.materials[r.deck.material].name = name;
}

/// The material is of a law that hilo has not: its regions get none, and that is said.
void no_law(InpReading& r, DeckMaterial& m, const std::string& what) {
  r.skip(what);
  if (m.no_law.empty()) m.no_law = fmt::format("{}, {}", what, r.card.place());
}
void read_no_law(InpReading& r) { no_law(r, material_of(r), r.card.name); }

/// Lines behind the first are for further temperatures.
void skip_temperatures(InpReading& r, DataLine& l) {
  l.ignore_rest();  // the temperature, where it is the only one
  while (r.lines.next_data(l)) r.in.skip(fmt::format("{} at further temperatures", r.card.name), l.place()), l.ignore_rest();
}

/// `count` numbers, eight on a line.
std::vector<double> numbers(InpReading& r, DataLine& l, size_t count) {
  std::vector<double> v;
  for (size_t i = 0; i < count; ++i) {
    if (i > 0 && i % 8 == 0 && !r.lines.next_data(l))
      throw Error(l.place(), fmt::format("{} has {} numbers on two lines", r.card.name, count));
    v.push_back(l.number(i % 8));
  }
  return v;
}

void set_orthotropic(DeckMaterial& m, const std::vector<double>& v) {
  m.become("orthotropic");
  const char* keys[] = {"E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23"};
  for (size_t i = 0; i < 9; ++i) m.set({keys[i], {v[i]}, i < 3 || i > 5 ? "Pa" : "1"});
}

void read_elastic(InpReading& r) {
  const std::string type = r.card.word("TYPE", "ISO");
  DataLine l;
  if (type.starts_with("ENGINEERING")) {
    auto& m = material_of(r, l, "E1, E2, E3, nu12, nu13, nu23, G12, G13 and on the next line G23");
    set_orthotropic(m, numbers(r, l, 9));
    return skip_temperatures(r, l);
  }
  if (type.starts_with("ORTHO")) {
    auto& m = material_of(r, l, "D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313 and on the next line D2323");
    const std::string place = l.place();
    const auto d = numbers(r, l, 9);
    Mat3 C;
    C << d[0], d[1], d[3], d[1], d[2], d[4], d[3], d[4], d[5];
    if (!(C.determinant() > 0)) throw Error(place, fmt::format("material {}: these moduli yield energy", m.name));
    const Mat3 S = C.inverse();
    set_orthotropic(m,
                    {1 / S(0, 0), 1 / S(1, 1), 1 / S(2, 2), -S(0, 1) / S(0, 0), -S(0, 2) / S(0, 0), -S(1, 2) / S(1, 1), d[6], d[7], d[8]});
    return skip_temperatures(r, l);
  }
  if (!type.starts_with("ISO")) return no_law(r, material_of(r), "*ELASTIC, TYPE=" + type);
  auto& m = material_of(r, l, "Young's modulus, Poisson's ratio");
  m.data.E = l.number(0);
  m.data.nu = l.number(1);
  if (!(m.data.E > 0)) throw Error(l.place(0), fmt::format("material {}: Young's modulus {:g} is not positive", m.name, m.data.E));
  if (!(m.data.nu > -1 && m.data.nu < 0.5))
    throw Error(l.place(1), fmt::format("material {}: Poisson's ratio {:g} is not in (-1, 0.5)", m.name, m.data.nu));
  skip_temperatures(r, l);
}

/// Yield stress by equivalent plastic strain, of the first temperature.
void read_plastic(InpReading& r) {
  const std::string hardening = r.card.word("HARDENING", "ISOTROPIC");
  if (hardening != "ISOTROPIC" && hardening != "KINEMATIC") return no_law(r, material_of(r), "*PLASTIC, HARDENING=" + hardening);
  DataLine l;
  auto& m = material_of(r, l, "yield stress, plastic strain");
  std::vector<double> strain, stress;
  const double temperature = l.number(2);
  do {
    if (l.number(2) != temperature) {
      r.in.skip("*PLASTIC at further temperatures", l.place());
      continue;
    }
    stress.push_back(l.number(0)), strain.push_back(l.number(1));
    if (!(stress.back() > 0)) throw Error(l.place(0), fmt::format("material {}: a yield stress of {:g}", m.name, stress.back()));
    if (strain.size() == 1 && strain[0] != 0)
      throw Error(l.place(1), fmt::format("material {}: the first yield stress is at a plastic strain of {:g}", m.name, strain[0]),
                  "the table begins at plastic strain 0");
    if (strain.size() > 1 && !(strain.back() > strain[strain.size() - 2]))
      throw Error(l.place(1), fmt::format("material {}: plastic strain does not rise", m.name));
  } while (r.lines.next_data(l));
  if (const auto odd = unknown_param(r.card, {"HARDENING", "EXTRAPOLATION"}); !odd.empty()) return no_law(r, m, odd);
  if (r.card.has("EXTRAPOLATION") && r.card.word("EXTRAPOLATION") != "CONSTANT") return no_law(r, m, "*PLASTIC, EXTRAPOLATION");
  if (const auto why = set_hardening(m, strain, stress, hardening == "KINEMATIC" ? 1 : 0); !why.empty()) no_law(r, m, "*PLASTIC " + why);
}

/// rate of plastic strain = D (q/yield - 1)^n
void read_rates(InpReading& r) {
  DataLine l;
  auto& m = material_of(r, l, "D, n");
  const std::string type = r.card.word("TYPE", "POWERLAW");
  if (type != "POWERLAW") return no_law(r, m, "*RATE DEPENDENT, TYPE=" + type);
  const double D = l.number(0), n = l.number(1);
  if (!(D > 0)) throw Error(l.place(0), fmt::format("material {}: *RATE DEPENDENT: D = {:g} is not positive", m.name, D));
  if (!(n >= 1)) return no_law(r, m, "*RATE DEPENDENT with n below 1");
  m.set({"reference_rate", {D}, "1/s"});
  m.set({"rate_exponent", {n}});
  skip_temperatures(r, l);
}

/// W in powers of invariants or stretches, 1/D1 (J - 1)^2: bulk modulus 2/D1.
void read_rubber(InpReading& r) {
  DataLine l;
  auto& m = material_of(r, l, "the factors of the potential, then D1");
  const bool mooney = r.card.has("MOONEY-RIVLIN"), neo = r.card.has("NEOHOOKE"), ogden = r.card.has("OGDEN");
  if (const auto odd = unknown_param(r.card, {"MOONEY-RIVLIN", "NEOHOOKE", "OGDEN", "N"}); !odd.empty() || mooney + neo + ogden != 1)
    return no_law(r, m, odd.empty() ? "*HYPERELASTIC" : odd);
  const size_t terms = ogden && r.card.has("N") ? std::stoul(r.card.word("N")) : 1, n = ogden ? 3 * terms : mooney ? 3 : 2;
  const auto v = numbers(r, l, n);
  double mu = 0;
  if (ogden) {
    DeckKey factor{"mu", {}, "Pa", true}, exponent{"alpha", {}, "1", true};
    for (size_t p = 0; p < terms; ++p) factor.values.push_back(v[2 * p]), exponent.values.push_back(v[2 * p + 1]), mu += v[2 * p];
    m.become("ogden"), m.set(factor), m.set(exponent);
  } else {
    m.become("mooney-rivlin");
    m.set({"c10", {v[0]}, "Pa"});
    if (mooney) m.set({"c01", {v[1]}, "Pa"});
    mu = 2 * (v[0] + (mooney ? v[1] : 0));
  }
  for (size_t p = 1; p < terms; ++p)
    if (v[2 * terms + p] != 0) return no_law(r, m, fmt::format("{} with D{}", r.card.name, p + 1));
  double D1 = v[n - terms];
  if (!(mu > 0)) throw Error(l.place(), fmt::format("material {}: a shear modulus of {:g}", m.name, mu));
  if (D1 < 0) throw Error(l.place(), fmt::format("material {}: D1 = {:g} is negative", m.name, D1));
  if (D1 == 0) {
    D1 = 0.1 / mu;
    r.in.notes.push_back(
        fmt::format("{}: material {} has D1 = 0 (incompressible): taken as 0.1/mu, a Poisson's ratio of 0.475, as CalculiX does",
                    r.card.place(), m.name));
  }
  m.set({"bulk", {2 / D1}, "Pa"});
  skip_temperatures(r, l);
}

void read_density(InpReading& r) {
  DataLine l;
  auto& m = material_of(r, l, "mass per volume");
  m.data.density = l.number(0);
  if (!(m.data.density > 0)) throw Error(l.place(0), fmt::format("material {}: density {:g} is not positive", m.name, m.data.density));
  skip_temperatures(r, l);
}

/// Factors of mass and stiffness.
void read_damping(InpReading& r) {
  auto& m = material_of(r);
  if (const auto odd = unknown_param(r.card, {"ALPHA", "BETA"}); !odd.empty()) return r.skip(odd);
  for (auto& [key, into] : {std::pair{"ALPHA", &m.alpha}, std::pair{"BETA", &m.beta}}) {
    if (!r.card.has(key)) continue;
    const std::string text = r.card.word(key);
    char* end = nullptr;
    *into = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end || !(*into >= 0))
      throw Error(r.card.place(key), fmt::format("*DAMPING, {}={}", key, text), "a number of 0 or more");
  }
}

/// The second line: an axis, and by how many degrees the others are turned about it.
void turn_orientation(InpOrientation& o, const DataLine& l) {
  const double axis = l.number(0, 1);
  if (axis != 1 && axis != 2 && axis != 3) throw Error(l.place(0), fmt::format("*ORIENTATION {}: axis {:g}", o.name, axis), "1, 2 or 3");
  o.about = static_cast<int>(axis);
  if (l.number(1) == 0) return;
  const Mat3 frame = o.frame();
  const Mat3 turn = Eigen::AngleAxisd(l.number(1) * std::numbers::pi / 180, frame.col(o.about - 1)).toRotationMatrix();
  o.a = turn * frame.col(0), o.b = turn * frame.col(1);
}

void read_orientation(InpReading& r) {
  InpOrientation o;
  o.name = r.card.need("NAME"), o.place = r.card.place();
  DataLine l;
  const std::string system = r.card.word("SYSTEM", "RECTANGULAR");
  if (system != "RECTANGULAR") {
    o.not_read = "*ORIENTATION, SYSTEM=" + system;
  } else if (const auto odd = unknown_param(r.card, {"NAME", "SYSTEM"}); !odd.empty()) {
    o.not_read = odd;
  } else {
    first_line(r, l, "a point on axis 1, one in the plane 1-2");
    for (int i = 0; i < 3; ++i) o.a[i] = l.number(i) - l.number(6 + i), o.b[i] = l.number(3 + i) - l.number(6 + i);
    if (!(o.a.cross(o.b).norm() > 0)) throw Error(l.place(), fmt::format("*ORIENTATION {}: the two points span no plane", o.name));
    if (r.lines.next_data(l)) turn_orientation(o, l);
  }
  r.deck.orientations[upper(o.name)] = o;
}

InpSection section_of(InpReading& r, bool layered = false) {
  const Card& card = r.card;
  InpSection s{upper(card.need("ELSET")), upper(card.value("MATERIAL")), card.need("ELSET"),
               card.value("MATERIAL"),    card.place("ELSET"),           card.place("MATERIAL")};
  s.card = card.name;
  if (s.material.empty() && !layered) r.skip(card.name + " without MATERIAL");
  return s;
}

void take_orientation(const Card& card, InpSection& s) {
  if (!card.has("ORIENTATION")) return;
  s.orientation_name = card.need("ORIENTATION"), s.orientation = upper(s.orientation_name), s.orientation_place = card.place("ORIENTATION");
}

void read_section(InpReading& r) {
  InpSection s = section_of(r);
  take_orientation(r.card, s);
  DataLine l;
  if (r.lines.next_data(l)) s.area = l.number(0);
  r.deck.sections.push_back(s);
}

/// Lines of COMPOSITE: thickness, points of integration, material, and an orientation of the layer's own or an angle by which the section's
/// is turned.  Layers of one material are one plate.
void read_layers(InpReading& r, InpSection& s) {
  bool same = true;
  const InpSection whole = s;
  for (DataLine l; r.lines.next_data(l);) {
    const double t = l.number(0);
    if (!(t > 0)) throw Error(l.place(0), fmt::format("{}: a layer of thickness {:g}", r.card.name, t));
    if (l.empty(2)) throw Error(l.place(), r.card.name + ", COMPOSITE: a layer without a material", "thickness, , MATERIAL");
    InpSection layer = whole;
    layer.material = upper(l.text(2)), layer.material_name = l.text(2), layer.material_place = l.place(2);
    if (!l.empty(3)) {
      const std::string word(l.text(3));
      char* end = nullptr;
      layer.turn = std::strtod(word.c_str(), &end);
      if (*end) layer.turn = 0, layer.orientation = upper(word), layer.orientation_name = word, layer.orientation_place = l.place(3);
    }
    if (s.thickness == 0) s = layer;
    same = same && layer.material == s.material;
    s.several_directions = s.several_directions || layer.orientation != s.orientation || layer.turn != s.turn;
    s.thickness += t;
  }
  if (!(s.thickness > 0)) throw Error(r.card.place() + ":1", r.card.name + ", COMPOSITE lacks its layers", "thickness, , MATERIAL");
  if (same) return;
  s.no_solid = r.card.name + ", COMPOSITE of several materials", s.material.clear();
  r.skip(s.no_solid + ": no stiffness, no density");
}

/// Thickness; OFFSET: where the nodes lie, in thicknesses above the mid-surface.
void read_shell_section(InpReading& r) {
  const bool layered = r.card.has("COMPOSITE");
  if (const auto odd = unknown_param(r.card, {"ELSET", "MATERIAL", "OFFSET", "ORIENTATION", "SECTIONINTEGRATION", "DENSITY", "COMPOSITE"});
      !odd.empty() || r.card.has("DENSITY"))
    throw Error(r.card.place() + ":1", (odd.empty() ? r.card.name + ", DENSITY" : odd) + " is not read", "give a material and a thickness");
  InpSection s = section_of(r, layered);
  take_orientation(r.card, s);
  if (layered) {
    read_layers(r, s);
  } else {
    DataLine l;
    first_line(r, l, "the thickness");
    s.thickness = l.number(0);
    if (!(s.thickness > 0)) throw Error(l.place(0), fmt::format("{}: a thickness of {:g}", r.card.name, s.thickness));
  }
  if (r.card.has("OFFSET")) {
    const std::string word = r.card.word("OFFSET");
    char* end = nullptr;
    const double above = word == "SPOS" ? 0.5 : word == "SNEG" ? -0.5 : std::strtod(word.c_str(), &end);
    if (end && (*end || end == word.c_str())) throw Error(r.card.place("OFFSET"), fmt::format("OFFSET={} is no number", word));
    s.offset = -above * s.thickness;
  }
  r.deck.sections.push_back(s);
}

void read_nodal_thickness(InpReading& r) {
  for (DataLine l; r.lines.next_data(l);) {
    const InpThickness t{target_of(l), l.number(1)};
    if (!(t.value > 0)) throw Error(l.place(1), fmt::format("{}: a thickness of {:g}", r.card.name, t.value));
    r.deck.thicknesses.push_back(t);
  }
}

/// The shape of a section by its sizes; extents along directions 1 and 2 to `extent`, how far its centre of area lies off its nodes along
/// direction 2 to `above`.
DeckSection beam_shape(InpReading& r, const DataLine& l, bool& along_n2, std::array<double, 2>& extent, double& above) {
  const Card& card = r.card;
  const std::string type = card.word("SECTION").starts_with("RECT") ? "RECT" : card.word("SECTION");
  const auto v = [&](size_t i) { return l.number(i, i == 1 && type == "RECT" ? l.number(0) : 0); };
  extent = {v(0), v(1)};
  if (type == "RECT") return rectangle_section(v(1), v(0));
  if (type == "CIRC" || type == "PIPE") extent = {2 * v(0), 2 * v(0)};
  if (type == "CIRC" && l.empty(1)) {
    r.skip(
        "*BEAM SECTION, SECTION=CIRC: its one number is the radius, as in Abaqus; in CalculiX it is the diameter, and two are diameters");
    return circle_section(2 * v(0));
  }
  if (type == "CIRC" && v(0) == v(1)) return circle_section(v(0));
  if (type == "CIRC") {  // the ellipse of CalculiX
    const double p = v(0) / 2, q = v(1) / 2, pi = std::numbers::pi;
    extent = {v(0), v(1)};
    DeckSection s = general_section(pi * p * q, pi * p * p * p * q / 4, pi * p * q * q * q / 4, pi * std::pow(p * q, 3) / (p * p + q * q));
    s.shear = {0.89, 0.89};  // of a circle
    return s;
  }
  if (type == "PIPE") return tube_section(2 * v(0), v(1));
  const bool equal = v(2) == v(3) && v(3) == v(4) && v(4) == v(5);
  if (type == "BOX" && equal) return box_section(v(1), v(0), v(2));
  along_n2 = type == "I";
  if (along_n2 && v(2) == v(3) && v(4) == v(5)) {
    above = v(1) / 2 - v(0);
    return I_section(v(2), v(1), v(4), v(6));
  }
  if (along_n2) {  // origin from below, height, widths below and above, their thicknesses, web; a flange of no width makes a T
    const double h = v(1), below = v(2) > 0 ? v(4) : 0, top = v(3) > 0 ? v(5) : 0;
    std::vector<DeckRectangle> parts{{-v(6) / 2, v(6) / 2, below, h - top}};
    if (v(2) > 0) parts.push_back({-v(2) / 2, v(2) / 2, 0, below});
    if (v(3) > 0) parts.push_back({-v(3) / 2, v(3) / 2, h - top, h});
    double A = 0, moment = 0;
    for (const DeckRectangle& p : parts) {
      const double a = (p.to_1 - p.from_1) * (p.to_2 - p.from_2);
      A += a, moment += a * (p.from_2 + p.to_2) / 2;
    }
    DeckSection s = section_of_rectangles(parts, l.place(0));
    s.shear_centre = {};  // these beams have it in their centre of area
    if (!s.given())
      throw Error(l.place(0), fmt::format("{}, SECTION=I: these sizes make no section", card.name), "l, h, b1, b2, t1, t2, t3");
    r.skip("*BEAM SECTION, SECTION=I of two flanges that differ: its shear centre off its centre of area");
    above = moment / A - v(0);
    return s;
  }
  throw Error(card.place("SECTION"),
              fmt::format("{}, SECTION={} is not read{}", card.name, type, type == "BOX" ? " with several thicknesses" : ""),
              "RECT, CIRC, PIPE, BOX and I are; a T is an I with one flange of no width");
}

/// Sizes of the section, then its direction 1.
void read_beam_section(InpReading& r) {
  require_known(r.card, {"ELSET", "MATERIAL", "SECTION", "ORIENTATION", "OFFSET1", "OFFSET2"}, "a section without it");
  InpSection s = section_of(r);
  DataLine l;
  first_line(r, l, "the sizes of the section");
  r.card.need("SECTION");
  std::array<double, 2> extent;
  double above = 0;
  s.beam = beam_shape(r, l, s.along_n2, extent, above);
  s.beam.area(0.3, l.place(0));
  if (r.lines.next_data(l)) s.n1 = l.vector(0);
  for (int k = 0; k < 2; ++k)
    if (const char* key = k == 0 ? "OFFSET1" : "OFFSET2"; r.card.has(key)) {
      const std::string word = r.card.word(key);
      char* end = nullptr;
      s.off[k] = -std::strtod(word.c_str(), &end) * extent[static_cast<size_t>(k)];
      if (*end || end == word.c_str()) throw Error(r.card.place(key), fmt::format("{}={} is no number", key, word));
    }
  s.off[1] += above;
  r.deck.sections.push_back(s);
}

/// A, I11, I12, I22, J; direction 1; E, G.  Direction 1 is axis 2 of hilo, so I11 = int x2^2 is I2.  With a shape and a MATERIAL, as in
/// CalculiX, it is *BEAM SECTION.
void read_general_section(InpReading& r) {
  const std::string type = r.card.word("SECTION", "GENERAL");
  if (type != "GENERAL" && r.card.has("MATERIAL")) return read_beam_section(r);
  if (type != "GENERAL") throw Error(r.card.place("SECTION"), fmt::format("{}, SECTION={} is not read", r.card.name, type), "GENERAL is");
  require_known(r.card, {"ELSET", "SECTION", "DENSITY", "POISSON"}, "a section without it");
  InpSection s{upper(r.card.need("ELSET")), "", r.card.need("ELSET"), "", r.card.place("ELSET"), ""};
  s.card = r.card.name;
  DataLine l;
  if (!r.lines.next_data(l)) throw Error(r.card.place() + ":1", r.card.name + " lacks its data lines", "A, I11, I12, I22, J");
  s.beam = general_section(l.number(0), l.number(3), l.number(1), l.number(4));
  s.beam.I12 = -l.number(2);
  const std::string place = l.place();
  if (r.lines.next_data(l) && !(l.empty(0) && l.empty(1) && l.empty(2))) s.n1 = l.vector(0);
  if (!r.lines.next_data(l)) throw Error(place, r.card.name + " lacks its third line", "E, G");
  DeckMaterial own;
  own.name = s.elset_name + "_section";
  own.data.E = l.number(0), own.G = l.number(1), own.data.nu = own.data.E / (2 * own.G) - 1;
  if (!(own.data.E > 0) || !(own.G > 0)) throw Error(l.place(), fmt::format("{}: E {:g}, G {:g}", r.card.name, own.data.E, own.G));
  if (r.card.has("DENSITY")) own.data.density = std::strtod(r.card.word("DENSITY").c_str(), nullptr);
  s.own = own;
  r.deck.sections.push_back(s);
}

}  // namespace

std::vector<InpCard> inp_material_cards() {
  std::vector<InpCard> cards{
      {"MATERIAL", read_material},
      {"ELASTIC", read_elastic},
      {"DENSITY", read_density},
      {"DAMPING", read_damping},
      {"SOLIDSECTION", read_section},
      {"SHELLSECTION", read_shell_section},
      {"NODALTHICKNESS", read_nodal_thickness},
      {"BEAMSECTION", read_beam_section},
      {"BEAMGENERALSECTION", read_general_section},
      {"PLASTIC", read_plastic},
      {"RATEDEPENDENT", read_rates},
      {"HYPERELASTIC", read_rubber},
      {"ORIENTATION", read_orientation},
  };
  for (const char* name : {"CYCLICHARDENING", "CREEP", "DEFORMATIONPLASTICITY", "DRUCKERPRAGER", "MOHRCOULOMB", "VISCOELASTIC", "HYPERFOAM",
                           "USERMATERIAL", "POTENTIAL"})
    cards.push_back({name, read_no_law});
  return cards;
}

}  // namespace hilo
