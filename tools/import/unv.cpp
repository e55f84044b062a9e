// SPDX-License-Identifier: GPL-3.0-or-later
// I-DEAS universal files: datasets 164 (units), 2411 (nodes), 2412 (elements) and the groups 2429 to 2477.
// (gmsh 4.8 crashes on groups that name an element it does not know, so the reader is ours.)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/param.hpp"
#include "base/utf8.hpp"
#include "import/data_line.hpp"
#include "import/grouped.hpp"

namespace hilo {
namespace {

/// Finite-element descriptors: dimension, our shape of solids and bars, the nodes: ours[i] = theirs[p[i]]; faces keep their corners.
struct UnvKind {
  std::vector<int> ids;
  int dimension;
  Shape shape;
  std::vector<int> p;
  size_t n_nodes;
};
const UnvKind* unv_kind(int id) {
  // quadratic cells are listed ring by ring: corner, middle, corner, ...
  static const std::vector<UnvKind> kinds = {
      {{11, 21}, 1, Shape::bar2, {0, 1}, 2},
      {{22, 24}, 1, Shape::bar2, {0, 2, 1}, 3},
      {{41, 91}, 2, Shape::bar2, {0, 1, 2}, 3},
      {{42, 92}, 2, Shape::bar2, {0, 2, 4}, 6},
      {{44, 94}, 2, Shape::bar2, {0, 1, 2, 3}, 4},
      {{45, 95}, 2, Shape::bar2, {0, 2, 4, 6}, 8},
      {{111}, 3, Shape::tet4, {0, 1, 2, 3}, 4},
      {{112}, 3, Shape::wedge6, {0, 1, 2, 3, 4, 5}, 6},
      {{115}, 3, Shape::hex8, {0, 1, 2, 3, 4, 5, 6, 7}, 8},
      {{118}, 3, Shape::tet10, {0, 2, 4, 9, 1, 3, 5, 6, 7, 8}, 10},
      {{113}, 3, Shape::wedge15, {0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8}, 15},
      {{116}, 3, Shape::hex20r, {0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11}, 20},
  };
  for (const auto& k : kinds)
    if (std::ranges::find(k.ids, id) != k.ids.end()) return &k;
  return nullptr;
}

/// Datasets of groups, and how many numbers each member of a group has there.
const std::map<std::string, size_t> group_datasets{{"2467", 4}, {"2477", 4}, {"2452", 4}, {"2435", 4},
                                                   {"2429", 2}, {"2430", 2}, {"2432", 2}};

class UnvReader {
 public:
  UnvReader(const std::string& path, const ImportOptions& o) : path_(path), o_(o), text_(as_utf8(read_gz(path, ""))) {}

  Imported read() {
    while (line()) {
      if (l_.fields.size() != 1 || l_.text(0) != "-1") continue;
      if (!line()) break;
      const std::string set(l_.text(0));
      if (set == "2411" || set == "781")
        nodes();
      else if (set == "2412")
        elements();
      else if (set == "164")
        units();
      else if (const auto group = group_datasets.find(set); group != group_datasets.end())
        groups(group->second);
      else {
        in_.skip("dataset " + set, l_.place(), 1, false);
        while (more()) {
        }
      }
    }
    if (in_.mesh.X.empty()) throw Error(path_, "no nodes (dataset 2411)", "a universal file of a mesh has datasets 2411 and 2412");
    if (mesh_.n_elements() == 0) throw Error(path_, "no elements (dataset 2412)");
    return mesh_.finish(path_, o_, "property");
  }

 private:
  /// The next line, cut at blanks.
  bool line() {
    if (at_ >= text_.size()) return false;
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    raw_ = std::string_view(text_).substr(at_, end - at_);
    if (!raw_.empty() && raw_.back() == '\r') raw_.remove_suffix(1);
    at_ = end + 1;
    l_.file = &path_;
    ++l_.line;
    l_.fields.clear();
    for (size_t i = 0; (i = raw_.find_first_not_of(" \t", i)) != std::string_view::npos;) {
      const size_t stop = std::min(raw_.find_first_of(" \t", i), raw_.size());
      l_.fields.push_back({raw_.substr(i, stop - i), static_cast<int>(i) + 1});
      i = stop;
    }
    return true;
  }
  /// The next line of a dataset; false at its end, "-1".
  bool more() {
    if (!line()) throw Error(l_.place(), "the file ends inside a dataset");
    return !(l_.fields.size() == 1 && l_.text(0) == "-1");
  }
  void must() {
    if (!more()) throw Error(l_.place(), "the dataset ends inside a record");
  }

