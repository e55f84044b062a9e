// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of regions of faces (BSURFS): BGSET as [[tie]] of the scene, the source's nodes follow the target; BCTSET as [[contact]].
#include <algorithm>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "import/bdf/scene.hpp"

namespace hilo {

/// The facets of a region, as a set; "" where it has none.
std::string BdfScene::pair_surface(std::int64_t region) {
  const auto faces = deck_.glue_faces.find(region);
  if (faces == deck_.glue_faces.end()) return "";
  const auto [at, fresh] = glue_name_.try_emplace(region);
  if (!fresh) return at->second;
  std::vector<Facet> facets;
  for (const BdfGlueFace& f : faces->second) {
    const auto cell = deck_.cell_row.find(f.element);
    if (deck_.pyramids.contains(f.element)) throw Error(f.place, fmt::format("BSURFS {}: faces of pyramids are not read", region));
    if (cell == deck_.cell_row.end()) throw Error(f.place, fmt::format("BSURFS {}: no solid element {}", region, f.element));
    const auto nodes = in_.mesh.cell(cell->second);
    const ShapeInfo& s = info(in_.mesh.shape[static_cast<size_t>(cell->second)]);
    std::int64_t found = -1;
    for (size_t i = 0; i < s.facets.size(); ++i)
      if (std::ranges::all_of(f.grids, [&](std::int64_t grid) {
            const auto a = row(grid, f.place, "BSURFS");
            return std::ranges::any_of(s.facets[i], [&](int local) { return nodes[static_cast<size_t>(local)] == a; });
          }))
        found = static_cast<std::int64_t>(i);
    if (found < 0)
      throw Error(f.place, fmt::format("BSURFS {}: element {} has no face of grids {}, {} and {}", region, f.element, f.grids[0],
                                       f.grids[1], f.grids[2]));
    facets.push_back({cell->second, found});
  }
  return at->second = names_.facets(fmt::format("glue_{}", region), std::move(facets));
}

void BdfScene::pairs() {
  const BdfCase& taken = deck_.chosen;
  const auto each = [&](const BdfSets<BdfGlue>& all, std::int64_t chosen, const std::string& card, const char* section,
                        const std::string& name, const auto& keys) {
    if (chosen >= 0 && !all.has(chosen))
      in_.skip(fmt::format("{} = {}, of which there is none", card == "BCTSET" ? "BCSET" : card, chosen), "case control");
    std::set<std::pair<std::string, std::string>> seen;
    const auto pair = [&](std::int64_t id, const BdfGlue& g) {
      if (taken.any && !all.takes(chosen, id)) return in_.skip(card + " of a set that the subcase does not use", g.place);
      const std::string a = pair_surface(g.target), b = pair_surface(g.source);
      if (a.empty() || b.empty()) return in_.skip(card + " of a region that is no BSURFS", g.place);
      if (!seen.emplace(std::minmax(a, b)).second)
        return in_.notes.push_back(fmt::format("{}: a [[{}]] has these two regions already", g.place, section));
      keys(g, scene_.add_unique(section, fmt::format("{}_{}", name, id), g.place, {{"a", a}, {"b", b}}));
    };
    for (const auto& [id, list] : all.lines)
      for (const BdfGlue& g : list) pair(id, g);
  };
  each(deck_.glue, taken.glue, "BGSET", "tie", "glue",
       [&](const BdfGlue& g, SceneTable& tie) { tie.set_if(g.distance > 0, "gap", g.distance * options_.scale * si("m")); });
  each(deck_.contacts, taken.contact, "BCTSET", "contact", "contact",
       [&](const BdfGlue& g, SceneTable& contact) { contact.set_if(g.friction > 0, "friction", g.friction); });
}

}  // namespace hilo
