// SPDX-License-Identifier: GPL-3.0-or-later
// What ties grids together, as scene lines: a grid of no cell that something is tied to becomes a [[body]], a rigid element a joint between
// it and a set, a spring a [[spring]] or a joint that gives way.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/joined.hpp"
#include "import/bdf/scene.hpp"
#include "import/links.hpp"

namespace hilo {

/// Elements that share a node of solids share its turn too, where both give it one: they are one rigid body.  Grids of no cell are bodies
/// of their own, which joints tie.
void BdfScene::join_rigid() {
  Joined<size_t> joined(deck_.rigid.size());
  std::map<std::int64_t, size_t> turned_by;  // node of solids -> element
  for (size_t i = 0; i < deck_.rigid.size(); ++i) {
    const BdfRigid& r = deck_.rigid[i];
    if ((r.components & 7) != 7) continue;
    const auto turns = [&](std::int64_t grid) {
      const auto a = row(grid, r.place, r.name);
      if (!used_[static_cast<size_t>(a)]) return;
      const auto [at, fresh] = turned_by.try_emplace(a, i);
      if (!fresh) joined.join(i, at->second);
    };
    turns(r.hub);
    if (r.components == 63) std::for_each(r.grids.begin(), r.grids.end(), turns);
  }
  std::map<size_t, std::vector<const BdfRigid*>> groups;
  for (size_t i = 0; i < deck_.rigid.size(); ++i) groups[joined.root(i)].push_back(&deck_.rigid[i]);
  for (const auto& [i, group] : groups) {
    if (group.size() == 1) {
      rigid_.push_back(*group[0]);
      continue;
    }
    const auto of_solids = [&, first = group[0]](std::int64_t grid) {
      return used_[static_cast<size_t>(row(grid, first->place, first->name))] != 0;
    };
    BdfRigid whole{group[0]->name, group[0]->place, group[0]->id, group[0]->hub, 63, {}};
    for (const BdfRigid* r : group)
      if (of_solids(whole.hub) && !of_solids(r->hub)) whole.hub = r->hub;
    std::vector<BdfRigid> others;  // grids of no cell that do not turn with it
    std::set<std::int64_t> has{whole.hub};
    for (const BdfRigid* r : group) {
      if (has.insert(r->hub).second) whole.grids.push_back(r->hub);
      for (const auto g : r->grids)
        if (r->components != 63 && !of_solids(g))
          others.push_back({r->name, r->place, r->id, whole.hub, r->components, {g}});
        else if (has.insert(g).second)
          whole.grids.push_back(g);
    }
    rigid_.push_back(std::move(whole));
    rigid_.insert(rigid_.end(), others.begin(), others.end());
  }
}

/// A grid of shells that become pairs of nodes is a body, in whose block its pairs are, where a pair cannot bear what acts on it.  A rigid
/// element takes pairs as they are where it has three grids that are not on a line, in all components.
void BdfScene::find_bodies_of_shells() {
  const auto make = [&](std::int64_t grid, const std::string& place, const std::string& who) {
    if (const auto a = grid == 0 ? -1 : row(grid, place, who); a >= 0 && is_of_shell(a)) body_.try_emplace(a, place);
  };
  for (const BdfRigid& r : rigid_) {
    std::vector<Vec3> points;
    for (const auto g : r.grids)
      if (const auto a = row(g, r.place, r.name); used_[static_cast<size_t>(a)] && !body_.contains(a)) points.push_back(X(a));
    make(r.hub, r.place, r.name);
    if (r.components != 63 || points.size() < 3 || on_a_line(points))
      for (const auto g : r.grids) make(g, r.place, r.name);
  }
  for (const BdfSpring& s : deck_.springs)
    for (const auto g : s.grids) make(g, s.place, s.name);
  for (const BdfMass& m : masses_) make(m.grid, m.place, "CONM2");
  for (const auto& [id, list] : deck_.ties.lines)
    for (const BdfEquation& m : list)
      for (const auto& t : m.terms) make(t.grid, m.place, "MPC");
  for (const auto& [factor, l] : loads_) {
    const bool turns = l->kind == BdfLoad::Kind::moment;
    if (!turns && l->kind != BdfLoad::Kind::force) continue;
    const auto a = row(l->grid, l->place, turns ? "MOMENT" : "FORCE");
    if (is_of_shell(a) && (turns || std::ranges::any_of(sheets(a), [](const Sheets::Part& p) { return p.offset != 0; })))
      body_.try_emplace(a, l->place);
  }
  for (const auto& [a, h] : held_) {
    const bool turned = h.value[3] != 0 || h.value[4] != 0 || h.value[5] != 0;
    if (is_of_shell(a) && needs_body(sheets(a), {h.bits, turned, !axes(a).isIdentity(1e-12)})) body_.try_emplace(a, h.place);
  }
}

/// CONM2, and of CMASS1 and CMASS2 those that are equal along all three axes of their grid, or along those that no support holds.
void BdfScene::find_masses() {
  masses_ = deck_.masses;
  struct Sum {
    std::array<double, 6> along{};
    const BdfScalarMass* first = nullptr;
  };
  std::map<std::int64_t, Sum> sums;
  for (const BdfScalarMass& m : deck_.scalar_masses) {
    Sum& s = sums[row(m.grid, m.place, m.name)];
    s.along[static_cast<size_t>(m.component - 1)] += m.mass;
    if (!s.first) s.first = &m;
  }
  for (const auto& [a, s] : sums) {
    const auto held = held_.find(a);
    const unsigned bits = held == held_.end() ? 0 : held->second.bits;
    double most = 0, least = 1e300;
    for (size_t k = 0; k < 3; ++k)
      if (!(bits >> k & 1)) most = std::max(most, s.along[k]), least = std::min(least, s.along[k]);
    const bool turns = std::any_of(s.along.begin() + 3, s.along.end(), [](double m) { return m != 0; });
    if (most < 0 || most - least > 1e-9 * most || turns) {
      in_.skip(fmt::format("{}: {}", s.first->name, turns ? "inertia of turns" : "a mass that differs by direction"), s.first->place);
      continue;
    }
    if (most > 0) masses_.push_back({s.first->id, s.first->grid, 0, most, Vec3::Zero(), Mat3::Zero(), s.first->place});
  }
}

void BdfScene::find_bodies() {
  for (const auto& b : deck_.beams)
    for (const auto grid : b.nodes) {
      const auto a = row(grid, b.place, b.card);
      body_.try_emplace(a, b.place);
      on_beam_.try_emplace(a, b.place);
    }
  join_rigid();
  if (in_.sheets) find_bodies_of_shells();
  const auto free = [&](std::int64_t a) { return !used_[static_cast<size_t>(a)]; };
  const auto make = [&](std::int64_t grid, const std::string& place, const std::string& who, bool cell_too = false) {
    if (const auto a = row(grid, place, who); cell_too || free(a)) body_.try_emplace(a, place);
  };
  for (const BdfRigid& r : rigid_) {
    const auto hub = row(r.hub, r.place, r.name);
    std::int64_t nodes = !free(hub);
    for (const auto g : r.grids) nodes += !free(row(g, r.place, r.name));
    // the hub of three nodes or more turns with them, be it a node itself; two nodes keep their distance
    make(r.hub, r.place, r.name, r.components != 0 && (nodes > 2 || nodes <= static_cast<std::int64_t>(r.grids.size())));
    for (const auto g : r.grids) make(g, r.place, r.name);
  }
  for (const BdfSpring& s : deck_.springs)
    for (const auto g : s.grids)
      if (g != 0) make(g, s.place, s.name);
  for (const BdfMean& m : deck_.means) {
    const auto a = row(m.grid, m.place, "RBE3");
    std::string why = m.not_read;
    if (why.empty() && !free(a)) why = "RBE3 whose grid is a node of a cell";
    if (why.empty() && body_.contains(a)) why = "RBE3 whose grid carries springs or rigid elements";
    if (why.empty() && m.components == 0) why = "RBE3 of no component";
    if (why.empty() && !mean_.try_emplace(a, &m).second) why = "RBE3 of a grid that has one already";
    if (!why.empty()) in_.skip(why, m.place);
  }
  for (const BdfMass& m : masses_)
    if (const auto a = row(m.grid, m.place, "CONM2"); !mean_.contains(a)) make(m.grid, m.place, "CONM2");
  for (const auto& [a, place] : body_)
    if (is_of_shell(a)) in_.body_of_node[a] = body_name(deck_.node_id[static_cast<size_t>(a)]);
}

/// Bodies with the masses at their grids; masses on nodes and means.
void BdfScene::bodies() {
  struct Sum {
    double mass = 0;
    Vec3 first = Vec3::Zero();
    Mat3 inertia = Mat3::Zero();  // about the grid
  };
  std::map<std::int64_t, Sum> sums;
  std::map<double, std::pair<Rows, std::string>> on_nodes;
  std::map<std::int64_t, double> on_node;
  std::map<std::int64_t, std::string> places;
  const auto about = [this](const Vec3& arm) -> Mat3 {
    const Vec3 x = arm * options_.scale;
    return x.squaredNorm() * Mat3::Identity() - x * x.transpose();
  };
  const auto place_mass = [&](const BdfMass& m) {
    const auto a = row(m.grid, m.place, "CONM2");
    const Mat3 own = axes_at(deck_, std::max<std::int64_t>(m.system, 0), X(a), m.place);
    const Vec3 at = m.system < 0 ? m.offset : Vec3(X(a) + own * m.offset);
    const Mat3 inertia = own * m.inertia * own.transpose();
    places.try_emplace(a, m.place);
    if (end(a) == End::body) {
      Sum& s = sums[a];
      const Vec3 arm = at - X(a);
      s.mass += m.mass, s.first += m.mass * arm, s.inertia += inertia + m.mass * about(arm);
      return;
    }
    if ((at - X(a)).norm() > 1e-9 * size_) in_.skip("CONM2: offset from a node of solids, which does not turn", m.place);
    if (inertia.norm() > 0) in_.skip("CONM2: inertia at a node of solids, which does not turn", m.place);
    const auto mean = mean_.find(a);
    if (mean == mean_.end()) return void(on_node[a] += m.mass);
    double most = 0, least = 1e300;
    for (const auto& of : mean->second->of) most = std::max(most, of.weight), least = std::min(least, of.weight);
    Rows rows;
    for (const auto& of : mean->second->of)
      if (const auto b = row(of.grid, m.place, "RBE3"); end(b) == End::node) rows.push_back(b);
    if (most != least || rows.size() != mean->second->of.size()) return in_.skip("CONM2 on an RBE3 of several weights", m.place);
    Vec3 centre = Vec3::Zero();
    for (const auto b : rows) centre += X(b) / static_cast<double>(rows.size());
    if ((X(a) - centre).norm() > 1e-6 * size_) return in_.skip("CONM2 on an RBE3 away from the mean of its grids", m.place);
    in_.notes.push_back(fmt::format("{}: CONM2 {}: its mass is shared by the {} grids of the RBE3", m.place, m.id, rows.size()));
    for (const auto b : rows) on_node[b] += m.mass / static_cast<double>(rows.size()), places.try_emplace(b, m.place);
  };
  std::ranges::for_each(masses_, place_mass);
  for (const auto& [a, mass] : on_node)
    if (mass > 0) {
      auto& [rows, place] = on_nodes[mass];
      if (rows.empty()) place = places.at(a);
      rows.push_back(a);
    }
  for (const auto& [a, place] : body_) {
    const auto it = sums.find(a);
    const Sum s = it == sums.end() ? Sum{} : it->second;
    const Vec3 arm = s.mass > 0 ? Vec3(s.first / s.mass) : Vec3(Vec3::Zero());
    Mat3 J = s.inertia - s.mass * about(arm);
    J = (J.array().abs() > 1e-12 * s.inertia.norm()).select(J, 0);  // the rest is rounding
    const double i = si("kg m^2");
    SceneTable& body = scene_.add("body", end_name(a), place, {{"mass", s.mass * si("kg")}, {"com", point(X(a) + arm)}});
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(J).eigenvalues();
    const bool of_no_body = moments[0] < -1e-9 * moments[2] || moments[2] > (moments[0] + moments[1]) * (1 + 1e-9);
    if (of_no_body && (deck_.chosen.is_static() || deck_.chosen.buckles()))
      in_.notes.push_back(fmt::format("{}: no body has the inertia of this CONM2: it is left out, as it counts in no static run", place));
    else if (J.norm() > 0)
      body.set("inertia", {J(0, 0) * i, J(1, 1) * i, J(2, 2) * i, J(0, 1) * i, J(0, 2) * i, J(1, 2) * i});
  }
  for (const auto& [mass, group] : on_nodes) {
    const std::string set = set_of(group.first, "mass", true);
    scene_.add_unique("point_mass", set, group.second, {{"on", set}, {"mass", mass * static_cast<double>(group.first.size()) * si("kg")}});
  }
}

void BdfScene::rigid() {
  for (const BdfRigid& r : rigid_) rigid(r);
}

void BdfScene::rigid(const BdfRigid& r) {
  const auto hub = row(r.hub, r.place, r.name);
  const std::string name = fmt::format("{}_{}", r.name, r.id);
  if (end(hub) != End::body || r.components == 0) {  // two nodes of solids, which do not turn, or a rod: they keep their distance
    for (const auto g : r.grids) {
      const auto a = row(g, r.place, r.name);
      if (r.components != 0 && (r.components & 7) != 7) return in_.skip(fmt::format("{} of some components", r.name), r.place);
      if ((X(a) - X(hub)).norm() < 1e-9 * size_) return in_.skip(r.name + " of two nodes at one place", r.place);
      scene_.add_unique({"joint", "distance"}, name, r.place,
                        {{"a", end_name(hub)}, {"b", end_name(a)}, {"at_a", point(X(hub))}, {"at_b", point(X(a))}});
    }
    return;
  }
  Rows nodes;
  std::vector<Vec3> points;
  const auto add = [&](std::int64_t a) { nodes.push_back(a), points.push_back(X(a)); };
  if (used_[static_cast<size_t>(hub)] && !on_beam_.contains(hub) && !is_of_shell(hub)) add(hub);
  for (const auto g : r.grids) {
    const auto a = row(g, r.place, r.name);
    if (end(a) == End::body && a != hub) {
      joint(r.components, axes(a), name, end_name(hub), end_name(a), X(a), r.place);
    }
    if (used_[static_cast<size_t>(a)] && end(a) != End::body) add(a);
  }
  if (nodes.empty()) return;
  if ((r.components & 7) != 7) return in_.skip(fmt::format("{} of some components of nodes of solids", r.name), r.place);
  if (on_a_line(points)) {
    for (const auto a : nodes) joint(7, Mat3::Identity(), name, end_name(hub), node_set(a), X(a), r.place);
    return;
  }
  joint(63, Mat3::Identity(), name, end_name(hub), set_of(nodes, name), X(hub), r.place);
}

/// Why the displacements of an MPC cannot be summed, or "".
std::string BdfScene::why_no_sum(const BdfEquation& m) const {
  if (m.terms.empty()) return " of no term";
  for (const auto& t : m.terms) {
    const End e = end(row(t.grid, m.place, "MPC"));
    if (t.component < 1 || t.component > 6 || (t.component > 3 && e != End::body)) return " of turns";
    if (e != End::node && e != End::body) return " of a grid of no solid";
  }
  return "";
}

/// Two displacements of nodes of solids that are equal.
bool BdfScene::is_slide(const BdfEquation& m) const {
  if (m.terms.size() != 2) return false;
  const auto &a = m.terms[0], &b = m.terms[1];
  return a.component == b.component && a.factor != 0 && std::abs(a.factor + b.factor) <= 1e-9 * std::abs(a.factor) &&
         std::ranges::all_of(m.terms, [&](const BdfEquation::Term& t) {
           const auto r = row(t.grid, m.place, "MPC");
           return end(r) == End::node && axes(r).isIdentity(1e-12);
         });
}

void BdfScene::sum_up(const BdfEquation& m) {
  std::map<std::int64_t, Vec3> of;
  std::vector<SumTerm> terms;
  for (const auto& t : m.terms) {
    const auto r = row(t.grid, m.place, "MPC");
    if (t.component <= 3) {
      of.try_emplace(r, Vec3::Zero()).first->second += t.factor * axes(r).col(t.component - 1);
    } else if (t.factor != 0) {
      const Vec3 axis = axes(r).col(t.component - 4), beside = axes(r).col((t.component - 3) % 3);
      add_turn(scene_, terms, end_name(r), point(X(r)), point(X(r) + size_ * beside), t.factor / size_ * axis.cross(beside), m.place);
    }
  }
  if (!terms.empty()) in_.notes.push_back(fmt::format("{}: MPC of turns holds for small ones: it has their sines", m.place));
  for (const auto& [r, way] : of)
    if (way != Vec3::Zero()) terms.push_back({end_name(r), point(X(r)), way});
  if (!terms.empty()) joints_of_sum(scene_, terms, "equation", m.place);
}

/// Two components of bodies that are equal: turns, or displacements at one place.
bool BdfScene::is_joint(const BdfEquation& m) const {
  if (m.terms.size() != 2) return false;
  const auto &a = m.terms[0], &b = m.terms[1];
  if (a.component != b.component || a.component < 1 || a.component > 6 || a.factor == 0 ||
      std::abs(a.factor + b.factor) > 1e-9 * std::abs(a.factor))
    return false;
  const auto ra = row(a.grid, m.place, "MPC"), rb = row(b.grid, m.place, "MPC");
  return ra != rb && end(ra) == End::body && end(rb) == End::body && axes(ra).isApprox(axes(rb), 1e-9) &&
         (a.component > 3 || (X(ra) - X(rb)).norm() < 1e-9 * size_);
}

/// Of the sets that the first subcase takes, or of all without case control: displacements that are equal are those of a body of no mass,
/// which slides along them.
void BdfScene::equations() {
  const BdfCase& chosen = deck_.chosen;
  EqualDisplacements equals;
  std::map<Displacement, std::string> place;
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<unsigned, std::string>> joints;  // between rows: components, first place
  const auto take = [&](const BdfEquation& m) {
    if (is_joint(m)) {
      const auto a = row(m.terms[0].grid, m.place, "MPC"), b = row(m.terms[1].grid, m.place, "MPC");
      joints.try_emplace(std::minmax(a, b), 0u, m.place).first->second.first |= 1u << (m.terms[0].component - 1);
      return;
    }
    if (const std::string why = why_no_sum(m); !why.empty()) return in_.skip("MPC" + why, m.place);
    if (!is_slide(m)) return sum_up(m);
    const int k = static_cast<int>(m.terms[0].component);
    const Displacement a{row(m.terms[0].grid, m.place, "MPC"), k}, b{row(m.terms[1].grid, m.place, "MPC"), k};
    equals.unite(a, b);
    place.try_emplace(a, m.place), place.try_emplace(b, m.place);
  };
  for (const auto& [id, list] : deck_.ties.lines) {
    const bool taken = !chosen.any || deck_.ties.takes(chosen.mpc, id);
    if (!taken) in_.skip("MPC of a set that the subcase does not use", list.front().place, static_cast<std::int64_t>(list.size()));
    if (taken) std::ranges::for_each(list, take);
  }
  for (const auto& [ends, held] : joints)
    joint(held.first, axes(ends.first), end_name(ends.second) + "_equal", end_name(ends.first), end_name(ends.second), X(ends.second),
          held.second);
  std::map<Displacement, std::string> body;
  for (const auto& [x, up] : equals.all()) {
    const Vec3 axis = Vec3::Unit(x.second - 1), at = point(X(x.first));
    auto& name = body[equals.root(x)];
    if (name.empty()) name = sliding_body(scene_, scene_.unique("body", fmt::format("equal_{}", "xyz"[x.second - 1])), axis, at, place[x]);
    const std::string node = node_set(x.first);
    joint_to_slide(scene_, node + "_equal", name, node, axis, at, place[x]);
  }
}

}  // namespace hilo
