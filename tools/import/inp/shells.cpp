// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of shells that become pairs: those that have to be bodies, since they turn in ways of their own.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "import/inp/equations.hpp"
#include "import/inp/ties.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {

void find_bodies_of_shells(InpDeck& d, Imported& in) {
  const auto make = [&](std::int64_t a, const std::string& place) {
    d.bodies.try_emplace(in.mesh.node_id[static_cast<size_t>(a)], InpBody{in.mesh.X[static_cast<size_t>(a)], place, {}});
  };
  for (const InpThickness& t : d.thicknesses)
    for (const auto a : inp_nodes(d, t.node.name, t.node.id, t.node.place))
      if (in.sheets->at(a).empty())
        in.skip("*NODAL THICKNESS of nodes of no shell", t.node.place);
      else
        in.thickness_at[a] = t.value;
  const auto of_shells = [&](const InpNodal& l) {
    auto rows = inp_nodes(d, l.target, l.id, l.place);
    std::erase_if(rows, [&](std::int64_t a) { return in.sheets->at(a).empty(); });
    return rows;
  };
  std::map<std::int64_t, std::pair<ShellSupport, std::string>> held;
  for (const auto& l : d.supports)
    for (const auto a : of_shells(l)) {
      if (!d.transformed.empty()) throw Error(l.place, "*TRANSFORM beside shells of --thicken is not read", "hold them in the deck's axes");
      auto& [support, place] = held[a];
      for (int k = l.first; k <= std::min(l.last, 6); ++k) support.held |= 1U << (k - 1);
      support.turned = support.turned || (l.last > 3 && l.value != 0);
      place = l.place;
    }
  for (const auto& [a, h] : held)
    if (needs_body(in.sheets->at(a), h.first))
      make(a, h.second);
    else
      in.held[a] = h.first.held;
  for (const auto& l : d.forces)
    for (const auto a : of_shells(l))
      if (l.last > 3 || std::ranges::any_of(in.sheets->at(a), [](const Sheets::Part& p) { return p.offset != 0; })) make(a, l.place);
  const auto by_number = [&](std::int64_t id, const std::string& place) {
    if (const auto a = d.node.find(id); a != d.node.end() && !in.sheets->at(a->second).empty()) make(a->second, place);
  };
  for (const auto& [id, p] : d.points)
    for (const auto n : p.nodes)
      if (p.type != "DCOUP3D") by_number(n, p.place);
  for (const InpEquation& e : d.equations)
    for (const auto& t : e.terms)
      for (const auto id : numbers_of(d, t.node)) by_number(id, e.place);
}

}  // namespace hilo
