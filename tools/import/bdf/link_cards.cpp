// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that tie grids to each other: rigid elements, means, masses, springs and dampers.
#include <fmt/format.h>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

/// A coefficient of thermal expansion behind a list of grids.
void expansion(const DataLine& d, size_t field, const std::string& name, Imported& in) {
  if (field < d.fields.size() && d.number(field) != 0) in.skip(name + ": thermal expansion", d.place(field));
}

void read_rbe2(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfRigid r{d.name, d.place(), d.integer(0), d.integer(1), components(d, 2), {}};
  expansion(d, grid_list(d, 3, r.grids), d.name, in);
  if (r.grids.empty()) throw Error(d.place(), fmt::format("RBE2 {} names no dependent grids", r.id));
  deck.rigid.push_back(std::move(r));
}
/// EID GA GB CNA CNB CMA CMB: one end carries the other whole, or it is told.
void read_rbar(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  const auto a = d.integer(1), b = d.integer(2);
  const auto field = [&](size_t i) { return d.empty(i) ? 0u : components(d, i); };
  const unsigned na = field(3), nb = field(4), ma = field(5), mb = field(6);
  expansion(d, 7, d.name, in);
  if (na == 63 && nb == 0)
    deck.rigid.push_back({d.name, d.place(), d.integer(0), a, mb ? mb : 63, {b}});
  else if (nb == 63 && na == 0)
    deck.rigid.push_back({d.name, d.place(), d.integer(0), b, ma ? ma : 63, {a}});
  else
    in.skip("RBAR whose independent components are of both ends", d.place());
}
/// EID GA GB CB ALPHA: a carries b.
void read_rbar1(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  expansion(d, 4, d.name, in);
  deck.rigid.push_back({d.name, d.place(), d.integer(0), d.integer(1), d.empty(3) ? 63 : components(d, 3), {d.integer(2)}});
}
/// RROD: EID GA GB CMA CMB: keeps its length.
void read_rrod(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  expansion(d, 5, d.name, in);
  deck.rigid.push_back({d.name, d.place(), d.integer(0), d.integer(1), 0, {d.integer(2)}});
}

/// EID - REFGRID REFC WT1 C1 G.. WT2 C2 G.. "UM" .. "ALPHA" ..
void read_rbe3(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfMean m{d.integer(0), d.integer(2), components(d, 3), {}, "", d.place()};
  size_t i = 4;
  while (i < d.fields.size()) {
    if (d.empty(i)) {
      ++i;
      continue;
    }
    const std::string word = upper(d.text(i));
    if (word == "ALPHA") {
      expansion(d, i + 1, d.name, in);
      break;
    }
    if (word == "UM") {
      m.not_read = "RBE3 with UM";
      break;
    }
    const double weight = d.number(i);
    if (!(weight >= 0)) throw Error(d.place(i), fmt::format("RBE3 {}: a weight of {:g}", m.id, weight));
    const unsigned c = components(d, i + 1);
    if (c != 7 && c != 63) m.not_read = fmt::format("RBE3 of components {}", d.text(i + 1));
    std::vector<std::int64_t> grids;
    i = grid_list(d, i + 2, grids);
    for (const auto g : grids) m.of.push_back({g, weight, c == 63});
  }
  if (m.of.empty()) throw Error(d.place(), fmt::format("RBE3 {} names no grids", m.id));
  deck.means.push_back(std::move(m));
}

/// EID G CID M X1 X2 X3 - I11 I21 I22 I31 I32 I33; the off-diagonal ones are integrals of products, so the tensor has them with a minus.
void read_conm2(const BdfEntry& d, BdfDeck& deck, Imported&) {
  BdfMass m{d.integer(0), d.integer(1), d.integer(2, 0), d.number(3), {}, Mat3::Zero(), d.place()};
  m.offset = d.vector(4);
  const double I[6] = {d.number(8), d.number(9), d.number(10), d.number(11), d.number(12), d.number(13)};
  m.inertia << I[0], -I[1], -I[3], -I[1], I[2], -I[4], -I[3], -I[4], I[5];
  for (const size_t i : {8, 10, 13})
    if (d.number(i) < 0) throw Error(d.place(i), fmt::format("CONM2 {}: a moment of inertia of {:g}", m.id, d.number(i)));
  if (m.mass < 0) throw Error(d.place(3), fmt::format("CONM2 {}: a mass of {:g}", m.id, m.mass));
  deck.masses.push_back(m);
}

