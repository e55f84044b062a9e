// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrangles of a mid-surface become solid-shells: each node a pair across the thickness for each sheet that it is in, along the mean of
// the normals there.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

#include "base/error.hpp"
#include "base/shell_shape.hpp"
#include "import/imported.hpp"
#include "import/sheets.hpp"
#include "import/shell_rows.hpp"

namespace hilo {
namespace {

class Thickening {
 public:
  Thickening(Imported& in, const std::string& file) : in_(in), m_(in.mesh), file_(file), sheets_(in) {
    for (const auto& [c, unused] : in.thin)
      if (info(m_.shape[c]).dimension == 2) cells_.push_back(c);
  }

  void run() {
    if (cells_.empty()) throw Error(file_, "there are no shells to be thickened", "S3 to S8R, CTRIA3 to CQUAD8, or surfaces");
    check_cells();
    look_for_short_rows();
    pair_nodes();
    rebuild();
    edges_and_faces();
    in_.notes.push_back(fmt::format("{} quadrangles became solid-shells, {} nodes pairs", cells_.size(), n_pairs_));
    if (!m_.block_name.empty())
      in_.notes.push_back(fmt::format("{} nodes of folds, edges of several shells, steps of thickness, beams and moments are rigid blocks",
                                      m_.block_name.size()));
    if (const auto& folded = sheets_.folded(); !folded.empty()) {
      const Vec3 X = m_.X[m_.cell(folded[0])[0]];
      in_.notes.push_back(
          fmt::format("warning: {} shells lie on a neighbour, edge on edge, as those of a mesher's mistake do: the first is "
                      "element {}, at ({:.4g}, {:.4g}, {:.4g})",
                      folded.size(), m_.cell_id[folded[0]], X[0], X[1], X[2]));
    }
    if (n_hinges_ > 0) in_.notes.push_back(fmt::format("{} nodes of shells are nodes of solids too, which do not turn: hinges", n_hinges_));
  }

 private:
  struct Pair {
    std::int64_t below, above;
  };

  [[noreturn]] void refuse(std::int64_t c, const std::string& why,
                           const char* hint = "leave them as they are: regions that are rigid") const {
    throw Error(file_, fmt::format("element {}: {}", m_.cell_id[c], why), hint);
  }

  /// A surface of few shells between folds and clamps is far too stiff there, and its answer looks like any other.
  void look_for_short_rows() {
    const ShortRows rows = short_rows(in_, sheets_, cells_);
    if (rows.cell < 0) return;
    Vec3 X = Vec3::Zero();
    for (const auto a : m_.cell(rows.cell)) X += m_.X[a] / 4;
    const std::string off =
        rows.fewest < 3 ? "hardly bend" : fmt::format("bend up to {:.0f} % too little", 400. / (rows.fewest * rows.fewest));
    in_.notes.push_back(
        fmt::format("warning: {} shells stand in rows of less than {} from a fold or clamp to the next; the shortest has {}, at ({:.4g}, "
                    "{:.4g}, {:.4g}): "
                    "so few {} (more elements across; mid-side nodes do not help)",
                    rows.n_shells, enough_in_a_row, rows.fewest, X[0], X[1], X[2], off));
  }

  void check_cells() {
    for (std::int64_t c = 0; c < m_.n_cells(); ++c)
      if (info(m_.shape[c]).dimension != 2) of_solid_.insert(m_.cell(c).begin(), m_.cell(c).end());
    for (const auto c : cells_)
      if (const std::string& why = in_.thin.at(c).no_solid; !why.empty()) refuse(c, why + " is no plate of one material");
  }

  /// A pair along the mean of the normals for each sheet that a node is in.  Of several pairs, and where the scene's lines have a body of
  /// the node, a block that moves as one is made.
  void pair_nodes() {
    std::int64_t id = *std::max_element(m_.node_id.begin(), m_.node_id.end());
    const auto new_node = [&](const Vec3& X) {
      m_.X.push_back(X), m_.node_id.push_back(++id);
      return m_.n_nodes() - 1;
    };
    for (const auto& [a, parts] : sheets_.all()) {
      const bool of_solid = of_solid_.contains(a);
      const auto body = in_.body_of_node.find(a);
      const auto held = in_.held.find(a);
      std::vector<std::int64_t> all;
      if (of_solid) all.push_back(a), ++n_hinges_;
      const Vec3 X = m_.X[a];
      for (const Sheets::Part& part : parts) {
        if (held != in_.held.end() && body == in_.body_of_node.end() && !bears_support(held->second, part.normal))
          refuse(part.cells.front(),
                 fmt::format("node {} in the middle of an edge is held as a hinge is, and a pair of nodes cannot be", m_.node_id[a]),
                 "clamp it or hold it as symmetry does; elements without mid-side nodes");
        const auto own = in_.thickness_at.find(a);
        const double thickness = own != in_.thickness_at.end() ? own->second : part.thickness;
        const Vec3 middle = X + part.offset * part.normal;
        const Vec3 below = middle - thickness / 2 * part.normal, above = middle + thickness / 2 * part.normal;
        Pair pair{a, 0};
        if (all.empty())
          m_.X[a] = below;
        else
          pair.below = new_node(below);
        pair.above = new_node(above);
        for (const auto c : part.cells) pair_[{c, a}] = pair;
        all.insert(all.end(), {pair.below, pair.above});
        ++n_pairs_;
      }
      if (const auto counted = in_.nodes_counted.find(a); counted != in_.nodes_counted.end() && counted->second != all.size())
        refuse(
            parts.front().cells.front(),
            fmt::format("whether the surface is folded at node {}, which has a force, is not clear: its normals are about 40 degrees apart",
                        m_.node_id[a]));
      if (body != in_.body_of_node.end() || parts.size() > 1 || of_solid) {
        for (const auto i : all) block_[i] = static_cast<std::int64_t>(m_.block_name.size());
        m_.block_name.push_back(body != in_.body_of_node.end() ? body->second : fmt::format("block_{}", m_.node_id[a]));
        m_.block_at.push_back(X);
      }
      all_[a] = std::move(all);
    }
    if (block_.empty()) return;
    m_.block.assign(m_.X.size(), -1);
    for (const auto& [i, block] : block_) m_.block[i] = block;
  }

