// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/cad.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

#include "import/data_line.hpp"

namespace hilo {
namespace {

double prefix_of(std::string_view word) {
  static const std::map<std::string_view, double> known{{"EXA", 1e18},   {"PETA", 1e15},  {"TERA", 1e12}, {"GIGA", 1e9},  {"MEGA", 1e6},
                                                        {"KILO", 1e3},   {"HECTO", 1e2},  {"DECA", 1e1},  {"DECI", 1e-1}, {"CENTI", 1e-2},
                                                        {"MILLI", 1e-3}, {"MICRO", 1e-6}, {"NANO", 1e-9}, {"PICO", 1e-12}};
  const auto found = known.find(word);
  return found == known.end() ? 1 : found->second;
}

std::string name_of(double metre) {
  static const std::map<double, const char*> known{{1e-6, "micrometres"}, {1e-3, "mm"},     {1e-2, "cm"},    {1, "m"},
                                                   {1e3, "km"},           {0.0254, "inch"}, {0.3048, "foot"}};
  for (const auto& [value, name] : known)
    if (std::abs(value - metre) < 1e-6 * metre) return name;
  return fmt::format("{:g} m", metre);
}

/// Records of a STEP file, "#12=...": blanks, texts and comments taken out; numbers of the others ascend or not.
std::map<long, std::string> records_of_units(const std::string& text) {
  std::map<long, std::string> records;
  std::string one;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted || c == '\'') {
      quoted = quoted != (c == '\'');
    } else if (c == '/' && i + 1 < text.size() && text[i + 1] == '*') {
      i = std::min(text.find("*/", i + 2), text.size() - 1) + 1;
    } else if (c == ';') {
      const size_t eq = one.find('=');
      if (one.starts_with('#') && eq != one.npos &&
          (one.find("_UNIT(", eq) != one.npos || one.find("_UNIT)", eq) != one.npos || one.find("UNIT_ASSIGNED_CONTEXT(", eq) != one.npos))
        records[std::strtol(one.c_str() + 1, nullptr, 10)] = one.substr(eq + 1);
      one.clear();
    } else if (!std::isspace(static_cast<unsigned char>(c))) {
      one += c;
    }
  }
  return records;
}

/// The number of the first reference at or behind `from`, 0 without one.
long reference(const std::string& record, size_t from) {
  const size_t at = record.find('#', from);
  return at == record.npos ? 0 : std::strtol(record.c_str() + at + 1, nullptr, 10);
}

/// A record of a length unit in metres, 0 where it is none.
double metres_of(const std::map<long, std::string>& records, long id, int depth = 0) {
  const auto found = records.find(id);
  if (found == records.end() || depth > 4) return 0;
  const std::string& r = found->second;
  if (const size_t si = r.find("SI_UNIT("); si != r.npos && r.find(".METRE.") != r.npos) {
    const size_t dot = r.find('.', si), end = r.find('.', dot + 1);
    return r[si + 8] == '$' ? 1 : prefix_of(std::string_view(r).substr(dot + 1, end - dot - 1));
  }
  if (const size_t based = r.find("CONVERSION_BASED_UNIT("); based != r.npos && r.find("LENGTH_UNIT(") != r.npos) {
    const auto measure = records.find(reference(r, based));  // LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#u)
    if (measure == records.end()) return 0;
    const size_t value = measure->second.find("LENGTH_MEASURE(");
    if (value == std::string::npos) return 0;
    return std::strtod(measure->second.c_str() + value + 15, nullptr) * metres_of(records, reference(measure->second, value), depth + 1);
  }
  return 0;
}

/// The parameters of the global section of an IGES file.
std::vector<std::string> global_section(const std::string& text) {
  std::string all;
  for (const std::string_view line : lines_of(text))
    if (line.size() > 72 && line[72] == 'G') all += line.substr(0, 72);
  std::vector<std::string> fields;
  char between = ',', behind = ';';
  for (size_t at = 0; at < all.size();) {
    while (at < all.size() && all[at] == ' ') ++at;
    size_t digits = at;
    while (digits < all.size() && std::isdigit(static_cast<unsigned char>(all[digits]))) ++digits;
    std::string field;
    if (digits > at && digits < all.size() && all[digits] == 'H') {  // 2HMM
      const size_t n = std::strtoul(all.c_str() + at, nullptr, 10);
      field = all.substr(digits + 1, n);
      at = std::min(all.size(), digits + 1 + n);
      while (at < all.size() && all[at] == ' ') ++at;
    } else {
      const size_t stop = std::min(all.find_first_of(std::string{between, behind}, at), all.size());
      field = all.substr(at, stop - at);
      at = stop;
    }
    if (fields.size() == 0 && !field.empty()) between = field[0];
    if (fields.size() == 1 && !field.empty()) behind = field[0];
    fields.push_back(field);
    if (at < all.size() && all[at] == behind && fields.size() > 1) break;
    ++at;
  }
  return fields;
}

