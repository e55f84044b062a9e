// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/section_msh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string_view>

#include "base/error.hpp"

namespace hilo {
namespace {

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
  [[noreturn]] void fail(const std::string& what, const std::string& hint = "") const {
    throw Error(fmt::format("{}:{}:{}", path_, std::max(number_, 1), at_ + 1), what, hint);
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

void add_node(SectionMsh& out, const Lines& lines, std::int64_t tag, const Vec3& x) {
  if (!x.allFinite() || x.cwiseAbs().maxCoeff() > 1e12) lines.fail("this is no place of a section");
  if (!out.nodes.emplace(tag, std::pair{x, lines.number()}).second) lines.fail(fmt::format("node {} stands twice", tag));
}
void add_element(SectionMsh& out, Lines& lines, const FaceElement& kind) {
  if (kind.dimension < 2) return;
  SectionMsh::Element e{kind.corners, kind.nodes, {}, lines.number()};
  for (int i = 0; i < kind.nodes; ++i) e.node[static_cast<size_t>(i)] = lines.get<std::int64_t>("a node");
  out.elements.push_back(e);
  if (out.elements.size() > most_cells)
    lines.fail(fmt::format("more than {} cells: a section needs some hundreds", most_cells), "mesh it with a larger size");
}

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

void read_nodes(Lines& lines, bool is_2, size_t bytes, SectionMsh& out) {
  lines.need("the nodes");
  const std::int64_t n = count(lines, is_2 ? "nodes" : "blocks of nodes", bytes);
  for (std::int64_t i = 0; is_2 && i < n; ++i) {
    lines.need("a node");
    const auto tag = lines.get<std::int64_t>("the number of a node");
    add_node(out, lines, tag, place(lines));
  }
  for (std::int64_t b = 0; !is_2 && b < n; ++b) {
    lines.need("a block of nodes");
    for (int k = 0; k < 3; ++k) (void)lines.get<int>("dimension, number and parameters of a block");
    const std::int64_t m = count(lines, "nodes", bytes);
    std::vector<std::int64_t> tags;
    for (std::int64_t i = 0; i < m; ++i) lines.need("a node"), tags.push_back(lines.get<std::int64_t>("the number of a node"));
    for (const std::int64_t tag : tags) {
      lines.need("a node");
      add_node(out, lines, tag, place(lines));
    }
  }
}

void read_elements(Lines& lines, bool is_2, size_t bytes, SectionMsh& out) {
  lines.need("the elements");
  const std::int64_t n = count(lines, is_2 ? "elements" : "blocks of elements", bytes);
  for (std::int64_t i = 0; is_2 && i < n; ++i) {
    lines.need("an element");
    (void)lines.get<std::int64_t>("the number of an element");
    const FaceElement& kind = element_of(lines, lines.get<int>("the type of an element"));
    const std::int64_t tags = count(lines, "tags", 1000);
    for (std::int64_t k = 0; k < tags; ++k) (void)lines.get<std::int64_t>("a tag");
    add_element(out, lines, kind);
  }
  for (std::int64_t b = 0; !is_2 && b < n; ++b) {
    lines.need("a block of elements");
    for (int k = 0; k < 2; ++k) (void)lines.get<int>("dimension and number of a block");
    const FaceElement& kind = element_of(lines, lines.get<int>("the type of elements"));
    const std::int64_t m = count(lines, "elements", bytes);
    for (std::int64_t i = 0; i < m; ++i) {
      lines.need("an element");
      (void)lines.get<std::int64_t>("the number of an element");
      add_element(out, lines, kind);
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

}  // namespace

void SectionMsh::fail_at(int line, const std::string& what, const std::string& hint) const {
  throw Error(fmt::format("{}:{}:1", path, std::max(line, 1)), what, hint);
}

SectionMsh read_section_msh(const std::string& text, const std::string& path) {
  Lines lines(text, path);
  const size_t bytes = text.size();
  SectionMsh out;
  out.path = path;
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

}  // namespace hilo
