// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/section_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "base/error.hpp"

namespace hilo {
namespace {

using Eigen::Vector2d;
using Cell = std::array<int, 9>;

constexpr size_t most_cells = 50'000;
constexpr const char* how_to_write = "gmsh writes it as text with Mesh.Binary = 0 and Mesh.MshFileVersion = 2.2 or 4.1";

/// Lines of numbers, with their place.
class Lines {
 public:
  Lines(const std::string& text, const std::string& path) : text_(text), path_(path) {}
  bool next() {
    if (end_ >= text_.size()) return false;
    const size_t begin = end_;
    const size_t stop = std::min(text_.find('\n', begin), text_.size());
    line_ = std::string_view(text_).substr(begin, stop - begin);
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.remove_suffix(1);
    end_ = stop + 1, ++number_, at_ = 0;
    return true;
  }
  void need(std::string_view what) {
    if (!next()) fail(fmt::format("the file ends before {}", what), "the file is cut off: write it again");
  }
  std::string_view line() const { return line_; }
  int number() const { return number_; }
  template <class T>
  bool take(T& x) {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
    const char *from = line_.data() + at_, *to = line_.data() + line_.size();
    const auto [stop, code] = std::from_chars(from, to, x);
    if (code != std::errc() || (stop != to && *stop != ' ' && *stop != '\t')) return false;
    at_ += static_cast<size_t>(stop - from);
    return true;
  }
  template <class T>
  T get(std::string_view what) {
    T x{};
    if (!take(x)) fail(fmt::format("{} is expected here", what));
    return x;
  }
  [[noreturn]] void fail(const std::string& what, const std::string& hint = "") const { fail_at(number_, at_ + 1, what, hint); }
  [[noreturn]] void fail_at(int number, size_t column, const std::string& what, const std::string& hint = "") const {
    throw Error(fmt::format("{}:{}:{}", path_, std::max(number, 1), column), what, hint);
  }

 private:
  const std::string &text_, &path_;
  std::string_view line_;
  size_t end_ = 0, at_ = 0;
  int number_ = 0;
};

/// Elements of gmsh by their number.
struct FaceElement {
  int type, dimension, corners, nodes;
  const char* name;
};
constexpr FaceElement face_elements[] = {{15, 0, 1, 1, "points"},      {1, 1, 2, 2, "lines"},       {8, 1, 2, 3, "lines"},
                                         {26, 1, 2, 4, "lines"},       {27, 1, 2, 5, "lines"},      {28, 1, 2, 6, "lines"},
                                         {2, 2, 3, 3, "triangles"},    {9, 2, 3, 6, "triangles"},   {3, 2, 4, 4, "quadrangles"},
                                         {16, 2, 4, 8, "quadrangles"}, {10, 2, 4, 9, "quadrangles"}};
const FaceElement& element_of(const Lines& lines, int type) {
  for (const FaceElement& k : face_elements)
    if (k.type == type) return k;
  constexpr int solids[] = {4, 5, 6, 7, 11, 12, 13, 14, 17, 18, 19};
  if (std::find(std::begin(solids), std::end(solids), type) != std::end(solids))
    lines.fail("a solid: a section is a face", "mesh it in 2-D (gmsh -2), and save the surface alone");
  lines.fail(fmt::format("elements of type {} of gmsh are no cells of a section", type),
             "triangles of 3 or 6 nodes, quadrangles of 4, 8 or 9: Mesh.ElementOrder = 1 or 2");
}

struct Read {
  struct Element {
    const FaceElement* kind;
    std::array<std::int64_t, 9> node;
    int line;
  };
  std::unordered_map<std::int64_t, std::pair<Vec3, int>> nodes;  // place and line
  std::vector<Element> elements;

