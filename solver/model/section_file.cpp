// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/section_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "model/section_msh.hpp"

namespace hilo {
namespace {

using Eigen::Vector2d;
using Cell = std::array<int, 9>;

/// A face in the making: checked step by step.
class Face {
 public:
  explicit Face(const SectionMsh& read) : read_(read) {}

  SectionMesh made() {
    if (read_.elements.empty())
      read_.fail_at(0, "no triangles or quadrangles", "mesh the face in 2-D; where the file has physical groups, the face must be in one");
    take_nodes();
    for (const SectionMsh::Element& e : read_.elements) take(e);
    if (size_ == 0) refuse(0, "the face has no area", "mesh the face again");
    orient();
    refuse_coinciding();
    join();
    refuse_crossing();
    return std::move(mesh_);
  }

 private:
  using Edge = std::pair<int, int>;
  static Edge edge(int a, int b) { return std::minmax(a, b); }
  [[noreturn]] void refuse(size_t cell, const std::string& what, const std::string& hint) const {
    read_.fail_at(read_.elements[cell].line, what, hint);
  }
  std::string at(int node) const {
    const Vector2d& x = mesh_.X[static_cast<size_t>(node)];
    return fmt::format("({:.6g}, {:.6g})", x.x(), x.y());
  }

  void take_nodes() {
    double low = 1e300, high = -1e300;
    Vector2d least = Vector2d::Constant(1e300), most = -least;
    for (const SectionMsh::Element& e : read_.elements)
      for (int i = 0; i < e.nodes; ++i) {
        const auto found = read_.nodes.find(e.node[static_cast<size_t>(i)]);
        if (found == read_.nodes.end()) read_.fail_at(e.line, fmt::format("no node {}", e.node[static_cast<size_t>(i)]));
        const Vec3& x = found->second.first;
        if (number_.emplace(found->first, static_cast<int>(mesh_.X.size())).second) mesh_.X.push_back(x.head<2>());
        low = std::min(low, x.z()), high = std::max(high, x.z());
        least = least.cwiseMin(x.head<2>()), most = most.cwiseMax(x.head<2>());
        if (high - low > 1e-6 * (most - least).norm() + 1e-9 * std::abs(low)) off_ = off_ ? off_ : found->second.second;
      }
    size_ = (most - least).norm();
    if (high - low > 1e-6 * size_)
      read_.fail_at(off_ ? off_ : read_.elements.front().line, fmt::format("the face is not plane: z is from {:.6g} to {:.6g}", low, high),
                    "draw it in the plane of x and y: x lies along axis 1 of the section, y along axis 2");
  }

  void take(const SectionMsh::Element& e) {
    Cell cell;
    cell.fill(SectionMesh::none);
    const int c = e.corners, n = e.nodes;
    for (int i = 0; i < n; ++i) cell[static_cast<size_t>(i)] = number_.at(e.node[static_cast<size_t>(i)]);
    const size_t here = mesh_.cells.size();
    for (int i = 0; i < c; ++i) {
      const int a = cell[i], b = cell[(i + 1) % c];
      if (a == b) refuse(here, "a cell has a node twice", "mesh the face again");
      auto [mid, is_new] = mid_.emplace(edge(a, b), n > c ? cell[c + i] : SectionMesh::none);
      if (is_new && n == c) {
        mid->second = static_cast<int>(mesh_.X.size());
        mesh_.X.emplace_back((mesh_.X[a] + mesh_.X[b]) / 2);
      }
      if (n > c && mid->second != cell[c + i])
        refuse(here, fmt::format("two cells at {} share an edge and not its mid-node", at(a)), "mesh all of the face with one order");
      cell[c + i] = mid->second;
    }
    if (c == 4 && n < 9) {  // where the shape functions of 8 nodes have it; of straight edges the mean of the corners
      Vector2d x = Vector2d::Zero();
      for (int i = 0; i < 4; ++i) x += mesh_.X[cell[4 + i]] / 2 - mesh_.X[cell[i]] / 4;
      cell[8] = static_cast<int>(mesh_.X.size());
      mesh_.X.push_back(x);
    }
    mesh_.cells.push_back(cell);
  }

