// Entries of the scene to motions, loads, stations and initial velocities.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "system/builder.hpp"
#include "system/facet.hpp"

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

const History& Builder::use_history(const Entry& e, Acts acts) {
  const History& h = e.history("history");
  const bool is_static = scene_.table("time").text("analysis") == "static";
  for (const History::Break& b : h.breaks())
    if (b.order == 0 && acts == Acts::as_position && !is_static)
      throw Error(e.where("history"), fmt::format("{}: the history jumps at t = {:.6g}, so what it moves would have to", e.label(), b.t),
                  "let the values rise over some time, with interpolation = \"smooth\"");
  out_->histories.push_back({e.label(), h, acts});
  return h;
}

void Builder::add_motions() {
  for (const Entry& e : scene_.entries("motion")) {
    Motion m;
    m.name = e.name;
    const std::string where = e.where("on");
    const Found found = find(e.text("on"), where);
    if (found.body == 0) throw Error(where, e.label() + ": the ground does not move");
    if (e.kind != "rotation") m.component = components(e);
    if (e.kind == "translation") m.displacement = e.vector3("displacement");
    if (e.kind == "rotation") m.at = e.vector3("at"), m.axis = direction(e, "axis"), m.angle = e.number("angle");
    m.moving = e.kind != "fixed";
    if (m.moving) m.law = MotionLaw(1, false, use_history(e, Acts::as_position), !e.given("history"));
    const bool whole = m.component[0] && m.component[1] && m.component[2];
    if (found.body >= 0 && !whole)
      throw Error(where, fmt::format("{}: \"{}\" is rigid and can only be held whole", e.label(), e.text("on")),
                  "use a joint to the ground");
    if (whole || found.body >= 0) {
      m.body = found.body;
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
      if (e.kind != "rotation") m.at = body.Xc;
    } else {
      comm_.together([&] {  // a rank alone may have the node
        for (int i : found.nodes)
          if (out_->follower[i] >= 0)
            throw Error(where, fmt::format("{}: node {} belongs to a rigid body and cannot have single components prescribed", e.label(),
                                           mesh_->mesh.node_id[i]));
      });
      for (int i : found.nodes) {
        for (int k = 0; k < 3; ++k)
          if (m.component[k]) out_->fixed[i][k] = true;
        m.nodes.push_back(i);
      }
    }
    for (const Motion& other : motions_->list)  // of the same components of a node only one may move
      if (comm_.max((m.moving || other.moving) && share_component(m, other) ? 1 : 0) > 0)
        throw Error(where, fmt::format("{}: motion \"{}\" prescribes the same component of a node", e.label(), other.name));
    motions_->list.push_back(std::move(m));
  }
}

void Builder::add_point_masses() {
  for (const Entry& e : scene_.entries("point_mass")) {
    const Found found = find(e.text("on"), e.where("on"));
    const double m = e.number("mass");
    out_->mass += m;
    if (found.body > 0) {
      Body& body = out_->bodies[found.body];
      const Vec3 at = e.has("at") ? e.vector3("at") : found.n_global == 0 || found.is_region ? body.Xc : mean_of(found.nodes);
      const double total = body.mass + m;
      const Vec3 d = at - body.Xc, shift = m / total * d;
      // about the new centre: J + mu d d^T with the reduced mass mu
      body.J += body.mass * m / total * d * d.transpose();
      body.mass = total;
      body.Xc += shift;
      out_->start.c[found.body] = body.Xc;
    } else if (found.body == 0) {
      throw Error(e.where("on"), e.label() + ": the ground has no mass");
    } else {
      const double share = m / static_cast<double>(std::max<std::int64_t>(1, found.n_global));
      for (int i : found.nodes)
        if (out_->node_owned[i]) point_masses_->add(i, share);
    }
  }
}