  void add_node(const Lines& lines, std::int64_t tag, const Vec3& x) {
    if (!x.allFinite() || x.cwiseAbs().maxCoeff() > 1e12) lines.fail("this is no place of a section");
    if (!nodes.emplace(tag, std::pair{x, lines.number()}).second) lines.fail(fmt::format("node {} stands twice", tag));
  }
  void add_element(Lines& lines, const FaceElement& kind) {
    if (kind.dimension < 2) return;
    Element e{&kind, {}, lines.number()};
    for (int i = 0; i < kind.nodes; ++i) e.node[static_cast<size_t>(i)] = lines.get<std::int64_t>("a node");
    elements.push_back(e);
    if (elements.size() > most_cells)
      lines.fail(fmt::format("more than {} cells: a section needs some hundreds", most_cells), "mesh it with a larger size");
  }
};

/// How many lines a block has; no more than there are characters.
std::int64_t count(Lines& lines, std::string_view what, size_t most) {
  const auto n = lines.get<std::int64_t>(what);
  if (n < 0 || static_cast<size_t>(n) > most) lines.fail(fmt::format("{} {} in a file of {} bytes", n, what, most));
  return n;
}

Vec3 place(Lines& lines) {
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = lines.get<double>("a coordinate");
  return x;
}

void read_nodes(Lines& lines, bool is_2, size_t bytes, Read& out) {
  lines.need("the nodes");
  const std::int64_t n = count(lines, is_2 ? "nodes" : "blocks of nodes", bytes);
  for (std::int64_t i = 0; is_2 && i < n; ++i) {
    lines.need("a node");
    const auto tag = lines.get<std::int64_t>("the number of a node");
    out.add_node(lines, tag, place(lines));
  }
  for (std::int64_t b = 0; !is_2 && b < n; ++b) {
    lines.need("a block of nodes");
    for (int k = 0; k < 3; ++k) (void)lines.get<int>("dimension, number and parameters of a block");
    const std::int64_t m = count(lines, "nodes", bytes);
    std::vector<std::int64_t> tags;
    for (std::int64_t i = 0; i < m; ++i) lines.need("a node"), tags.push_back(lines.get<std::int64_t>("the number of a node"));
    for (const std::int64_t tag : tags) {
      lines.need("a node");
      out.add_node(lines, tag, place(lines));
    }
  }
}

void read_elements(Lines& lines, bool is_2, size_t bytes, Read& out) {
  lines.need("the elements");
  const std::int64_t n = count(lines, is_2 ? "elements" : "blocks of elements", bytes);
  for (std::int64_t i = 0; is_2 && i < n; ++i) {
    lines.need("an element");
    (void)lines.get<std::int64_t>("the number of an element");
    const FaceElement& kind = element_of(lines, lines.get<int>("the type of an element"));
    const std::int64_t tags = count(lines, "tags", 1000);
    for (std::int64_t k = 0; k < tags; ++k) (void)lines.get<std::int64_t>("a tag");
    out.add_element(lines, kind);
  }
  for (std::int64_t b = 0; !is_2 && b < n; ++b) {
    lines.need("a block of elements");
    for (int k = 0; k < 2; ++k) (void)lines.get<int>("dimension and number of a block");
    const FaceElement& kind = element_of(lines, lines.get<int>("the type of elements"));
    const std::int64_t m = count(lines, "elements", bytes);
    for (std::int64_t i = 0; i < m; ++i) {
      lines.need("an element");
      (void)lines.get<std::int64_t>("the number of an element");
      out.add_element(lines, kind);
    }
  }
}

/// Several named groups of surfaces may stand for several materials, of which a section has one.
void refuse_materials(Lines& lines, size_t bytes) {
  lines.need("the number of names");
  const std::int64_t n = count(lines, "names", bytes);
  int surfaces = 0;
  for (std::int64_t i = 0; i < n; ++i) {
    lines.need("a name");
    surfaces += lines.get<int>("the dimension of a group") == 2;
  }
  if (surfaces > 1)
    lines.fail(fmt::format("{} groups of surfaces: a section has one material", surfaces),
               "one group; for several materials kind = \"matrix\" takes the 6 x 6 numbers");
}

Read read(Lines& lines, size_t bytes) {
  Read out;
  bool known = false, is_2 = false;
  while (lines.next()) {
    const std::string_view word = lines.line();
    if (!known && word != "$MeshFormat") lines.fail("this is no mesh of gmsh: it does not begin with $MeshFormat", how_to_write);
    if (word == "$MeshFormat") {
      lines.need("the version");
      const auto version = lines.get<double>("the version");
      if (version != 2.2 && version != 4.1) lines.fail(fmt::format("version {} of .msh", version), how_to_write);
      if (lines.get<int>("0, for text") != 0) lines.fail("a binary file", how_to_write);
      known = true, is_2 = version == 2.2;
    } else if (word == "$PhysicalNames") {
      refuse_materials(lines, bytes);
    } else if (word == "$Nodes") {
      read_nodes(lines, is_2, bytes, out);
    } else if (word == "$Elements") {
      read_elements(lines, is_2, bytes, out);
    }  // names, entities and lines between
  }
  if (!known) lines.fail("an empty file", how_to_write);
  return out;
}

/// A face in the making: checked step by step.
class Face {
 public:
  Face(Lines& lines, const Read& read) : lines_(lines), read_(read) {}

