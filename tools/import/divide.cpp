// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces with triangles or mid-side nodes become quadrangles: a triangle three, a quadrangle four, so that neighbours stay joined.  The
// nodes in the middle of edges are those of the deck where it has them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "base/error.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

class Dividing {
 public:
  Dividing(Imported& in, const std::string& file) : in_(in), m_(in.mesh), file_(file) {
    for (const auto& [c, unused] : in.thin)
      if (info(m_.shape[c]).dimension == 2) cells_.push_back(c);
  }

  void run() {
    if (!is_divided(in_)) return;
    first_new_ = m_.n_nodes();
    if (first_new_ > 0) next_id_ = *std::ranges::max_element(m_.node_id) + 1;
    for (const auto c : cells_) take_middles(c);
    for (const auto c : cells_) divide(c);
    rebuild();
    complete_sets();
    in_.notes.push_back(
        fmt::format("{} surfaces have triangles or mid-side nodes among them: {} quadrangles, three of each triangle, four of each "
                    "quadrangle",
                    cells_.size(), n_made_));
  }

 private:
  using Edge = std::pair<std::int64_t, std::int64_t>;
  static Edge edge(std::int64_t a, std::int64_t b) { return std::minmax(a, b); }

  void take_middles(std::int64_t c) {
    const auto nodes = m_.cell(c);
    const int corners = info(m_.shape[c]).n_corners;
    for (int k = 0; k<corners&& static_cast<int>(nodes.size())> corners; ++k) {
      const auto [it, fresh] = middle_.try_emplace(edge(nodes[k], nodes[(k + 1) % corners]), nodes[corners + k]);
      if (!fresh && it->second != nodes[corners + k])
        throw Error(file_,
                    fmt::format("element {}: nodes {} and {} stand in the middle of one edge", m_.cell_id[c], m_.node_id[it->second],
                                m_.node_id[nodes[corners + k]]),
                    "--merge-nodes, where they are one");
    }
  }

  std::int64_t new_node(const Vec3& X) {
    m_.X.push_back(X), m_.node_id.push_back(next_id_++);
    return m_.n_nodes() - 1;
  }

  /// The mean over some nodes, where all have a thickness of their own.
  void take_thickness(std::int64_t node, std::span<const std::int64_t> of) {
    double sum = 0;
    for (const auto a : of) {
      const auto own = in_.thickness_at.find(a);
      if (own == in_.thickness_at.end()) return;
      sum += own->second;
    }
    in_.thickness_at.try_emplace(node, sum / static_cast<double>(of.size()));
  }

  void divide(std::int64_t c) {
    const auto own = m_.cell(c);
    const std::vector<std::int64_t> nodes(own.begin(), own.end());
    const int corners = info(m_.shape[c]).n_corners;
    std::vector<std::int64_t> mid;
    Vec3 of_corners = Vec3::Zero(), of_middles = Vec3::Zero();
    for (int k = 0; k < corners; ++k) {
      const auto a = nodes[k], b = nodes[(k + 1) % corners];
      auto found = middle_.find(edge(a, b));
      if (found == middle_.end()) found = middle_.emplace(edge(a, b), new_node((m_.X[a] + m_.X[b]) / 2)).first;
      mid.push_back(found->second);
      if (found->second >= first_new_) take_thickness(found->second, std::array{a, b});
      of_corners += m_.X[a] / corners, of_middles += m_.X[mid.back()] / corners;
    }
    // the interpolation of six or eight nodes in the middle
    const auto centre = new_node(corners == 3 ? Vec3(4. / 3 * of_middles - of_corners / 3) : Vec3(2 * of_middles - of_corners));
    take_thickness(centre, std::span(nodes).first(static_cast<size_t>(corners)));
    auto& of = children_[c];
    for (int k = 0; k < corners; ++k) of.push_back({nodes[k], mid[k], centre, mid[(k + corners - 1) % corners]});
    n_made_ += corners;
  }

  /// The section of child k, of as many as the parent has corners.
  static ThinSection child(const ThinSection& parent, size_t k, size_t corners) {
    ThinSection out = parent;
    if (parent.own[0] == 0) return out;
    double centre = 0;
    for (size_t i = 0; i < corners; ++i) centre += parent.own[i] / static_cast<double>(corners);
    out.own = {parent.own[k], parent.thickness_at(corners + k, corners), centre,
               parent.thickness_at(corners + (k + corners - 1) % corners, corners)};
    return out;
  }