void Builder::add_loads() {
  for (const Entry& e : scene_.entries("load")) {
    Load load;
    load.name = e.name;
    load.history = use_history(e, Acts::as_force);
    load.ramped = !e.given("history");
    const std::string where = e.where("on"), &on = e.text("on");
    const Found found = find(on, where);
    if (found.body == 0) throw Error(where, e.label() + ": a load on the ground does nothing");
    const bool has_facets = mesh_ && mesh_->mesh.facet_sets.contains(on);
    const auto facets = [&] {
      if (!has_facets) throw Error(where, fmt::format("{}: \"{}\" is not a set of facets", e.label(), on), "name a 2-D group or *SURFACE");
      std::vector<std::vector<int>> list;
      for (const Facet& f : mesh_->mesh.facet_sets.at(on)) {
        const auto nodes = mesh_->mesh.facet_nodes(f);
        list.emplace_back(nodes.begin(), nodes.end());
      }
      return list;
    };
    const auto share_by_area = [&](double& area) {
      std::vector<double> weight(out_->X.size(), 0.0);
      area = 0;
      for (const auto& facet : facets()) {
        std::vector<Vec3> X;
        for (int i : facet) X.push_back(out_->X[i]);
        const auto w = facet_weights(X);
        for (size_t a = 0; a < facet.size(); ++a) weight[facet[a]] += w[a], area += w[a];
      }
      area = comm_.sum(area);
      for (size_t i = 0; i < weight.size(); ++i)
        if (weight[i] != 0) load.nodes.push_back(static_cast<int>(i)), load.weight.push_back(weight[i]);
    };
    if (e.kind == "force") {
      load.value = e.vector3("force");
      if (found.body >= 0 && (found.n_global == 0 || e.has("at") || found.is_region)) {
        load.kind = Load::Kind::body_force;
        load.body = found.body;
        if (e.has("at")) load.arm = e.vector3("at") - out_->bodies[found.body].Xc;
      } else {
        if (e.has("at")) throw Error(e.where("at"), fmt::format("{}: \"{}\" is flexible, its force is shared by its nodes", e.label(), on));
        load.kind = Load::Kind::nodal;
        if (has_facets && !e.boolean("per_node")) {
          double area = 0;
          share_by_area(area);
          for (double& w : load.weight) w /= area;
        } else {
          for (int i : found.nodes)
            if (out_->node_owned[i])
              load.nodes.push_back(i), load.weight.push_back(e.boolean("per_node") ? 1.0 : 1.0 / static_cast<double>(found.n_global));
        }
      }
    } else if (e.kind == "traction") {
      load.kind = Load::Kind::nodal;
      load.value = e.vector3("traction");
      double area = 0;
      share_by_area(area);
    } else if (e.kind == "pressure") {
      load.kind = Load::Kind::pressure;
      load.pressure = e.number("pressure");
      load.facets = facets();
    } else {
      load.kind = Load::Kind::body_torque;
      load.value = e.vector3("torque");
      load.follower = e.boolean("follower");
      load.body = body_of(on, found, where);
    }
    loads_->list.push_back(std::move(load));
  }
}

void Builder::add_stations() {
  for (const char* section : {"sensor", "probe"})
    for (const Entry& e : scene_.entries(section)) {
      Station s;
      s.name = e.name;
      s.sensor = std::string_view(section) == "sensor";
      const Found found = find(e.text("on"), e.where("on"));
      if (s.sensor) {
        const Vec3 z = direction(e, "z"), x = direction(e, "x");
        if (std::abs(x.dot(z)) > 1 - 1e-9) throw Error(e.where("x"), e.label() + ": x is parallel to z");
        s.axes = frame_of_axis(z, x);
      }
      if (found.body >= 0) {
        s.body = found.body;
        const Body& body = out_->bodies[s.body];
        const Vec3 at = e.has("at") ? e.vector3("at") : found.n_global == 0 || found.is_region ? body.Xc : mean_of(found.nodes);
        s.arm = at - body.Xc;
      } else if (e.has("at") && !s.sensor) {
        if (const int nearest = nearest_owned(found.nodes, e.vector3("at")); nearest >= 0) s.nodes.push_back(nearest);
        s.n_nodes = 1;
        s.mean = e.vector3("at");
      } else {
        for (int i : found.nodes)
          if (out_->node_owned[i]) s.nodes.push_back(i);
        s.n_nodes = static_cast<double>(found.n_global);
        s.mean = mean_of(found.nodes);
      }
      stations_->list.push_back(std::move(s));
    }
}

