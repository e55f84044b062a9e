// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/error.hpp"
#include "import/inp/passes.hpp"
#include "import/sheets.hpp"

namespace hilo {
namespace {

/// Components of one set, held on the same nodes in the same way, are one motion.
void merge_components(std::vector<Held>& groups) {
  for (auto& h : groups) std::sort(h.nodes.begin(), h.nodes.end());
  for (size_t i = 0; i < groups.size(); ++i)
    for (size_t j = i + 1; j < groups.size();) {
      Held &a = groups[i], &b = groups[j];
      const bool apart = !(a.on[0] && b.on[0]) && !(a.on[1] && b.on[1]) && !(a.on[2] && b.on[2]);
      if (a.target.empty() || a.target != b.target || a.amplitude != b.amplitude || a.moved != b.moved || !apart || a.nodes != b.nodes) {
        ++j;
        continue;
      }
      for (int k = 0; k < 3; ++k)
        if (b.on[k]) a.on[k] = true, a.value[k] = b.value[k];
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(j));
    }
}

/// How many nodes a line speaks of that no cell uses.
std::int64_t of_no_cell(const InpDeck& d, const InpNodal& l, bool tied_too = false) {
  const auto lost = [&](std::int64_t id) { return d.unused.contains(id) && (tied_too || !is_tied(d, id)); };
  return std::ranges::count_if(numbers_in(d.nset, l), lost);
}

}  // namespace

Mat3 InpTransform::axes(const Vec3& at) const {
  Vec3 x = a, y = b, z = b - a;
  if (cylindrical) {  // x away from the axis, z along it
    z.normalize();
    x = at - a - z * z.dot(at - a);
    y = z.cross(x);
  } else {
    z = x.cross(y), y = z.cross(x);
  }
  if (!is_read || !(x.norm() > 1e-9 * (at.norm() + a.norm())) || !(y.norm() > 0) || !(z.norm() > 0)) return Mat3::Zero();
  Mat3 out;
  out << x.normalized(), y.normalized(), z.normalized();
  return out;
}

std::vector<int> turned_nodes(const InpDeck& d, const Mesh& mesh) {
  std::vector<int> turned(mesh.X.size(), -1);
  for (size_t t = 0; t < d.transformed.size(); ++t)
    for (const auto a : inp_nodes(d, d.transformed[t])) turned[a] = static_cast<int>(t);
  return turned;
}

/// Nodes of cells that a line speaks of, but for those that are bodies too, of beams: ties speak of these.
static Rows nodes_of_cells(const InpDeck& d, const InpNodal& l, const Imported& in) {
  Rows rows = inp_nodes(d, l);
  std::erase_if(rows, [&](std::int64_t a) { return d.bodies.contains(in.mesh.node_id[static_cast<size_t>(a)]); });
  return rows;
}