  /// Code and name of the units, then the factors that SI is divided by: the first is that of lengths.
  void units() {
    must();
    must();
    const double factor = l_.number(0);
    while (more()) {
    }
    if (!(factor > 0)) return;
    if (!o_.units_given)
      in_.metre = 1 / factor;
    else if (std::abs(to_si("m", o_.units) * factor - 1) > 1e-9)
      in_.notes.push_back(
          fmt::format("the file says that its unit of length is {:g} m (dataset 164); taken as {}, as --units says", 1 / factor, o_.units));
  }

  void nodes() {
    while (more()) {
      const auto id = l_.integer(0);  // the coordinates are those of the part, whatever the node's systems are
      const auto place = l_.place(0);
      must();
      if (!mesh_.add_node(id, {l_.number(0), l_.number(1), l_.number(2)}))
        throw Error(place, fmt::format("node {} is given twice", id), "number each node once");
    }
  }

  void elements() {
    while (more()) {
      const auto number = l_.integer(0), property = l_.integer(2);
      const auto place = l_.place(0);
      const auto id = static_cast<int>(l_.integer(1));
      const auto n = static_cast<size_t>(l_.integer(5));
      const UnvKind* kind = unv_kind(id);
      if (!kind)
        throw Error(l_.place(1), fmt::format("element {}: descriptor {} is not read", number, id),
                    "supported: rods 11, beams as lines 21 22 24, faces 41 42 44 45 91 92 94 95, solids 111 112 113 115 116 118");
      if (n != kind->n_nodes)
        throw Error(place, fmt::format("element {}: descriptor {} has {} nodes, not {}", number, id, kind->n_nodes, n));
      if (kind->dimension == 1) must();  // orientation and cross-sections of beams
      std::vector<std::int64_t> all;
      while (all.size() < n) {
        must();
        for (size_t i = 0; i < l_.fields.size(); ++i) all.push_back(l_.integer(i));
      }
      std::vector<std::int64_t> rows;
      for (const int i : kind->p) {
        rows.push_back(mesh_.row(all[static_cast<size_t>(i)]));
        if (rows.back() < 0)
          throw Error(place, fmt::format("element {} names node {}, which does not exist", number, all[static_cast<size_t>(i)]));
      }
      if (!mesh_.add_element(kind->dimension, kind->shape, number, property, std::move(rows), kind->n_nodes > 4))
        throw Error(place, fmt::format("element {} is given twice", number), "number each element once");
    }
  }

  /// `width` numbers an entity: type (7 node, 8 element), number, and two that say nothing here.
  void groups(size_t width) {
    while (more()) {
      GroupedMesh::Group g;
      const auto number = l_.integer(0), count = l_.integer(7);
      must();
      g.name = strip(raw_).empty() ? fmt::format("group_{}", number) : std::string(strip(raw_));
      for (std::int64_t got = 0; got < count;) {
        must();
        for (size_t i = 0; i + 1 < l_.fields.size(); i += width, ++got) {
          const auto type = l_.integer(i);
          if (type == 7)
            g.nodes.push_back(l_.integer(i + 1));
          else if (type == 8)
            g.elements.push_back(l_.integer(i + 1));
          else
            in_.skip(fmt::format("group members of type {}", type), l_.place());
        }
      }
      mesh_.add_group(std::move(g));
    }
  }

  std::string path_;
  const ImportOptions& o_;
  std::string text_;
  GroupedMesh mesh_;
  Imported& in_ = mesh_.in;
  size_t at_ = 0;
  DataLine l_;
  std::string_view raw_;
};

}  // namespace

Imported read_unv(const std::string& path, const ImportOptions& options) { return UnvReader(path, options).read(); }

}  // namespace hilo
