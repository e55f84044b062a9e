// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrangles of a mid-surface become solid-shells: each node a pair across the thickness, along the mean of the normals around it.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <unordered_map>

#include "base/error.hpp"
#include "base/shell_shape.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

/// Normals of neighbouring cells further apart than this make a fold [rad].
constexpr double most_bend = 40 * M_PI / 180;

class Thickening {
 public:
  Thickening(Imported& in, const std::string& file) : in_(in), m_(in.mesh), file_(file) {
    for (const auto& [c, unused] : in.thin)
      if (info(m_.shape[c]).dimension == 2) cells_.push_back(c);
  }

  void run() {
    if (cells_.empty()) throw Error(file_, "there are no shells to be thickened", "S3 to S8R, CTRIA3 to CQUAD8, or surfaces");
    check_cells();
    turn_alike();
    pair_nodes();
    rebuild();
    edges_and_faces();
    in_.notes.push_back(fmt::format("{} quadrangles became solid-shells, {} nodes pairs", cells_.size(), top_.size()));
  }

 private:
  [[noreturn]] void refuse(std::int64_t c, const std::string& why,
                           const char* hint = "leave them as they are: regions that are rigid") const {
    throw Error(file_, fmt::format("element {}: {}", m_.cell_id[c], why), hint);
  }
  const ThinSection& section(std::int64_t c) const { return in_.thin.at(c); }

  void check_cells() {
    std::vector<char> of_solid(m_.X.size(), 0);
    for (std::int64_t c = 0; c < m_.n_cells(); ++c)
      if (info(m_.shape[c]).dimension != 2)
        for (const auto a : m_.cell(c)) of_solid[a] = 1;
    for (const auto c : cells_) {
      if (!section(c).no_solid.empty()) refuse(c, section(c).no_solid + " is no plate of one material");
      for (const auto a : m_.cell(c))
        if (of_solid[a]) refuse(c, fmt::format("node {} is of a solid or bar too: a pair of nodes does not fit", m_.node_id[a]));
    }
  }

  /// Cells numbered so that neighbours have their normals on the same side.
  void turn_alike() {
    using Edge = std::pair<std::int64_t, std::int64_t>;
    struct Side {
      std::int64_t cell;
      bool forward;
    };
    std::map<Edge, std::vector<Side>> sides;
    for (const auto c : cells_)
      for (int k = 0; k < 4; ++k) {
        const auto a = m_.cell(c)[k], b = m_.cell(c)[(k + 1) % 4];
        sides[std::minmax(a, b)].push_back({c, a < b});
      }
    for (const auto& [edge, list] : sides)
      if (list.size() > 2)
        refuse(list[2].cell, fmt::format("more than two shells meet in nodes {} and {}", m_.node_id[edge.first], m_.node_id[edge.second]));
    for (const auto start : cells_) {
      if (!turned_.try_emplace(start, false).second) continue;
      std::deque<std::int64_t> open{start};
      while (!open.empty()) {
        const auto c = open.front();
        open.pop_front();
        for (int k = 0; k < 4; ++k) {
          const auto& list = sides.at(std::minmax(m_.cell(c)[k], m_.cell(c)[(k + 1) % 4]));
          if (list.size() < 2) continue;
          const Side &own = list[0].cell == c ? list[0] : list[1], &other = list[0].cell == c ? list[1] : list[0];
          const bool turn = (own.forward == other.forward) != turned_.at(c);
          const auto [it, fresh] = turned_.try_emplace(other.cell, turn);
          if (fresh)
            open.push_back(other.cell);
          else if (it->second != turn)
            refuse(c, "the surface has one side alone, as a Moebius strip");
        }
      }
    }
    for (const auto c : cells_)
      if (turned_.at(c) && section(c).offset != 0) refuse(c, "its normal points away from its neighbours', and it has an offset");
  }

  Vec3 normal(std::int64_t c) const {
    const auto n = m_.cell(c);
    const Vec3 d = (m_.X[n[2]] - m_.X[n[0]]).cross(m_.X[n[3]] - m_.X[n[1]]);
    return (turned_.at(c) ? -1 : 1) * d.normalized();
  }

