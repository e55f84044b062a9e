// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of no cell that something is tied to become bodies of the scene, or the mean of the nodes they pull.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.hpp"
#include "import/inp/passes.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {
namespace {

constexpr size_t most_rows = 2000;  // nodes of a coupling of some components: joints for each

/// The node that a target names.
std::int64_t node_of(const InpDeck& d, const InpTarget& t) {
  auto ids = numbers_of(d, t);
  sort_unique(ids);
  if (ids.size() != 1) throw Error(t.place, fmt::format("node set \"{}\" holds {} nodes, one is due", t.target, ids.size()));
  return ids.front();
}

Vec3 place_of(const InpDeck& d, std::int64_t id, const std::string& place) {
  const auto x = d.loose.find(id);
  if (x == d.loose.end()) throw Error(place, fmt::format("no node {}", id));
  return x->second;
}

/// Numbers of the nodes of its set, or of its surface of nodes, those of no cell too.
std::vector<std::int64_t> ids_of(const InpDeck& d, const InpTie& t) {
  std::vector<std::int64_t> ids;
  const auto add = [&](const InpTarget& of) {
    const auto more = numbers_in(d.nset, of);
    ids.insert(ids.end(), more.begin(), more.end());
  };
  if (t.kind == InpTie::Of::nodes) add({t.of});
  if (t.kind == InpTie::Of::surface)
    for (const InpSurface& s : d.surfaces)
      if (s.of_nodes && upper(s.name) == t.of)
        for (const auto& l : s.lines) add(l);
  sort_unique(ids);
  return ids;
}

/// Nodes of a surface with the area that each stands for; of sets 1 each.
std::map<std::int64_t, double> members(const InpDeck& d, const InpTie& t, const Mesh& m,
                                       const std::map<std::string, std::string>& surface) {
  std::map<std::int64_t, double> w;
  const auto add = [&](const std::vector<std::int64_t>& nodes) {
    for (const auto a : nodes) w[a] = 1;
  };
  if (t.kind == InpTie::Of::nodes) {
    add(inp_nodes(d, {t.of, 0, t.place}));
  } else if (t.kind == InpTie::Of::weighted) {
    for (const auto& [of, weight] : t.weights)
      for (const auto a : inp_nodes(d, of)) w[a] += weight;
  } else if (t.kind == InpTie::Of::cells) {
    for (const auto c : inp_cells(d, {t.of, 0, t.place})) add({m.cell(c).begin(), m.cell(c).end()});
  } else if (const auto s = surface.find(t.of); s != surface.end() && m.facet_sets.contains(s->second)) {
    for (const Facet& f : m.facet_sets.at(s->second)) {
      const auto nodes = m.facet_nodes(f);
      const double area = facet_area(m, f).norm();
      const size_t n = nodes.size(), corners = n == 6 ? 3 : n == 8 ? 4 : n;
      for (size_t i = 0; i < n; ++i)  // consistent with a pressure: quadratic facets push at the middle of their edges
        w[nodes[i]] += area * (n == corners ? 1. / static_cast<double>(n) : i >= corners ? 1. / 3 : n == 6 ? 0. : -1. / 12);
    }
  } else {
    bool found = false;
    for (const InpSurface& s2 : d.surfaces)
      if (s2.of_nodes && upper(s2.name) == t.of) {
        found = true;
        for (const auto& l : s2.lines) add(inp_nodes(d, l));
      }
    if (!found) throw Error(t.place, fmt::format("{}: no surface \"{}\"", t.name, t.of));
  }
  return w;
}

/// The node of the one DCOUP3D of its element set.
std::int64_t node_of_coupling(const InpDeck& d, const InpTie& t) {
  const InpSet& set = set_of(d.elset, t.reference, "element", false);
  const InpPoint* one = nullptr;
  for (const auto id : set.members)
    if (const auto p = d.points.find(id); p != d.points.end() && p->second.type == "DCOUP3D") {
      if (one) throw Error(t.place, fmt::format("{}: element set \"{}\" has several DCOUP3D", t.name, set.name), "one for each");
      one = &p->second;
    }
  if (!one) throw Error(t.place, fmt::format("{}: element set \"{}\" has no DCOUP3D", t.name, set.name));
  return one->nodes[0];
}

/// In the middle of what a rigid body carries.
Vec3 mean_of(const InpDeck& d, const InpTie& t, const std::map<std::int64_t, double>& w, const Mesh& m) {
  Vec3 sum = Vec3::Zero();
  double n = 0;
  for (const auto& [a, weight] : w) sum += m.X[a], n += 1;
  if (n == 0)
    for (const auto id : ids_of(d, t))
      if (const auto x = d.loose.find(id); x != d.loose.end()) sum += x->second, n += 1;
  return n > 0 ? Vec3(sum / n) : sum;
}

/// `w`: the nodes of cells that it takes, with weights; `ref`: its reference node.
void find_tie(InpDeck& d, Imported& in, const InpTie& t, std::map<std::int64_t, double> w, std::int64_t ref) {
  if (t.undecided) return in.skip(t.name + " without *KINEMATIC or *DISTRIBUTING", t.place);
  if (d.node.contains(ref) && !d.bodies.contains(ref)) return in.skip(t.name + " whose reference node is a node of a cell", t.place);
  if (in.sheets && !t.mean) {  // a patch of pairs turns with the body, and must not lie on a line
    std::vector<Vec3> points;
    for (const auto& [a, weight] : w) points.push_back(in.mesh.X[static_cast<size_t>(a)]);
    if (t.components != 63 || on_a_line(points))
      for (const auto& [a, weight] : w)
        if (!in.sheets->at(a).empty())
          d.bodies.try_emplace(in.mesh.node_id[static_cast<size_t>(a)], InpBody{in.mesh.X[static_cast<size_t>(a)], t.place, {}});
  }
  std::vector<std::int64_t> beams;  // nodes of beams, and others that are bodies, among them
  std::vector<std::int64_t> ids = ids_of(d, t);
  for (const auto& [a, weight] : w) ids.push_back(in.mesh.node_id[static_cast<size_t>(a)]);
  sort_unique(ids);
  for (const auto id : ids)
    if (d.bodies.contains(id) && id != ref) {
      beams.push_back(id);
      if (const auto a = d.node.find(id); a != d.node.end()) w.erase(a->second);
    }
  if (t.kind == InpTie::Of::surface && w.empty() && beams.empty())
    throw Error(t.place, fmt::format("{}: no node of surface \"{}\" is of a cell or a beam", t.name, t.of));
  if (t.kind != InpTie::Of::nodes && !d.beams.empty())
    if (const auto set = d.elset.find(t.of);
        set != d.elset.end() && std::ranges::any_of(set->second.members, [&](auto id) { return d.beams.contains(id); }))
      throw Error(t.place, fmt::format("{}: element set \"{}\" has beams", t.name, set->second.name), "a set of their nodes");
  if (!t.mean && !beams.empty() && t.components != 63 && t.own_axes)
    return in.skip(t.name + " of some components in axes of its own, of nodes of beams", t.place);
  if (t.mean && !beams.empty()) return in.skip(t.name + ", distributing, of nodes of beams", t.place);
  if (t.mean) {
    if (t.own_axes && (t.components & 7) != 7)
      in.skip(t.name + ", distributing, of some components in axes of its own", t.place);
    else if (d.bodies.contains(ref))
      in.skip(t.name + ", distributing, whose node carries springs, masses or rigid bodies", t.place);
    else if (!d.means.try_emplace(ref, InpMean{place_of(d, ref, t.place), w, t.place}).second)
      in.skip(t.name + " of a node that has one already", t.place);
    return;
  }
  if ((t.components & 7) != 7 && (t.own_axes || (!w.empty() && (t.components & 7) == 0) || w.size() > most_rows))
    return in.skip(t.name + (t.own_axes             ? " of some components in axes of its own"
                             : w.size() > most_rows ? fmt::format(" of some components of more than {} nodes", most_rows)
                                                    : " of turns alone, which nodes of solids do not have"),
                   t.place);
  if (d.means.erase(ref) > 0) in.skip("*DISTRIBUTING of a node that is *KINEMATIC too", t.place);
  auto& body = d.bodies.try_emplace(ref, InpBody{place_of(d, ref, t.place), t.place, {}}).first->second;
  std::vector<std::int64_t> rows;
  for (const auto& [a, weight] : w) rows.push_back(a);
  if (!rows.empty()) body.carries.push_back({t.name, t.place, rows, t.components & 7});
  for (const auto id : beams) body.bodies.emplace_back(id, t.components);
  if (!t.turns.target.empty() || t.turns.id) d.turns_of[node_of(d, t.turns)] = ref;
}

}  // namespace

