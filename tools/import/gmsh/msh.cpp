// SPDX-License-Identifier: GPL-3.0-or-later
// Files of gmsh's mesh format, msh 2.0 to 2.2, 4.0 and 4.1, text and binary, and 1.
// The library would take whatever does not begin as a mesh for a script and run it, so the reader is ours: it runs nothing.  Nothing is
// allocated by a count that the rest of the file could not fill.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include "base/error.hpp"
#include "import/data_line.hpp"
#include "import/gmsh/element_types.hpp"
#include "import/gmsh/mesh.hpp"
#include "import/text_input.hpp"

namespace hilo {
namespace {

/// Numbers one after the other, as text or as bytes; an error says the line, in a binary file the byte.
class MshInput : public TextInput {
 public:
  explicit MshInput(const std::string& path) : TextInput(path, read_gz(path, "")) {}

  bool binary = false, swap = false;

  std::string quoted() {
    const size_t from = text_.find_first_not_of(" \t", at_), line = text_.find('\n', at_);
    const size_t to = from < line && text_[from] == '"' ? text_.find('"', from + 1) : text_.npos;
    if (to >= line) fail("a name in quotes is missing");
    at_ = to + 1;
    return text_.substr(from + 1, to - from - 1);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1; }
  /// Behind the line `word`, wherever it is.
  void skip_behind(const std::string& word) {
    const size_t found = text_.find("\n" + word, at_ ? at_ - 1 : 0);
    if (found == text_.npos) fail(fmt::format("no {}", word), "cut off?");
    at_ = found + 1 + word.size();
    if (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) fail(fmt::format("{} runs on", word));
  }
  std::string_view bytes(size_t n) {
    if (text_.size() - at_ < n) fail("the file ends here");
    at_ += n;
    return std::string_view(text_).substr(at_ - n, n);
  }

  /// The next number; a T in a binary file.
  template <class T>
  T next() {
    if (!binary) return number<T>();
    T value;
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes(sizeof(T)).data(), sizeof(T));
    if (swap) std::reverse(raw.begin(), raw.end());
    std::memcpy(&value, raw.data(), sizeof(T));
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) fail("a coordinate is not finite");
    return value;
  }
  /// How many things follow, of `numbers` numbers each: no more than the file has room for.
  template <class T>
  size_t count(size_t numbers, bool in_text = false) {
    const auto n = in_text ? number<std::int64_t>() : static_cast<std::int64_t>(next<T>());
    const size_t least = binary ? 4 : 2;  // bytes of a number
    if (n < 0 || static_cast<size_t>(n) > (text_.size() - at_) / (least * std::max<size_t>(1, numbers)) + 1)
      fail(fmt::format("a count of {}, more than the rest of the file can hold", n));
    return static_cast<size_t>(n);
  }

 private:
  std::string place() const override { return binary ? fmt::format("{}: byte {}", path_, at_) : TextInput::place(); }
};

class MshReader {
 public:
  explicit MshReader(const std::string& path) : path_(path), in_(path) {}

  GmshMesh read() {
    bool nodes = false, elements = false;
    header();
    if (version_ == 1) return read1();
    for (auto name = in_.word(); !name.empty(); name = in_.word()) {
      if (name.size() < 2 || name[0] != '$') in_.fail(fmt::format("\"{}\" stands outside of a section", name.substr(0, 40)));
      const std::string section(name);
      if (section == "$PhysicalNames")
        physical_names();
      else if (section == "$Entities" && version_ >= 4)
        in_.skip_line(), entities();
      else if (section == "$PartitionedEntities")
        in_.skip_line(), partitioned_entities();
      else if (section == "$Nodes" && !nodes)
        in_.skip_line(), nodes = true, version_ < 4 ? nodes2() : nodes4();
      else if (section == "$Elements" && nodes && !elements)
        in_.skip_line(), elements = true, version_ < 4 ? elements2() : elements4();
      else if (section == "$Nodes" || section == "$Elements")
        in_.fail(fmt::format("{} {}", section, nodes ? "a second time" : "before $Nodes"));
      else {  // data on nodes, periodic surfaces, comments: not for us
        in_.skip_behind("$End" + section.substr(1));
        if (section != "$Comments" && section != "$Periodic" && section != "$Parametrizations" && section != "$GhostElements")
          ++unread_[section];
        continue;
      }
      if (const auto end = in_.word(); end != "$End" + section.substr(1))
        in_.fail(fmt::format("$End{} is missing", section.substr(1)), "cut off, or its counts are damaged?");
    }
    if (!nodes || !elements) throw Error(path_, fmt::format("no ${}", nodes ? "Elements" : "Nodes"), "cut off?");
    tell_partitions();
    for (const auto& [section, n] : unread_) mesh_.notes.push_back(fmt::format("not read: {} sections {}", n, section));
    order_nodes();
    return std::move(mesh_);
  }