std::string colour_of(int dim, int tag) {
  int r = 0, g = 0, b = 0, a = 0;
  gmsh::model::getColor(dim, tag, r, g, b, a);
  return a == 0 ? "" : fmt::format("colour_{:02x}{:02x}{:02x}", r, g, b);  // without a colour of its own it is transparent
}

std::string short_name(int tag) {
  std::string name;
  gmsh::model::getEntityName(3, tag, name);
  name = name.substr(name.rfind('/') + 1);
  return name.empty() || name.starts_with("Open CASCADE STEP translator") ? fmt::format("volume_{}", tag) : name;  // the writer's own
}

/// Area or length, and centre, of a face or an edge: what tells it from others after its number has changed.
std::array<double, 4> print_of(int dim, int tag) {
  std::array<double, 4> p{};
  gmsh::model::occ::getMass(dim, tag, p[0]);
  gmsh::model::occ::getCenterOfMass(dim, tag, p[1], p[2], p[3]);
  return p;
}

/// Faces or edges under a name, to be found again after the solids are cut at one another.
class Prints {
 public:
  explicit Prints(int dim) : dim_(dim) {}
  void add(const std::string& name, int tag) { prints_[name].push_back(print_of(dim_, tag)); }
  bool empty() const { return prints_.empty(); }
  void look_at(int tag) {
    const auto print = print_of(dim_, tag);
    const double length = dim_ == 2 ? std::sqrt(std::abs(print[0])) : print[0];
    const auto is_it = [&](const std::array<double, 4>& p) {
      return std::abs(p[0] - print[0]) < 1e-6 * print[0] && std::hypot(p[1] - print[1], p[2] - print[2], p[3] - print[3]) < 1e-6 * length;
    };
    for (auto& [name, prints] : prints_)  // of two solids that touch both may give it the name
      if (std::erase_if(prints, is_it) > 0) groups_[name].push_back(tag);
  }
  void make_groups(std::vector<std::string>& notes) const {
    for (const auto& [name, tags] : groups_) gmsh::model::setPhysicalName(dim_, gmsh::model::addPhysicalGroup(dim_, tags), name);
    for (const auto& [name, prints] : prints_)
      if (!prints.empty())
        notes.push_back(fmt::format("{}: {} of its {} were cut where solids touch, and are not in the set", name, prints.size(),
                                    dim_ == 2 ? "faces" : "edges"));
  }

 private:
  int dim_;
  std::map<std::string, std::vector<std::array<double, 4>>> prints_;
  std::map<std::string, std::vector<int>> groups_;
};

}  // namespace

std::optional<LengthUnit> step_unit(const std::string& text) {
  const auto records = records_of_units(text);
  std::vector<double> found;
  for (const auto& [id, record] : records)
    for (size_t at = record.find("GLOBAL_UNIT_ASSIGNED_CONTEXT("); at != record.npos && at < record.size() && record[at] != ')';) {
      at = record.find_first_of("#)", at + 1);
      if (at == record.npos || record[at] == ')') break;
      const double metre = metres_of(records, reference(record, at));
      if (metre > 0 && std::none_of(found.begin(), found.end(), [&](double m) { return std::abs(m - metre) < 1e-9 * m; }))
        found.push_back(metre);
    }
  if (found.empty()) return std::nullopt;
  return LengthUnit{found.size() > 1 ? "" : name_of(found[0]), found[0]};
}

std::optional<LengthUnit> iges_unit(const std::string& text) {
  const auto fields = global_section(text);
  if (fields.size() < 14) return std::nullopt;
  static const std::map<int, double> by_flag{{1, 0.0254}, {2, 1e-3},    {4, 0.3048}, {5, 1609.344}, {6, 1},
                                             {7, 1e3},    {8, 2.54e-5}, {9, 1e-6},   {10, 1e-2},    {11, 2.54e-8}};
  static const std::map<std::string, double> by_name{{"IN", 0.0254}, {"INCH", 0.0254}, {"MM", 1e-3},     {"FT", 0.3048}, {"MI", 1609.344},
                                                     {"M", 1},       {"KM", 1e3},      {"MIL", 2.54e-5}, {"UM", 1e-6},   {"CM", 1e-2}};
  const auto flag = by_flag.find(static_cast<int>(std::strtol(fields[13].c_str(), nullptr, 10)));
  if (flag != by_flag.end()) return LengthUnit{name_of(flag->second), flag->second};
  const auto name = fields.size() > 14 ? by_name.find(fields[14]) : by_name.end();
  if (name == by_name.end()) return std::nullopt;
  return LengthUnit{name_of(name->second), name->second};
}

