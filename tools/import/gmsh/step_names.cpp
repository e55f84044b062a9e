// SPDX-License-Identifier: GPL-3.0-or-later
// Names of single faces and edges of a STEP file, which gmsh does not read.  The file's faces are found among those of the CAD kernel by
// their corners and kind of surface; where several have the same, by their order in the shell, which the kernel keeps.
#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "import/gmsh/cad.hpp"

namespace hilo {
namespace {

struct StepRecord {
  std::string_view kind;     // "ADVANCED_FACE"
  std::string name;          // its first argument where that is a text
  std::vector<long> refers;  // #numbers, in order
  std::string_view body;
};

class StepText {
 public:
  /// Records of a kind that names or bounds something; the others are passed over.
  explicit StepText(const std::string& text) {
    for (size_t at = text.find("DATA;"); at < text.size();) {
      const size_t from = text.find('#', at);
      if (from == text.npos) break;
      size_t end = from;
      for (bool quoted = false; end < text.size() && (quoted || text[end] != ';'); ++end) quoted = quoted != (text[end] == '\'');
      add(std::string_view(text).substr(from, end - from));
      at = end + 1;
    }
  }
  const StepRecord* find(long id) const {
    const auto r = records_.find(id);
    return r == records_.end() ? nullptr : &r->second;
  }
  const std::vector<long>& shells() const { return shells_; }

  /// Corners below a face or an edge.
  void corners(long id, std::vector<Vec3>& out, int depth = 0) const {
    const StepRecord* r = find(id);
    if (!r || depth > 6) return;
    if (r->kind == "CARTESIAN_POINT") {
      const size_t open = r->body.rfind('(');
      Vec3 x = Vec3::Zero();
      const std::string numbers(r->body.substr(open == std::string_view::npos ? 0 : open + 1));
      const char* at = numbers.c_str();
      for (int k = 0; k < 3; ++k) {
        char* next = nullptr;
        x[k] = std::strtod(at, &next);
        for (at = next; *at == ',' || std::isspace(static_cast<unsigned char>(*at));) ++at;
      }
      out.push_back(x);
      return;
    }
    // of an edge its two vertices, of a face its bounds: the last reference is the curve or the surface
    const size_t n = r->kind == "EDGE_CURVE"                                   ? std::min<size_t>(2, r->refers.size())
                     : r->kind == "ADVANCED_FACE" || r->kind == "FACE_SURFACE" ? r->refers.size() - std::min<size_t>(1, r->refers.size())
                                                                               : r->refers.size();
    for (size_t i = 0; i < n; ++i) corners(r->refers[i], out, depth + 1);
  }
  std::string surface(long face) const {
    const StepRecord* r = find(face);
    const StepRecord* s = r && !r->refers.empty() ? find(r->refers.back()) : nullptr;
    return s ? std::string(s->kind) : "";
  }

 private:
  void add(std::string_view record) {
    static constexpr std::array<std::string_view, 18> kinds{
        "ADVANCED_FACE", "FACE_SURFACE",        "FACE_OUTER_BOUND", "FACE_BOUND",        "EDGE_LOOP",        "ORIENTED_EDGE",
        "EDGE_CURVE",    "VERTEX_POINT",        "VERTEX_LOOP",      "CARTESIAN_POINT",   "CLOSED_SHELL",     "OPEN_SHELL",
        "PLANE",         "CYLINDRICAL_SURFACE", "CONICAL_SURFACE",  "SPHERICAL_SURFACE", "TOROIDAL_SURFACE", "SURFACE_OF_REVOLUTION"};
    const size_t eq = record.find('=');
    if (eq == record.npos) return;
    size_t from = eq + 1;
    while (from < record.size() && std::isspace(static_cast<unsigned char>(record[from]))) ++from;
    const size_t open = record.find('(', from);
    if (open == record.npos) return;
    std::string_view kind = record.substr(from, open - from);
    while (!kind.empty() && std::isspace(static_cast<unsigned char>(kind.back()))) kind.remove_suffix(1);
    const auto known = std::ranges::find(kinds, kind);
    if (known == kinds.end()) return;
    StepRecord r{*known, "", {}, record.substr(open)};
    bool quoted = false, named = false;
    for (size_t i = open; i < record.size(); ++i) {
      const char c = record[i];
      if (quoted && c != '\'') {
        if (!named) r.name += c;
      } else if (c == '\'') {
        if (quoted) named = true;
        quoted = !quoted;
      } else if (c == '#') {
        r.refers.push_back(std::strtol(record.data() + i + 1, nullptr, 10));
      }
    }
    const long id = std::strtol(record.data() + 1, nullptr, 10);
    if (kind.ends_with("_SHELL")) shells_.push_back(id);
    records_.emplace(id, std::move(r));
  }