void Builder::set_initial_velocities() {
  Config& v = out_->start_velocity;
  v.resize(out_->X.size(), out_->bodies.size());
  for (const Entry& e : scene_.entries("initial")) {
    std::vector<bool> region(regions_.size(), false), body(out_->bodies.size(), false);
    std::vector<char> node(out_->X.size(), 0);
    double mass = 0;
    Vec3 moment = Vec3::Zero();
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
          mass += out_->bodies[b].mass, moment += out_->bodies[b].mass * out_->bodies[b].Xc;
        }
      if (!used) {
        const Found found = find(pattern, e.where("on"));
        for (int i : found.nodes) node[i] = 1;
        if (found.body > 0) body[found.body] = true;  // a set of a rigid body is that body
        if (!e.has("about") && e.vector3("spin").norm() > 0) throw Error(e.place.text(), e.label() + ": a spin of a set needs `about`");
      }
    }
    for (size_t r = 0; r < regions_.size(); ++r)
      if (region[r])
        for (std::int64_t i : mesh_->nodes_of(regions_[r].name, e.where("on"))) node[i] = 1;
    const Vec3 velocity = e.vector3("velocity"), spin = e.vector3("spin");
    const Vec3 about = e.has("about") ? e.vector3("about") : mass > 0 ? Vec3(moment / mass) : Vec3::Zero();
    for (size_t i = 0; i < node.size(); ++i)
      if (node[i]) {
        v.x[i] = velocity + spin.cross(out_->X[i] - about);
        if (const int b = out_->follower[i]; b > 0 && (out_->bodies[b].patch || (out_->bodies[b].held && out_->bodies[b].mass == 0)))
          body[b] = true;  // made of nodes for a joint or a motion
      }
    for (size_t b = 1; b < body.size(); ++b)
      if (body[b]) v.c[b] = velocity + spin.cross(out_->bodies[b].Xc - about), v.R[b] = skew(spin);
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
  // what is held has none; what moves by a law takes that of its law from the one given here, by a blow where they differ
  const auto rests = [&](const Body& b) { return b.ground || (b.held && !b.moving); };
  for (size_t b = 0; b < out_->bodies.size(); ++b)
    if (rests(out_->bodies[b])) v.c[b].setZero(), v.R[b].setZero();
  for (const Motion& m : motions_->list)
    for (int i : m.nodes)
      for (int k = 0; k < 3; ++k)
        if (m.body < 0 && m.component[k] && !m.moving) v.x[i][k] = 0;
  Config full = v;
  out_->follow(full);
  for (size_t i = 0; i < out_->X.size(); ++i)
    if (out_->follower[i] >= 0) v.x[i] = full.x[i];
}

Builder::Builder(const Scene& scene, LocalMesh* mesh, const Comm& comm) : scene_(scene), mesh_(mesh), comm_(comm) {}

/// All that takes part in the equations; evaluations, results and the line that tells them go in this order.
void Builder::add_contributions() {
  System& s = *out_;
  solids_ = &s.add<Solids>(s);
  s.add<Bodies>(s);
  point_masses_ = &s.add<PointMasses>(s);
  s.place_joints();
  springs_ = &s.add<Springs>(s, s.joints);
  loads_ = &s.add<Loads>(s);
  motions_ = &s.add<Motions>(s);
  stations_ = &s.add<Stations>(s);
}

std::unique_ptr<System> Builder::build() {
  out_ = std::make_unique<System>();
  add_contributions();
  out_->comm = &comm_;
  out_->mesh = mesh_;
  out_->gravity = scene_.table("scene").vector3("gravity");
  if (mesh_) {
    out_->X = mesh_->mesh.X;
    out_->node_owned = mesh_->node_owned;
    out_->length = mesh_->length;
  }
  out_->start.x = out_->X;
  out_->follower.assign(out_->X.size(), -1);
  out_->fixed.assign(out_->X.size(), {false, false, false});
  held_by_.resize(out_->X.size());
  new_body("ground", Vec3::Zero());
  out_->bodies[0].ground = true;
  read_regions();
  integrate_regions();
  make_rigid_bodies();
  add_free_bodies();
  comm_.together([&] { make_batches(); });  // a region that lacks something may have its cells on one rank
  add_point_masses();
  add_motions();
  add_joints();
  add_springs();
  add_joint_forces();
  add_loads();
  add_stations();
  if (!mesh_) {  // size of a scene of bodies: what its points span
    Eigen::AlignedBox3d box;
    for (size_t b = 1; b < out_->bodies.size(); ++b) box.extend(out_->bodies[b].Xc);
    for (const Connector& j : out_->joints)
      for (const Entity& e : j.entities)
        if (e.point && j.end[e.end].body >= 0) box.extend(Vec3(out_->bodies[j.end[e.end].body].Xc + e.r));
    out_->length = box.isEmpty() ? 1 : std::max(box.diagonal().norm(), 1e-9);
    if (out_->length < 1e-8) out_->length = out_->bodies.size() > 1 ? out_->bodies[1].size : 1;
  }
  const bool is_static = scene_.table("time").text("analysis") == "static";
  if (!(out_->mass > 0) && !is_static)
    throw Error(scene_.path, "the scene has no mass: nothing can move", "give a mesh or [[body]] entries, and densities");
  out_->stiffness = comm_.max(out_->stiffness);  // cells are on their ranks
  out_->number();
  if (comm_.sum(static_cast<double>(out_->n_blocks())) == 0)
    throw Error(scene_.path, "nothing is free to move", "every region and body is held");
  set_initial_velocities();
  return std::move(out_);
}

std::unique_ptr<System> build_system(const Scene& scene, LocalMesh* mesh, const Comm& comm) { return Builder(scene, mesh, comm).build(); }

}  // namespace hilo