  SectionMesh made() {
    if (read_.elements.empty())
      lines_.fail("no triangles or quadrangles", "mesh the face in 2-D; where the file has physical groups, the face must be in one");
    take_nodes();
    for (const Read::Element& e : read_.elements) take(e);
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
    lines_.fail_at(read_.elements[cell].line, 1, what, hint);
  }
  std::string at(int node) const {
    const Vector2d& x = mesh_.X[static_cast<size_t>(node)];
    return fmt::format("({:.6g}, {:.6g})", x.x(), x.y());
  }

  void take_nodes() {
    double low = 1e300, high = -1e300;
    Vector2d least = Vector2d::Constant(1e300), most = -least;
    for (const Read::Element& e : read_.elements)
      for (int i = 0; i < e.kind->nodes; ++i) {
        const auto found = read_.nodes.find(e.node[static_cast<size_t>(i)]);
        if (found == read_.nodes.end()) lines_.fail_at(e.line, 1, fmt::format("no node {}", e.node[static_cast<size_t>(i)]));
        const Vec3& x = found->second.first;
        if (number_.emplace(found->first, static_cast<int>(mesh_.X.size())).second) mesh_.X.push_back(x.head<2>());
        low = std::min(low, x.z()), high = std::max(high, x.z());
        least = least.cwiseMin(x.head<2>()), most = most.cwiseMax(x.head<2>());
        if (high - low > 1e-6 * (most - least).norm() + 1e-9 * std::abs(low)) off_ = off_ ? off_ : found->second.second;
      }
    size_ = (most - least).norm();
    if (high - low > 1e-6 * size_)
      lines_.fail_at(off_ ? off_ : read_.elements.front().line, 1,
                     fmt::format("the face is not plane: z is from {:.6g} to {:.6g}", low, high),
                     "draw it in the plane of x and y: x lies along axis 1 of the section, y along axis 2");
  }

  void take(const Read::Element& e) {
    Cell cell;
    cell.fill(SectionMesh::none);
    const int c = e.kind->corners, n = e.kind->nodes;
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
          lines_.fail_at(line_of(order[i]), 1,
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

  Lines& lines_;
  const Read& read_;
  std::unordered_map<std::int64_t, int> number_;
  std::map<Edge, int> mid_;
  SectionMesh mesh_;
  std::vector<Piece> border_;
  double size_ = 0;
  int off_ = 0;
};

}  // namespace

SectionMesh section_mesh_of(const std::string& text, const std::string& path) {
  Lines lines(text, path);
  const Read file = read(lines, text.size());
  return Face(lines, file).made();
}

}  // namespace hilo