 private:
  /// msh 1, text alone: no names, and one physical and one elementary tag of each element.
  GmshMesh read1() {
    nodes2();
    if (in_.word() != "$ENDNOD") in_.fail("$ENDNOD is missing", "cut off, or its count is damaged?");
    if (in_.word() != "$ELM") in_.fail("no $ELM behind $ENDNOD", "cut off?");
    for (size_t n = in_.count<int>(6); n > 0; --n) {
      const auto id = in_.next<std::int32_t>();
      const GmshType& t = type(in_.next<std::int32_t>());
      const int group = std::abs(in_.next<std::int32_t>()), tag = in_.next<std::int32_t>(), nodes = in_.next<std::int32_t>();
      if (nodes != t.n_nodes) in_.fail(fmt::format("a {} of {} nodes", t.name, nodes));
      auto& entity = mesh_.entities[{t.dimension, tag, group}];
      if (group > 0 && entity.groups.empty()) entity.groups = {group};
      element(entity, t, id);
    }
    if (in_.word() != "$ENDELM") in_.fail("$ENDELM is missing", "cut off, or its count is damaged?");
    order_nodes();
    return std::move(mesh_);
  }

  void header() {
    std::string_view first = in_.word();
    while (first == "$Comments") in_.skip_behind("$EndComments"), first = in_.word();
    if (first == "$NOD") {
      version_ = 1;
      return;
    }
    if (first != "$MeshFormat")
      in_.fail("not a mesh of gmsh: it does not begin with $MeshFormat", "a script is read from a file named .geo");
    const auto version = in_.number<double>();
    const auto binary = in_.number<int>(), size = in_.number<int>();
    if (version != 2 && version != 2.1 && version != 2.2 && version != 4 && version != 4.1)
      in_.fail(fmt::format("msh {} is not read", version), "save it as msh 4.1 or 2.2");
    if ((binary != 0 && binary != 1) || size != 8) in_.fail("a line of $MeshFormat is: version, 0 or 1, 8");
    version_ = version;
    if (binary) {
      in_.skip_line();
      in_.binary = true;
      const auto one = in_.next<std::int32_t>();
      if (one != 1 && one != 0x01000000) in_.fail("the 1 that marks the order of bytes is missing");
      in_.swap = one != 1;
    }
    if (in_.word() != "$EndMeshFormat") in_.fail("$EndMeshFormat is missing");
  }

  void physical_names() {
    for (size_t n = in_.count<int>(2, true); n > 0; --n) {
      const int dim = in_.number<int>(), tag = in_.number<int>();
      mesh_.group_name[{dim, tag}] = in_.quoted();
    }
  }

  /// An integer of the kind that counts are: 4.0 and 4.1 have 8 bytes.
  std::int64_t big() { return in_.next<std::int64_t>(); }

  /// Of a physical group; its sign is an orientation.
  int group() {
    const int number = in_.next<std::int32_t>();
    if (number == std::numeric_limits<int>::min()) in_.fail(fmt::format("{} is no number of a group", number));
    return std::abs(number);
  }

  void entities() {
    std::array<size_t, 4> n{};
    for (auto& one : n) one = in_.count<std::int64_t>(1);
    for (int dim = 0; dim < 4; ++dim)
      for (size_t i = 0; i < n[static_cast<size_t>(dim)]; ++i) {
        const int tag = in_.next<std::int32_t>();
        auto& entity = mesh_.entities[{dim, tag, 0}];
        for (const int g : rest_of_entity(dim)) entity.groups.push_back(g);
      }
  }
  /// Where an entity is, its groups, and what bounds it.
  std::vector<int> rest_of_entity(int dim) {
    for (int x = dim == 0 && version_ > 4 ? 3 : 6; x > 0; --x) in_.next<double>();
    std::vector<int> groups;
    for (size_t k = in_.count<std::int64_t>(1); k > 0; --k) groups.push_back(group());
    if (dim > 0)
      for (size_t bounds = in_.count<std::int64_t>(1); bounds > 0; --bounds) in_.next<std::int32_t>();
    return groups;
  }

