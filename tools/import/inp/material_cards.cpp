// The cards of an .inp deck that say materials and which cells are of them.
#include <fmt/format.h>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {
namespace {

void read_material(InpReading& r) {
  const std::string name = r.card.need("NAME");
  r.deck.material = upper(name);
  r.deck.materials[r.deck.material].name = name;
}

/// The material that a card speaks of, and the card's first data line.
InpMaterial& material_of(InpReading& r, DataLine& l, const char* expected) {
  if (!r.lines.next_data(l)) throw Error(r.card.place() + ":1", fmt::format("{} lacks its data line", r.card.name), expected);
  if (r.deck.material.empty()) throw Error(r.card.place() + ":1", fmt::format("{} stands before any *MATERIAL", r.card.name));
  return r.deck.materials[r.deck.material];
}

/// Lines behind the first are for further temperatures.
void skip_temperatures(InpReading& r, DataLine& l) {
  while (r.lines.next_data(l)) r.in.skip(fmt::format("{} at further temperatures", r.card.name), l.place());
}

void read_elastic(InpReading& r) {
  const std::string type = r.card.has("TYPE") ? r.card.word("TYPE") : "ISO";
  if (type.substr(0, 3) != "ISO") return r.skip("*ELASTIC, TYPE=" + type);
  DataLine l;
  auto& m = material_of(r, l, "Young's modulus, Poisson's ratio");
  m.data.E = l.number(0);
  m.data.nu = l.number(1);
  if (!(m.data.E > 0)) throw Error(l.place(0), fmt::format("material {}: Young's modulus {:g} is not positive", m.name, m.data.E));
  if (!(m.data.nu > -1 && m.data.nu < 0.5))
    throw Error(l.place(1), fmt::format("material {}: Poisson's ratio {:g} is not in (-1, 0.5)", m.name, m.data.nu));
  skip_temperatures(r, l);
}

void read_density(InpReading& r) {
  DataLine l;
  auto& m = material_of(r, l, "mass per volume");
  m.data.density = l.number(0);
  if (!(m.data.density > 0)) throw Error(l.place(0), fmt::format("material {}: density {:g} is not positive", m.name, m.data.density));
  skip_temperatures(r, l);
}

void read_section(InpReading& r) {
  const Card& card = r.card;
  InpSection s{upper(card.need("ELSET")), upper(card.need("MATERIAL")), card.need("ELSET"),
               card.need("MATERIAL"),     card.place("ELSET"),          card.place("MATERIAL")};
  if (card.has("ORIENTATION")) r.skip("*SOLID SECTION, ORIENTATION");
  DataLine l;
  if (r.lines.next_data(l)) s.area = l.number(0);
  r.deck.sections.push_back(s);
}

}  // namespace

std::span<const InpCard> inp_material_cards() {
  static constexpr InpCard cards[] = {
      {"MATERIAL", read_material}, {"ELASTIC", read_elastic}, {"DENSITY", read_density}, {"SOLIDSECTION", read_section}};
  return cards;
}

}  // namespace hilo
