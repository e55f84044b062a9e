// SPDX-License-Identifier: GPL-3.0-or-later
// [[obstacle]] and [[contact]] entries.
#include "system/contact/contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

#include "model/height_grid.hpp"
#include "physics/contact/obstacle_kinds.hpp"
#include "system/build/builder.hpp"
#include "system/contact/contact_entries.hpp"

namespace hilo {
namespace {

/// 1/R of a ball and what it lies on; nothing where the two radii of curvature differ.
double relative_curvature(const Distance& shape, double radius) {
  if (shape.kind == Distance::Kind::plane) return 1 / radius;
  if (shape.kind == Distance::Kind::sphere) return 1 / radius + (shape.inside ? -1 : 1) / shape.radius;
  return std::nan("");
}

/// Half of what is narrow enough to pass between points of a surface: across a bar, of the middle edge of a box; 0: nothing of it is [m].
double half_width(const Distance& shape) {
  if (shape.inside || shape.kind == Distance::Kind::plane || shape.kind == Distance::Kind::height_field) return 0;
  if (shape.kind == Distance::Kind::torus) return shape.tube;
  if (shape.kind != Distance::Kind::box) return shape.radius;
  return shape.half.sum() - shape.half.minCoeff() - shape.half.maxCoeff();
}

/// From the least to the largest of what was seen.
struct Extremes {
  double low = 1e300, high = -1e300;
  void take(double x) { low = std::min(low, x), high = std::max(high, x); }
  std::string text() const { return high <= low * (1 + 1e-3) ? fmt::format("{:.4g}", high) : fmt::format("{:.4g} to {:.4g}", low, high); }
};

/// The heights of an obstacle of that kind.
std::shared_ptr<const HeightField> height_field_of(const Entry& e, const Scene& scene) {
  HeightGrid grid = height_grid_of(e, scene);
  auto out = std::make_shared<HeightField>(std::move(grid.x), std::move(grid.y), grid.heights);
  if (!out->is_finite()) e.refuse("file", "heights or slopes of the field are too large");
  return out;
}

/// Methods that take the force of a gap at an instant, as that of any spring.
constexpr std::array plain_methods{"generalized-alpha", "newmark", "hht", "wbz", "mid-point", "bdf2", "bathe"};

void refuse_plain_methods(const Scene& scene, const Entry& e, std::string_view what) {
  const Entry& time = scene.table("time");
  if (time.text("analysis") == "dynamic" && time.text("integrator") != "energy-momentum")
    throw Error(time.where("integrator"), fmt::format("{}: {} are for integrator = \"energy-momentum\"", e.label(), what));
}

/// What contacts are not right for, by name.
void refuse_what_is_not_there(const Scene& scene, const Entry& e) {
  const Entry& time = scene.table("time");
  const std::string label = e.label();
  if (time.text("analysis") == "static" || time.text("analysis") == "path") {
    if (e.number("restitution") < 1)
      e.refuse("restitution", "load steps have no impacts, so that restitution is 1", "leave restitution out");
    return;
  }
  if (time.text("analysis") == "modes") return;
  if (time.text("analysis") != "dynamic")
    throw Error(time.where("analysis"),
                fmt::format("{}: contacts are for load steps, paths, steps in time and modes, not for analysis = \"{}\"", label,
                            time.text("analysis")));
  const std::string& method = time.text("integrator");
  if (method != "energy-momentum") {
    if (std::ranges::find(plain_methods, method) == plain_methods.end())
      throw Error(time.where("integrator"), fmt::format("{}: contacts are not for integrator = \"{}\"", label, method),
                  fmt::format("energy-momentum takes all contacts; {} those with obstacles, without friction and restitution",
                              fmt::join(plain_methods, ", ")));
    for (const char* key : {"friction", "restitution"})
      if (e.number(key) != (key[0] == 'f' ? 0 : 1))
        throw Error(time.where("integrator"), fmt::format("{}: {} is for integrator = \"energy-momentum\"", label, key),
                    fmt::format("leave {} out, or the integrator", key));
  }
  if (time.given("tolerance"))
    throw Error(time.where("tolerance"), fmt::format("{}: contacts are for equal steps, not for a tolerance that chooses them", label),
                "give time.step");
}

/// What all balls of a heap have in common.
BallHeap heap_of(const Entry& e) {
  BallHeap heap;
  heap.name = e.name, heap.loses = e.number("restitution") < 1;
  PointLaw& law = heap.law;
  law.friction = e.number("friction"), law.loss = ImpactLoss(e.number("restitution")), law.slow = e.number("rest_speed");
  if (e.has("modulus")) {
    heap.modulus = e.number("factor") * e.number("modulus");
    heap.told =
        fmt::format("F = 4/3 E* sqrt(R) depth^1.5 of each pair of balls, E* {:.4g} Pa, 1/R the sum of both curvatures", heap.modulus);
  } else if (e.has("stiffness")) {
    law.k = e.number("factor") * e.number("stiffness"), law.kt = tangential_ratio(0.3) * law.k;
    heap.told = fmt::format("{:.4g} N/m of each pair of balls, as given", law.k);
  } else {
    e.refuse("", "both are rigid: nothing says how stiff they are", "give modulus, E* of the pair (Hertz), or stiffness");
  }
  return heap;
}

/// Balls that start deep in each other.
void look_at_start(const Entry& e, const BallHeap& heap, const std::vector<std::string>& names, const Contacts& contacts, const Config& q) {
  double depth = 0, share = 0;
  std::pair<int, int> worst;
  for (const auto& pair : heap.overlaps(q)) {
    const ContactPair both = heap.pair_of(pair.first, pair.second);
    const double d = -contacts.gap(both, both.points[0], q), s = d / both.points[0].cell;
    if (s > share) depth = d, share = s, worst = pair;
  }
  if (share <= 0.01) return;
  const std::string told =
      fmt::format("{}: \"{}\" starts {:.3g} m deep in \"{}\"", e.label(), names[worst.second], depth, names[worst.first]);
  if (share > 1) throw Error(e.place.text(), fmt::format("{}, more than {:.3g} m", told, depth / share), "move one of them apart");
  warn(e.place.text(), told);
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
    Obstacle made = obstacle_kinds().at(e.kind, e.place.text()).make(e);
    if (made.shape.kind == Distance::Kind::height_field) made.shape.field = height_field_of(e, scene_);
    const std::string &on = e.text("on"), where = e.where("on");
    obstacles[e.name] = {&e, made, body_of(on, find(on, where), where)};
    names.push_back(e.name);
  }
  std::set<std::string> used;
  const auto is_held = [&](int body) { return body == 0 || !out_->bodies[body].free(); };
  const auto body_behind = [&](const std::string& name) {  // that all of it follows, or -1
    if (const auto o = obstacles.find(name); o != obstacles.end()) return o->second.body;
    const int r = mesh_ ? mesh_->mesh.find_region(name) : -1;
    return r >= 0 && regions_[r].fidelity != Fidelity::nonlinear ? regions_[r].body : -1;
  };
  size_t taken = 0;  // of an "all"
  std::vector<ContactNote> told;
  const std::vector<ContactEntry> entries = contact_entries(scene_, mesh_, comm_, &told);
  for (const auto& [where, what] : told) warn(where, what);
  for (const auto& [e, of_all, balls, never] : entries) {
    const auto a = obstacles.find(e.text("a"));
    refuse_what_is_not_there(scene_, e);
    if (!balls.empty()) {
      used.insert(balls.begin(), balls.end()), ++taken;
      BallHeap heap = heap_of(e);
      std::map<std::string, int> number;
      std::vector<char> held;
      for (const std::string& name : balls) {
        const Named& ball = obstacles.at(name);
        number[name] = static_cast<int>(heap.balls.size());
        heap.balls.push_back({ball.body, ball.obstacle.at - out_->bodies[ball.body].Xc, ball.obstacle.shape.radius});
        held.push_back(is_held(ball.body));
      }
      const auto leave_out = [&](int i, int j) { heap.never.emplace_back(std::min(i, j), std::max(i, j)); };
      for (const auto& [one, other] : never)
        if (number.contains(one) && number.contains(other)) leave_out(number[one], number[other]);
      std::map<int, std::vector<int>> on;  // balls by body; what is held is as one
      for (int i = 0; i < static_cast<int>(balls.size()); ++i) on[held[i] ? 0 : heap.balls[i].body].push_back(i);
      for (const auto& [body, list] : on)
        for (size_t i = 0; i < list.size(); ++i)
          for (size_t j = 0; j < i; ++j) leave_out(list[j], list[i]);
      std::ranges::sort(heap.never);
      refuse_plain_methods(scene_, e, "contacts of many balls");
      look_at_start(e, heap, balls, out_->part<Contacts>(), out_->start);
      heap.is_mine = comm_.rank == 0;
      double largest = 0;
      for (const BallHeap::Ball& ball : heap.balls) largest = std::max(largest, ball.radius);
      out_->stiffness = std::max(out_->stiffness, heap.modulus > 0 ? heap.modulus * largest * std::sqrt(1e-3) : heap.law.k);
      out_->part<Contacts>().heaps.push_back(std::move(heap));
      continue;
    }
    if (of_all) {
      used.insert(e.text("a")), used.insert(e.text("b"));
      const int one = body_behind(e.text("a")), other = body_behind(e.text("b"));
      if (one >= 0 && other >= 0 && (one == other || (is_held(one) && is_held(other)))) continue;
      ++taken;
    }
    if (a == obstacles.end()) {
      refuse_plain_methods(scene_, e, "contacts of two surfaces");
      add_surfaces(e, names);
      continue;
    }
    used.insert(e.text("a"));
    const Named& obstacle = a->second;
    ContactPair pair;
    pair.name = e.name, pair.shape = obstacle.obstacle.shape, pair.friction = e.number("friction");
    pair.loses = e.number("restitution") < 1;
    pair.carrier = obstacle.body, pair.axes = obstacle.obstacle.axes;
    pair.at = obstacle.obstacle.at - out_->bodies[pair.carrier].Xc;
    const std::string& b = e.text("b");
    if (const auto ball = obstacles.find(b); ball != obstacles.end())
      used.insert(b), add_points_of_body(e, ball->second.obstacle, ball->second.body, pair);
    else
      add_points_of_surface(e, pair), pair.has_facets = true;
    if (pair.n_points == 0) throw Error(e.where("b"), fmt::format("{}: \"{}\" has no surface", e.label(), b));
    bool held = is_held(pair.carrier) && (pair.body < 0 || is_held(pair.body));
    for (const ContactPoint& point : pair.points)
      for (const int i : point.nodes) {
        const auto& fixed = out_->fixed[i];
        held = held && (out_->follower[i] >= 0 ? is_held(out_->follower[i]) : fixed[0] && fixed[1] && fixed[2]);
      }
    if (comm_.max(held ? 0 : 1) == 0) throw Error(e.place.text(), fmt::format("{}: both sides are held", e.label()));
    double own = 0, cell = 0;
    const Contacts& contacts = out_->part<Contacts>();
    pair.outside = static_cast<int>(comm_.sum(double(contacts.outside(pair, out_->start))));
    for (const ContactPoint& point : pair.points)
      if (const double depth = -contacts.gap(pair, point, out_->start); depth > own) own = depth, cell = point.cell;
    const double deepest = comm_.max(own);
    cell = comm_.max(own == deepest ? cell : 0);
    if (deepest > cell)
      throw Error(e.place.text(),
                  fmt::format("{}: \"{}\" starts {:.3g} m deep in \"{}\", more than {:.3g} m", e.label(), b, deepest, a->first, cell),
                  "move one of them apart");
    if (deepest > 0.01 * cell)
      warn(e.place.text(), fmt::format("{}: \"{}\" starts {:.3g} m deep in \"{}\"", e.label(), b, deepest, a->first));
    out_->part<Contacts>().list.push_back(std::move(pair));
  }
  if (const auto some = std::ranges::find(entries, true, &ContactEntry::of_all); some != entries.end() && taken == 0)
    throw Error(some->entry.place.text(), "\"all\" stands for no pair: those that could meet are held or on the same body");
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
  if (pair.shape.field && ball && b.shape.radius > pair.shape.field->least_hollow())
    warn(e.where("b"),
         fmt::format("{}: the ball, of {:.3g} m, is larger than the hollows of the height field, of {:.3g} m: it touches one side "
                     "of a hollow at a time",
                     e.label(), b.shape.radius, pair.shape.field->least_hollow()));
  pair.body = body;
  if (ball) pair.shape.reach = b.shape.radius;
  ContactPoint point;
  PointLaw& law = point.law;
  law.friction = e.number("friction"), law.loss = ImpactLoss(e.number("restitution")), law.slow = e.number("rest_speed");
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
    law.take_hertz(E, R);
    pair.told = fmt::format("F = {:.4g} N/m^1.5 depth^1.5: 4/3 E* sqrt(R), E* {:.4g} Pa, R {:.4g} m", law.hertz, E, R);
    out_->stiffness = std::max(out_->stiffness, 2 * E * R * std::sqrt(1e-3));
  }
  const Vec3 centre = b.at - out_->bodies[body].Xc;
  const int n_walls = pair.shape.n_walls();
  for (int k = 0; k < n_walls && n_walls > 1; ++k) pair.walls.push_back(pair.shape.of_wall(k));
  pair.n_points = (ball ? 1 : 8) * n_walls;
  if (!out_->counts(body)) return;
  const auto add = [&] {
    for (int k = 0; k < n_walls; ++k) {
      point.wall = n_walls > 1 ? k : -1;
      pair.points.push_back(point);
    }
  };
  if (ball) {
    point.arm = centre, law.radius = b.shape.radius, point.cell = 0.1 * b.shape.radius;
    add();
  } else {
    point.cell = b.shape.half.minCoeff();
    for (int k = 0; k < 8; ++k) {
      point.arm = centre + b.axes * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(b.shape.half);
      add();
    }
  }
  pair.number.resize(pair.points.size());
  std::iota(pair.number.begin(), pair.number.end(), 0);
}