  void rebuild() {
    Mesh& m = m_;
    Mesh cells;
    for (std::int64_t c = 0; c < m.n_cells(); ++c) {
      const auto own = m.cell(c);
      std::vector<std::int64_t> cell(own.begin(), own.end());
      const bool is_shell = std::ranges::binary_search(cells_, c);
      if (is_shell) {
        if (sheets_.is_turned(c)) std::reverse(cell.begin(), cell.end());
        std::vector<std::int64_t> above;
        for (auto& a : cell) {
          const Pair& pair = pair_.at({c, a});
          above.push_back(pair.above), a = pair.below;
        }
        cell.insert(cell.end(), above.begin(), above.end());
      }
      cells.add_cell(is_shell ? shell8 : static_cast<Shape>(m.shape[c]), cell, m.region[c], m.cell_id[c]);
    }
    replace_cells(m, std::move(cells));
    for (auto& [name, set] : m.node_sets) {
      for (size_t k = 0, n = set.size(); k < n; ++k)
        if (const auto all = all_.find(set[k]); all != all_.end()) set.insert(set.end(), all->second.begin(), all->second.end());
      sort_unique(set);
    }
    for (auto& [name, set] : m.facet_sets) {  // the outward side of a quadrangle is that of its own normal
      const bool below = in_.below.contains(name);
      for (Facet& f : set)
        if (std::binary_search(cells_.begin(), cells_.end(), f.cell)) f.facet = sheets_.is_turned(f.cell) != below ? 4 : 5;
    }
    for (const auto c : cells_) in_.thin.erase(c);
  }

  /// Node sets that are whole edges of the shells become facet sets; the faces of each region get sets of their own.
  void edges_and_faces() {
    Mesh& m = m_;
    const std::vector<Facet> free = free_facets(m, cells_);
    for (auto it = m.node_sets.begin(); it != m.node_sets.end();) {
      std::unordered_map<std::int64_t, char> met;
      for (const auto a : it->second) met[a] = 0;
      std::vector<Facet> sides;
      for (const Facet& f : free) {
        if (f.facet > 3) continue;
        const auto nodes = m.facet_nodes(f);
        if (!std::all_of(nodes.begin(), nodes.end(), [&](std::int64_t a) { return met.contains(a); })) continue;
        sides.push_back(f);
        for (const auto a : nodes) met[a] = 1;
      }
      if (!sides.empty() && !in_.as_listed.contains(it->first) &&
          std::all_of(met.begin(), met.end(), [](const auto& one) { return one.second != 0; })) {
        m.facet_sets[it->first] = std::move(sides);
        it = m.node_sets.erase(it);
      } else {
        ++it;
      }
    }
    std::map<int, std::array<std::vector<Facet>, 2>> faces;
    for (const auto c : cells_)
      for (const int side : {0, 1}) faces[m.region[c]][static_cast<size_t>(side)].push_back({c, 4 + side});
    for (auto& [region, both] : faces) {
      SetNames(in_).facets(m.region_name[static_cast<size_t>(region)] + "_bottom", std::move(both[0]));
      SetNames(in_).facets(m.region_name[static_cast<size_t>(region)] + "_top", std::move(both[1]));
    }
  }

  Imported& in_;
  Mesh& m_;
  const std::string& file_;
  const Sheets sheets_;
  std::vector<std::int64_t> cells_;  // sorted
  std::set<std::int64_t> of_solid_;
  std::map<std::pair<std::int64_t, std::int64_t>, Pair> pair_;  // of a cell at a node
  std::map<std::int64_t, std::vector<std::int64_t>> all_;       // nodes that a node became
  std::map<std::int64_t, std::int64_t> block_;                  // of nodes
  std::int64_t n_pairs_ = 0, n_hinges_ = 0;
};

}  // namespace

void thicken(Imported& in, const std::string& file) {
  divide_surfaces(in, file);
  Thickening(in, file).run();
}

}  // namespace hilo
