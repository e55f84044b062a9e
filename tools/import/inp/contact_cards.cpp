// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that let surfaces meet: *CONTACT PAIR, *SURFACE INTERACTION with *SURFACE BEHAVIOR and *FRICTION, and the
// general contact of Abaqus, *CONTACT.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {
namespace {

/// What says how the other program searches and holds contact is nothing that a scene has.
void read_contact_pair(InpReading& r) {
  if (const auto odd = unknown_param(r.card, {"INTERACTION", "TYPE", "SMALLSLIDING", "ADJUST", "CPSET", "MECHANICALCONSTRAINT", "WEIGHT",
                                              "EXTENSIONZONE", "HCRIT", "TRACKING", "SUPPLEMENTARYCONSTRAINTS", "NOTHICKNESS"});
      !odd.empty())
    return r.skip(odd);
  bool any = false;
  for (DataLine l; r.lines.next_data(l);) {
    InpPair c;
    c.name = r.card.has("CPSET") ? r.card.need("CPSET") : "contact", c.place = l.place();
    c.slave = upper(l.text(0)), c.master = l.empty(1) ? c.slave : upper(l.text(1));
    c.interaction = upper(r.card.value("INTERACTION"));
    if (c.slave.empty()) throw Error(l.place(0), "*CONTACT PAIR: two surfaces are expected", "SLAVE, MASTER");
    if (r.card.has("ADJUST")) r.in.skip("*CONTACT PAIR, ADJUST: gaps and overlaps of the mesh stay as they are", r.card.place());
    if (r.card.has("SMALLSLIDING"))
      r.in.notes.push_back(fmt::format("{}: *CONTACT PAIR, SMALL SLIDING: surfaces may slide as far as they do", r.card.place()));
    r.deck.contacts.push_back(std::move(c));
    any = true;
  }
  if (!any) r.skip("*CONTACT PAIR of nothing");
}

void read_interaction(InpReading& r) {
  const std::string name = r.card.need("NAME");
  if (!r.deck.interactions.try_emplace(upper(name), InpInteraction{name}).second)
    throw Error(r.card.place("NAME"), fmt::format("*SURFACE INTERACTION {} is given twice", name), "name each once");
  r.deck.interaction = upper(name);
  if (const auto odd = unknown_param(r.card, {"NAME", "PADTHICKNESS"}); !odd.empty()) r.skip(odd);
}

/// The interaction that a card speaks of; null where the card stands in a step or belongs to something else.
InpInteraction* interaction_of(InpReading& r) {
  const auto found = r.deck.interactions.find(r.deck.interaction);
  if (r.step == 0 && found != r.deck.interactions.end()) return &found->second;
  r.skip(r.step == 0 ? r.card.name : r.card.name + " in a step");
  return nullptr;
}

void read_behavior(InpReading& r) {
  InpInteraction* of = interaction_of(r);
  if (!of) return;
  if (const auto odd = unknown_param(r.card, {"PRESSURE-OVERCLOSURE", "PENALTY", "DIRECT", "AUGMENTEDLAGRANGE"}); !odd.empty())
    return r.skip(odd);
  const std::string law = r.card.word("PRESSURE-OVERCLOSURE");
  of->law = law == "HARD" ? "" : law;
  for (DataLine l; r.lines.next_data(l);) l.ignore_rest();  // the stiffness, of which contacts() tells
}

void read_friction(InpReading& r) {
  InpInteraction* of = interaction_of(r);
  if (!of) return;
  if (const auto odd = unknown_param(r.card, {"ROUGH", "SLIPTOLERANCE"}); !odd.empty()) return r.skip(odd);
  constexpr double most = 5;  // that [[contact]] takes
  DataLine l;
  double mu = r.card.has("ROUGH") ? std::numeric_limits<double>::infinity() : 0;
  if (r.lines.next_data(l) && !r.card.has("ROUGH")) mu = l.number(0, 0), l.ignore_rest();
  if (!(mu >= 0)) throw Error(l.place(0), fmt::format("*FRICTION: a coefficient of {:g}", mu), "one of zero or above");
  if (mu > most)
    r.in.notes.push_back(fmt::format("{}: a friction of {:g} becomes {:g}, the largest that a [[contact]] has", r.card.place(), mu, most));
  of->friction = std::min(mu, most);
}

/// Everything with everything, which an empty line says too.
void read_inclusions(InpReading& r) {
  if (const auto odd = unknown_param(r.card, {"ALLEXTERIOR"}); !odd.empty()) return r.skip(odd);
  bool any = r.card.has("ALLEXTERIOR");
  if (any) r.deck.every_pair = r.card.place();
  for (DataLine l; r.lines.next_data(l);) {
    any = true;
    if (l.empty(0) && l.empty(1)) {
      r.deck.every_pair = r.card.place();
      continue;
    }
    InpPair c;
    c.name = "contact", c.place = l.place(), c.slave = upper(l.text(0)), c.master = l.empty(1) ? c.slave : upper(l.text(1));
    if (c.slave.empty()) return r.skip("*CONTACT INCLUSIONS of all with one");
    r.deck.contacts.push_back(std::move(c));
  }
  if (!any) r.deck.every_pair = r.card.place();
}

/// The interaction of all pairs; that of single ones is not read.
void read_assignment(InpReading& r) {
  for (DataLine l; r.lines.next_data(l);)
    if (l.empty(0) && l.empty(1) && !l.empty(2))
      r.deck.every_interaction = upper(l.text(2));
    else
      return r.skip("*CONTACT PROPERTY ASSIGNMENT to single surfaces");
}

void read_general(InpReading& r) {
  if (const auto odd = unknown_param(r.card, {"OP"}); !odd.empty()) r.skip(odd);
}

}  // namespace

std::vector<InpCard> inp_contact_cards() {
  return {
      {"CONTACTPAIR", read_contact_pair, true},
      {"SURFACEINTERACTION", read_interaction, true},
      {"SURFACEBEHAVIOR", read_behavior, true},
      {"FRICTION", read_friction, true},
      {"CONTACT", read_general, true},
      {"CONTACTINCLUSIONS", read_inclusions, true},
      {"CONTACTPROPERTYASSIGNMENT", read_assignment, true},
  };
}

}  // namespace hilo