  void pair_nodes() {
    std::map<std::int64_t, std::vector<std::int64_t>> around;
    std::map<std::int64_t, Vec3> normals;  // before any node moves
    for (const auto c : cells_) {
      normals[c] = normal(c);
      for (const auto a : m_.cell(c)) around[a].push_back(c);
    }
    std::int64_t id = *std::max_element(m_.node_id.begin(), m_.node_id.end());
    for (const auto& [a, list] : around) {
      Vec3 n = Vec3::Zero();
      for (const auto c : list) n += normals.at(c);
      n.normalize();
      const ThinSection& own = section(list.front());
      for (const auto c : list) {
        if (!(normals.at(c).dot(n) > std::cos(most_bend / 2)))
          refuse(c, fmt::format("the surface is folded at node {}: its normals differ by more than 40 degrees", m_.node_id[a]));
        if (section(c).thickness != own.thickness || section(c).offset != own.offset)
          refuse(c, fmt::format("thickness or offset steps at node {}", m_.node_id[a]));
      }
      if (const auto held = in_.held.find(a); held != in_.held.end()) check_support(list.front(), a, held->second, n);
      const Vec3 middle = m_.X[a] + own.offset * n;
      top_[a] = m_.n_nodes();
      m_.X.push_back(middle + own.thickness / 2 * n);
      m_.node_id.push_back(++id);
      m_.X[a] = middle - own.thickness / 2 * n;
    }
  }

  /// A support holds both nodes of a pair or none: (turn x n)_i is held with place i.
  void check_support(std::int64_t c, std::int64_t a, unsigned bits, const Vec3& n) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double lever = i == j ? 0 : std::abs(n[3 - i - j]);
        if (lever > 1e-3 && (bits >> i & 1U) != (bits >> (3 + j) & 1U))
          refuse(c,
                 fmt::format("node {} is held along {} {} about {}: a pair of nodes is held in both or in none", m_.node_id[a], "xyz"[i],
                             bits >> i & 1U ? "and free to turn" : "not at all, but not free to turn", "xyz"[j]),
                 "clamp it or hold it as symmetry does; or leave --thicken away");
      }
  }

  void rebuild() {
    Mesh& m = m_;
    std::vector<std::int64_t> nodes, offset{0};
    for (std::int64_t c = 0; c < m.n_cells(); ++c) {
      const auto own = m.cell(c);
      std::vector<std::int64_t> cell(own.begin(), own.end());
      if (const auto t = turned_.find(c); t != turned_.end()) {
        if (t->second) std::reverse(cell.begin(), cell.end());
        for (int k = 0; k < 4; ++k) cell.push_back(top_.at(cell[k]));
        m.shape[c] = static_cast<std::uint8_t>(shell8);
      }
      nodes.insert(nodes.end(), cell.begin(), cell.end());
      offset.push_back(static_cast<std::int64_t>(nodes.size()));
    }
    m.nodes = std::move(nodes), m.offset = std::move(offset);
    for (auto& [name, set] : m.node_sets) {
      for (size_t k = 0, n = set.size(); k < n; ++k)
        if (const auto pair = top_.find(set[k]); pair != top_.end()) set.push_back(pair->second);
      std::sort(set.begin(), set.end());
    }
    for (auto& [name, set] : m.facet_sets)  // the outward side of a quadrangle is that of its own normal
      for (Facet& f : set)
        if (const auto t = turned_.find(f.cell); t != turned_.end()) f.facet = t->second ? 4 : 5;
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
  std::vector<std::int64_t> cells_;
  std::map<std::int64_t, bool> turned_;       // by cell: numbered against its neighbours
  std::map<std::int64_t, std::int64_t> top_;  // of each node, which stays below
};

}  // namespace

bool is_of_shell(const Imported& in, std::int64_t node) {
  if (in.of_shells.empty())
    for (const auto& [c, unused] : in.thin)
      if (info(in.mesh.shape[c]).dimension == 2) in.of_shells.insert(in.mesh.cell(c).begin(), in.mesh.cell(c).end());
  return in.of_shells.contains(node);
}

void thicken(Imported& in, const std::string& file) {
  divide_surfaces(in, file);
  Thickening(in, file).run();
}

}  // namespace hilo
