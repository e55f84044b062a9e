// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that are known: a keyword and what reads it.  Another card is one more row in the table of its family, or from
// outside the tree `inp_cards().add({"LAME", read_lame})` before the first deck is read.
#pragma once
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/registry.hpp"
#include "import/inp/deck.hpp"

namespace hilo {

/// A deck being read: where it stands, and what it has said so far.
struct InpReading {
  InpLines lines;
  InpDeck& deck;
  Imported& in;
  Card card = {};                   // the card at hand
  int step = 0;                     // 0 before the first *STEP
  size_t supports_before_step = 0;  // that OP=NEW forgets
  int parts = 0, instances = 0;     // *PART, *INSTANCE so far
  bool in_part = false;             // read once more
  bool several = false;             // instances or parts: each instance is its part, read once more
  std::map<std::string, InpLines::Mark> part_at = {};
  bool skipped = false;  // the card at hand, as a whole: told already
  void skip(const std::string& what) { in.skip(what, card.place()), skipped = true; }
};

struct InpCard {
  std::string_view name;  // "SOLIDSECTION": upper case, blanks removed
  void (*read)(InpReading&);
  bool first_step_only = false;  // what it says of a second step does not become scene lines
  bool of_step = false;          // or only where one run can say both (inp/steps)
};
using InpCards = Registry<InpCard>;

/// The families, one file each.
std::vector<InpCard> inp_mesh_cards();      // *NODE, *ELEMENT, sets, surfaces
std::vector<InpCard> inp_generate_cards();  // *NGEN, *NFILL, *ELGEN
std::vector<InpCard> inp_material_cards();  // *MATERIAL and what follows it, sections
std::vector<InpCard> inp_load_cards();      // supports, loads, histories
std::vector<InpCard> inp_motion_cards();    // *BASE MOTION
std::vector<InpCard> inp_tie_cards();       // couplings, rigid bodies, masses, springs
std::vector<InpCard> inp_contact_cards();   // contact pairs, and what happens between them
std::vector<InpCard> inp_step_cards();      // heading, parts, steps, procedures
std::vector<InpCard> inp_modal_cards();     // what sums modes
std::vector<InpCard> inp_unread_cards();    // requests for output, and cards without which the mesh would be another
/// All of them.
InpCards& inp_cards();

/// Reads the cards.  One that is not among `cards` is counted in `in.not_read`, with the card it may be a slip of.
void parse_inp(const std::string& path, InpDeck& deck, Imported& in, const InpCards& cards);

/// The material that a card speaks of; Error where it stands before any *MATERIAL.
DeckMaterial& material_of(InpReading& r);
/// And the card's first data line; Error with what is expected there where it has none.
DeckMaterial& material_of(InpReading& r, DataLine& l, const char* expected);

/// Target of a line: a number or the name of a set.
InpTarget target_of(const DataLine& l);

/// *ELEMENT of a type of points (MASS, SPRINGA, ...); false where it is of cells.
bool read_points(InpReading& r, const std::string& type);

/// The first parameter of a card that is not among those known, as "*CLOAD, SECTOR"; "" when all are.
std::string unknown_param(const Card& card, std::initializer_list<const char*> known);
/// An Error where there is one.
void require_known(const Card& card, std::initializer_list<const char*> known, const char* hint);
/// The card's first data line; Error with what is expected there where it has none.
void first_line(InpReading& r, DataLine& l, const char* expected);
/// The step at hand; a procedure may stand without one.
InpStep& step_of(InpReading& r);

}  // namespace hilo
