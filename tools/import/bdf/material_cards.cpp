// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of a Nastran file: MAT1, plasticity by MATS1 and TABLES1, rubber by MATHP.
#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {

DeckMaterial& material_of(const BdfEntry& e, BdfDeck& deck) {
  const auto id = e.integer(0);
  auto& m = deck.materials[id];
  m.name = fmt::format("mat_{}", id);
  return m;
}

namespace {

void no_law(DeckMaterial& m, Imported& in, const std::string& what, const std::string& place) {
  in.skip(what, place);
  if (m.no_law.empty()) m.no_law = fmt::format("{}, {}", what, place);
}

/// MID E G NU RHO A TREF GE; a density that is 0 or blank is none.
void read_mat1(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  if (const auto old = deck.materials.find(d.integer(0));
      old != deck.materials.end() && !std::isnan(old->second.data.nu + old->second.data.E))
    throw Error(d.place(0), fmt::format("MAT1 {} is given twice", d.integer(0)), "number each material once");
  RegionData m;
  const bool E = !d.empty(1), G = !d.empty(2), nu = !d.empty(3);
  if (E) m.E = d.number(1);
  if (nu) m.nu = d.number(3);
  if (G && !(d.number(2) > 0))
    throw Error(d.place(2), fmt::format("MAT1 {}: shear modulus {:g} is not positive", d.integer(0), d.number(2)));
  if (E && G && !nu) m.nu = m.E / (2 * d.number(2)) - 1;
  if (!E && G && nu) m.E = 2 * d.number(2) * (1 + m.nu);
  if (!d.empty(4) && d.number(4) != 0)
    m.density = d.number(4);
  else
    deck.without_density[d.integer(0)] = d.place();
  if (m.E <= 0) throw Error(d.place(1), fmt::format("MAT1 {}: Young's modulus {:g} is not positive", d.integer(0), m.E));
  if (!nu && (m.nu <= -1 || m.nu >= 0.5)) {  // of bars, whose torsion has a modulus of its own
    in.notes.push_back(
        fmt::format("{}: E/(2 G) - 1 = {:.3g} of MAT1 {} is no Poisson's ratio: it has none", d.place(2), m.nu, d.integer(0)));
    m.nu = RegionData{}.nu;
  }
  if (m.nu <= -1 || m.nu >= 0.5)
    throw Error(d.place(3), fmt::format("MAT1 {}: Poisson's ratio {:g} is not in (-1, 0.5)", d.integer(0), m.nu));
  if (m.density <= 0) throw Error(d.place(4), fmt::format("MAT1 {}: density {:g} is not positive", d.integer(0), m.density));
  if (E && G && nu && std::abs(d.number(2) - m.E / (2 * (1 + m.nu))) > 0.01 * d.number(2)) deck.other_shear[d.integer(0)] = d.place(2);
  if (E && !G && !nu) in.notes.push_back(fmt::format("{}: MAT1 {} has neither G nor NU: no Poisson's ratio", d.place(), d.integer(0)));
  if (d.number(5) != 0) in.skip("MAT1: thermal expansion", d.place(5));
  if (d.number(7) != 0) in.skip("MAT1: structural damping GE", d.place(7));
  d.ignore_rest();  // its reference temperature, and limits of stress
  DeckMaterial& material = material_of(d, deck);
  material.data = m;
  if (E && G) material.G = d.number(2);
}

void read_mats1(const BdfEntry& e, BdfDeck& deck, Imported&) { deck.metals.push_back(e); }

/// Pairs x, y from the second line on, up to ENDT.
void read_tables1(const BdfEntry& d, BdfDeck& deck, Imported&) {
  auto& table = deck.tables[d.integer(0)];
  for (size_t i = 8; i < d.fields.size(); i += 2) {
    const std::string word = upper(d.text(i));
    if (word == "ENDT") break;
    if (word == "SKIP" || upper(d.text(i + 1)) == "SKIP") continue;
    if (d.empty(i) && d.empty(i + 1)) continue;
    table.emplace_back(d.number(i), d.number(i + 1));
  }
}

/// W = A10 (I1 - 3) + A01 (I2 - 3) + D1 (J - 1)^2 of the isochoric invariants; higher orders have no law here.
void read_mathp(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  DeckMaterial& m = material_of(d, deck);
  const double c10 = d.number(1), c01 = d.number(2), D1 = d.number(3, 1000 * (c10 + c01));
  if (!(c10 + c01 > 0)) throw Error(d.place(1), fmt::format("MATHP {}: A10 + A01 is not positive", d.integer(0)));
  if (!(D1 > 0)) throw Error(d.place(3), fmt::format("MATHP {}: D1 is not positive", d.integer(0)));
  if (!d.empty(4)) m.data.density = d.number(4);
  m.become("mooney-rivlin");
  m.set({"c10", {c10}, "Pa"});
  m.set({"c01", {c01}, "Pa"});
  m.set({"bulk", {2 * D1}, "Pa"});
  for (size_t i = 8; i < d.fields.size(); ++i)  // orders NA and ND of 1 say what is read
    if (!d.empty(i) && d.number(i) != 0 && !((i == 9 || i == 10) && d.number(i) == 1))
      return no_law(m, in, "MATHP of higher order, or by tests", d.place(i));
}

/// MID E1 E2 NU12 G12 G1Z G2Z RHO, of plane stress: across the shell E3 is E2, and its ratios are 0, which leaves the plane as it is.
void read_mat8(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  DeckMaterial& m = material_of(d, deck);
  const double E1 = d.number(1), E2 = d.number(2), nu12 = d.number(3), G12 = d.number(4);
  for (const size_t i : {1, 2, 4})
    if (!(d.number(i) > 0)) throw Error(d.place(i), fmt::format("MAT8 {}: the modulus {:g} is not positive", d.integer(0), d.number(i)));
  m.become("orthotropic");
  m.set({"E1", {E1}, "Pa"}), m.set({"E2", {E2}, "Pa"}), m.set({"E3", {E2}, "Pa"});
  m.set({"nu12", {nu12}}), m.set({"nu13", {0}}), m.set({"nu23", {0}});
  m.set({"G12", {G12}, "Pa"}), m.set({"G13", {d.number(5, G12)}, "Pa"}), m.set({"G23", {d.number(6, d.number(5, G12))}, "Pa"});
  if (d.empty(5) || d.empty(6))
    in.notes.push_back(fmt::format("{}: MAT8 {}: a blank G1Z is G12, a blank G2Z is G1Z", d.place(), d.integer(0)));
  if (!d.empty(7) && d.number(7) != 0)
    m.data.density = d.number(7);
  else
    deck.without_density[d.integer(0)] = d.place();
  if (d.number(8) != 0 || d.number(9) != 0) in.skip("MAT8: thermal expansion", d.place(8));
  if (d.number(16) != 0) in.skip("MAT8: structural damping GE", d.place(16));
  d.ignore_rest();  // its reference temperature, and limits of stress
}

/// Kinds without a law here.
void read_other(const BdfEntry& e, BdfDeck& deck, Imported& in) { no_law(material_of(e, deck), in, e.name, e.place()); }

/// MATS1 and the table it names.
void read_metal(const DataLine& d, DeckMaterial& m, const BdfDeck& deck, Imported& in) {
  const auto id = d.integer(0);
  const std::string type = d.empty(2) ? "PLASTIC" : upper(d.text(2));
  const auto choice = [&](size_t field) {
    const auto n = d.integer(field, 1);
    return n == 0 ? 1 : n;
  };
  if (type != "PLASTIC" && type != "PLSTRN") return no_law(m, in, "MATS1, TYPE " + type, d.place(2));
  if ((!d.empty(5) && !d.is_integer(5)) || choice(5) > 3) return no_law(m, in, fmt::format("MATS1, HR {}", d.text(5)), d.place(5));
  if (choice(4) != 1) return no_law(m, in, fmt::format("MATS1, YF {}", d.text(4)), d.place(4));
  const double kinematic = choice(5) == 1 ? 0 : choice(5) == 2 ? 1 : 0.3;
  if (choice(5) == 3)
    in.notes.push_back(fmt::format("{}: MATS1 {}: HR 3 is taken as 30 % kinematic, 70 % isotropic hardening", d.place(5), id));
  std::vector<double> strain, stress;
  if (d.empty(1) || d.integer(1) == 0) {
    const double H = d.number(3), yield = d.number(6);
    if (!(yield > 0)) throw Error(d.place(6), fmt::format("MATS1 {}: LIMIT1, the yield stress, is not positive", id));
    if (H < 0) return no_law(m, in, "MATS1 that softens", d.place(3));
    m.become("j2");
    m.set({"yield", {yield}, "Pa"});
    if (H > 0 && kinematic < 1) m.set({"hardening", {(1 - kinematic) * H}, "Pa"});
    if (H > 0 && kinematic > 0) m.set({"kinematic", {kinematic * H}, "Pa"});
    return;
  }
  const auto table = deck.tables.find(d.integer(1));
  if (table == deck.tables.end()) return no_law(m, in, fmt::format("MATS1 by a table that is no TABLES1 ({})", d.integer(1)), d.place(1));
  if (!d.empty(3)) throw Error(d.place(3), fmt::format("MATS1 {} has H and a table: leave one of them out", id));
  // PLASTIC: stress by total strain from the origin, its second point at yield; PLSTRN: by plastic strain, its first point at yield
  const size_t first = type == "PLASTIC" ? 1 : 0;
  const auto& points = table->second;
  if (points.size() <= first || (first == 1 && (points[0].first != 0 || points[0].second != 0)))
    throw Error(d.place(1), fmt::format("MATS1 {}: table {} begins at the origin and goes on at the yield point", id, d.integer(1)));
  for (size_t i = first; i < points.size(); ++i) {
    const double p = first == 1 ? points[i].first - points[i].second / m.data.E : points[i].first;
    strain.push_back(i == first ? 0 : p), stress.push_back(points[i].second);
    if (i == first && std::abs(p) > 0.01 * std::max(points[i].first, 1e-3))
      throw Error(d.place(1),
                  fmt::format("MATS1 {}: the yield point of table {} is not at its stress divided by Young's modulus", id, d.integer(1)));
    if (i > first && !(strain.back() > strain[strain.size() - 2]))
      throw Error(d.place(1), fmt::format("MATS1 {}: plastic strain does not rise in table {}", id, d.integer(1)));
  }
  if (!d.empty(6) && std::abs(d.number(6) - stress.front()) > 0.01 * stress.front())
    throw Error(d.place(6),
                fmt::format("MATS1 {}: LIMIT1 is {:g}, and table {} yields at {:g}", id, d.number(6), d.integer(1), stress.front()));
  if (const auto why = set_hardening(m, strain, stress, kinematic); !why.empty()) no_law(m, in, "MATS1 " + why, d.place());
}

}  // namespace

void resolve_metals(BdfDeck& deck, Imported& in) {
  for (const DataLine& d : deck.metals) {
    const auto at = deck.materials.find(d.integer(0));
    if (at == deck.materials.end()) throw Error(d.place(0), fmt::format("MATS1 {}: no MAT1 of this number", d.integer(0)));
    read_metal(d, at->second, deck, in);
  }
}

std::vector<BdfCard> bdf_material_cards() {
  return {{"MAT1", read_mat1}, {"MATS1", read_mats1}, {"TABLES1", read_tables1}, {"MATHP", read_mathp},  {"MAT3", read_other},
          {"MAT8", read_mat8}, {"MAT9", read_other},  {"MAT11", read_other},     {"MATORT", read_other}, {"MATHE", read_other}};
}

}  // namespace hilo
