// Entries of the scene to springs, stops, motors and friction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/coordinates.hpp"
#include "system/builder.hpp"
#include "system/springs.hpp"

namespace hilo {
namespace {

std::vector<double> padded(const Entry& e, std::string_view key, size_t n) {
  std::vector<double> v = e.numbers(key);
  if (v.size() > n || v.empty()) throw Error(e.where(key), fmt::format("{}: {} has up to {} numbers", e.label(), key, n));
  for (double x : v)
    if (!(x >= 0)) throw Error(e.where(key), fmt::format("{}: {} is negative", e.label(), key));
  v.resize(n, 0.0);
  return v;
}

Vec3 vec(const std::vector<double>& v) { return {v[0], v.size() > 1 ? v[1] : 0, v.size() > 2 ? v[2] : 0}; }

std::unique_ptr<SpringLaw> stop_law(const Entry& e) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!e.has("lower") && !e.has("upper")) throw Error(e.place.text(), e.label() + " has no limit", "give lower, upper or both");
  const double lower = e.has("lower") ? e.number("lower") : -none, upper = e.has("upper") ? e.number("upper") : none;
  if (!(lower < upper)) throw Error(e.where("lower"), fmt::format("{}: lower is not below upper", e.label()));
  return make_stop(lower, upper, e.number("stiffness"), e.number("restitution"), e.number("rest_speed"));
}

std::unique_ptr<SpringLaw> motor_law(const Entry& e, std::string_view force) {
  const std::vector<double>&rate = e.numbers("rate"), &value = e.numbers(force);
  if (rate.size() != value.size() || rate.empty())
    throw Error(e.where(force), fmt::format("{}: rate has {} numbers and {} has {}", e.label(), rate.size(), force, value.size()),
                "both columns of the table are as long");
  for (size_t i = 1; i < rate.size(); ++i)
    if (!(rate[i] > rate[i - 1]))
      throw Error(e.where("rate"), fmt::format("{}: rate does not rise from {} to {}", e.label(), rate[i - 1], rate[i]));
  return make_motor(rate, value);
}

}  // namespace

void Builder::add_springs() {
  for (const Entry& e : scene_.entries("spring")) {
    const bool needs = e.kind != "axial" && e.kind != "stop";
    const Carrier a = carrier(e, "a", needs), b = carrier(e, "b", needs && e.kind != "support");
    if (a.body == b.body && a.node == b.node) throw Error(e.where("b"), fmt::format("{}: both ends are the same body", e.label()));
    const Config& q = out_->start;
    Spring c;
    if (e.kind == "axial") {
      const Vec3 pa = e.vector3("at_a"), pb = e.vector3("at_b");
      const double distance = (pb - pa).norm(), k = e.number("stiffness"), preload = e.number("preload");
      if (!(distance > 0)) throw Error(e.where("at_b"), e.label() + ": the two points coincide");
      if (preload != 0 && k == 0) throw Error(e.where("preload"), e.label() + ": a preload needs a stiffness");
      const double length = (e.given("length") ? e.number("length") : distance) - (k > 0 ? preload / k : 0);
      c = make_axial_spring({.a = a, .b = b, .at_a = pa, .at_b = pb, .stiffness = k, .damping = e.number("damping"), .length = length}, q);
      out_->stiffness = std::max(out_->stiffness, k);
    } else if (e.kind == "torsion") {
      c = make_torsion_spring({.a = a,
                               .b = b,
                               .frame = joint_frame(e),
                               .stiffness = e.number("stiffness"),
                               .damping = e.number("damping"),
                               .angle = e.number("angle")},
                              q);
    } else if (e.kind == "bushing") {
      const Stiffness s{.along = vec(padded(e, "stiffness", 3)),
                        .damping = vec(padded(e, "damping", 3)),
                        .about = vec(padded(e, "angular_stiffness", 3)),
                        .angular_damping = vec(padded(e, "angular_damping", 3))};
      c = make_bushing({.a = a, .b = b, .at = e.vector3("at"), .frame = joint_frame(e), .stiffness = s}, q);
      out_->stiffness = std::max(out_->stiffness, s.along.maxCoeff());
    } else if (e.kind == "stop") {
      c = make_distance_stop({.a = a, .b = b, .at_a = e.vector3("at_a"), .at_b = e.vector3("at_b")}, q, stop_law(e));
      out_->stiffness = std::max(out_->stiffness, e.number("stiffness"));
    } else if (e.kind == "support") {
      if (e.given("restitution") && e.number("damping") > 0)
        throw Error(e.where("restitution"), e.label() + ": restitution and damping are two ways to say the same", "leave one out");
      c = make_support({.a = a,
                        .b = b,
                        .at = e.vector3("at"),
                        .frame = joint_frame(e),
                        .stiffness = e.number("stiffness"),
                        .damping = e.number("damping"),
                        .restitution = e.number("restitution"),
                        .rest_speed = e.number("rest_speed"),
                        .clearance = e.number("clearance"),
                        .tangential_stiffness = vec(padded(e, "tangential_stiffness", 2)),
                        .tangential_damping = vec(padded(e, "tangential_damping", 2))},
                       q);
      out_->stiffness = std::max(out_->stiffness, e.number("stiffness"));
    } else {
      throw Error(e.place.text(), fmt::format("{}: no spring of kind {}", e.label(), e.kind), "", Exit::fault);
    }
    c.name = e.name;
    out_->part<Springs>().list.push_back(std::move(c));
  }
}

