// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that are known and not read: requests for output, of which nothing is lost, and cards that make nodes or cells,
// without which the mesh would be another.
#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {
namespace {

void output(InpReading& r) {
  r.in.skip(r.card.name, r.card.place(), 1, true);
  r.skipped = true;
  if (r.card.key == "NODEPRINT" && r.card.has("NSET")) r.deck.printed.push_back(r.card.word("NSET"));
}

[[noreturn]] void refuse(const InpReading& r, const char* hint) { throw Error(r.card.place() + ":1", r.card.name + " is not read", hint); }
void nodes(InpReading& r) { refuse(r, "write the nodes out"); }

}  // namespace

std::vector<InpCard> inp_unread_cards() {
  std::vector<InpCard> cards{{"NMAP", nodes}};
  for (const char* name : {"NODEPRINT",   "NODEFILE",     "NODEOUTPUT", "ELPRINT",       "ELFILE",           "ELEMENTOUTPUT", "OUTPUT",
                           "CONTACTFILE", "CONTACTPRINT", "FACEPRINT",  "CONTACTOUTPUT", "SECTIONPRINT",     "PREPRINT",      "ENERGYPRINT",
                           "MONITOR",     "TIMEPOINTS",   "FILEFORMAT", "ENERGYOUTPUT",  "RESTART",          "ENERGYFILE",    "SECTIONFILE",
                           "MODALFILE",   "MODALPRINT",   "PRINT",      "FILEOUTPUT",    "INTEGRATEDOUTPUT", "RADIATIONFILE"})
    cards.push_back({name, output});
  return cards;
}

}  // namespace hilo
