// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of an .inp deck: their nodes become bodies, their elements beams of the scene between these.
#include <fmt/format.h>

#include <Eigen/Geometry>

#include "base/error.hpp"
#include "import/inp/passes.hpp"

namespace hilo {
namespace {

/// The points of a beam of three nodes as two arcs, each through a point between: the circle through the nodes; straight ones as lines.
std::array<std::vector<Vec3>, 2> halves(const Vec3& a, const Vec3& m, const Vec3& b) {
  const Vec3 u = m - a, v = b - a, normal = u.cross(v);
  if (normal.norm() < 1e-6 * u.norm() * v.norm()) return {{{a, m}, {m, b}}};
  const Vec3 centre = a + (u.squaredNorm() * v - v.squaredNorm() * u).cross(normal) / (2 * normal.squaredNorm());
  const auto between = [&](const Vec3& x, const Vec3& y) -> Vec3 {
    return centre + (x - centre).norm() * ((x + y) / 2 - centre).normalized();  // each half is less than half a turn
  };
  return {{{a, between(a, m), m}, {m, between(m, b), b}}};
}

std::map<std::int64_t, const InpSection*> sections_of(const InpDeck& d) {
  std::map<std::int64_t, const InpSection*> of;
  for (const auto& s : d.sections)
    for (const auto id : d.elset.at(s.elset).members) {
      const auto b = d.beams.find(id);
      if (b == d.beams.end()) continue;
      if (!s.beam.given()) throw Error(s.place, fmt::format("{} on element {}", s.card, id), "it needs *BEAM SECTION");
      of[id] = &s;
    }
  for (const auto& [id, b] : d.beams)
    if (!of.contains(id)) throw Error(b.place, fmt::format("element {} has no section", id), "beams need *BEAM SECTION");
  return of;
}

}  // namespace

Vec3 direction_1(const InpDeck& d, const Mesh& m, const InpSection& s, std::int64_t element, const Vec3& from) {
  const auto towards = d.towards.find(element);
  if (towards == d.towards.end()) return s.n1;
  const Vec3* to = point_of(d, m, towards->second);
  if (!to) throw Error(s.place, fmt::format("element {} is turned towards node {}, which does not exist", element, towards->second));
  return *to - from;
}

void beams_as_cells(InpDeck& d) {
  for (const auto& [id, b] : d.beams) {
    if (b.nodes.size() != 2)
      throw Error(b.place, fmt::format("{} {}: beams of three nodes are no cells of rigid regions", b.type, id), "B31");
    d.add_cell(id, Shape::bar2, b.nodes, b.file, b.line);
    d.beam_cells.insert(id);
  }
  d.beams.clear();
}

void find_beams(InpDeck& d, Imported& in) {
  in.n_beams = static_cast<std::int64_t>(d.beams.size());
  for (const auto& [id, b] : d.beams)
    for (const auto node : b.nodes) {
      const Vec3* X = point_of(d, in.mesh, node);
      if (!X) throw Error(b.place, fmt::format("element {} names node {}, which does not exist", id, node));
      d.bodies.try_emplace(node, InpBody{*X, b.place, {}});
    }
}

void write_beams(const InpDeck& d, Imported& in, SetNames& names, const ImportOptions& o, SceneWriter& scene) {
  std::set<std::string> materials;
  std::map<const InpSection*, std::array<std::string, 2>> written;  // names of section (stiff in shear or not), by B33
  const auto of = sections_of(d);
  std::set<std::string> of_cells;  // materials that cells have written
  for (const auto& s : d.sections)
    for (const auto id : d.elset.at(s.elset).members)
      if (d.cell.contains(id)) of_cells.insert(s.law);
  for (const auto& [id, b] : d.beams) {
    const InpSection& s = *of.at(id);
    const DeckMaterial& m = d.laws.at(s.law);
    const bool thin = b.type == "B33";
    std::string& name = written[&s][thin];
    DeckSection section = s.beam;
    section.no_shear_strain = {thin, thin};
    const bool with_material = has_scene_material(section, m);
    if (name.empty()) {
      name = clean_name(s.elset_name) + (thin ? "_B33" : "");
      for (const auto& [other, used] : written)
        if (other != &s && used[thin] == name) name += fmt::format("_{}", written.size());
      if (m.alpha != 0 || m.beta != 0) in.skip("*DAMPING of beams", s.place);
      if (m.kind != "stvk" || !m.no_law.empty()) in.skip("*PLASTIC of beams, which are linear elastic", s.place);
      if (with_material && !of_cells.contains(s.law) && materials.insert(s.law).second) m.write(scene, o);
      write_section(scene, name, section, section, m, o, s.place);
    }
    std::vector<Vec3> X;
    for (const auto node : b.nodes) X.push_back(d.bodies.at(node).X);
    const auto lines = b.nodes.size() == 3 ? halves(X[0], X[1], X[2]) : std::array<std::vector<Vec3>, 2>{X, {}};
    const size_t n = b.nodes.size() - 1;
    for (size_t k = 0; k < n; ++k) {
      std::vector<Vec3> points = lines[k];
      const Vec3 along = points.back() - points.front();
      if (!(along.norm() > 0)) throw Error(b.place, fmt::format("element {} has no length", id));
      const Vec3 v = direction_1(d, in.mesh, s, id, X[0]);
      if (!(along.cross(v).norm() > 1e-6 * along.norm() * v.norm()))
        throw Error(s.place, fmt::format("{}: element {} lies along the direction 1 of its section", s.card, id));
      const Vec3 n1 = (v - along * along.dot(v) / along.squaredNorm()).normalized(), n2 = along.normalized().cross(n1);
      for (Vec3& x : points) x = o.point(x + s.off[0] * n1 + s.off[1] * n2);
      scene.add("beam",
                fmt::format("{}_{}{}", b.type, id,
                            n == 1   ? ""
                            : k == 0 ? "a"
                                     : "b"),
                b.place,
                {{"points", points},
                 {"cells", std::vector{1}},
                 {"section", name},
                 {"path", points.size() == 3 ? "arc" : ""},
                 {"material", with_material ? clean_name(m.name) : ""},
                 {"orientation", s.along_n2 ? n2 : n1},
                 {"a", body_name(d, b.nodes[k])},
                 {"b", body_name(d, b.nodes[k + 1])}});
    }
  }
  std::set<std::int64_t> nodes;
  for (const auto& [id, b] : d.beams)
    for (const auto node : b.nodes)
      if (const auto a = d.node.find(node); a != d.node.end() && !in.body_of_node.contains(a->second)) nodes.insert(node);
  for (const auto node : nodes) {  // of solids too, which do not turn
    const std::string set = names.nodes(fmt::format("node_{}_of_cells", node), {d.node.at(node)});
    in.as_listed.insert(set);
    scene.add({"joint", "spherical"}, fmt::format("node_{}_of_cells", node), d.bodies.at(node).place,
              {{"a", body_name(d, node)}, {"b", set}, {"at", o.point(d.bodies.at(node).X)}});
  }
}

}  // namespace hilo
