// SPDX-License-Identifier: GPL-3.0-or-later
// The scene lines of an .inp deck's pairs of surfaces: [[tie]] and [[contact]].
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "import/inp/scene.hpp"

namespace hilo {

const std::string* InpScene::facets_of(const InpPair& pair, const std::string& surface, const char* card) {
  const auto found = surface_.find(surface);
  if (found == surface_.end())
    in_.skip(fmt::format("{}: no surface \"{}\"", card, surface), pair.place);
  else if (found->second.empty())
    in_.skip(fmt::format("{} of a surface of no face", card), pair.place);
  else
    return &found->second;
  return nullptr;
}

void InpScene::tied() {
  for (const InpPair& t : d_.tied) {
    const std::string *a = facets_of(t, t.master, "*TIE"), *b = a ? facets_of(t, t.slave, "*TIE") : nullptr;
    if (!a || !b) continue;
    if (!t.adjust)
      in_.notes.push_back(fmt::format("{}: *TIE, ADJUST=NO: nodes off the other surface are moved onto it all the same", t.place));
    tables_ += fmt::format("\n[[tie]]   # {}\nname = {}\na = {}\nb = {}\n", t.place, toml_text(unique("tie", clean_name(t.name))),
                           toml_text(*a), toml_text(*b));
    if (t.tolerance > 0) tables_ += fmt::format("gap = {}\n", num(t.tolerance * si("m") * o_.scale));
  }
}

void InpScene::contacts() {
  const auto table = [&](const InpPair& c, const std::string& a, const std::string& b) {
    InpInteraction with;
    if (!c.interaction.empty()) {
      const auto found = d_.interactions.find(c.interaction);
      if (found == d_.interactions.end())
        throw Error(c.place, fmt::format("no *SURFACE INTERACTION \"{}\"", c.interaction), suggest_name(c.interaction, d_.interactions));
      with = found->second;
    }
    const bool tied = with.law == "TIED";
    if (tied)
      in_.notes.push_back(fmt::format("{}: tied contact becomes a [[tie]], without the stiffness of *SURFACE BEHAVIOR", c.place));
    else if (!with.law.empty())
      in_.notes.push_back(
          fmt::format("{}: the stiffness of the contact is hilo's own, by E and the depth of cells, not that of *SURFACE BEHAVIOR, {}",
                      c.place, with.law));
    tables_ += fmt::format("\n[[{}]]   # {}\nname = {}\na = {}\nb = {}\n", tied ? "tie" : "contact", c.place,
                           toml_text(unique(tied ? "tie" : "contact", clean_name(c.name))), toml_text(a), toml_text(b));
    if (!tied && with.friction > 0) tables_ += fmt::format("friction = {}\n", num(with.friction));
  };
  std::set<std::pair<std::string, std::string>> seen;
  for (InpPair c : d_.contacts) {
    if (c.interaction.empty()) c.interaction = d_.every_interaction;
    const std::string *a = facets_of(c, c.master, "*CONTACT PAIR"), *b = a ? facets_of(c, c.slave, "*CONTACT PAIR") : nullptr;
    if (!a || !b) continue;
    if (seen.emplace(std::minmax(*a, *b)).second)
      table(c, *a, *b);
    else
      in_.notes.push_back(fmt::format("{}: a contact has these two surfaces already, and points of both meet the other", c.place));
  }
  if (!d_.every_pair.empty()) table({"contact", "", "", d_.every_pair, -1, true, d_.every_interaction}, "all", "all");
}

}  // namespace hilo
