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
    scene_.add_unique("tie", clean_name(t.name), t.place, {{"a", *a}, {"b", *b}})
        .set_if(t.tolerance > 0, "gap", t.tolerance * si("m") * o_.scale);
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
      in_.skip(
          fmt::format("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={}: the stiffness is hilo's own, by E and the depth of cells", with.law),
          c.place);
    scene_.add_unique(tied ? "tie" : "contact", clean_name(c.name), c.place, {{"a", a}, {"b", b}})
        .set_if(!tied && with.friction > 0, "friction", with.friction);
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
