// SPDX-License-Identifier: GPL-3.0-or-later
// [[load]] entries.
#include "system/loads.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "physics/axes.hpp"
#include "system/build/builder.hpp"
#include "system/facet.hpp"

namespace hilo {

/// One entry, of any kind but a line.
struct Builder::LoadReading {
  Builder& b;
  const Entry& e;
  Load load;
  std::string where = e.where("on");
  const std::string& on = e.text("on");
  Found found = b.find(on, where);
  System& out = *b.out_;

  bool has_facets() const { return b.mesh_ && b.mesh_->mesh.facet_sets.contains(on); }
  bool is_of_body() const { return found.body >= 0 && found.n_global == 0; }
  const std::vector<Facet>& facets() const {
    if (!has_facets()) throw Error(where, fmt::format("{}: \"{}\" is not a set of facets", e.label(), on), "name a 2-D group or *SURFACE");
    return b.mesh_->mesh.facet_sets.at(on);
  }
  std::vector<int> nodes_of(const Facet& f) const {
    const auto nodes = b.mesh_->mesh.facet_nodes(f);
    return {nodes.begin(), nodes.end()};
  }
  std::vector<Vec3> positions(const std::vector<int>& nodes) const {
    std::vector<Vec3> X;
    for (const int i : nodes) X.push_back(out.X[i]);
    return X;
  }
  /// Areas of the facets by their nodes [m^2].
  std::map<int, double> areas() const {
    std::map<int, double> weight;
    for (const Facet& facet : facets()) {
      const std::vector<int> nodes = nodes_of(facet);
      const auto w = facet_weights(positions(nodes));
      for (size_t a = 0; a < nodes.size(); ++a) weight[nodes[a]] += w[a];
    }
    return weight;
  }
  /// `value` times the weight of each node; what follows rigid bodies acts on these.
  void act_on(const std::map<int, double>& weight) {
    std::map<int, Vec3> force;
    for (const auto& [i, w] : weight)
      if (w != 0) force[i] = w * load.value;
    for (Load& one : b.take_rigid_share(force, load)) out.part<Loads>().list.push_back(std::move(one));
    for (const auto& [i, f] : force) load.nodes.push_back(i), load.weight.push_back(weight.at(i));
  }