Builder::Host Builder::joint_of(const Entry& e) const {
  const std::string& name = e.text("joint");
  std::vector<std::string> names;
  for (size_t j = 0; j < out_->joints.size(); ++j) {
    const Joint& joint = out_->joints[j];
    if (joint.name == name) return {joint, *joint.kind, static_cast<int>(j)};
    names.push_back(joint.name);
  }
  for (const Spring& c : out_->part<Springs>().list) {
    if (!c.gives_way) continue;
    if (c.name == name) return {c, *c.gives_way, -1};
    names.push_back(c.name);
  }
  throw Error(e.where("joint"), fmt::format("{}: no joint \"{}\"", e.label(), name), suggest(name, names));
}

/// Stops, motors and friction act along the free directions of a joint.
void Builder::add_joint_forces() {
  const Config& q = out_->start;
  const auto add = [&](Spring c, const Entry& e) {
    c.name = e.name, c.group = e.section;
    out_->part<Springs>().list.push_back(std::move(c));
  };
  const auto along = [&](const Entry& e, Freedom freedom, std::unique_ptr<SpringLaw> law) {
    const Host host = joint_of(e);
    if (!host.kind.frees(freedom))
      throw Error(e.where("joint"), fmt::format("{}: a {} joint has no free {} along its axis", e.label(), host.kind.name,
                                                freedom == Freedom::angle ? "angle" : "displacement"));
    return along_joint(host.geometry, q, freedom, std::move(law));
  };
  for (const Entry& e : scene_.entries("stop")) add(along(e, e.kind == "angle" ? Freedom::angle : Freedom::slide, stop_law(e)), e);
  for (const Entry& e : scene_.entries("motor")) {
    const bool turns = e.kind == "rotary";
    Spring c = along(e, turns ? Freedom::angle : Freedom::slide, motor_law(e, turns ? "torque" : "force"));
    if (e.given("history")) c.history = use_history(e, Acts::as_force);
    add(std::move(c), e);
  }
  for (const Entry& e : scene_.entries("friction")) {
    const Host host = joint_of(e);
    if (host.kind.pressing.empty())
      throw Error(e.where("joint"), fmt::format("{}: no friction in a joint of kind {}", e.label(), host.kind.name),
                  "revolute, cylindrical, prismatic, screw and spherical joints have it");
    const bool turns = host.kind.frees(Freedom::angle) || !host.kind.frees(Freedom::slide);
    if (turns && !e.has("radius"))
      throw Error(e.where("joint"), fmt::format("{}: a joint of kind {} turns and needs a radius", e.label(), host.kind.name));
    if (host.geometry.end[0].body < 0 || host.geometry.end[1].body < 0)
      throw Error(e.where("joint"), fmt::format("{}: both ends of joint \"{}\" must be able to turn", e.label(), host.geometry.name),
                  "name a set of several nodes");
    Spring c = friction_in(host.geometry, host.kind, q,
                           {.coefficient = e.number("coefficient"),
                            .radius = e.has("radius") ? e.number("radius") : 0,
                            .preload = e.number("preload"),
                            .slip_velocity = e.number("slip_velocity")});
    if (e.boolean("reaction")) {
      if (host.joint < 0)
        throw Error(e.where("joint"),
                    fmt::format("{}: joint \"{}\" gives way and has no reaction to press with", e.label(), host.geometry.name),
                    "say reaction = false and give a preload");
      c.pressing.joint = host.joint;
    }
    add(std::move(c), e);
  }
}

}  // namespace hilo