/// By a property: EID PID G1 C1 G2 C2, and by a value: EID M G1 C1 G2 C2; the mass between two grids is none of a body.
void read_scalar_mass(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfScalarMass m{d.name, d.place(), d.integer(0)};
  if (d.name == "CMASS1")
    m.property = d.integer(1, m.id);
  else
    m.mass = d.number(1);
  const size_t end = d.empty(2) ? 4 : 2;
  if (!d.empty(2) && !d.empty(4)) return in.skip(d.name + " between two grids", d.place(4));
  m.grid = d.integer(end);
  const auto component = d.integer(end + 1, 0);
  if (component < 1 || component > 6)
    throw Error(d.place(end + 1), fmt::format("{} {}: component {} is not 1 to 6", d.name, m.id, component));
  m.component = static_cast<int>(component);
  deck.scalar_masses.push_back(m);
}
/// PID1 M1 PID2 M2 ...
void read_pmass(const BdfEntry& e, BdfDeck& deck, Imported&) {
  for (size_t i = 0; i < 8; i += 2)
    if (!e.empty(i) && !deck.mass_of.try_emplace(e.integer(i), e.number(i + 1)).second)
      throw Error(e.place(i), fmt::format("PMASS {} is given twice", e.integer(i)), "number each property once");
}

void ends(const DataLine& d, size_t field, BdfSpring& s) {
  for (size_t i = 0; i < 2; ++i) {
    s.grids[i] = d.integer(field + 2 * i, 0);
    const auto c = d.integer(field + 2 * i + 1, 0);
    if (c < 0 || c > 6) throw Error(d.place(field + 2 * i + 1), fmt::format("{} {}: component {} is not 1 to 6", s.name, s.id, c));
    s.component[i] = static_cast<int>(c);
    if (c == 0) s.grids[i] = 0;
  }
}
/// By a property: EID PID G1 C1 G2 C2, and by a value: EID K G1 C1 G2 C2.
void read_scalar(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfSpring s{d.name, d.place(), d.integer(0)};
  if (d.name.back() == '1')
    s.property = d.integer(1, s.id);
  else
    (d.name == "CELAS2" ? s.k : s.c)[0] = d.number(1);
  ends(d, 2, s);
  if (d.name == "CELAS2" && d.number(6) != 0) in.skip("CELAS2: structural damping GE", d.place(6));
  deck.springs.push_back(s);
}
/// EID PID GA GB GO|X1 X2 X3 CID S OCID S1 S2 S3
void read_bush(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  BdfSpring s{d.name, d.place(), d.integer(0), d.integer(1, d.integer(0))};
  for (size_t i = 0; i < 2; ++i) s.grids[i] = d.integer(2 + i, 0);
  if (d.name == "CBUSH1D") {
    s.component = {-1, -1};
    if (!d.empty(4)) s.system = d.integer(4);
  } else {
    if (d.is_integer(4) && d.empty(5) && d.empty(6))
      s.towards = d.integer(4);
    else
      s.plane = d.vector(4);
    if (!d.empty(7)) s.system = d.integer(7);
    if (!d.empty(8)) s.share = d.number(8);
    if (!d.empty(9) && d.integer(9) != -1) return in.skip("CBUSH with a place of its own (OCID)", d.place(9));
  }
  deck.springs.push_back(s);
}

