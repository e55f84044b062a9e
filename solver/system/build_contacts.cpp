// SPDX-License-Identifier: GPL-3.0-or-later
// [[obstacle]] and [[contact]] entries.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "physics/contact/obstacle_kinds.hpp"
#include "system/builder.hpp"
#include "system/contacts.hpp"

namespace hilo {
namespace {

/// 1/R of a ball and what it lies on; nothing where the two radii of curvature differ.
double relative_curvature(const Distance& shape, double radius) {
  if (shape.kind == Distance::Kind::plane) return 1 / radius;
  if (shape.kind == Distance::Kind::sphere) return 1 / radius + (shape.inside ? -1 : 1) / shape.radius;
  return std::nan("");
}

/// What contacts are not right for, by name.
void refuse_what_is_not_there(const Scene& scene, const Comm& comm, const Entry& e, bool surfaces) {
  const Entry& time = scene.table("time");
  const std::string label = e.label();
  const bool is_static = time.text("analysis") == "static";
  if (comm.size > 1) throw Error(e.place.text(), fmt::format("{}: contacts run on one rank", label), "run without mpirun");
  if (is_static && surfaces) return;
  if (is_static)
    throw Error(time.where("analysis"),
                fmt::format("{}: contacts with obstacles are for steps in time, not for analysis = \"static\"", label),
                "make the obstacle a rigid region with a mesh");
  if (surfaces && time.given("start") && time.text("start") == "equilibrium")
    throw Error(time.where("start"), fmt::format("{}: surfaces that meet do not start from equilibrium", label));
  if (time.text("analysis") != "dynamic")
    throw Error(time.where("analysis"),
                fmt::format("{}: contacts are for steps in time, not for analysis = \"{}\"", label, time.text("analysis")));
  if (time.text("integrator") != "energy-momentum")
    throw Error(time.where("integrator"), fmt::format("{}: contacts are for integrator = \"energy-momentum\"", label));
  if (time.given("tolerance"))
    throw Error(time.where("tolerance"), fmt::format("{}: contacts are for equal steps, not for a tolerance that chooses them", label),
                "give time.step");
}

}  // namespace

void Builder::add_contacts() {
  struct Named {
    const Entry* entry;
    Obstacle obstacle;
    int body;
  };
  std::map<std::string, Named> obstacles;
  std::vector<std::string> names;
  for (const Entry& e : scene_.entries("obstacle")) {
    const Obstacle made = obstacle_kinds().at(e.kind, e.place.text()).make(e);
    const std::string &on = e.text("on"), where = e.where("on");
    obstacles[e.name] = {&e, made, body_of(on, find(on, where), where)};
    names.push_back(e.name);
  }
  std::set<std::string> used;
  for (const Entry& e : scene_.entries("contact")) {
    const auto a = obstacles.find(e.text("a"));
    refuse_what_is_not_there(scene_, comm_, e, a == obstacles.end());
    if (a == obstacles.end()) {
      add_surfaces(e, names);
      continue;
    }
    used.insert(e.text("a"));
    const Named& obstacle = a->second;
    ContactPair pair;
    pair.name = e.name, pair.shape = obstacle.obstacle.shape;
    pair.carrier = obstacle.body, pair.axes = obstacle.obstacle.axes;
    pair.at = obstacle.obstacle.at - out_->bodies[pair.carrier].Xc;
    const std::string& b = e.text("b");
    if (const auto ball = obstacles.find(b); ball != obstacles.end())
      used.insert(b), add_points_of_body(e, ball->second.obstacle, ball->second.body, pair);
    else
      add_points_of_surface(e, pair);
    if (pair.points.empty()) throw Error(e.where("b"), fmt::format("{}: \"{}\" has no surface", e.label(), b));
    const auto is_held = [&](int body) { return body == 0 || !out_->bodies[body].free(); };
    bool held = is_held(pair.carrier) && (pair.body < 0 || is_held(pair.body));
    for (const ContactPoint& point : pair.points)
      for (const int i : point.nodes) {
        const auto& fixed = out_->fixed[i];
        held = held && (out_->follower[i] >= 0 ? is_held(out_->follower[i]) : fixed[0] && fixed[1] && fixed[2]);
      }
    if (held) throw Error(e.place.text(), fmt::format("{}: both sides are held", e.label()));
    double deepest = 0;
    const ContactPoint* worst = nullptr;
    const Contacts& contacts = out_->part<Contacts>();
    for (const ContactPoint& point : pair.points)
      if (const double depth = -contacts.gap(pair, point, out_->start); depth > deepest) deepest = depth, worst = &point;
    if (worst && deepest > worst->cell)
      throw Error(
          e.place.text(),
          fmt::format("{}: \"{}\" starts {:.3g} m deep in \"{}\", more than {:.3g} m", e.label(), b, deepest, a->first, worst->cell),
          "move one of them apart");
    if (worst && deepest > 0.01 * worst->cell)
      warn(e.place.text(), fmt::format("{}: \"{}\" starts {:.3g} m deep in \"{}\"", e.label(), b, deepest, a->first));
    out_->part<Contacts>().list.push_back(std::move(pair));
  }
  for (const auto& [name, obstacle] : obstacles)
    if (!used.contains(name)) warn(obstacle.entry->place.text(), fmt::format("{}: no contact names it", obstacle.entry->label()));
}

/// A ball is one point; of a box its corners are seen, by what is flat or hollow.
void Builder::add_points_of_body(const Entry& e, const Obstacle& b, int body, ContactPair& pair) {
  if (body == pair.carrier) e.refuse("b", "both are on the same body");
  if (body == 0) e.refuse("b", "it is on the ground: name it as a");
  const bool ball = b.shape.kind == Distance::Kind::sphere && !b.shape.inside;
  if (!ball && (b.shape.kind != Distance::Kind::box || b.shape.inside))
    e.refuse("b", "an obstacle is met by a region, by a set of facets, or by an obstacle of kind sphere or box");
  if (!ball && !pair.shape.is_container()) e.refuse("b", "the corners of a box meet a plane, or the inside of an obstacle, alone");
  if (ball && pair.shape.inside && b.shape.radius >= pair.shape.radius + pair.shape.half.minCoeff())
    e.refuse("b", "the ball is as large as what it is in");
  pair.body = body;
  ContactPoint point;
  PointLaw& law = point.law;
  law.friction = e.number("friction");
  const double ratio = tangential_ratio(0.3);
  if (e.given("layer")) e.refuse("layer", "a layer is of a surface of facets");
  if (e.has("stiffness")) {
    if (e.has("modulus")) e.refuse("modulus", "stiffness is given too");
    law.k = e.number("factor") * e.number("stiffness"), law.kt = ratio * law.k;
    pair.told = fmt::format("{:.4g} N/m of each point, as given", law.k);
    out_->stiffness = std::max(out_->stiffness, law.k);
  } else if (!e.has("modulus")) {
    e.refuse("", "both are rigid: nothing says how stiff they are",
             ball ? "give modulus, E* of the pair (Hertz), or stiffness" : "give stiffness, of each corner");
  } else {
    const double curvature = ball ? relative_curvature(pair.shape, b.shape.radius) : std::nan("");
    if (!(curvature > 0)) e.refuse("modulus", "Hertz is of a ball on a plane or on another ball", "give stiffness");
    const double E = e.number("factor") * e.number("modulus"), R = 1 / curvature;
    law.hertz = 4. / 3 * E * std::sqrt(R);
    law.kt = ratio * 2 * E * R * std::sqrt(1e-3);  // the slope at a depth of R/1000
    pair.told = fmt::format("F = {:.4g} N/m^1.5 depth^1.5: 4/3 E* sqrt(R), E* {:.4g} Pa, R {:.4g} m", law.hertz, E, R);
    out_->stiffness = std::max(out_->stiffness, 2 * E * R * std::sqrt(1e-3));
  }
  const Vec3 centre = b.at - out_->bodies[body].Xc;
  if (ball) {
    point.arm = centre, law.radius = b.shape.radius, point.cell = 0.1 * b.shape.radius;
    pair.points.push_back(std::move(point));
    return;
  }
  point.cell = b.shape.half.minCoeff();
  for (int k = 0; k < 8; ++k) {
    point.arm = centre + b.axes * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(b.shape.half);
    pair.points.push_back(point);
  }
}

/// Gauss points of the facets of a region's surface, or of a set.
void Builder::add_points_of_surface(const Entry& e, ContactPair& pair) {
  const Mesh& mesh = mesh_->mesh;
  const std::vector<Facet> facets = facets_of(e, "b");
  if (e.has("stiffness"))
    e.refuse("stiffness", "the stiffness of a surface comes from its region", "scale it by factor, or give a rigid one modulus and layer");
  const double factor = e.number("factor");
  std::map<int, double> modulus;  // of regions
  double low = 1e300, high = 0, E = 0, depth_low = 1e300, depth_high = 0;
  for (const Facet& f : facets) {
    const std::vector<std::int64_t> nodes = mesh.facet_nodes(f);
    if (nodes.size() < 3) continue;
    const int r = mesh.region[f.cell];
    const Region& region = regions_[r];
    const bool rigid = region.fidelity == Fidelity::rigid;
    int body = rigid ? region.body : -1;
    if (region.fidelity == Fidelity::linear && region.body == pair.carrier) body = pair.carrier;
    if (body >= 0 && body == pair.carrier) e.refuse("b", "both are on the same body");
    if (body != pair.body && !pair.points.empty())
      e.refuse("b", "it has rigid and flexible regions, or several bodies", "one contact for each");
    pair.body = body;
    double nu = 0.3, k = 0, depth = std::abs(quality(mesh, f.cell).volume) / std::max(facet_area(mesh, f).norm(), 1e-300);
    const double cell = depth;
    if (rigid) {
      if (!e.has("layer") || !e.has("modulus"))
        e.refuse("", fmt::format("region \"{}\" is rigid, and so is the obstacle: nothing says how stiff they are", region.name),
                 "give modulus and layer, or tag it linear or nonlinear");
      E = e.number("modulus"), depth = e.number("layer"), k = factor * E / depth;
    } else {
      if (e.has("layer")) e.refuse("layer", fmt::format("region \"{}\" is not rigid", region.name));
      if (e.has("modulus"))
        e.refuse("modulus", fmt::format("region \"{}\" is not rigid: its stiffness comes from its material", region.name));
      if (!modulus.contains(r)) modulus[r] = young_of(linear_moduli(material_of(region)));
      E = modulus[r], k = factor * E / depth;
      if (!std::isnan(region.nu)) nu = region.nu;
    }
    std::vector<Vec3> X;
    for (const std::int64_t i : nodes) X.push_back(mesh.X[i]);
    const FacetPoints at = facet_points(X);
    for (size_t j = 0; j < at.area.size(); ++j) {
      ContactPoint point;
      point.law.k = k * at.area[j], point.law.kt = tangential_ratio(nu) * point.law.k, point.law.friction = e.number("friction");
      point.cell = rigid ? std::min(cell, depth) : cell;
      if (body >= 0) {
        Vec3 x = Vec3::Zero();
        for (size_t n = 0; n < X.size(); ++n) x += at.share[j][n] * X[n];
        point.arm = x - out_->bodies[body].Xc;
      } else {
        point.nodes.assign(nodes.begin(), nodes.end()), point.share = at.share[j];
      }
      pair.points.push_back(std::move(point));
    }
    low = std::min(low, k), high = std::max(high, k), depth_low = std::min(depth_low, depth), depth_high = std::max(depth_high, depth);
  }
  const auto range = [](double a, double b) {
    return b <= a * (1 + 1e-3) ? fmt::format("{:.4g}", b) : fmt::format("{:.4g} to {:.4g}", a, b);
  };
  pair.told = fmt::format("{} Pa/m: {}{:.4g} Pa over {} m, the depth of {}", range(low, high),
                          factor == 1 ? "" : fmt::format("{:g} times ", factor), E, range(depth_low, depth_high),
                          pair.body >= 0 ? "the layer" : "the cells");
}

}  // namespace hilo
