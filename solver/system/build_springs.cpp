// Entries of the scene to springs, stops, motors and friction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/freedom.hpp"
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
    Connector c;
    if (e.kind == "axial") {
      const Vec3 pa = e.vector3("at_a"), pb = e.vector3("at_b");
      const double distance = (pb - pa).norm(), k = e.number("stiffness"), preload = e.number("preload");
      if (!(distance > 0)) throw Error(e.where("at_b"), e.label() + ": the two points coincide");
      if (preload != 0 && k == 0) throw Error(e.where("preload"), e.label() + ": a preload needs a stiffness");
      const double length = (e.given("length") ? e.number("length") : distance) - (k > 0 ? preload / k : 0);
      c = make_axial_spring(a, b, q, pa, pb, k, e.number("damping"), length);
      out_->stiffness = std::max(out_->stiffness, k);
    } else if (e.kind == "torsion") {
      c = make_torsion_spring(a, b, q, joint_frame(e), e.number("stiffness"), e.number("damping"), e.number("angle"));
    } else if (e.kind == "bushing") {
      c = make_bushing(a, b, q, e.vector3("at"), joint_frame(e), vec(padded(e, "stiffness", 3)), vec(padded(e, "damping", 3)),
                       vec(padded(e, "angular_stiffness", 3)), vec(padded(e, "angular_damping", 3)));
      out_->stiffness = std::max(out_->stiffness, vec(padded(e, "stiffness", 3)).maxCoeff());
    } else if (e.kind == "stop") {
      c = make_distance_stop(a, b, q, e.vector3("at_a"), e.vector3("at_b"), stop_law(e));
      out_->stiffness = std::max(out_->stiffness, e.number("stiffness"));
    } else {
      if (e.given("restitution") && e.number("damping") > 0)
        throw Error(e.where("restitution"), e.label() + ": restitution and damping are two ways to say the same", "leave one out");
      c = make_support(a, b, q, e.vector3("at"), joint_frame(e), e.number("stiffness"), e.number("damping"), e.number("restitution"),
                       e.number("rest_speed"), e.number("clearance"), vec(padded(e, "tangential_stiffness", 2)),
                       vec(padded(e, "tangential_damping", 2)));
      out_->stiffness = std::max(out_->stiffness, e.number("stiffness"));
    }
    c.name = e.name;
    out_->part<Springs>().list.push_back(std::move(c));
  }
}

const Connector& Builder::joint_of(const Entry& e) const {
  const std::string& name = e.text("joint");
  std::vector<std::string> names;
  for (const auto* list : {&out_->joints.list, &out_->part<Springs>().list})
    for (const Connector& c : *list) {
      if (c.law && c.section != "joint") continue;
      if (c.name == name) return c;
      names.push_back(c.name);
    }
  throw Error(e.where("joint"), fmt::format("{}: no joint \"{}\"", e.label(), name), suggest(name, names));
}

/// Stops, motors and friction act along the free directions of a joint.
void Builder::add_joint_forces() {
  const Config& q = out_->start;
  const auto add = [&](Connector c, const Entry& e) {
    c.name = e.name, c.section = e.section;
    out_->part<Springs>().list.push_back(std::move(c));
  };
  const auto along = [&](const Entry& e, Freedom freedom, std::unique_ptr<SpringLaw> law) {
    const Connector& joint = joint_of(e);
    const auto free = freedoms(joint.kind);
    if (std::find(free.begin(), free.end(), freedom) == free.end())
      throw Error(e.where("joint"), fmt::format("{}: a {} joint has no free {} along its axis", e.label(), joint.kind,
                                                freedom == Freedom::angle ? "angle" : "displacement"));
    return along_joint(joint, q, freedom, std::move(law));
  };
  for (const Entry& e : scene_.entries("stop")) add(along(e, e.kind == "angle" ? Freedom::angle : Freedom::slide, stop_law(e)), e);
  for (const Entry& e : scene_.entries("motor")) {
    const bool turns = e.kind == "rotary";
    Connector c = along(e, turns ? Freedom::angle : Freedom::slide, motor_law(e, turns ? "torque" : "force"));
    if (e.given("history"))
      c.factor = [history = use_history(e, Acts::as_force)](double t0, double t1) { return t1 > t0 ? history.mean(t0, t1) : history(t0); };
    add(std::move(c), e);
  }
  for (const Entry& e : scene_.entries("friction")) {
    const Connector& joint = joint_of(e);
    if (!has_friction(joint.kind))
      throw Error(e.where("joint"), fmt::format("{}: no friction in a joint of kind {}", e.label(), joint.kind),
                  "revolute, cylindrical, prismatic, screw and spherical joints have it");
    if (joint.kind != "prismatic" && !e.has("radius"))
      throw Error(e.where("joint"), fmt::format("{}: a joint of kind {} turns and needs a radius", e.label(), joint.kind));
    if (joint.end[0].body < 0 || joint.end[1].body < 0)
      throw Error(e.where("joint"), fmt::format("{}: both ends of joint \"{}\" must be able to turn", e.label(), joint.name),
                  "name a set of several nodes");
    Connector c = friction_in(joint, q, e.number("coefficient"), e.has("radius") ? e.number("radius") : 0, e.number("preload"),
                              e.number("slip_velocity"));
    if (e.boolean("reaction")) {
      if (joint.law)
        throw Error(e.where("joint"), fmt::format("{}: joint \"{}\" gives way and has no reaction to press with", e.label(), joint.name),
                    "say reaction = false and give a preload");
      c.load_joint = static_cast<int>(&joint - out_->joints.list.data());
    }
    add(std::move(c), e);
  }
}

}  // namespace hilo