/// The property of the number in a field, each card with numbers of its own.
BdfSpringData& new_property(const BdfEntry& e, size_t field, BdfDeck& deck) {
  const auto id = e.integer(field);
  const auto [at, fresh] = deck.spring_data.try_emplace({e.name, id});
  if (!fresh) throw Error(e.place(field), fmt::format("{} {} is given twice", e.name, id), "number each property once");
  return at->second;
}
void read_pelas(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  const bool spring = d.name == "PELAS";
  for (size_t i = 0; i < 8; i += spring ? 4 : 2) {
    if (d.empty(i)) continue;
    BdfSpringData& p = new_property(d, i, deck);
    (spring ? p.k : p.c)[0] = d.number(i + 1);
    if (spring && d.number(i + 2) != 0) in.skip("PELAS: structural damping GE", d.place(i + 2));
  }
}
/// PID, and on each line a word and six values: K stiffness, B damping.
void read_pbush(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  auto& p = new_property(d, 0, deck);
  for (size_t i = 1; i < d.fields.size(); i += 8) {
    const std::string word = upper(d.text(i));
    if (word == "K" || word == "B")
      for (size_t k = 0; k < 6; ++k) (word == "K" ? p.k : p.c)[k] = d.number(i + 1 + k);
    else if (!word.empty() && word != "RCV")
      in.skip("PBUSH, " + word.substr(0, 8), d.place(i));
  }
}
/// PID K C M
void read_pbush1d(const BdfEntry& d, BdfDeck& deck, Imported& in) {
  auto& p = new_property(d, 0, deck);
  p.k[0] = d.number(1), p.c[0] = d.number(2);
  if (d.number(3) != 0) in.skip("PBUSH1D: its mass", d.place(3));
  for (size_t i = 4; i < d.fields.size(); ++i)
    if (!d.empty(i)) return in.skip("PBUSH1D that is not linear", d.place(i));
}

/// ID - - - EID G1 G2 G3 EID G1 G2 G3 ...
void read_bsurfs(const BdfEntry& d, BdfDeck& deck, Imported&) {
  std::vector<BdfGlueFace>& faces = deck.glue_faces[d.integer(0)];
  for (size_t i = 4; i < d.fields.size(); i += 4) {
    if (d.empty(i)) continue;
    faces.push_back({d.integer(i), {d.integer(i + 1), d.integer(i + 2), d.integer(i + 3)}, d.place(i)});
  }
}
/// GSID SID TID SDIST - EXT - -, and more pairs behind, a line each.
void read_bgset(const BdfEntry& d, BdfDeck& deck, Imported&) {
  for (size_t i = 1; i < d.fields.size(); i += 8)
    if (!d.empty(i)) deck.glue.lines[d.integer(0)].push_back({d.integer(i), d.integer(i + 1), d.number(i + 2), d.place(i)});
}
/// CSID SID TID FRIC MIND MAXD - -, and more pairs behind, a line each; distances are of that program's search.
void read_bctset(const BdfEntry& d, BdfDeck& deck, Imported&) {
  for (size_t i = 1; i < d.fields.size(); i += 8) {
    if (d.empty(i)) continue;
    const double friction = d.number(i + 2);
    if (!(friction >= 0 && friction <= 5)) throw Error(d.place(i + 2), fmt::format("BCTSET: a friction of {:g}", friction), "0 to 5");
    deck.contacts.lines[d.integer(0)].push_back({d.integer(i), d.integer(i + 1), 0, d.place(i), friction});
  }
}

}  // namespace

std::vector<BdfCard> bdf_link_cards() {
  return {
      {"RBE2", read_rbe2},          {"RBAR", read_rbar},     {"RBAR1", read_rbar1},   {"RROD", read_rrod},     {"RBE3", read_rbe3},
      {"CONM2", read_conm2},        {"CELAS1", read_scalar}, {"CELAS2", read_scalar}, {"CDAMP1", read_scalar}, {"CDAMP2", read_scalar},
      {"CBUSH", read_bush},         {"CBUSH1D", read_bush},  {"PELAS", read_pelas},   {"PDAMP", read_pelas},   {"PBUSH", read_pbush},
      {"PBUSH1D", read_pbush1d},    {"BSURFS", read_bsurfs}, {"BGSET", read_bgset},   {"BCTSET", read_bctset}, {"CMASS1", read_scalar_mass},
      {"CMASS2", read_scalar_mass}, {"PMASS", read_pmass},
  };
}

}  // namespace hilo
