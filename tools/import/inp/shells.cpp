// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of shells that become pairs: those that have to be bodies, since they turn in ways of their own.
#include <fmt/format.h>

#include <algorithm>

#include "import/inp/passes.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {

void find_bodies_of_shells(InpDeck& d, Imported& in) {
  const auto make = [&](std::int64_t a, const std::string& place) {
    d.bodies.try_emplace(in.mesh.node_id[static_cast<size_t>(a)], InpBody{in.mesh.X[static_cast<size_t>(a)], place, {}});
  };
  for (const InpThickness& t : d.thicknesses)
    for (const auto a : inp_nodes(d, t))
      if (in.sheets->at(a).empty())
        in.skip("*NODAL THICKNESS of nodes of no shell", t.place);
      else
        in.thickness_at[a] = t.value;
  const auto of_shells = [&](const InpNodal& l) {
    auto rows = inp_nodes(d, l);
    std::erase_if(rows, [&](std::int64_t a) { return in.sheets->at(a).empty(); });
    return rows;
  };
  struct Support {
    ShellSupport support;
    std::string place;
    bool moves = false;
  };
  std::map<std::int64_t, Support> held;
  const std::vector<int> axes = turned_nodes(d, in.mesh);
  for (const auto& l : d.supports)
    for (const auto a : of_shells(l)) {
      auto& [support, place, moves] = held[a];
      for (int k = l.first; k <= std::min(l.last, 6); ++k) support.held |= 1U << (k - 1);
      support.turned = support.turned || (l.last > 3 && l.value != 0);
      place = l.place, moves = moves || l.value != 0;
    }
  for (const auto& [a, h] : held) {
    // in axes of its own a node is a body, unless these say nothing
    const unsigned turns = h.support.held >> 3;
    const bool all = (h.support.held & 7) == 7 && (turns == 0 || turns == 7) && !h.moves;
    if (needs_body(in.sheets->at(a), h.support) || (axes[static_cast<size_t>(a)] >= 0 && !all))
      make(a, h.place);
    else
      in.held[a] = h.support.held;
  }
  for (const auto& l : d.forces)
    for (const auto a : of_shells(l))
      if (l.last > 3 || std::ranges::any_of(in.sheets->at(a), [](const Sheets::Part& p) { return p.offset != 0; })) make(a, l.place);
  const auto by_number = [&](std::int64_t id, const std::string& place) {
    if (is_of_pairs(d, in, id)) make(d.node.at(id), place);
  };
  for (const auto& [id, p] : d.points)
    for (const auto n : p.nodes)
      if (p.type != "DCOUP3D") by_number(n, p.place);
  for (const InpEquation& e : d.equations)
    for (const auto& t : e.terms)
      for (const auto id : numbers_of(d, t.node)) by_number(id, e.place);
}

}  // namespace hilo
