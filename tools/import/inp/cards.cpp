// SPDX-License-Identifier: GPL-3.0-or-later
// The table of contents of the .inp reader.
#include <fmt/format.h>

#include <algorithm>

#include "import/inp/card.hpp"

namespace hilo {

InpCards& inp_cards() {
  static InpCards all = [] {
    InpCards list("card of .inp decks", {});
    for (const auto& family : {inp_mesh_cards(), inp_generate_cards(), inp_material_cards(), inp_load_cards(), inp_motion_cards(),
                               inp_tie_cards(), inp_contact_cards(), inp_step_cards(), inp_modal_cards(), inp_unread_cards()})
      for (const InpCard& card : family) list.add(card);
    return list;
  }();
  return all;
}

std::string unknown_param(const Card& card, std::initializer_list<const char*> known) {
  for (const char* key : known) card.find(key);
  for (const auto& [key, p] : card.params)
    if (std::find_if(known.begin(), known.end(), [&key = key](const char* k) { return key == k; }) == known.end())
      return fmt::format("{}, {}{}", card.name, key, p.value.empty() ? "" : "=" + p.value);
  return "";
}

void require_known(const Card& card, std::initializer_list<const char*> known, const char* hint) {
  if (const auto odd = unknown_param(card, known); !odd.empty()) throw Error(card.place() + ":1", odd + " is not read", hint);
}

void first_line(InpReading& r, DataLine& l, const char* expected) {
  if (!r.lines.next_data(l)) throw Error(r.card.place() + ":1", fmt::format("{} lacks its data line", r.card.name), expected);
}

}  // namespace hilo