  /// Entities that gmsh has cut into parts: what is on a part is on the whole.  Borders between parts are of less dimension than what they
  /// divide; elements on them, of no group of the model, are left out.
  void partitioned_entities() {
    n_partitions_ = in_.count<std::int64_t>(1);
    for (size_t ghosts = in_.count<std::int64_t>(2); ghosts > 0; --ghosts) in_.next<std::int32_t>(), in_.next<std::int32_t>();
    std::array<size_t, 4> n{};
    for (auto& one : n) one = in_.count<std::int64_t>(1);
    for (int dim = 0; dim < 4; ++dim)
      for (size_t i = 0; i < n[static_cast<size_t>(dim)]; ++i) {
        const int tag = in_.next<std::int32_t>(), of_dim = in_.next<std::int32_t>(), of = in_.next<std::int32_t>();
        Part& part = part_[{dim, tag, 0}];
        part.is_border = of_dim != dim;
        part.of = {dim, part.is_border ? tag : of, part.is_border ? 1 : 0};  // a border is no entity of the model
        for (size_t k = in_.count<std::int64_t>(1); k > 0; --k) part.partitions.push_back(in_.next<std::int32_t>());
        const auto groups = rest_of_entity(dim);
        auto& entity = mesh_.entities[part.of];
        if (entity.groups.empty() && !part.is_border) entity.groups = groups;  // those of the whole, where it is in the file
      }
  }
  /// gmsh may write each part to a file of its own.
  void tell_partitions() {
    if (n_partitions_ == 0) return;
    std::set<int> there;
    int most = 0;
    for (const auto& [key, part] : part_) most = std::max(most, part.is_border ? 0 : std::get<0>(key));
    for (const auto& [key, part] : part_)
      if (part.filled && std::get<0>(key) == most) there.insert(part.partitions.begin(), part.partitions.end());
    mesh_.notes.push_back(
        there.size() < n_partitions_
            ? fmt::format("warning: the file holds {} of the {} parts of its mesh: the others are missing", there.size(), n_partitions_)
            : fmt::format("the mesh is in {} parts, which are put together (hilo-part makes others)", n_partitions_));
  }

  void node(std::int64_t tag, const GmshMesh::Key& on) {
    if (tag <= 0) in_.fail(fmt::format("node number {}", tag));
    mesh_.node_tag.push_back(tag);
    on_.push_back(on);
  }
  void position() {
    const double x = in_.next<double>(), y = in_.next<double>(), z = in_.next<double>();
    mesh_.X.emplace_back(x, y, z);
  }

  void nodes2() {
    const size_t n = in_.count<int>(4, true);
    if (in_.binary) in_.skip_line();
    for (size_t i = 0; i < n; ++i) node(in_.next<std::int32_t>(), {4, 0, 0}), position();
  }

  /// Dimension and tag of the entity of a block.
  GmshMesh::Key block(bool of_elements) {
    const int first = in_.next<std::int32_t>(), second = in_.next<std::int32_t>();
    const int dim = version_ > 4 ? first : second, tag = version_ > 4 ? second : first;
    if (dim < 0 || dim > 3) in_.fail(fmt::format("a block of dimension {}", dim));
    const auto part = part_.find({dim, tag, 0});
    if (part != part_.end() && of_elements) part->second.filled = true;
    return part == part_.end() ? GmshMesh::Key{dim, tag, 0} : part->second.of;
  }