  /// The first child stands where its parent stood, the others behind all cells.
  void rebuild() {
    Mesh& m = m_;
    Mesh cells;
    for (std::int64_t c = 0; c < m.n_cells(); ++c)
      if (const auto of = children_.find(c); of != children_.end())
        cells.add_cell(quad4, of->second[0], m.region[c], m.cell_id[c]);
      else
        cells.add_cell(static_cast<Shape>(m.shape[c]), m.cell(c), m.region[c], m.cell_id[c]);
    std::int64_t id = *std::ranges::max_element(m.cell_id);
    for (auto& [c, of] : children_) {
      const bool is_plain = std::ranges::all_of(of, [&](const auto& piece) { return piece[1] >= first_new_; });
      const ThinSection whole = in_.thin.at(c);
      in_.thin.at(c) = child(whole, 0, of.size());
      for (size_t k = 1; k < of.size(); ++k) {
        behind_[c].push_back(cells.n_cells());
        if (is_plain) in_.piece_of[cells.n_cells()] = c;
        cells.add_cell(quad4, of[k], m.region[c], ++id);
        in_.thin.emplace(behind_[c].back(), child(whole, k, of.size()));
      }
    }
    replace_cells(m, std::move(cells));
    for (auto& [name, set] : m.cell_sets)
      for (size_t k = 0, n = set.size(); k < n; ++k)
        if (const auto more = behind_.find(set[k]); more != behind_.end()) set.insert(set.end(), more->second.begin(), more->second.end());
    for (auto& [name, set] : m.facet_sets)
      for (size_t k = 0, n = set.size(); k < n; ++k)
        if (const auto more = behind_.find(set[k].cell); more != behind_.end())
          for (const auto c : more->second) set.push_back({c, set[k].facet});
  }

  /// A new node in the middle of an edge is in the sets that both ends are in; supports hold of it what they hold of both.
  void complete_sets() {
    std::map<std::string, std::vector<char>> inside;
    for (const auto& [name, set] : m_.node_sets) {
      if (in_.as_listed.contains(name)) continue;
      auto& is = inside[name];
      is.assign(m_.X.size(), 0);
      for (const auto a : set) is[a] = 1;
    }
    const auto supports = in_.scene.ends({"motion"});
    for (const auto& [ends, middle] : middle_) {
      if (middle < first_new_) continue;
      const auto held = [&](std::int64_t a) { return in_.held.contains(a) ? in_.held.at(a) : 0U; };
      const unsigned both = held(ends.first) & held(ends.second);
      const auto like = held(ends.first) == both ? ends.first : ends.second;
      if (both && held(like) != both)
        throw Error(file_,
                    fmt::format("nodes {} and {} of an edge are held in different components, and the middle of the edge in both",
                                m_.node_id[ends.first], m_.node_id[ends.second]),
                    "quadrangles, or the supports of one of them");
      if (both) in_.held[middle] = both;
      for (auto& [name, is] : inside)
        if ((is[ends.first] && is[ends.second]) || (both && is[like] && supports.contains(name))) m_.node_sets.at(name).push_back(middle);
    }
  }

  Imported& in_;
  Mesh& m_;
  const std::string& file_;
  std::vector<std::int64_t> cells_;
  std::map<Edge, std::int64_t> middle_;
  std::map<std::int64_t, std::vector<std::array<std::int64_t, 4>>> children_;
  std::map<std::int64_t, std::vector<std::int64_t>> behind_;  // children of a cell but the first
  std::int64_t first_new_ = 0, next_id_ = 1, n_made_ = 0;
};

}  // namespace

bool is_divided(const Imported& in) {
  return std::ranges::any_of(in.thin, [&](const auto& one) {
    return info(in.mesh.shape[one.first]).dimension == 2 && static_cast<Shape>(in.mesh.shape[one.first]) != quad4;
  });
}

void divide_surfaces(Imported& in, const std::string& file) { Dividing(in, file).run(); }

}  // namespace hilo