/// Gauss points of the facets of a region's surface, or of a set.  Each rank has those of its cells.
void Builder::add_points_of_surface(const Entry& e, ContactPair& pair) {
  const Mesh& mesh = mesh_->mesh;
  const std::vector<Facet> facets = facets_of(e, "b");
  if (e.has("stiffness"))
    e.refuse("stiffness", "the stiffness of a surface comes from its region", "scale it by factor, or give a rigid one modulus and layer");
  const char* const several = "it has rigid and flexible regions, or several bodies";
  std::map<int, double> modulus;  // of regions
  Extremes stiffness, E, depth, times, body;
  const ImpactLoss loss(e.number("restitution"));
  std::vector<std::array<std::int64_t, 3>> counts;  // cell and facet in the mesh, points
  comm_.together([&] {
    for (const Facet& f : facets) {
      const std::vector<std::int64_t> nodes = mesh.facet_nodes(f);
      if (nodes.size() < 3) continue;
      const int r = mesh.region[f.cell];
      const Region& region = regions_[r];
      const bool rigid = region.fidelity == Fidelity::rigid;
      const bool follows = rigid || (region.fidelity == Fidelity::linear && region.body == pair.carrier);
      if (follows && region.body == pair.carrier) e.refuse("b", "both are on the same body");
      body.take(follows ? region.body : -1);
      if (body.low < body.high) e.refuse("b", several, "one contact for each");
      const double factor = e.given("factor") || rigid || !is_static() ? e.number("factor") : static_factor;
      double nu = 0.3, k = 0, deep = std::abs(quality(mesh, f.cell).volume) / std::max(facet_area(mesh, f).norm(), 1e-300);
      const double cell = deep;
      if (rigid) {
        if (!e.has("layer") || !e.has("modulus"))
          e.refuse("", fmt::format("region \"{}\" is rigid, and so is the obstacle: nothing says how stiff they are", region.name),
                   "give modulus and layer, or tag it linear or nonlinear");
        E.take(e.number("modulus")), deep = e.number("layer"), k = factor * e.number("modulus") / deep;
      } else {
        if (e.has("layer")) e.refuse("layer", fmt::format("region \"{}\" is not rigid", region.name));
        if (e.has("modulus"))
          e.refuse("modulus", fmt::format("region \"{}\" is not rigid: its stiffness comes from its material", region.name));
        if (!modulus.contains(r)) modulus[r] = young_of(linear_moduli(material_of(region)));
        E.take(modulus[r]), k = factor * modulus[r] / deep;
        if (!std::isnan(region.nu)) nu = region.nu;
      }
      std::vector<Vec3> X;
      for (const std::int64_t i : nodes) X.push_back(mesh.X[i]);
      const FacetPoints at = facet_points(X, is_static() ? 4 : 2);
      for (size_t j = 0; j < at.area.size(); ++j) {
        ContactPoint point;
        point.facet.assign(nodes.begin(), nodes.end()), point.share = at.share[j], point.area = at.area[j];
        point.law.k = k * at.area[j], point.law.kt = tangential_ratio(nu) * point.law.k, point.law.friction = pair.friction;
        point.law.loss = loss, point.law.slow = e.number("rest_speed");
        point.cell = rigid ? std::min(cell, deep) : cell;
        if (!rigid) point.deep = cell / factor;
        if (follows) {
          Vec3 x = Vec3::Zero();
          for (size_t n = 0; n < X.size(); ++n) x += at.share[j][n] * X[n];
          point.arm = x - out_->bodies[region.body].Xc;
        } else {
          point.nodes = point.facet;
        }
        pair.points.push_back(std::move(point));
      }
      counts.push_back({mesh_->cell_global[f.cell], f.facet, static_cast<std::int64_t>(at.area.size())});
      stiffness.take(k), depth.take(deep), times.take(factor);
    }
  });
  for (Extremes* range : {&stiffness, &E, &depth, &times, &body})
    range->low = -comm_.max(-range->low), range->high = comm_.max(range->high);
  if (body.low < body.high) e.refuse("b", several, "one contact for each");
  if (body.low <= body.high) pair.body = static_cast<int>(body.low);
  auto all = comm_.gather(counts);
  std::sort(all.begin(), all.end());
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> first;  // point of each facet
  for (const auto& [cell, facet, n] : all) first[{cell, facet}] = pair.n_points, pair.n_points += n;
  for (const auto& [cell, facet, n] : counts)
    for (std::int64_t k = 0; k < n; ++k) pair.number.push_back(first.at({cell, facet}) + k);
  double apart = 0;
  for (const ContactPoint& point : pair.points) apart = std::max(apart, std::sqrt(point.area));
  apart = comm_.max(apart);
  if (const double half = half_width(pair.shape); half > 0 && half < 0.8 * apart)  // a square of 2 x 2 points has 0.82 to its middle
    warn(e.where("a"), fmt::format("{}: \"{}\" is {:.3g} m across, and points of \"{}\" are up to {:.3g} m apart: it may pass between them "
                                   "unseen (smaller facets there, or a set of them as b)",
                                   e.label(), e.text("a"), 2 * half, e.text("b"), apart));
  pair.told = fmt::format("{} Pa/m: {}{} Pa over {} m, the depth of {}", stiffness.text(),
                          times.high == 1 ? "" : fmt::format("{:g} times ", times.high), E.text(), depth.text(),
                          pair.body >= 0 ? "the layer" : "the cells");
}

}  // namespace hilo
