// SPDX-License-Identifier: GPL-3.0-or-later
// [[motion]] and [[initial]] entries: what is held or moves by a law, and velocities at the start.
#include "system/motions.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <set>

#include "system/build/builder.hpp"
#include "system/welds.hpp"

namespace hilo {
namespace {

std::array<bool, 3> components(const Entry& e) {
  std::array<bool, 3> c{};
  for (const std::string& t : e.texts("components")) {
    if (t != "x" && t != "y" && t != "z")
      throw Error(e.where("components"), fmt::format("{}: unknown component \"{}\"", e.label(), t), "x, y or z");
    c[t[0] - 'x'] = true;
  }
  return c;
}

/// Two motions of components of nodes that prescribe the same one of the same node.
bool share_component(const Motion& a, const Motion& b) {
  bool same = false;
  for (int k = 0; k < 3; ++k) same = same || (a.component[k] && b.component[k]);
  if (!same || a.body >= 0 || b.body >= 0) return false;  // a node follows one body at most
  const std::set<int> of_a(a.nodes.begin(), a.nodes.end());
  return std::any_of(b.nodes.begin(), b.nodes.end(), [&](int i) { return of_a.contains(i); });
}

}  // namespace

void Builder::add_motions() {
  std::vector<Motion>& motions = out_->part<Motions>().list;
  for (const Entry& e : scene_.entries("motion")) {
    Motion m;
    m.name = e.name;
    const std::string where = e.where("on");
    const Found found = find(e.text("on"), where);
    if (found.body == 0) throw Error(where, e.label() + ": the ground does not move");
    const bool turns = e.has("angle");  // the kinds differ by what they are given; a fixed one by nothing
    if (!turns) m.component = components(e);
    if (e.has("displacement")) m.displacement = e.vector3("displacement");
    if (turns) m.at = e.vector3("at"), m.axis = direction(e, "axis"), m.angle = e.number("angle");
    m.moving = turns || e.has("displacement");
    if (m.moving) m.law = MotionLaw(1, false, use_history(e, Acts::as_position), !e.given("history"));
    const bool whole = m.component[0] && m.component[1] && m.component[2];
    if (found.body >= 0 && !whole)
      throw Error(where, fmt::format("{}: \"{}\" is rigid and can only be held whole", e.label(), e.text("on")),
                  "use a joint to the ground");
    const auto of_linear = [&](int i) { return out_->follower[i] >= 0 && out_->bodies[out_->follower[i]].linear; };
    const auto in_block = [&](int i) { return !mesh_->mesh.block_name.empty() && mesh_->mesh.block[i] >= 0; };  // which is a body
    const bool elsewhere = std::ranges::any_of(found.nodes, [&](int i) { return of_linear(i) && !in_block(i); });
    if (found.linear && !whole && comm_.max(elsewhere ? 1 : 0) > 0)
      throw Error(where, fmt::format("{}: \"{}\" belongs to a linear region and can only be held whole", e.label(), e.text("on")),
                  "use a joint to the ground, or tag the region nonlinear");
    if (whole || found.body >= 0) {
      m.body = found.linear ? body_of(e.text("on"), found, where) : found.body;
      if (m.body < 0) {
        double other = -1;  // nodes of a rigid body among them: it is held too
        for (int i : found.nodes) other = std::max<double>(other, out_->follower[i]);
        m.body = static_cast<int>(comm_.max(other));
        if (m.body < 0) m.body = new_body(e.name, mean_of(found.nodes));
        follow_all(found.nodes, m.body, where);
      }
      Body& body = out_->bodies[m.body];
      if (body.held) throw Error(where, fmt::format("{}: motion \"{}\" moves this body already", e.label(), body.motion));
      body.held = true, body.moving = m.moving, body.motion = m.name;
      if (!turns) m.at = body.Xc;
    } else {
      comm_.together([&] {  // a rank alone may have the node
        for (int i : found.nodes)
          if (out_->follower[i] >= 0 && !of_linear(i))
            throw Error(where, fmt::format("{}: node {} belongs to a rigid body and cannot have single components prescribed", e.label(),
                                           mesh_->mesh.node_id[i]));
      });
      for (int i : found.nodes) {
        for (int k = 0; k < 3; ++k)
          if (m.component[k]) out_->fixed[i][k] = true;
        m.nodes.push_back(i);
      }
    }
    for (const Motion& other : motions)  // of the same components of a node only one may move
      if (comm_.max((m.moving || other.moving) && share_component(m, other) ? 1 : 0) > 0)
        throw Error(where, fmt::format("{}: motion \"{}\" prescribes the same component of a node", e.label(), other.name));
    motions.push_back(std::move(m));
  }
}

void Builder::set_initial_velocities() {
  Config& v = out_->start_velocity;
  v.resize_like(out_->start);
  std::vector<Vec3> nodal(out_->X.size(), Vec3::Zero());  // of nodes of linear regions
  std::vector<double> by_nodes(out_->bodies.size(), 0);   // linear regions of which an entry names a set
  for (const Entry& e : scene_.entries("initial")) {
    std::vector<bool> region(regions_.size(), false), body(out_->bodies.size(), false);
    std::vector<char> node(out_->X.size(), 0);
    double mass = 0;
    Vec3 moment = Vec3::Zero();
    bool massless = false;  // sections of beams, whose mass lies between them
    for (const std::string& pattern : e.texts("on")) {
      bool used = false;
      for (size_t r = 0; r < regions_.size(); ++r)
        if (!region[r] && fnmatch(pattern.c_str(), regions_[r].name.c_str(), 0) == 0) {
          region[r] = used = true;
          mass += regions_[r].mass, moment += regions_[r].moment + regions_[r].mass * origin_;
          if (regions_[r].body >= 0) body[regions_[r].body] = true;
        }
      for (const auto& [name, b] : body_by_name_)
        if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) {
          body[b] = used = true;
          massless = massless || (b > 0 && out_->bodies[b].mass == 0);
          mass += out_->bodies[b].mass, moment += out_->bodies[b].mass * out_->bodies[b].Xc;
        }
      if (!used) {
        const Found found = find(pattern, e.where("on"), Asks::looks);
        for (int i : found.nodes)
          if (const int b = out_->follower[i]; b >= 0 && out_->bodies[b].linear) by_nodes[b] = 1;
        for (int i : found.nodes) node[i] = 1;
        if (found.body > 0 && !out_->bodies[found.body].linear) body[found.body] = true;  // a set of a rigid body is that body
        if (!e.has("about") && e.vector3("spin").norm() > 0) throw Error(e.place.text(), e.label() + ": a spin of a set needs `about`");
      }
    }
    for (size_t r = 0; r < regions_.size(); ++r)  // a part of a linear body: its other regions keep theirs
      if (const int b = regions_[r].body; !region[r] && b >= 0 && body[b] && out_->bodies[b].linear) by_nodes[b] = 1;
    for (size_t r = 0; r < regions_.size(); ++r)
      if (region[r])
        for (std::int64_t i : mesh_->nodes_of(regions_[r].name, e.where("on"))) node[i] = 1;
    if (massless && !e.has("about") && e.vector3("spin").norm() > 0)
      throw Error(e.place.text(), e.label() + ": a spin of sections of beams needs `about`");
    const Vec3 velocity = e.vector3("velocity"), spin = e.vector3("spin");
    const Vec3 about = e.has("about") ? e.vector3("about") : mass > 0 ? Vec3(moment / mass) : Vec3::Zero();
    for (size_t i = 0; i < node.size(); ++i)
      if (node[i]) nodal[i] = velocity + spin.cross(out_->X[i] - about);
    for (size_t i = 0; i < node.size(); ++i)
      if (node[i] && i < v.x.size()) {
        v.x[i] = nodal[i];
        if (const int b = out_->follower[i]; b > 0 && (out_->bodies[b].patch || (out_->bodies[b].held && out_->bodies[b].mass == 0)))
          body[b] = true;  // made of nodes for a joint or a motion
      }
    for (size_t b = 1; b < body.size(); ++b)
      if (body[b]) v.c[b] = velocity + spin.cross(out_->bodies[b].Xc - about), v.R[b] = skew(spin);
    start_sections(body, velocity, spin, about);
    for (const Weld& w : out_->part<Welds>().list) {  // what is welded to nodes that move
      if (beam_region(w.modes)) continue;
      const bool stays = std::any_of(w.nodes.begin(), w.nodes.end(), [&](int i) { return node[i] == 0; });
      if (comm_.max(stays ? 1 : 0) > 0 || !out_->bodies[w.body].patch || body[w.body]) continue;
      v.c[w.body] = velocity + spin.cross(out_->bodies[w.body].Xc - about), v.R[w.body] = skew(spin);
    }
  }
  // a patch made on another rank's nodes must know its velocity too
  if (comm_.size > 1) {
    std::vector<double> all(12 * v.c.size());
    for (size_t b = 0; b < v.c.size(); ++b) {
      double found = comm_.max(v.c[b].isZero(0) && v.R[b].isZero(0) ? 0.0 : static_cast<double>(comm_.rank + 1));
      if (static_cast<int>(found) != comm_.rank + 1) continue;
      for (int k = 0; k < 3; ++k) all[12 * b + k] = v.c[b][k];
      for (int k = 0; k < 9; ++k) all[12 * b + 3 + k] = v.R[b](k / 3, k % 3);
    }
    comm_.sum(all);
    for (size_t b = 0; b < v.c.size(); ++b) {
      for (int k = 0; k < 3; ++k) v.c[b][k] = all[12 * b + k];
      for (int k = 0; k < 9; ++k) v.R[b](k / 3, k % 3) = all[12 * b + 3 + k];
    }
  }
  comm_.sum(by_nodes);
  for (size_t b = 1; b < by_nodes.size(); ++b)
    if (by_nodes[b] > 0) set_modal_velocity(static_cast<int>(b), nodal, v);
  set_beam_velocities(v);
  // what is held has none; what moves by a law takes that of its law from the one given here, by an impulse where they differ
  const auto rests = [&](const Body& b) { return b.ground || (b.held && !b.moving); };
  for (size_t b = 0; b < out_->bodies.size(); ++b)
    if (rests(out_->bodies[b])) v.c[b].setZero(), v.R[b].setZero();
  for (const Motion& m : out_->part<Motions>().list)
    for (int i : m.nodes)
      for (int k = 0; k < 3; ++k)
        if (m.body < 0 && m.component[k] && !m.moving) v.x[i][k] = 0;
  out_->follow(v);
}

}  // namespace hilo