std::vector<Held> held_groups(const InpDeck& d, const std::vector<int>& turned, Imported& in, std::vector<HeldAskew>& askew) {
  // the last line that speaks of a component of a node holds it
  std::unordered_map<std::int64_t, size_t> claim;
  for (size_t i = 0; i < d.supports.size(); ++i) {
    const auto& b = d.supports[i];
    if (const auto n = of_no_cell(d, b)) in.skip("*BOUNDARY on a node of no cell", b.place, n);
    for (const auto a : nodes_of_cells(d, b, in))
      for (int k = b.first - 1; k < std::min(b.last, 3); ++k) claim[3 * a + k] = i;  // nodes of solids do not turn
  }
  const auto fixed = [&](std::int64_t a, int k) {
    const auto c = claim.find(3 * a + k);
    return c != claim.end() && d.supports[c->second].value == 0;
  };
  std::vector<Held> groups;
  std::map<std::array<bool, 3>, size_t> along_axes;  // of *TRANSFORM, where these are the model's in another order
  std::int64_t lost = 0;
  for (std::int64_t a = 0; a < in.mesh.n_nodes(); ++a) {
    if (turned[a] < 0 || (fixed(a, 0) && fixed(a, 1) && fixed(a, 2))) continue;
    const Mat3 axes = d.transformed[turned[a]].axes(in.mesh.X[a]);
    std::array<bool, 3> straight{};
    std::string place;
    for (int k = 0; k < 3; ++k) {
      const auto c = claim.find(3 * a + k);
      if (c == claim.end()) continue;
      const Vec3 axis = axes.col(k);
      Eigen::Index along;
      if (!fixed(a, k) || !(axis.norm() > 0))
        ++lost;
      else if (axis.cwiseAbs().maxCoeff(&along) > 1 - 1e-12)
        straight[along] = true, place = d.supports[c->second].place;
      else
        askew.push_back({a, axis, d.supports[c->second].place});
      claim.erase(c);
    }
    if (place.empty()) continue;
    const auto [at, fresh] = along_axes.try_emplace(straight, groups.size());
    if (fresh) groups.push_back({"", "", place, straight});
    groups[at->second].nodes.push_back(a);
  }
  if (lost) in.skip("*BOUNDARY in axes of *TRANSFORM", "", lost);

  std::map<std::tuple<std::string, std::string, int, double>, size_t> of_set;  // target, amplitude, component, value
  std::map<std::int64_t, std::array<std::int64_t, 3>> of_node;                 // single nodes: line of each component
  for (size_t i = 0; i < d.supports.size(); ++i) {
    const auto& b = d.supports[i];
    const std::string amplitude = b.value == 0 ? "" : b.amplitude;
    for (int k = b.first - 1; k < std::min(b.last, 3); ++k)
      for (const auto a : nodes_of_cells(d, b, in)) {
        const auto c = claim.find(3 * a + k);
        if (c == claim.end() || c->second != i) continue;
        if (b.target.empty()) {
          of_node.try_emplace(a, std::array<std::int64_t, 3>{-1, -1, -1}).first->second[k] = static_cast<std::int64_t>(i);
          continue;
        }
        const auto [it, fresh] = of_set.try_emplace({b.target, amplitude, k, b.value}, groups.size());
        if (fresh) {
          Held h{b.target, amplitude, b.place};
          h.on[k] = true, h.value[k] = b.value, h.moved = b.value != 0;
          groups.push_back(h);
        }
        groups[it->second].nodes.push_back(a);
      }
  }
  for (const auto& [a, line] : of_node)
    for (const bool moved : {false, true}) {  // the held and the moved components of one node are two groups
      std::map<std::string, Held> by_amplitude;
      for (int k = 0; k < 3; ++k) {
        if (line[k] < 0) continue;
        const auto& b = d.supports[line[k]];
        if ((b.value != 0) != moved) continue;
        auto& h = by_amplitude[moved ? b.amplitude : ""];
        h.on[k] = true, h.value[k] = b.value, h.moved = moved, h.place = b.place, h.amplitude = moved ? b.amplitude : "";
      }
      for (auto& [amplitude, h] : by_amplitude) {
        const auto same = std::find_if(groups.begin(), groups.end(), [&, &h = h](const Held& g) {
          return g.target.empty() && g.moved == moved && g.on == h.on && g.value == h.value && g.amplitude == h.amplitude;
        });
        if (same == groups.end())
          groups.push_back(h), groups.back().nodes = {a};
        else
          same->nodes.push_back(a);
      }
    }
  merge_components(groups);
  return groups;
}

std::vector<Nodal> nodal_groups(const InpDeck& d, const std::vector<InpNodal>& lines, const char* what, bool add,
                                const std::vector<int>& turned, Imported& in) {
  std::vector<Nodal> groups;
  std::map<std::pair<std::string, std::string>, size_t> of_set;
  std::map<std::pair<std::int64_t, std::string>, Nodal> of_node;
  for (const auto& f : lines) {
    if (const auto n = of_no_cell(d, f, !add)) in.skip(fmt::format("{} on a node of no cell", what), f.place, n);
    Rows nodes = nodes_of_cells(d, f, in);
    if (!add)  // loads reach the bodies, velocities do not
      if (const size_t all = inp_nodes(d, f).size(); all > nodes.size())
        in.skip(fmt::format("{} on a node of a beam or a tie", what), f.place, static_cast<std::int64_t>(all - nodes.size()));
    if (nodes.empty()) continue;
    if (f.first > 3) {
      in.skip(fmt::format("{} on degree of freedom {}", what, f.first), f.place);
      continue;
    }
    if (std::ranges::any_of(nodes, [&](std::int64_t a) { return turned[a] >= 0; })) {
      std::int64_t lost = 0;
      for (const auto a : nodes) {
        const Vec3 axis =
            turned[a] < 0 ? Vec3(Vec3::Unit(f.first - 1)) : Vec3(d.transformed[turned[a]].axes(in.mesh.X[a]).col(f.first - 1));
        if (!add || !(axis.norm() > 0)) {
          ++lost;
          continue;
        }
        Nodal& n = of_node[{a, f.amplitude}];
        n.value += f.value * axis, n.amplitude = f.amplitude;
        if (n.place.empty()) n.place = f.place;
      }
      if (lost) in.skip(fmt::format("{} in axes of *TRANSFORM", what), f.place, lost);
      continue;
    }
    Nodal* n;
    if (f.target.empty())
      n = &of_node[{nodes[0], f.amplitude}];
    else {
      const auto [it, fresh] = of_set.try_emplace({f.target, f.amplitude}, groups.size());
      if (fresh) groups.push_back({f.target, f.amplitude, f.place, Vec3::Zero(), nodes});
      n = &groups[it->second];
    }
    n->amplitude = f.amplitude;
    if (n->place.empty()) n->place = f.place;
    n->value[f.first - 1] = f.value + (add ? n->value[f.first - 1] : 0);
  }
  for (const auto& [key, n] : of_node) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&, &n = n](const Nodal& g) {
      return g.target.empty() && g.value == n.value && g.amplitude == n.amplitude;
    });
    if (same == groups.end())
      groups.push_back(n), groups.back().nodes = {key.first};
    else
      same->nodes.push_back(key.first);
  }
  return groups;
}