void find_ties(InpDeck& d, Imported& in, const std::map<std::string, std::string>& surface) {
  std::int64_t own = 0;  // numbers below zero are reference nodes that the deck does not have
  std::set<std::int64_t> turns;
  for (const InpTie& t : d.ties)
    if (!t.left_out && (!t.turns.target.empty() || t.turns.id)) turns.insert(node_of(d, t.turns));
  for (const auto& [id, p] : d.points)
    for (const auto n : p.nodes)
      if (p.type != "DCOUP3D" && !d.node.contains(n) && !turns.contains(n))
        d.bodies.try_emplace(n, InpBody{place_of(d, n, p.place), p.place, {}});
  for (const InpTie& t : d.ties) {
    if (t.left_out) continue;
    const auto w = members(d, t, in.mesh, surface);
    const auto ref = t.no_node ? --own : t.kind == InpTie::Of::weighted ? node_of_coupling(d, t) : node_of(d, t.reference);
    if (t.no_node) d.loose[ref] = mean_of(d, t, w, in.mesh);
    find_tie(d, in, t, w, ref);
  }
}

bool is_tied(const InpDeck& d, std::int64_t id) {
  return is_slide(d, id) || d.bodies.contains(id) || d.means.contains(id) || d.turns_of.contains(id);
}

