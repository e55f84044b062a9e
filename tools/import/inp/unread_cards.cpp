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

std::span<const InpCard> inp_unread_cards() {
  static constexpr InpCard cards[] = {
      {"NMAP", nodes},        {"NODEPRINT", output},        {"NODEFILE", output},      {"NODEOUTPUT", output},   {"ELPRINT", output},
      {"ELFILE", output},     {"ELEMENTOUTPUT", output},    {"OUTPUT", output},        {"CONTACTFILE", output},  {"CONTACTPRINT", output},
      {"FACEPRINT", output},  {"CONTACTOUTPUT", output},    {"SECTIONPRINT", output},  {"PREPRINT", output},     {"ENERGYPRINT", output},
      {"MONITOR", output},    {"TIMEPOINTS", output},       {"FILEFORMAT", output},    {"ENERGYOUTPUT", output}, {"RESTART", output},
      {"ENERGYFILE", output}, {"SECTIONFILE", output},      {"MODALFILE", output},     {"MODALPRINT", output},   {"PRINT", output},
      {"FILEOUTPUT", output}, {"INTEGRATEDOUTPUT", output}, {"RADIATIONFILE", output},
  };
  return cards;
}

}  // namespace hilo