std::string unqualified(const std::string& name) { return name.substr(name.rfind('.') + 1); }

void unqualify(InpDeck& d) {
  const auto own = [&](std::string& target, std::int64_t& id, const auto& known) {
    if (target.find('.') == std::string::npos || known(target)) return;
    const auto instance = d.shift_of.find(target.substr(0, target.rfind('.')));
    target = unqualified(target);
    if (target.empty() || target.size() > 18 || target.find_first_not_of("0123456789") != std::string::npos) return;
    id = std::stoll(target) + (instance == d.shift_of.end() ? 0 : instance->second);
    target.clear();
  };
  const auto nset = [&](const std::string& key) { return d.nset.contains(key); };
  const auto elset = [&](const std::string& key) { return d.elset.contains(key); };
  const auto surface = [&](const std::string& key) {
    return std::ranges::any_of(d.surfaces, [&](const InpSurface& s) { return upper(s.name) == key; });
  };
  for (auto* lines : {&d.supports, &d.forces, &d.velocities})
    for (InpNodal& l : *lines) own(l.target, l.id, nset);
  for (InpDistributed& l : d.distributed) l.face == 0 ? own(l.target, l.id, surface) : own(l.target, l.id, elset);
  for (InpSurface& s : d.surfaces)
    for (auto& l : s.lines) s.of_nodes ? own(l.target, l.id, nset) : own(l.target, l.id, elset);
  std::int64_t none;
  for (InpTie& t : d.ties)
    t.kind == InpTie::Of::nodes ? own(t.of, none, nset) : t.kind == InpTie::Of::cells ? own(t.of, none, elset) : own(t.of, none, surface);
  for (auto* pairs : {&d.tied, &d.contacts})
    for (InpPair& t : *pairs) own(t.slave, none, surface), own(t.master, none, surface);
  for (InpSection& s : d.sections) own(s.elset, none, elset);
  for (InpTransform& t : d.transformed) own(t.target, t.id, nset);
  for (InpEquation& e : d.equations)
    for (auto& t : e.terms) own(t.node.target, t.node.id, nset);
}

const InpSet& set_of(const std::map<std::string, InpSet>& sets, const InpTarget& t, const char* of, bool qualified) {
  auto set = sets.find(t.target);
  if (qualified && set == sets.end()) set = sets.find(unqualified(t.target));
  if (set == sets.end()) throw Error(t.place, fmt::format("no {} set \"{}\"", of, t.target), suggest_name(t.target, sets));
  return set->second;
}

std::vector<std::int64_t> numbers_in(const std::map<std::string, InpSet>& sets, const InpTarget& t) {
  if (t.target.empty()) return {t.id};
  const auto set = sets.find(t.target);
  return set == sets.end() ? Rows{} : set->second.members;
}

std::vector<const InpSection*> section_of_cells(const InpDeck& d) {
  std::vector<const InpSection*> of(d.shape.size(), nullptr);
  for (const auto& s : d.sections)
    for (const auto id : d.elset.at(s.elset).members)
      if (const auto c = d.cell.find(id); c != d.cell.end()) of[static_cast<size_t>(c->second)] = &s;
  return of;
}

const Vec3* point_of(const InpDeck& d, const Mesh& mesh, std::int64_t node) {
  if (const auto a = d.node.find(node); a != d.node.end()) return &mesh.X[static_cast<size_t>(a->second)];
  const auto x = d.loose.find(node);
  return x == d.loose.end() ? nullptr : &x->second;
}

bool is_of_pairs(const InpDeck& d, const Imported& in, std::int64_t node) {
  const auto a = d.node.find(node);
  return a != d.node.end() && !sheets_at(in, a->second).empty();
}

std::string free_body_name(const InpDeck& d, std::string wish) {
  const auto taken = [&] {
    const std::string key = upper(wish);
    return d.nset.contains(key) || d.elset.contains(key) ||
           std::ranges::any_of(d.surfaces, [&](const InpSurface& s) { return upper(s.name) == key; });
  };
  while (taken()) wish += "_body";
  return wish;
}

std::vector<std::int64_t> inp_nodes(const InpDeck& d, const InpTarget& t) {
  Rows rows;
  if (t.target.empty() && !d.node.contains(t.id) && !d.unused.contains(t.id)) throw Error(t.place, fmt::format("no node {}", t.id));
  for (const auto i : t.target.empty() ? Rows{t.id} : set_of(d.nset, t, "node", false).members)
    if (const auto a = d.node.find(i); a != d.node.end()) rows.push_back(a->second);
  sort_unique(rows);
  return rows;
}

std::vector<std::int64_t> inp_cells(const InpDeck& d, const InpTarget& t) {
  Rows rows;
  if (t.target.empty() && !d.has_element(t.id)) throw Error(t.place, fmt::format("no element {}", t.id));
  for (const auto i : t.target.empty() ? Rows{t.id} : set_of(d.elset, t, "element", false).members)
    if (const auto c = d.cell.find(i); c != d.cell.end()) rows.push_back(c->second);
  sort_unique(rows);
  return rows;
}

}  // namespace hilo