void tied_lines(const InpDeck& d, const InpNodal& l, const std::function<void(std::int64_t, int, int)>& use) {
  auto ids = numbers_in(d.nset, l);
  sort_unique(ids);
  for (const auto id : ids) {
    if (const auto turns = d.turns_of.find(id); turns != d.turns_of.end())
      use(turns->second, l.first + 3, std::min(l.last, 3) + 3);  // 1 to 3 of a ROT NODE are turns
    else if (is_tied(d, id))
      use(id, l.first, l.last);
  }
}

/// No name of a set: what names one would mean the other.
std::string body_name(const InpDeck& d, std::int64_t id) {
  const bool assembly = id >= assembly_numbers;
  std::string name = id < 0 ? fmt::format("rigid_body_{}", -id) : fmt::format("node_{}", assembly ? id - assembly_numbers : id);
  if (assembly && d.node.contains(id - assembly_numbers)) name = "assembly_" + name;
  return free_body_name(d, name);
}

static const std::vector<std::int64_t>& elements_of(const InpDeck& d, const InpPointValue& v) {
  auto set = d.elset.find(v.elset);
  if (set == d.elset.end()) set = d.elset.find(unqualified(v.elset));
  if (set == d.elset.end()) throw Error(v.place, fmt::format("{}: no element set \"{}\"", v.name, v.elset), suggest_name(v.elset, d.elset));
  return set->second.members;
}

double size_of(const InpDeck& d, const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.X) box.extend(x);
  for (const auto& [id, b] : d.bodies) box.extend(b.X);
  const double size = box.isEmpty() ? 0 : box.diagonal().norm();
  return size > 0 ? size : 1;
}