  void nodes4() {
    const size_t blocks = in_.count<std::int64_t>(3);
    in_.count<std::int64_t>(4);
    if (version_ > 4) big(), big();
    for (size_t b = 0; b < blocks; ++b) {
      const auto on = block(false);
      const int parametric = in_.next<std::int32_t>();
      const size_t n = in_.count<std::int64_t>(4);
      const size_t extra = parametric ? static_cast<size_t>(std::get<0>(on)) : 0;
      auto& entity = mesh_.entities[on];
      const size_t first = mesh_.node_tag.size();
      if (version_ > 4)
        for (size_t i = 0; i < n; ++i) node(big(), on);
      for (size_t i = 0; i < n; ++i) {
        if (version_ <= 4) node(in_.next<std::int32_t>(), on);
        position();
        for (size_t u = 0; u < extra; ++u) in_.next<double>();
      }
      if (std::get<0>(on) == 0)
        entity.points.insert(entity.points.end(), mesh_.node_tag.begin() + static_cast<std::ptrdiff_t>(first), mesh_.node_tag.end());
    }
  }

  const GmshType& type(int number) const {
    const GmshType* t = gmsh_type(number);
    if (!t)
      in_.fail(fmt::format("elements of type {} are not read", number),
               "supported: tetrahedra, hexahedra and prisms of order 1 and 2, pyramids of 5 nodes, lines");
    return *t;
  }

  void elements2() {
    const size_t n = in_.count<int>(3, true);
    if (in_.binary) in_.skip_line();
    for (size_t done = 0; done < n;) {
      std::int64_t id = 0;
      if (!in_.binary) id = in_.next<std::int32_t>();
      const GmshType& t = type(in_.next<std::int32_t>());
      const size_t run = in_.binary ? in_.count<std::int32_t>(1) : 1, tags = in_.count<std::int32_t>(run);
      if (run == 0 || run > n - done) in_.fail(fmt::format("a run of {} elements, {} are left", run, n - done));
      for (size_t e = 0; e < run; ++e, ++done) {
        if (in_.binary) id = in_.next<std::int32_t>();
        int group = 0, tag = 0;
        for (size_t i = 0; i < tags; ++i) {
          if (i == 0)
            group = this->group();
          else if (const int value = in_.next<std::int32_t>(); i == 1)
            tag = value;
        }
        auto& entity = mesh_.entities[{t.dimension, tag, group}];
        if (group > 0 && entity.groups.empty()) entity.groups = {group};
        element(entity, t, id);
      }
    }
  }

  void elements4() {
    const size_t blocks = in_.count<std::int64_t>(3);
    in_.count<std::int64_t>(2);
    if (version_ > 4) big(), big();
    for (size_t b = 0; b < blocks; ++b) {
      const auto on = block(true);
      const GmshType& t = type(in_.next<std::int32_t>());
      if (t.dimension != std::get<0>(on)) in_.fail(fmt::format("\"{}\" in an entity of dimension {}", t.name, std::get<0>(on)));
      const size_t n = in_.count<std::int64_t>(1);
      auto& entity = mesh_.entities[on];
      for (size_t e = 0; e < n; ++e) element(entity, t, version_ > 4 ? big() : in_.next<std::int32_t>());
    }
  }

  void element(GmshMesh::Entity& entity, const GmshType& t, std::int64_t id) {
    auto& b = entity.of(t.type);
    b.tags.push_back(id);
    for (int i = 0; i < t.n_nodes; ++i) b.nodes.push_back(version_ > 4 ? big() : in_.next<std::int32_t>());
  }

  void order_nodes() {
    if (version_ < 4) on_ = entity_of_nodes(mesh_);
    hilo::order_nodes(mesh_, on_, version_ < 4);
    const auto& tags = mesh_.node_tag;
    for (size_t i = 1; i < tags.size(); ++i)
      if (tags[i] == tags[i - 1] && mesh_.X[i] != mesh_.X[i - 1])
        throw Error(path_, fmt::format("node {} is given twice, at two places", tags[i]));
  }

  std::string path_;
  MshInput in_;
  double version_ = 0;
  GmshMesh mesh_;
  struct Part {
    GmshMesh::Key of;  // the whole
    std::vector<int> partitions = {};
    bool is_border = false, filled = false;
  };
  std::map<GmshMesh::Key, Part> part_;
  size_t n_partitions_ = 0;
  std::map<std::string, int> unread_;  // sections by name
  std::vector<GmshMesh::Key> on_;      // entity of each node
};

}  // namespace

Imported read_msh(const std::string& path, const ImportOptions& options) { return imported_from(path, MshReader(path).read(), options); }

}  // namespace hilo
