// SPDX-License-Identifier: GPL-3.0-or-later
// Solids that share no node with another, and that nothing of the deck holds, moves, loads or ties.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "import/imported.hpp"
#include "model/mesh_pieces.hpp"

namespace hilo {

void tell_untouched(Imported& in) {
  const Mesh& m = in.mesh;
  const auto piece = pieces_of(m);
  std::map<std::int64_t, std::set<std::string>> regions;  // of each piece
  std::map<std::int64_t, std::int64_t> first;             // cell of each
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto p = piece[m.cell(c)[0]];
    regions[p].insert('"' + m.region_name[m.region[c]] + '"');
    first.try_emplace(p, m.cell_id[c]);
  }
  if (regions.size() < 2) return;
  std::set<std::int64_t> reached;
  const auto all = m.all_names();
  const std::set<std::string> known(all.begin(), all.end());
  const auto reach = [&](const SceneWriter& scene) {
    const auto at_work = scene.ends({"motion", "joint", "spring", "load", "initial"});
    for (size_t a = 0; a < m.block.size(); ++a)
      if (m.block[a] >= 0 && at_work.contains(m.block_name[static_cast<size_t>(m.block[a])])) reached.insert(piece[a]);
    for (const std::string& name : at_work)
      if (known.contains(name))  // else a body, the ground
        for (const auto a : m.nodes_of(name, "")) reached.insert(piece[a]);
  };
  reach(in.scene);
  for (const DeckCase& c : in.cases) reach(c.scene);
  std::vector<std::string> lines;
  for (const auto& [p, names] : regions)
    if (!reached.contains(p)) lines.push_back(fmt::format("{} (from cell {} on)", fmt::join(names, ", "), first[p]));
  if (lines.empty()) return;
  in.notes.push_back(fmt::format("{} of {} solids share no node with another{}: {}", lines.size(), regions.size(),
                                 reached.empty() ? "" : ", and nothing of the deck holds, moves, loads or ties them",
                                 some(lines, 6, "; ")));
}

}  // namespace hilo