std::map<std::int64_t, double> masses_of(const InpDeck& d) {
  std::map<std::int64_t, double> out;
  for (const InpPointValue& v : d.point_values)
    if (v.name == "*MASS" && v.first.size() == 1 && v.first[0] > 0)
      for (const auto id : elements_of(d, v))
        if (const auto p = d.points.find(id); p != d.points.end() && p->second.type == "MASS") out[id] = v.first[0];
  return out;
}

/// Springs and dampers that turn a body about the model's axes, by the displacements of its ROT NODE.
struct Turning {
  Vec3 stiffness = Vec3::Zero(), damping = Vec3::Zero();
  Vec3 at = Vec3::Zero();
  std::string name, place;
};

void write_ties(const InpDeck& d, Imported& in, SetNames& names, const ImportOptions& o, SceneWriter& scene) {
  const auto X = [&](std::int64_t id) { return *point_of(d, in.mesh, id); };
  std::map<std::int64_t, std::string> of_node;
  const auto end_name = [&](std::int64_t id) {
    if (d.bodies.contains(id)) return body_name(d, id);
    auto& name = of_node[id];
    if (name.empty()) name = names.nodes(fmt::format("node_{}", id), {d.node.at(id)}), in.as_listed.insert(name);
    return name;
  };
  std::set<std::int64_t> own_axes;
  for (const InpTransform& t : d.transformed)
    for (const auto id : numbers_of(d, t)) own_axes.insert(id);
  std::map<std::int64_t, double> mass, inertia;
  std::map<std::pair<std::string, std::string>, Turning> turning;  // of what turns against the other, "" the ground
  SceneWriter springs;
  const double size = size_of(d, in.mesh);
  std::set<std::int64_t> valued;
  const auto turn = [&](const InpPointValue& v, const InpPoint& p) {
    const bool two = p.nodes.size() == 2;
    const double dof = v.first[0];
    if (p.type.ends_with('A') || v.table || v.first.size() != 2 || !(dof == 1 || dof == 2 || dof == 3) ||
        (two && (v.second[0] != dof || !d.turns_of.contains(p.nodes[0]) || !d.turns_of.contains(p.nodes[1]))))
      return in.skip(fmt::format("{} of {} on a ROT NODE, but linear and along one of its components 1 to 3{}", v.name, p.type,
                                 two ? ", the same of two such nodes" : ""),
                     v.place);
    const std::int64_t body = d.turns_of.at(p.nodes[0]);
    Turning& t = turning[{two ? body_name(d, d.turns_of.at(p.nodes[1])) : "", body_name(d, body)}];
    (v.name == "*SPRING" ? t.stiffness : t.damping)[static_cast<Eigen::Index>(dof) - 1] += v.first[1];
    if (t.place.empty()) t.name = fmt::format("{}_{}", p.type, p.id), t.place = p.place, t.at = o.point(d.bodies.at(body).X);
  };
  const auto give = [&](const InpPointValue& v, std::int64_t id) {
    const auto p = d.points.find(id);
    if (p == d.points.end() || v.first.empty()) return;
    const std::string& type = p->second.type;
    const double value = v.first.back();
    if (type == "DCOUP3D" || (type == "MASS") != (v.name == "*MASS") || (type[0] == 'S') != (v.name == "*SPRING")) return;
    if (!valued.insert(id).second)
      throw Error(v.place, fmt::format("{} of element {} is given twice", v.name, id), "give each element one value");
    if (v.more)
      in.skip(v.name + (v.table ? ": numbers after the first two, of temperatures"
                                : ": numbers after the first, of temperatures or frequencies"),
              v.place);
    if (!v.table && value < 0) return in.skip(v.name + " below zero", v.place);
    if (type == "MASS" && v.first.size() > 1) return in.skip(v.name + " of several values", v.place);
    const auto& nodes = p->second.nodes;
    const auto turned = [&](std::int64_t n) { return d.turns_of.contains(n); };
    if (!std::ranges::all_of(nodes, [&](auto n) { return d.node.contains(n) || d.bodies.contains(n) || turned(n); }))
      return in.skip(v.name + " on a ROT NODE of which nothing is made", v.place);
    if (type == "MASS") return void((turned(nodes[0]) ? inertia[d.turns_of.at(nodes[0])] : mass[nodes[0]]) += value);
    if (!type.ends_with('A') && std::ranges::any_of(p->second.nodes, [&](auto n) { return own_axes.contains(n); }))
      return in.skip(v.name + " in axes of *TRANSFORM", v.place);
    if (std::ranges::any_of(nodes, turned)) return turn(v, p->second);
    InpPointSpring spring{p->second, v, {}};
    for (const auto node : p->second.nodes) spring.ends.push_back({"", X(node), d.bodies.contains(node)});
    if (const std::string why = why_no_spring(spring); !why.empty()) return in.skip(why, v.place);
    for (size_t k = 0; k < spring.ends.size(); ++k) spring.ends[k].name = end_name(p->second.nodes[k]);
    write_point_spring(d, size, spring, o, springs);
  };
  for (const InpPointValue& v : d.point_values)
    for (const auto id : elements_of(d, v)) give(v, id);
  for (const auto& [id, p] : d.points)
    if (!valued.contains(id) && !(p.type == "DCOUP3D" && d.means.contains(p.nodes[0])))
      in.skip("*ELEMENT, TYPE=" + p.type + " without a value", p.place);

  for (const auto& [id, b] : d.bodies) {
    SceneTable& body = scene.add("body", body_name(d, id), b.place, {{"mass", mass[id] * o.si("kg")}, {"com", o.point(b.X)}});
    if (const double J = inertia[id] * o.si("kg m^2"); J > 0) body.set("inertia", {J, J, J});
    mass.erase(id);
  }
  for (const auto& [id, m] : mass)
    if (m > 0) scene.add("point_mass", end_name(id), "", {{"on", end_name(id)}, {"mass", m * o.si("kg")}});
  for (const auto& [id, b] : d.bodies)
    for (const auto& [other, components] : b.bodies)
      joints_that_hold(scene, components, Mat3::Identity(), fmt::format("{}_{}", body_name(d, id), other), body_name(d, id),
                       body_name(d, other), o.point(X(other)), b.place);
  for (const auto& [id, b] : d.bodies)
    for (const InpCarried& c : b.carries) {
      std::vector<Vec3> points;
      for (const auto a : c.rows) points.push_back(in.mesh.X[a]);
      const std::string body = body_name(d, id);
      if (c.components != 7) {  // planes of the body, in which the nodes stay
        for (const auto a : c.rows)
          for (int k = 0; k < 3; ++k)
            if (c.components >> k & 1)
              joint_to_slide(scene, body, body, end_name(in.mesh.node_id[a]), Vec3::Unit(k), o.point(in.mesh.X[a]), c.place);
        continue;
      }
      if (on_a_line(points)) {
        for (const auto a : c.rows)
          scene.add_unique({"joint", "spherical"}, body, c.place,
                           {{"a", body}, {"b", end_name(in.mesh.node_id[a])}, {"at", o.point(in.mesh.X[a])}});
        continue;
      }
      const std::string as = scene.unique("joint", body);
      scene.add({"joint", "fixed"}, as, c.place, {{"a", body}, {"b", names.nodes(as + "_tied", c.rows)}, {"at", o.point(b.X)}});
    }
  for (const auto& [ends, t] : turning)
    scene
        .add({"spring", "bushing"}, t.name, t.place,
             {{"a", ends.first}, {"b", ends.second}, {"at", t.at}, {"axis", Vec3(Vec3::UnitZ())}, {"x", Vec3(Vec3::UnitX())}})
        .set_if(t.stiffness.norm() > 0, "angular_stiffness", t.stiffness * o.si("N m/rad"))
        .set_if(t.damping.norm() > 0, "angular_damping", t.damping * o.si("N m s/rad"));
  scene.append(springs);
}

}  // namespace hilo
