// SPDX-License-Identifier: GPL-3.0-or-later
// Supports of the nodes that --order 2 puts in the middle of edges: what both ends hold.
#include <fmt/format.h>

#include <Eigen/SVD>
#include <array>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <unordered_map>

#include "import/imported.hpp"
#include "import/links.hpp"

namespace hilo {
namespace {

using Ways = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Of a node.
struct Held {
  std::array<const SceneSupport*, 3> along{};  // x, y, z
  std::vector<const SceneSupport*> askew;
};

/// Ways across each other that the node does not go, without those of x, y, z that are known of it.
Ways ways(const Held& h, unsigned known) {
  Ways out(3, 0);
  const auto add = [&](Vec3 way) {
    for (Eigen::Index k = 0; k < 3; ++k)
      if (known >> k & 1) way[k] = 0;
    way -= out * (out.transpose() * way);
    if (!(way.norm() > 1e-6)) return;
    out.conservativeResize(3, out.cols() + 1);
    out.rightCols(1) = way.normalized();
  };
  for (Eigen::Index k = 0; k < 3; ++k)
    if (const SceneSupport* s = h.along[static_cast<size_t>(k)]; s && s->by[k] == 0) add(Vec3::Unit(k));
  for (const SceneSupport* s : h.askew) add(s->axis);
  return out;
}

struct Middles {
  std::vector<std::int64_t> nodes;
  std::string place;
  void add(std::int64_t a, const std::string& where) {
    if (nodes.empty()) place = where;
    nodes.push_back(a);
  }
};

/// Between nodes one cell apart that a deck holds and moves: the mean is that of a linear cell.
std::int64_t one_cell_apart(const Mesh& m, const std::unordered_map<std::int64_t, Held>& held, std::int64_t first,
                            const std::vector<std::array<std::int64_t, 2>>& ends) {
  std::set<std::int64_t> found;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto nodes = m.cell(c);
    const auto corners = nodes.first(static_cast<size_t>(info(m.shape[static_cast<size_t>(c)]).n_corners));
    if (!std::ranges::all_of(corners, [&](auto a) { return held.contains(a); })) continue;
    for (size_t k = 0; k < 3; ++k) {
      if (!std::ranges::all_of(corners, [&](auto a) { return held.at(a).along[k] != nullptr; })) continue;
      const auto by = [&](std::int64_t a) { return held.at(a).along[k]->by[static_cast<Eigen::Index>(k)]; };
      for (const auto a : nodes)
        if (a >= first)
          if (const auto& [from, to] = ends[static_cast<size_t>(a - first)]; by(from) != by(to)) found.insert(a);
    }
  }
  return static_cast<std::int64_t>(found.size());
}

void hold(Imported& in, SceneWriter& scene, const std::vector<std::array<std::int64_t, 2>>& ends, double metres) {
  Mesh& m = in.mesh;
  const std::int64_t first = m.n_nodes() - static_cast<std::int64_t>(ends.size());
  const std::vector<SceneSupport> supports = scene.supports;
  std::unordered_map<std::int64_t, Held> held;
  for (const SceneSupport& s : supports) {
    const auto set = m.node_sets.find(s.set);
    if (set == m.node_sets.end()) continue;
    for (const auto a : set->second) {
      if (a >= first) continue;
      Held& h = held[a];
      if (s.components == 0) h.askew.push_back(&s);
      for (size_t k = 0; k < 3; ++k)
        if (s.components >> k & 1) h.along[k] = &s;
    }
  }
  std::map<std::tuple<unsigned, std::array<double, 3>, std::string>, Middles> straight;  // components, how far, history
  SetNames names(in);
  double apart = 1;  // cosine of the largest angle between ways that are taken as one
  for (size_t i = 0; i < ends.size(); ++i) {
    const auto one = held.find(ends[i][0]), other = held.find(ends[i][1]);
    if (one == held.end() || other == held.end()) continue;
    const Held &a = one->second, &b = other->second;
    const std::int64_t middle = first + static_cast<std::int64_t>(i);
    unsigned both = 0;
    std::map<std::string, std::pair<unsigned, std::array<double, 3>>> by_history;
    std::string place;
    for (size_t k = 0; k < 3; ++k) {
      const SceneSupport *s = a.along[k], *t = b.along[k];
      if (!s || !t) continue;
      both |= 1u << k;
      if (s == t) continue;  // their set holds the middle
      const double u = s->by[static_cast<Eigen::Index>(k)], v = t->by[static_cast<Eigen::Index>(k)];
      place = s->place;
      if (u != 0 && v != 0 && s->history != t->history) {
        in.skip("*BOUNDARY of the middle of an edge whose ends follow two amplitudes", place);
        continue;
      }
      auto& [bits, by] = by_history[u != 0 ? s->history : v != 0 ? t->history : ""];
      bits |= 1u << k, by[k] = (u + v) / 2;
    }
    for (const auto& [history, moved] : by_history) straight[{moved.first, moved.second, history}].add(middle, place);
    if (a.askew.empty() && b.askew.empty()) continue;
    const Ways of_a = ways(a, both), of_b = ways(b, both);
    if (of_a.cols() == 0 || of_b.cols() == 0) continue;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(of_a.transpose() * of_b, Eigen::ComputeThinU | Eigen::ComputeThinV);
    for (Eigen::Index j = 0; j < svd.singularValues().size(); ++j) {
      const double cosine = svd.singularValues()[j];
      if (cosine < 1 / std::numbers::sqrt2) continue;
      apart = std::min(apart, cosine);
      const Vec3 way = (of_a * svd.matrixU().col(j) + of_b * svd.matrixV().col(j)).normalized();
      const std::string& where = (a.askew.empty() ? b : a).askew.front()->place;
      const std::string set = names.nodes(scene.unique("set", fmt::format("node_{}", m.node_id[static_cast<size_t>(middle)])), {middle});
      joint_to_slide(scene, set + "_support", "", set, way, m.X[static_cast<size_t>(middle)] * metres, where);
    }
  }
  for (const auto& [key, group] : straight) {
    const auto& [bits, by, history] = key;
    const Vec3 way(by.data());
    hold_set(scene, names.nodes(scene.unique("set", "middles"), group.nodes), bits, way == Vec3::Zero() ? std::nullopt : std::optional(way),
             history, group.place);
  }
  if (apart < 1 - 1e-6)
    in.notes.push_back(fmt::format("order 2: nodes between supports whose axes are up to {:.0f} deg apart are held along the mean axis",
                                   std::acos(apart) * 180 / std::numbers::pi));

  if (const auto n = one_cell_apart(m, held, first, ends); n > 0)
    in.notes.push_back(fmt::format(
        "warning: order 2: {} nodes in the middle of edges from nodes that are held to nodes that are moved, one cell apart, go the "
        "mean way, as in linear cells: two cells there are better",
        n));
  std::set<std::string> of_supports;
  for (const SceneSupport& s : supports) of_supports.insert(s.set);
  std::set<std::int64_t> tied;  // one by one
  for (const std::string& name : scene.ends({"joint"}))
    if (const auto set = m.node_sets.find(name); set != m.node_sets.end() && in.as_listed.contains(name) && !of_supports.contains(name))
      tied.insert(set->second.begin(), set->second.end());
  std::int64_t free = 0;
  for (const auto& [a, b] : ends) free += tied.contains(a) && tied.contains(b);
  if (free > 0)
    in.notes.push_back(
        fmt::format("warning: order 2: joints tie single nodes, and none of the {} nodes in the middle of edges between them", free));
}

}  // namespace

void hold_middles(Imported& in, const std::vector<std::array<std::int64_t, 2>>& ends, double metres) {
  if (in.cases.empty()) hold(in, in.scene, ends, metres);
  for (DeckCase& c : in.cases) hold(in, c.scene, ends, metres);
}

}  // namespace hilo
