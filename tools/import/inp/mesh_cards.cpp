// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that make the mesh: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "import/inp/card.hpp"
#include "import/inp/passes.hpp"

namespace hilo {
namespace {

constexpr const char* supported =
    "C3D4, C3D6, C3D8, C3D10, C3D15, C3D20 and their I, R, H, M, T variants, T3D2, B31, B32, B33; as rigid regions or by --thicken "
    "S3, S4, S6, S8";

InpSet& set_named(const std::string& name, std::map<std::string, InpSet>& sets, std::vector<std::string>& order) {
  const std::string key = upper(name);
  auto [it, fresh] = sets.try_emplace(key);
  if (fresh) {
    it->second.name = name;
    order.push_back(key);
  }
  return it->second;
}

/// A set that the assembly is about to make: one of the part that has this name makes room, "INSTANCE.NAME".
void make_room(const std::string& name, bool of_nodes, InpDeck& d) {
  const std::string key = upper(name);
  auto& part = of_nodes ? d.part_nsets : d.part_elsets;
  if (!d.in_assembly || !part.erase(key)) return;
  auto& sets = of_nodes ? d.nset : d.elset;
  auto& order = of_nodes ? d.nset_order : d.elset_order;
  const std::string other = upper(d.instance) + "." + key;
  auto set = sets.extract(key);
  set.key() = other;
  set.mapped().name = d.instance + "." + set.mapped().name;
  sets.insert(std::move(set));
  std::replace(order.begin(), order.end(), key, other);
  for (InpSurface& s : d.surfaces)
    for (auto& l : s.lines)
      if (s.of_nodes == of_nodes && l.target == key) l.target = other;
  for (InpSection& s : d.sections)
    if (!of_nodes && s.elset == key) s.elset = other;
}

void read_nodes(const Card& card, InpLines& lines, InpDeck& d, Imported& in) {
  const std::string system = card.word("SYSTEM", "R");
  if (system != "R" && system != "C")
    throw Error(card.place("SYSTEM"), "*NODE in spherical axes is not read", "write the nodes in rectangular or cylindrical axes");
  InpSet* set = card.has("NSET") ? &set_of_nodes(card.need("NSET"), d) : nullptr;
  for (DataLine l; lines.next_data(l);) {
    auto id = l.integer(0);
    if (id < 1 || id >= (d.shift ? instance_numbers : assembly_numbers))
      throw Error(l.place(0), fmt::format("node number {} is not one", id));
    id += d.node_shift();
    Vec3 x = l.vector(1);
    if (const double t = x[1] * std::numbers::pi / 180; system == "C") x = Vec3(x[0] * std::cos(t), x[0] * std::sin(t), x[2]);
    x = d.system_at + d.system_axes * x;
    const auto [it, fresh] = d.node.try_emplace(id, static_cast<std::int64_t>(d.X.size()));
    if (fresh) {
      d.X.push_back(x);
      d.node_id.push_back(id);
    } else if (d.X[it->second] == x)
      in.skip("*NODE: the same node again, at the same place", l.place());
    else
      throw Error(l.place(0), fmt::format("node {} is given twice, at two places", id), "number each node once");
    if (set) set->members.push_back(id);
  }
}

/// Axes of the nodes that follow: their origin, a point of the first one, and one of the plane of the first two; nothing: those of the
/// model.
void read_system(InpReading& r) {
  InpDeck& d = r.deck;
  d.system_at = Vec3::Zero(), d.system_axes = Mat3::Identity();
  std::vector<double> x;
  std::string place = r.card.place();
  for (DataLine l; r.lines.next_data(l);) {
    place = l.place();
    for (size_t i = 0; i < l.fields.size(); ++i) x.push_back(l.number(i));
    x.resize(x.size() <= 3 ? 3 : x.size() <= 6 ? 6 : 9);
  }
  if (x.empty()) return;
  const auto at = [&](size_t i) { return Vec3(x[3 * i], x[3 * i + 1], x[3 * i + 2]); };
  d.system_at = at(0);
  if (x.size() == 3) return;
  // without a third point the axes turn about the third one of the model
  const Vec3 a = at(1) - at(0), b = x.size() == 9 ? Vec3(at(2) - at(0)) : Vec3(Vec3::UnitZ().cross(a)), z = a.cross(b);
  if (!(z.norm() > 1e-9 * a.norm() * b.norm()) || !(a.norm() > 0)) throw Error(place, "*SYSTEM: its points are on a line");
  d.system_axes.col(0) = a.normalized(), d.system_axes.col(2) = z.normalized();
  d.system_axes.col(1) = d.system_axes.col(2).cross(d.system_axes.col(0));
}

/// How many nodes a beam has; 0: no beam.
size_t nodes_of_beam(const std::string& type) {
  static const std::map<std::string, size_t> types{{"B31", 2}, {"B31R", 2}, {"B31H", 2}, {"B33", 2}, {"B32", 3}, {"B32R", 3}, {"B32H", 3}};
  const auto known = types.find(type);
  return known == types.end() ? 0 : known->second;
}

void read_elements(InpReading& r) {
  r.card.find("PARENT");  // the cell that it was divided from
  if (read_points(r, upper(r.card.need("TYPE")))) return;
  const Card& card = r.card;
  InpLines& lines = r.lines;
  InpDeck& d = r.deck;
  Imported& in = r.in;
  const std::string type = upper(card.need("TYPE"));
  const size_t of_beam = nodes_of_beam(type);
  const Shape shape = of_beam ? Shape::bar2 : inp_shape(card);
  const bool pyramid = type.starts_with("C3D5");
  const size_t n = pyramid ? 5 : of_beam ? of_beam : static_cast<size_t>(info(shape).n_nodes);
  InpSet* set = card.has("ELSET") ? &set_of_cells(card.need("ELSET"), d) : nullptr;
  std::vector<std::int64_t> row;
  for (DataLine l; lines.next_data(l);) {
    const std::string place = l.place(0);
    const int line = l.line;
    const std::string* file = &*d.files.insert(*l.file).first;  // the lines close before the cells are resolved
    row.clear();
    for (size_t i = 0; i < l.fields.size(); ++i) row.push_back(l.integer(i));
    while (row.size() < n + 1) {
      if (!lines.next_data(l))
        throw Error(place, fmt::format("element {} has {} of its {} nodes", row.empty() ? 0 : row[0], row.empty() ? 0 : row.size() - 1, n));
      for (size_t i = 0; i < l.fields.size(); ++i) row.push_back(l.integer(i));
    }
    for (auto& number : row) number += d.shift;
    if (of_beam && row.size() == n + 2) d.towards[row[0]] = row.back(), row.pop_back();
    if (row.size() > n + 1) {  // as CalculiX reads it
      in.skip(fmt::format("*ELEMENT, TYPE={}: numbers after its {} nodes", upper(card.value("TYPE")), n), l.place());
      row.resize(n + 1);
    }
    if (d.has_element(row[0])) throw Error(place, fmt::format("element {} is given twice", row[0]), "number each element once");
    if (set) set->members.push_back(row[0]);
    if (of_beam) {
      d.beams[row[0]] = {type, row[0], {row.begin() + 1, row.end()}, place, file, line};
      continue;
    }
    const auto nodes = std::span<const std::int64_t>(row).subspan(1);
    if (!pyramid) {
      d.add_cell(row[0], shape, nodes, file, line);
      continue;
    }
    const auto halves = halves_of_pyramid(nodes);
    d.add_cell(row[0], shape, halves[0], file, line), d.add_cell(row[0] + second_half, shape, halves[1], file, line);
    d.pyramids.insert({row[0], row[0] + second_half});
  }
}

/// *NSET and *ELSET; a name among the data stands for the set of that name.
void read_set(const Card& card, const std::string& key, InpLines& lines, std::map<std::string, InpSet>& sets,
              std::vector<std::string>& order, InpDeck& d) {
  const std::string name = card.need(key);
  make_room(name, key == "NSET", d);
  set_named(name, sets, order).unsorted |= card.has("UNSORTED");
  const auto of_instance = d.shift_of.find(card.word("INSTANCE"));
  const std::int64_t shift = of_instance != d.shift_of.end()          ? of_instance->second
                             : key == "ELSET" || card.has("INSTANCE") ? d.shift
                                                                      : d.node_shift();
  const auto find = [&](std::string_view text) {  // a set so far, by its name or its qualified one
    for (const std::string& prefix : {d.prefix, card.has("INSTANCE") ? card.value("INSTANCE") + "." : ""})
      if (const auto own = sets.find(upper(prefix + std::string(text))); !prefix.empty() && own != sets.end()) return own;
    const auto exact = sets.find(upper(text));
    return exact != sets.end() ? exact : sets.find(unqualified(upper(text)));
  };
  std::vector<std::int64_t> add;
  if (key == "NSET" && card.has("ELSET")) {  // the nodes of an element set
    const auto it = d.elset.find(card.word("ELSET"));
    if (it == d.elset.end()) throw Error(card.place("ELSET"), fmt::format("no element set \"{}\"", card.value("ELSET")));
    for (const auto e : it->second.members)
      if (const auto b = d.beams.find(e); b != d.beams.end())
        add.insert(add.end(), b->second.nodes.begin(), b->second.nodes.end());
      else
        for (const auto half : {e, e + second_half})
          if (const auto c = d.cell.find(half); c != d.cell.end())
            add.insert(add.end(), d.cell_nodes.begin() + d.offset[c->second], d.cell_nodes.begin() + d.offset[c->second + 1]);
  }
  for (DataLine l; lines.next_data(l);) {
    if (card.has("GENERATE")) {
      if (!l.is_integer(0)) {  // CalculiX: a set name stands for itself here too
        const auto it = find(l.text(0));
        if (it == sets.end()) throw Error(l.place(0), fmt::format("GENERATE: expected first, last, increment, found \"{}\"", l.text(0)));
        add.insert(add.end(), it->second.members.begin(), it->second.members.end());
        continue;
      }
      const auto first = l.integer(0), last = l.integer(1, first), by = l.integer(2, 1);
      if (by < 1 || last < first || (last - first) / by > 1'000'000'000)
        throw Error(l.place(0), fmt::format("GENERATE: {}, {}, {} names no usable range", first, last, by));
      for (auto i = first; i <= last; i += by) add.push_back(i + shift);
      continue;
    }
    for (size_t i = 0; i < l.fields.size(); ++i) {
      if (l.empty(i)) continue;
      if (l.is_integer(i)) {
        add.push_back(l.integer(i) + shift);
        continue;
      }
      const std::string_view text = unquote(l.text(i));
      if (const DataLine own{l.file, l.line, {{text.substr(text.rfind('.') + 1), l.fields[i].column}}};
          text.find('.') != text.npos && own.is_integer(0)) {  // "PART-1-1.17"
        const auto qualified = d.shift_of.find(upper(text.substr(0, text.rfind('.'))));
        add.push_back(own.integer(0) + (qualified == d.shift_of.end() ? 0 : qualified->second));
        continue;
      }
      const auto it = find(text);
      if (it == sets.end()) throw Error(l.place(i), fmt::format("no set \"{}\" so far", text), suggest_name(std::string(text), sets));
      add.insert(add.end(), it->second.members.begin(), it->second.members.end());
    }
  }
  auto& members = sets[upper(name)].members;
  members.insert(members.end(), add.begin(), add.end());
}

void read_surface(const Card& card, InpLines& lines, InpDeck& d, Imported& in) {
  InpSurface s;
  s.name = card.need("NAME");
  if (d.in_assembly)
    for (InpSurface& other : d.surfaces)
      if (upper(other.name) == upper(s.name) && other.name.find('.') == std::string::npos) other.name = d.instance + "." + other.name;
  const std::string type = card.word("TYPE", "ELEMENT");
  s.of_nodes = type == "NODE";
  if (!s.of_nodes && type != "ELEMENT") {
    in.skip(fmt::format("*SURFACE, TYPE={}", type), card.place());
    return;
  }
  for (DataLine l; lines.next_data(l);) {
    InpSurface::Line one{{"", 0, l.place()}};
    if (l.is_integer(0))
      one.id = l.integer(0) + (s.of_nodes ? d.node_shift() : d.shift);
    else
      one.target = upper(d.prefix) + upper(unquote(l.text(0)));
    const std::string face = upper(l.text(1));
    const bool by_face = !s.of_nodes && !face.empty();
    if (by_face && (face == "SPOS" || face == "SNEG"))
      one.face = face == "SPOS" ? 2 : 1, one.of_shell = true;
    else if (by_face && face.size() == 2 && face[0] == 'S' && face[1] >= '1' && face[1] <= '6')
      one.face = face[1] - '0';
    else if (by_face) {
      in.skip(fmt::format("*SURFACE: face {}", face), l.place());
      continue;
    }
    s.lines.push_back(one);
  }
  d.surfaces.push_back(std::move(s));
}

}  // namespace

void InpDeck::add_cell(std::int64_t id, Shape of, std::span<const std::int64_t> nodes, const std::string* at_file, int at_line) {
  cell[id] = static_cast<std::int64_t>(shape.size());
  shape.push_back(static_cast<std::uint8_t>(of));
  cell_id.push_back(id);
  cell_nodes.insert(cell_nodes.end(), nodes.begin(), nodes.end());
  offset.push_back(static_cast<std::int64_t>(cell_nodes.size()));
  cell_line.push_back(at_line);
  cell_file.push_back(at_file);
}

InpSet& set_of_cells(const std::string& name, InpDeck& d) {
  make_room(name, false, d);
  return set_named(name, d.elset, d.elset_order);
}
InpSet& set_of_nodes(const std::string& name, InpDeck& d) {
  make_room(name, true, d);
  return set_named(name, d.nset, d.nset_order);
}

Shape inp_shape(const Card& card) {
  const std::string type = upper(card.need("TYPE"));
  const std::string place = card.place("TYPE");
  const auto refuse = [&](const std::string& why) {
    return Error(place, fmt::format("element type \"{}\": {}", type, why), fmt::format("supported: {}", supported));
  };
  if (type == "T3D2") return Shape::bar2;
  static const std::map<std::string, Shape> shells{{"S3", tri3},  {"S3R", tri3},  {"S6", tri6},  {"STRI3", tri3}, {"STRI65", tri6},
                                                   {"S4", quad4}, {"S4R", quad4}, {"S8", quad8}, {"S8R", quad8}};
  if (const auto shell = shells.find(type); shell != shells.end()) return shell->second;
  if (type.substr(0, 3) == "C3D") {
    size_t i = 3;
    while (i < type.size() && std::isdigit(static_cast<unsigned char>(type[i]))) ++i;
    const std::string nodes = type.substr(3, i - 3), variant = type.substr(i);
    if (variant.find_first_not_of("IRHMST") == std::string::npos) {
      if (nodes == "4") return Shape::tet4;
      if (nodes == "6") return Shape::wedge6;
      if (nodes == "8") return Shape::hex8;
      if (nodes == "10") return Shape::tet10;
      if (nodes == "15") return Shape::wedge15;
      if (nodes == "20") return variant.find('R') == std::string::npos ? Shape::hex20 : Shape::hex20r;
    }
    if (nodes == "5") return Shape::tet4;  // two of them
    if (nodes == "13") throw refuse("pyramids of mid-side nodes are not read");
    throw refuse("this solid is not read");
  }
  // Prefixes from the longest to the shortest, each with its reason.
  static const std::pair<const char*, const char*> reasons[] = {
      {"DCOUP", "a coupling element is not a solid; a set serves as a patch in the scene"},
      {"SPRING", "springs between two components are not read; say [[spring]] in the scene"},
      {"DASHPOT", "dampers between components are not read; say [[spring]] in the scene"},
      {"CONN3D", "connectors are not read; say [[joint]] in the scene"},
      {"ROTARYI", "rotary inertia is not read; say [[body]] in the scene"},
      {"GAP", "gap elements are not read"},
      {"COH", "cohesive elements are not read"},
      {"DC3D", "heat-transfer elements are not read"},
      {"CAX", "axisymmetric elements are not three-dimensional"},
      {"CPS", "plane-stress elements are not three-dimensional"},
      {"CPE", "plane-strain elements are not three-dimensional"},
      {"SAX", "axisymmetric shells are not three-dimensional"},
      {"F3D", "fluid elements are not read"},
      {"M3D", "membranes are not read"},
      {"SFM3D", "surface elements are not read"},
      {"T2D", "plane trusses are not read"},
      {"T3D", "trusses of three nodes are not read"},
      {"R3D", "rigid elements are not read; make the region rigid with hilo-tag"},
      {"B2", "plane beams are not read"},
      {"B3", "beams of three nodes are not read"},
      {"S", "this shell is not read"},
      {"D", "network elements are not read"},
      {"U", "user elements are not read"},
  };
  for (const auto& [prefix, why] : reasons)
    if (type.rfind(prefix, 0) == 0) throw refuse(why);
  throw refuse("unknown to hilo");
}

int inp_facet(Shape shape, int face) {
  // corners of the faces S1.. of an element, counted from 0, by its number of corners
  static const std::map<int, std::vector<std::vector<int>>> of_corners{
      {4, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}},
      {6, {{0, 1, 2}, {3, 4, 5}, {0, 1, 3, 4}, {1, 2, 4, 5}, {0, 2, 3, 5}}},
      {8, {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5}, {1, 2, 5, 6}, {2, 3, 6, 7}, {0, 3, 4, 7}}}};
  const ShapeInfo& s = info(shape);
  const auto known = of_corners.find(s.n_corners);
  if (s.dimension != 3 || known == of_corners.end()) return -1;
  const auto& faces = known->second;
  if (face < 1 || face > static_cast<int>(faces.size())) return -1;
  for (size_t f = 0; f < s.facets.size(); ++f) {
    auto corners = facet_corners(s, f);
    std::ranges::sort(corners);
    if (corners == faces[face - 1]) return static_cast<int>(f);
  }
  return -1;
}

std::vector<InpCard> inp_mesh_cards() {
  return {
      {"NODE", [](InpReading& r) { read_nodes(r.card, r.lines, r.deck, r.in); }},
      {"SYSTEM", read_system},
      {"ELEMENT", read_elements},
      {"NSET", [](InpReading& r) { read_set(r.card, "NSET", r.lines, r.deck.nset, r.deck.nset_order, r.deck); }},
      {"ELSET", [](InpReading& r) { read_set(r.card, "ELSET", r.lines, r.deck.elset, r.deck.elset_order, r.deck); }},
      {"SURFACE", [](InpReading& r) { read_surface(r.card, r.lines, r.deck, r.in); }},
  };
}

}  // namespace hilo