  void force() {
    load.value = e.vector3("force");
    if (found.body >= 0 && (found.n_global == 0 || e.has("at") || (found.is_region && !e.boolean("per_node")))) {
      load.kind = Load::Kind::body_force;
      load.body = found.body;
      const Vec3& centre = out.bodies[found.body].Xc;
      const Vec3 at = e.has("at") ? e.vector3("at") : found.is_region ? b.centre_of(b.shares_of(found)) : b.point_of(found.body);
      load.arm = at - centre;
      return;
    }
    if (e.has("at"))
      throw Error(e.where("at"), fmt::format("{}: \"{}\" is flexible, its force is shared by its nodes", e.label(), on),
                  "name a set of nodes there");
    std::map<int, double> weight;
    if (e.boolean("per_node")) {
      for (int i : found.nodes)
        if (out.node_owned[i]) weight[i] = 1;
    } else if (has_facets()) {
      weight = areas();
      double area = 0;
      for (const auto& [i, w] : weight) area += w;
      area = b.comm_.sum(area);
      for (auto& [i, w] : weight) w /= area;
    } else {
      for (const auto& [i, share] : b.shares_of(found)) weight[i] += share;
    }
    act_on(weight);
  }
  void traction() {
    load.value = e.vector3("traction");
    act_on(areas());
  }
  /// Facets of a rigid region push its body with one force and one moment, which turn with it.
  void pressure() {
    load.pressure = e.number("pressure");
    std::map<int, Vec6> wrench;  // of bodies, about their centres
    std::vector<std::vector<int>> others;
    for (const Facet& facet : facets()) {
      std::vector<int> nodes = nodes_of(facet);
      const Region& region = b.regions_[b.mesh_->mesh.region[facet.cell]];
      if (region.fidelity != Fidelity::rigid) {
        others.push_back(std::move(nodes));
        continue;
      }
      const std::vector<Vec3> X = positions(nodes);
      std::vector<Vec3> f(X.size());
      pressure_force(load.pressure, X, X, f, nullptr);
      Vec6& sum = wrench.try_emplace(region.body, Vec6::Zero()).first->second;
      for (size_t a = 0; a < X.size(); ++a) sum.head<3>() += f[a], sum.tail<3>() += (X[a] - out.bodies[region.body].Xc).cross(f[a]);
    }
    for (const auto& [body, sum] : b.sum_over_ranks(wrench))
      for (const bool turns : {false, true}) {
        Load one = load;
        one.kind = turns ? Load::Kind::body_torque : Load::Kind::body_force;
        one.body = body, one.value = turns ? sum.tail<3>() : sum.head<3>(), one.follower = true;
        out.part<Loads>().list.push_back(std::move(one));
      }
    load.kind = Load::Kind::pressure, load.facets = std::move(others);
  }
  void torque() {
    load.kind = Load::Kind::body_torque;
    load.value = e.vector3("torque");
    load.follower = e.boolean("follower");
    load.body = b.body_of(on, found, where);
  }
  /// Each component is a load of its own.
  void of_mass(const std::function<Vec3(const Vec3&)>& acceleration) {
    std::map<int, Vec3> force = b.forces_of_mass(e, acceleration);
    for (Load& one : b.take_rigid_share(force, load)) out.part<Loads>().list.push_back(std::move(one));
    for (int k = 0; k < 3; ++k) {
      Load one = load;
      one.value = Vec3::Unit(k);
      for (const auto& [i, f] : force)
        if (f[k] != 0) one.nodes.push_back(i), one.weight.push_back(f[k]);
      if (k < 2)
        out.part<Loads>().list.push_back(std::move(one));
      else
        load = std::move(one);
    }
  }
  void acceleration() {
    const Vec3 a = e.vector3("acceleration");
    if (!is_of_body()) return of_mass([a](const Vec3&) { return a; });
    if (b.section_at_.contains(found.body))
      throw Error(where, fmt::format("{}: the mass of \"{}\" is that of its beam", e.label(), on), "kind = \"line\" on the beam");
    const double mass = out.bodies[found.body].mass;
    if (mass == 0) throw Error(where, fmt::format("{}: \"{}\" has no mass, so this would do nothing", e.label(), on));
    load.kind = Load::Kind::body_force, load.body = found.body;
    load.value = mass * a;
  }
  void centrifugal() {
    if (is_of_body()) throw Error(where, e.label() + ": a body has no cells", "give it the force that it has");
    const Vec3 at = e.vector3("at"), axis = direction(e, "axis");
    const double square = e.number("speed") * e.number("speed");
    of_mass([=](const Vec3& X) { return Vec3(square * (X - at - (X - at).dot(axis) * axis)); });
  }
};

void Builder::add_loads() {
  struct Kind {
    std::string_view name;
    void (LoadReading::*read)();
  };
  const Registry<Kind> kinds("load", {{"force", &LoadReading::force},
                                      {"traction", &LoadReading::traction},
                                      {"pressure", &LoadReading::pressure},
                                      {"torque", &LoadReading::torque},
                                      {"acceleration", &LoadReading::acceleration},
                                      {"centrifugal", &LoadReading::centrifugal}});
  const std::string& analysis = scene_.table("time").text("analysis");
  const bool in_proportion = analysis == "buckling" || analysis == "modes";  // of load steps: only what has no history
  for (const Entry& e : scene_.entries("load")) {
    Load load;
    load.name = e.name;
    load.history = use_history(e, Acts::as_force);
    load.ramped = in_proportion || !e.given("history");
    if (e.kind == "line") {
      load.follower = e.boolean("follower");
      add_line_load(e, load);
      continue;
    }
    LoadReading one{*this, e, load};
    if (one.found.body == 0) throw Error(one.where, e.label() + ": a load on the ground does nothing");
    (one.*kinds.at(e.kind, e.place.text()).read)();
    out_->part<Loads>().list.push_back(std::move(one.load));
  }
}

/// A torque about the line on which all nodes of a body lie would turn it for ever, where nothing but loads and what looks at it names the
/// body.
void Builder::drop_spinning_torques() {
  auto& loads = out_->part<Loads>().list;
  const auto spins = [&](const Load& l) { return l.kind == Load::Kind::body_torque && !out_->bodies[l.body].line.isZero(0); };
  if (std::ranges::none_of(loads, spins)) return;
  const std::set<std::string_view> idle{"body", "load", "probe", "sensor", "quantity"};
  std::set<std::string_view> named;
  for (const KindSchema& kind : scene_schema())
    if (!idle.contains(kind.section))
      for (const Entry& e : scene_.entries(kind.section))
        for (const auto& [key, value] : e.values) named.insert(value.texts.begin(), value.texts.end());
  for (Load& l : loads) {
    if (!spins(l) || named.contains(out_->bodies[l.body].name)) continue;
    l.line = out_->bodies[l.body].line;
    if (const double along = std::abs(l.value.dot(l.line)); along > 1e-3 * l.value.norm())
      warn(scene_.path, fmt::format("load \"{}\": {:.3g} N m of its torque is about the line through the nodes of \"{}\", which does not "
                                    "resist it: left out",
                                    l.name, along, out_->bodies[l.body].name));
  }
}

}  // namespace hilo
