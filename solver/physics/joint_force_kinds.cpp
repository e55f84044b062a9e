// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of forces along the free directions of a joint: stops, motors, friction.
#include <fmt/format.h>

#include "base/keys.hpp"
#include "physics/spring_kinds.hpp"

namespace hilo {
namespace {

using enum Type;

Spring along(const EntryValues& e, const JointHost& host, const Config& q, Freedom freedom, std::unique_ptr<SpringLaw> law) {
  if (!host.kind.frees(freedom))
    e.refuse("joint",
             fmt::format("a {} joint has no free {} along its axis", host.kind.name, freedom == Freedom::angle ? "angle" : "displacement"));
  return along_joint(host.geometry, q, freedom, std::move(law));
}

template <Freedom freedom>
Spring stop(const EntryValues& e, const JointHost& host, const Config& q) {
  return along(e, host, q, freedom, make_stop(stop_law(e)));
}

MotorLaw motor_law(const EntryValues& e, std::string_view force) {
  const std::vector<double>&rate = e.numbers("rate"), &value = e.numbers(force);
  if (rate.size() != value.size() || rate.empty())
    e.refuse(force, fmt::format("rate has {} numbers and {} has {}", rate.size(), force, value.size()),
             "both columns of the table are as long");
  for (size_t i = 1; i < rate.size(); ++i)
    if (!(rate[i] > rate[i - 1])) e.refuse("rate", fmt::format("rate does not rise from {} to {}", rate[i - 1], rate[i]));
  return {.rate = rate, .force = value};
}

Spring rotary(const EntryValues& e, const JointHost& host, const Config& q) {
  return along(e, host, q, Freedom::angle, make_motor(motor_law(e, "torque")));
}
Spring linear(const EntryValues& e, const JointHost& host, const Config& q) {
  return along(e, host, q, Freedom::slide, make_motor(motor_law(e, "force")));
}

Spring friction(const EntryValues& e, const JointHost& host, const Config& q) {
  if (host.kind.pressing.empty())
    e.refuse("joint", fmt::format("no friction in a joint of kind {}", host.kind.name),
             "revolute, cylindrical, prismatic, screw and spherical joints have it");
  const bool turns = host.kind.frees(Freedom::angle) || !host.kind.frees(Freedom::slide);
  if (turns && !e.has("radius")) e.refuse("joint", fmt::format("a joint of kind {} turns and needs a radius", host.kind.name));
  const std::string& name = host.geometry.name;
  if (host.geometry.end[0].body < 0 || host.geometry.end[1].body < 0)
    e.refuse("joint", fmt::format("both ends of joint \"{}\" must be able to turn", name), "name a set of several nodes");
  Spring c = friction_in(host.geometry, host.kind, q,
                         {.coefficient = e.number("coefficient"),
                          .radius = e.has("radius") ? e.number("radius") : 0,
                          .preload = e.number("preload"),
                          .slip_velocity = e.number("slip_velocity")});
  if (!e.boolean("reaction")) return c;
  if (host.joint < 0)
    e.refuse("joint", fmt::format("joint \"{}\" gives way and has no reaction to press with", name),
             "say reaction = false and give a preload");
  c.pressing.joint = host.joint;
  return c;
}

constexpr Param of_joint{"joint", text, "", "!", "name of the [[joint]] along whose axis it acts, on b and in return on a"};

std::vector<Param> stop_keys(std::string_view unit, std::string_view per, std::string_view speed) {
  std::vector<Param> keys{of_joint,
                          {"lower", number, unit, "", "limit from below, measured from the start"},
                          {"upper", number, unit, "", "limit from above, measured from the start"},
                          {"stiffness", number, per, "!", "of the stop, beyond the limit", above(0)}};
  for (const Param& p : rebound_keys(speed)) keys.push_back(p);
  return keys;
}

}  // namespace

StopLaw stop_law(const EntryValues& e) {
  if (!e.has("lower") && !e.has("upper")) e.refuse("", "there is no limit", "give lower, upper or both");
  StopLaw stop{.stiffness = e.number("stiffness"), .restitution = e.number("restitution"), .rest_speed = e.number("rest_speed")};
  if (e.has("lower")) stop.lower = e.number("lower");
  if (e.has("upper")) stop.upper = e.number("upper");
  if (!(stop.lower < stop.upper)) e.refuse("lower", "lower is not below upper");
  return stop;
}

std::vector<Param> rebound_keys(std::string_view unit_of_speed) {
  return {{"restitution", number, "1", "1",
           "speed after an impact, divided by that before it; 1 gives the energy back exactly, less needs 10 steps an impact or more",
           from_to(0, 1)},
          {"rest_speed", number, unit_of_speed, "1e-3", "slower impacts lose no smaller part of their speed than they would at this one",
           above(0)}};
}

Registry<JointForceKind>& joint_force_kinds() {
  static Registry<JointForceKind> kinds{
      "force along a joint",
      {
          {"angle", "stop", "limits the angle of a revolute, cylindrical, screw or planar joint", stop_keys("rad", "N m/rad", "rad/s"),
           stop<Freedom::angle>},
          {"slide", "stop", "limits the displacement of a prismatic, cylindrical, screw or in-line joint", stop_keys("m", "N/m", "m/s"),
           stop<Freedom::slide>},
          {"rotary",
           "motor",
           "torque about the axis of a revolute, cylindrical, screw or planar joint, from its speed",
           {of_joint,
            {"rate", numbers, "rad/s", "!", "rising speeds of b relative to a; one number for a constant torque"},
            {"torque", numbers, "N m", "!",
             "torque on b at these speeds, linear between them, first and last segment continued; none in statics"},
            keys::history},
           rotary},
          {"linear",
           "motor",
           "force along the axis of a prismatic, cylindrical, screw or in-line joint, from its speed",
           {of_joint,
            {"rate", numbers, "m/s", "!", "rising speeds of b relative to a; one number for a constant force"},
            {"force", numbers, "N", "!",
             "force on b at these speeds, linear between them, first and last segment continued; none in statics"},
            keys::history},
           linear},
          {"",
           "friction",
           "Coulomb friction in a revolute, cylindrical, prismatic, screw or spherical joint, pressed by the joint's own reaction force; "
           "without force in statics (static, path, buckling, start = equilibrium), a damper of mu N r^2/slip_velocity in modes",
           {{"joint", text, "", "!", "name of the [[joint]]"},
            {"coefficient", number, "1", "!", "of friction", at_least(0)},
            {"radius", number, "m", "", "of the surfaces that turn; not of a prismatic joint", above(0)},
            {"preload", number, "N", "0", "pressing force besides the reaction", at_least(0)},
            {"reaction", boolean, "", "true", "the joint's reaction presses too; false leaves the preload alone, as of a brake"},
            {"slip_velocity", number, "m/s", "1e-3",
             "v of the regularisation tanh(slip/v): a fraction p of the limit force creeps at v artanh(p)", above(0)}},
           friction},
      }};
  return kinds;
}

}  // namespace hilo