  void refuse_coinciding() const {
    std::vector<int> order(mesh_.X.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return mesh_.X[a].x() < mesh_.X[b].x(); });
    const double near = 1e-7 * size_;
    std::map<std::int64_t, int> row;  // of the nodes of about one x, by y
    size_t first = 0;
    for (size_t i = 0; i < order.size(); ++i) {
      const Vector2d& x = mesh_.X[order[i]];
      const auto cell_of = [&](const Vector2d& p) { return static_cast<std::int64_t>(std::floor((p.y() - mesh_.X[0].y()) / near)); };
      for (; mesh_.X[order[first]].x() < x.x() - near; ++first)
        if (const auto found = row.find(cell_of(mesh_.X[order[first]])); found != row.end() && found->second == order[first])
          row.erase(found);
      for (std::int64_t k = cell_of(x) - 1; k <= cell_of(x) + 1; ++k)
        if (const auto found = row.find(k); found != row.end() && (mesh_.X[found->second] - x).norm() < near)
          read_.fail_at(line_of(order[i]),
                        fmt::format("two nodes are at {}: parts of the face touch and do not hang together", at(order[i])),
                        "one node for both: in gmsh \"Coherence;\" (BooleanFragments in OpenCASCADE), or \"Coherence Mesh;\"");
      row[cell_of(x)] = order[i];
    }
  }
  int line_of(int node) const {
    for (size_t c = 0; c < mesh_.cells.size(); ++c)
      if (std::find(mesh_.cells[c].begin(), mesh_.cells[c].end(), node) != mesh_.cells[c].end()) return read_.elements[c].line;
    return 1;
  }

  /// Counter-clockwise, all of them: some programs draw faces from below.
  void orient() {
    for (size_t c = 0; c < mesh_.cells.size(); ++c) {
      Cell& cell = mesh_.cells[c];
      auto [low, high] = extreme_jacobian(mesh_, cell, size_);
      if (high < 0) {
        cell = SectionMesh::is_triangle(cell) ? Cell{cell[0], cell[2], cell[1], cell[5], cell[4], cell[3], -1, -1, -1}
                                              : Cell{cell[0], cell[3], cell[2], cell[1], cell[7], cell[6], cell[5], cell[4], cell[8]};
        std::tie(low, high) = std::pair{-high, -low};
      }
      if (std::max(-low, high) < 1e-13) refuse(c, fmt::format("a cell at {} has no area", at(cell[0])), "mesh the face again");
      if (low < 1e-3 * high)
        refuse(c, fmt::format("a cell at {} is turned inside out", at(cell[0])),
               "a smaller size, Mesh.ElementOrder = 1, or Mesh.HighOrderOptimize = 2");
    }
  }

