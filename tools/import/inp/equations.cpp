// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/inp/equations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import/links.hpp"

namespace hilo {
namespace {

std::vector<std::int64_t> nodes_of(const InpDeck& d, const InpTarget& t) {
  if (t.name.empty()) return {t.id};
  auto set = d.nset.find(t.name);
  if (set == d.nset.end()) set = d.nset.find(unqualified(t.name));
  if (set == d.nset.end()) throw Error(t.place, fmt::format("no node set \"{}\"", t.name), suggest_name(t.name, d.nset));
  return set->second.members;
}

/// Why a displacement cannot be one of an equation, or "".
std::string why_not(const InpDeck& d, std::int64_t node, int component, const std::set<std::int64_t>& turned) {
  if (component < 1 || component > 3) return "of turns or temperatures";
  if (turned.contains(node)) return "in axes of *TRANSFORM";
  if (d.bodies.contains(node)) return "of nodes of beams";
  if (!d.node.contains(node) && !d.loose.contains(node)) return "of a node that does not exist";
  for (const InpTie& t : d.ties)
    if (!t.no_node && t.kind != InpTie::Of::weighted && std::ranges::count(nodes_of(d, t.reference), node)) return "of a reference node";
  for (const auto& [id, p] : d.points)
    if (!d.node.contains(node) && std::ranges::count(p.nodes, node)) return "of a node of springs or masses alone";
  return "";
}

}  // namespace

void find_equations(InpDeck& d, Imported& in) {
  std::set<std::int64_t> turned;
  for (const InpTransform& t : d.transformed)
    for (const auto id : nodes_of(d, {t.target, t.id, t.place})) turned.insert(id);
  EqualDisplacements equals;
  std::map<Displacement, std::string> place;
  for (const InpEquation& e : d.equations) {
    std::string why;
    for (const auto& t : e.terms)
      for (const auto node : nodes_of(d, t.node))
        if (why.empty()) why = why_not(d, node, t.component, turned);
    const auto& first = e.terms[0];
    if (!why.empty()) {
      in.skip("*EQUATION " + why, e.place);
    } else if (e.terms.size() == 1) {
      d.supports.push_back({first.node.name, first.node.id, first.component, first.component, 0, "", e.place});
    } else if (const auto& second = e.terms.back(); e.terms.size() > 2 || first.component != second.component ||
                                                    std::abs(first.factor + second.factor) > 1e-9 * std::abs(first.factor)) {
      in.skip("*EQUATION that is more than two equal displacements", e.place);
    } else {
      const auto a = nodes_of(d, first.node), b = nodes_of(d, second.node);
      if (a.size() != b.size() && b.size() != 1 && a.size() != 1)
        throw Error(e.place, fmt::format("*EQUATION between {} nodes and {}", a.size(), b.size()), "sets of as many nodes");
      for (size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
        const Displacement x{a[a.size() == 1 ? 0 : i], first.component}, y{b[b.size() == 1 ? 0 : i], first.component};
        equals.unite(x, y);
        place.try_emplace(x, e.place), place.try_emplace(y, e.place);
      }
    }
  }
  std::map<Displacement, int> number;
  for (const auto& [x, up] : equals.all()) {
    const auto [at, fresh] = number.try_emplace(equals.root(x), static_cast<int>(d.slides.size()));
    if (fresh) {
      InpSlide& s = d.slides.emplace_back();
      s.component = x.second, s.place = place[x];
      s.X = d.node.contains(x.first) ? in.mesh.X[d.node.at(x.first)] : d.loose.at(x.first);
    }
    d.slide_of[x] = at->second;
    if (const auto a = d.node.find(x.first); a != d.node.end()) d.slides[at->second].rows.push_back(a->second);
  }
}

int slide_of(const InpDeck& d, std::int64_t node, int component) {
  const auto it = d.slide_of.find({node, component});
  return it == d.slide_of.end() ? -1 : it->second;
}

bool is_slide(const InpDeck& d, std::int64_t node) {
  return !d.node.contains(node) && (slide_of(d, node, 1) >= 0 || slide_of(d, node, 2) >= 0 || slide_of(d, node, 3) >= 0);
}

std::string slide_name(const InpDeck& d, int slide) { return fmt::format("equal_{}_{}", "xyz"[d.slides[slide].component - 1], slide + 1); }

}  // namespace hilo