void join_touching(bool keep_apart, const std::vector<NamedEntity>& named, std::map<std::string, std::vector<int>>& solids,
                   std::vector<std::string>& notes) {
  gmsh::vectorpair volumes, faces;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getEntities(faces, 2);
  std::map<int, std::string> name, solid_colour;
  std::set<std::string> taken;
  for (const auto& [dim, tag] : volumes) {
    name[tag] = short_name(tag), solid_colour[tag] = colour_of(3, tag);
    if (!taken.insert(name[tag]).second) taken.insert(name[tag] = fmt::format("{}_{}", name[tag], tag));  // two solids under one label
    gmsh::model::setEntityName(3, tag, name[tag]);
  }
  Prints of_faces(2), of_edges(1);  // faces that have a name, or differ in colour from their solid; edges with a name
  for (const NamedEntity& e : named) (e.dim == 2 ? of_faces : of_edges).add(e.name, e.tag);
  for (const auto& [dim, tag] : faces) {
    std::vector<int> up, down;
    gmsh::model::getAdjacencies(2, tag, up, down);
    const std::string colour = colour_of(2, tag);
    if (!colour.empty() && std::none_of(up.begin(), up.end(), [&](int v) { return solid_colour[v] == colour; })) of_faces.add(colour, tag);
  }
  std::map<int, std::vector<std::string>> parents;  // of the solids that are there in the end
  for (const auto& [dim, tag] : volumes) parents[tag] = {name[tag]};
  if (volumes.size() > 1 && !keep_apart) {
    gmsh::vectorpair made;
    std::vector<gmsh::vectorpair> children;
    try {
      gmsh::model::occ::fragment(volumes, {}, made, children);
      gmsh::model::occ::synchronize();
    } catch (...) {
      children.clear();
      notes.push_back("the solids cannot be cut at one another: where they touch they share no nodes");
    }
    if (!children.empty()) {
      parents.clear();
      std::map<int, std::string> colour;
      for (size_t i = 0; i < volumes.size(); ++i)
        for (const auto& [dim, tag] : children[i])
          if (dim == 3) {
            auto& of = parents[tag];
            of.push_back(name[volumes[i].second]);
            if (of.size() == 1) {
              gmsh::model::setEntityName(3, tag, of[0]);
              colour[tag] = solid_colour[volumes[i].second];
            } else
              notes.push_back(
                  fmt::format("warning: the solids \"{}\" and \"{}\" overlap: the common part is of \"{}\"", of[0], of.back(), of[0]));
          }
      solid_colour = std::move(colour);
    }
  }
  std::set<std::string> pairs;
  size_t shared = 0;
  gmsh::model::getEntities(faces, 2);
  for (const auto& [dim, tag] : faces) {
    std::vector<int> up, down;
    gmsh::model::getAdjacencies(2, tag, up, down);
    if (up.size() == 2 && parents.contains(up[0]) && parents.contains(up[1])) {
      const auto &a = parents[up[0]][0], &b = parents[up[1]][0];
      ++shared, pairs.insert(a < b ? fmt::format("\"{}\" and \"{}\"", a, b) : fmt::format("\"{}\" and \"{}\"", b, a));
    }
    if (!of_faces.empty()) of_faces.look_at(tag);
  }
  if (!of_edges.empty()) {
    gmsh::vectorpair edges;
    gmsh::model::getEntities(edges, 1);
    for (const auto& [dim, tag] : edges) of_edges.look_at(tag);
  }
  if (shared)
    notes.push_back(
        fmt::format("{} faces of solids that touch have their nodes in common, as if glued (--keep-apart leaves solids apart): {}", shared,
                    some(pairs, 6)));
  of_faces.make_groups(notes);
  of_edges.make_groups(notes);
  std::set<std::string> all;
  for (const auto& [tag, colour] : solid_colour) all.insert(colour);
  if (all.size() > 1)
    for (const auto& [tag, colour] : solid_colour)
      if (!colour.empty()) solids[colour].push_back(tag);
}

}  // namespace hilo