  /// Neighbours lie on both sides of what they share, and each cell is reached from the first one over edges.
  void join() {
    std::map<Edge, std::vector<size_t>> of_edge;
    const auto each_edge = [&](size_t c, const auto& use) {
      const Cell& cell = mesh_.cells[c];
      const int n = SectionMesh::is_triangle(cell) ? 3 : 4;
      for (int i = 0; i < n; ++i) use(cell[i], cell[(i + 1) % n], cell[n + i]);
    };
    std::map<std::pair<int, int>, size_t> directed;
    for (size_t c = 0; c < mesh_.cells.size(); ++c)
      each_edge(c, [&](int a, int b, int) {
        if (!directed.emplace(std::pair{a, b}, c).second)
          refuse(c, fmt::format("two cells at {} lie on one another", at(a)), "a face covers each place once");
        of_edge[edge(a, b)].push_back(c);
      });
    std::vector<size_t> open{0};
    std::vector<bool> reached(mesh_.cells.size());
    for (reached[0] = true; !open.empty();) {
      const size_t c = open.back();
      open.pop_back();
      each_edge(c, [&](int a, int b, int) {
        for (const size_t other : of_edge.at(edge(a, b)))
          if (!reached[other]) reached[other] = true, open.push_back(other);
      });
    }
    if (const auto missed = std::find(reached.begin(), reached.end(), false); missed != reached.end()) {
      const auto c = static_cast<size_t>(missed - reached.begin());
      refuse(
          c,
          fmt::format("the face falls into parts: that at {} shares no edge with that at {}", at(mesh_.cells[c][0]), at(mesh_.cells[0][0])),
          "parts that are joined along the beam alone are beams of their own; parts that touch need common nodes");
    }
    std::map<int, int> leaving;
    for (size_t c = 0; c < mesh_.cells.size(); ++c)
      each_edge(c, [&](int a, int b, int mid) {
        if (of_edge.at(edge(a, b)).size() > 1) return;
        if (++leaving[a] > 1)
          refuse(c, fmt::format("parts of the face meet in the point {} alone", at(a)), "let them share an edge, or part them");
        const Vector2d &p = mesh_.X[a], &q = mesh_.X[b], &m = mesh_.X[mid];
        const bool straight = (m - (p + q) / 2).norm() < 1e-6 * (q - p).norm();
        const int n = straight ? 1 : 4;
        for (int k = 0; k < n; ++k) {
          const auto on = [&](double t) { return Vector2d((1 - t) * (1 - 2 * t) * p + 4 * t * (1 - t) * m + t * (2 * t - 1) * q); };
          border_.push_back({on(static_cast<double>(k) / n), on((k + 1.0) / n), a, b, c});
        }
      });
  }

  struct Piece {
    Vector2d from, to;
    int a, b;  // the corners of its edge
    size_t cell;
  };
  static double side(const Vector2d& a, const Vector2d& b, const Vector2d& x) {
    return (b - a).x() * (x - a).y() - (b - a).y() * (x - a).x();
  }
  static double distance(const Piece& s, const Vector2d& x) {
    const Vector2d d = s.to - s.from;
    return (x - s.from - std::clamp((x - s.from).dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm();
  }

  void refuse_crossing() {
    std::sort(border_.begin(), border_.end(),
              [](const Piece& s, const Piece& t) { return std::min(s.from.x(), s.to.x()) < std::min(t.from.x(), t.to.x()); });
    const double near = 1e-9 * size_;
    for (size_t i = 0; i < border_.size(); ++i)
      for (size_t k = i + 1; k < border_.size(); ++k) {
        const Piece &s = border_[i], &t = border_[k];
        if (std::min(t.from.x(), t.to.x()) > std::max(s.from.x(), s.to.x()) + near) break;
        if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) continue;
        if (std::min(t.from.y(), t.to.y()) > std::max(s.from.y(), s.to.y()) + near ||
            std::min(s.from.y(), s.to.y()) > std::max(t.from.y(), t.to.y()) + near)
          continue;
        if (side(s.from, s.to, t.from) * side(s.from, s.to, t.to) < 0 && side(t.from, t.to, s.from) * side(t.from, t.to, s.to) < 0)
          refuse(t.cell, fmt::format("the border of the face crosses itself near {}", at(t.a)), "a face covers each place once");
        for (const auto& [piece, x] : {std::pair{&s, t.from}, {&s, t.to}, {&t, s.from}, {&t, s.to}})
          if (distance(*piece, x) < near)
            refuse(t.cell,
                   fmt::format("a node lies on an edge without a node of it near {}: parts touch and do not hang together", at(t.a)),
                   "one mesh for both: in gmsh \"Coherence;\" (BooleanFragments in OpenCASCADE)");
      }
  }

  const SectionMsh& read_;
  std::unordered_map<std::int64_t, int> number_;
  std::map<Edge, int> mid_;
  SectionMesh mesh_;
  std::vector<Piece> border_;
  double size_ = 0;
  int off_ = 0;
};

}  // namespace

SectionMesh section_mesh_of(const std::string& text, const std::string& path) {
  const SectionMsh file = read_section_msh(text, path);
  return Face(file).made();
}

}  // namespace hilo
