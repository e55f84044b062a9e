// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import/inp/passes.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {

std::vector<std::int64_t> numbers_of(const InpDeck& d, const InpTarget& t) {
  return t.target.empty() ? std::vector{t.id} : set_of(d.nset, t, "node").members;
}

namespace {

/// The body that a node is or turns: of beams, a reference node, the ROT NODE of one, or a node of springs and masses alone.
struct EquationBody {
  bool is = false, turns = false;
  std::int64_t id = 0;
  bool of_turns = false;  // a ROT NODE, whose displacements are turns
};
EquationBody body_of(const InpDeck& d, std::int64_t node) {
  const auto is = [&](const InpTarget& t) { return (!t.target.empty() || t.id) && std::ranges::count(numbers_of(d, t), node); };
  for (const InpTie& t : d.ties) {
    if (t.no_node || t.mean || t.kind == InpTie::Of::weighted || t.left_out) continue;
    if (is(t.turns)) return {true, true, numbers_of(d, t.reference).front(), true};
    if (is(t.reference)) return {true, true, node};
  }
  if (d.bodies.contains(node)) return {true, true, node};
  for (const auto& [id, p] : d.points)
    if (!d.node.contains(node) && std::ranges::count(p.nodes, node)) return {true, false, node};
  return {};
}

/// Why a displacement cannot be one of an equation, or "".
std::string why_not(const InpDeck& d, const Imported& in, std::int64_t node, int component, const std::set<std::int64_t>& turned) {
  if (component < 1 || component > 6) return "of temperatures or potentials";
  if (turned.contains(node) && (!d.node.contains(node) || (body_of(d, node).is && !is_of_pairs(d, in, node))))
    return "in axes of *TRANSFORM, of a node of no solid";
  if (!d.node.contains(node) && !d.loose.contains(node) && !body_of(d, node).is) return "of a node that does not exist";
  for (const InpTie& t : d.ties)
    if (t.mean && !t.no_node && t.kind != InpTie::Of::weighted && std::ranges::count(numbers_of(d, t.reference), node))
      return "of the node of a distributing coupling";
  for (const auto& [id, p] : d.points)
    if (p.type == "DCOUP3D" && std::ranges::count(p.nodes, node)) return "of the node of a distributing coupling";
  if (component > 3 && is_of_pairs(d, in, node)) return "of turns of nodes of shells";
  if (component > 3 && !body_of(d, node).turns) return "of turns of a node that has none";
  return "";
}

struct EquationSum {
  std::map<Displacement, double> of;
  std::string place;
};

constexpr size_t most_terms = 1000;  // each beyond the third is a body

bool of_nothing(const InpSum& s) {
  return s.bodies.empty() && std::ranges::all_of(s.rows, [](const auto& r) { return r.second == Vec3::Zero(); }) &&
         std::ranges::all_of(s.slides, [](const auto& r) { return r.second == 0; });
}

}  // namespace

void find_equations(InpDeck& d, Imported& in) {
  std::set<std::int64_t> turned;
  for (const InpTransform& t : d.transformed)
    for (const auto id : numbers_of(d, t)) turned.insert(id);
  EqualDisplacements equals;
  std::map<Displacement, std::string> place;
  std::vector<EquationSum> sums;
  // a node of shells that is a body stands in the mesh all the same
  const auto is_body = [&](std::int64_t node) { return body_of(d, node).is && !is_of_pairs(d, in, node); };
  for (const InpEquation& e : d.equations) {
    std::string why;
    std::vector<std::vector<std::int64_t>> nodes;
    size_t n = 1;  // a term may have a set: one equation for each of its nodes
    bool askew = false;
    for (const auto& t : e.terms) {
      nodes.push_back(numbers_of(d, t.node));
      if (nodes.back().size() != 1 && n != 1 && nodes.back().size() != n)
        throw Error(e.place, fmt::format("*EQUATION between {} nodes and {}", n, nodes.back().size()), "sets of as many nodes");
      n = std::max(n, nodes.back().size());
      for (const auto node : nodes.back()) {
        if (why.empty()) why = why_not(d, in, node, t.component, turned);
        askew = askew || turned.contains(node) || is_body(node);
      }
    }
    const auto& first = e.terms[0];
    const auto node_of = [&](size_t term, size_t i) { return nodes[term][nodes[term].size() == 1 ? 0 : i]; };
    if (!why.empty()) {
      in.skip("*EQUATION " + why, e.place);
    } else if (e.terms.size() == 1) {
      d.supports.push_back({{first.node.target, first.node.id, e.place}, first.component, first.component});
    } else if (const auto& second = e.terms.back(); e.terms.size() == 2 && !askew && first.component == second.component &&
                                                    std::abs(first.factor + second.factor) <= 1e-9 * std::abs(first.factor)) {
      for (size_t i = 0; i < n; ++i) {
        const Displacement x{node_of(0, i), first.component}, y{node_of(1, i), first.component};
        equals.unite(x, y);
        place.try_emplace(x, e.place), place.try_emplace(y, e.place);
      }
    } else {
      for (size_t i = 0; i < n; ++i) {
        EquationSum& sum = sums.emplace_back(EquationSum{{}, e.place});
        for (size_t k = 0; k < e.terms.size(); ++k) {
          const Displacement x{node_of(k, i), e.terms[k].component};
          sum.of[x] += e.terms[k].factor;
          if (!d.node.contains(x.first) && !is_body(x.first)) equals.root(x), place.try_emplace(x, e.place);
        }
      }
    }
  }
  std::map<Displacement, int> number;
  for (const auto& [x, up] : equals.all()) {
    const auto [at, fresh] = number.try_emplace(equals.root(x), static_cast<int>(d.slides.size()));
    if (fresh) {
      InpSlide& s = d.slides.emplace_back();
      s.component = x.second, s.place = place[x];
      s.X = *point_of(d, in.mesh, x.first);
    }
    d.slide_of[x] = at->second;
    if (const auto a = d.node.find(x.first); a != d.node.end()) d.slides[at->second].rows.push_back(a->second);
  }
  const std::vector<int> axes = turned_nodes(d, in.mesh);
  for (const EquationSum& sum : sums) {
    InpSum to{{}, {}, {}, sum.place};
    for (const auto& [x, factor] : sum.of) {
      if (factor == 0) continue;
      if (is_body(x.first)) {
        const EquationBody body = body_of(d, x.first);
        to.bodies.push_back({body.id, x.second + (body.of_turns ? 3 : 0), factor});
        continue;
      }
      const auto row = d.node.find(x.first);
      if (row == d.node.end()) {
        to.slides[d.slide_of.at(x)] += factor;
        continue;
      }
      const int of = axes[static_cast<size_t>(row->second)];
      const Mat3 own = of < 0 ? Mat3(Mat3::Identity()) : d.transformed[static_cast<size_t>(of)].axes(in.mesh.X[row->second]);
      to.rows.try_emplace(row->second, Vec3::Zero()).first->second += factor * own.col(x.second - 1);
    }
    if (of_nothing(to)) continue;
    if (to.rows.size() + to.slides.size() + 2 * to.bodies.size() > most_terms)
      in.skip(fmt::format("*EQUATION of more than {} terms", most_terms), sum.place);
    else
      d.sums.push_back(std::move(to));
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