  std::unordered_map<long, StepRecord> records_;
  std::vector<long> shells_;  // as they stand in the file
};

/// A face or edge: its number, corners and kind.
struct StepItem {
  long id;
  std::string name, kind;
  std::vector<Vec3> corners;
};

bool same_corners(const StepItem& a, const StepItem& b, double tolerance) {
  if (a.corners.size() != b.corners.size() || (!a.kind.empty() && !b.kind.empty() && a.kind != b.kind)) return false;
  std::vector<char> used(b.corners.size(), 0);
  return std::ranges::all_of(a.corners, [&](const Vec3& x) {
    for (size_t i = 0; i < used.size(); ++i)
      if (!used[i] && (b.corners[i] - x).norm() < tolerance) return used[i] = 1, true;
    return false;
  });
}

void keep_distinct(std::vector<Vec3>& points, double tolerance) {
  std::vector<Vec3> kept;
  for (const Vec3& x : points)
    if (std::ranges::none_of(kept, [&](const Vec3& y) { return (x - y).norm() < tolerance; })) kept.push_back(x);
  points = std::move(kept);
}

std::string kind_of_surface(const std::string& word) {
  for (const auto& [step, kernel] : {std::pair("PLANE", "Plane"),
                                     {"CYLINDRICAL_SURFACE", "Cylinder"},
                                     {"CONICAL_SURFACE", "Cone"},
                                     {"SPHERICAL_SURFACE", "Sphere"},
                                     {"TOROIDAL_SURFACE", "Torus"}})
    if (word == step || word == kernel) return kernel;
  return "";
}

bool says_something(const std::string& name) { return name.find_first_not_of(" ") != name.npos && name != "NONE"; }

std::vector<StepItem> kernel_items(int dim, double tolerance) {
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dim);
  std::vector<StepItem> items;
  for (const auto& [d, tag] : entities) {
    StepItem item{tag, "", "", {}};
    gmsh::vectorpair points;
    gmsh::model::getBoundary({{dim, tag}}, points, false, false, true);
    for (const auto& [zero, point] : points) {
      std::vector<double> x;
      gmsh::model::getValue(0, point, {}, x);
      item.corners.emplace_back(x[0], x[1], x[2]);
    }
    keep_distinct(item.corners, tolerance);
    if (dim == 2) {
      std::string type;
      gmsh::model::getType(dim, tag, type);
      item.kind = kind_of_surface(type);
    }
    items.push_back(std::move(item));
  }
  return items;
}

}  // namespace

std::vector<NamedEntity> step_names(const std::string& text, double unit, std::vector<std::string>& notes) {
  const StepText step(text);
  std::vector<NamedEntity> found;
  std::vector<long> faces, edges;
  for (const long shell : step.shells())
    for (const long face : step.find(shell)->refers) faces.push_back(face);
  const auto add_edges = [&](auto&& self, long id, int depth) -> void {
    const StepRecord* r = step.find(id);
    if (!r || depth > 4) return;
    if (r->kind == "EDGE_CURVE") return edges.push_back(id);
    for (const long next : r->refers) self(self, next, depth + 1);
  };
  for (const long face : faces) add_edges(add_edges, face, 0);
  sort_unique(edges);
  double size = 0;
  for (const auto& [dim, ids] : {std::pair(2, &faces), std::pair(1, &edges)}) {
    std::vector<StepItem> items;
    for (const long id : *ids) {
      const StepRecord* r = step.find(id);
      if (!r) continue;
      StepItem item{id, r->name, dim == 2 ? kind_of_surface(step.surface(id)) : "", {}};
      step.corners(id, item.corners);
      for (Vec3& x : item.corners) size = std::max(size, (x *= unit).norm());
      items.push_back(std::move(item));
    }
    if (std::ranges::none_of(items, [](const StepItem& i) { return says_something(i.name); })) continue;
    const double tolerance = 1e-6 * size;
    for (StepItem& item : items) keep_distinct(item.corners, tolerance);
    const auto kernel = kernel_items(dim, tolerance);
    size_t lost = 0;
    std::string first;
    for (const StepItem& item : items) {
      if (!says_something(item.name)) continue;
      std::vector<long> mine, theirs;
      for (const StepItem& other : items)
        if (same_corners(item, other, tolerance)) mine.push_back(other.id);
      for (const StepItem& other : kernel)
        if (same_corners(item, other, tolerance)) theirs.push_back(other.id);
      const auto at = static_cast<size_t>(std::ranges::find(mine, item.id) - mine.begin());
      if (mine.size() == theirs.size())
        found.push_back({dim, static_cast<int>(theirs[at]), item.name});
      else if (++lost == 1)
        first = item.name;
    }
    if (lost)
      notes.push_back(
          fmt::format("{} {} of the file have names and are not found among those of the CAD kernel, \"{}\" among them: left out", lost,
                      dim == 2 ? "faces" : "edges", first));
  }
  return found;
}

}  // namespace hilo
