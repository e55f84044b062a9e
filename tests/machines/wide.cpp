// SPDX-License-Identifier: GPL-3.0-or-later
// Attacks beyond the suite: what supplies power or takes it in jumps, and machines drawn where their joints' rows depend on each other.
#include <fmt/format.h>

#include <numbers>
#include <stdexcept>

#include "machines/maker.hpp"

namespace hilo::test {
namespace {

constexpr double pi = std::numbers::pi;
using Energy = Machine::Energy;

/// A wheel on a shaft of the ground or of an arm, geared to a second one; a rack on the ground; a nut on a screw.
void geared(Maker& k) {
  Dice& d = k.dice;
  const Mat3 R = k.rotation();
  const Vec3 axis = R.col(2);
  Side carrier = Side::ground();
  if (d.chance(0.5)) {
    carrier = Side::on(k.add_body(R * Vec3(0.2, 0.1, 0), 0.5));
    k.hinge_at(Side::ground(), carrier, Vec3::Zero(), d.chance(0.5) ? axis : d.direction(), false);
  }
  const Vec3 first = R * Vec3(0.2, 0, 0), second = R * Vec3(0.6, 0.1, 0);
  const int a = k.add_body(first, 0.3), b = k.add_body(second + R * (0.05 * d.vector(1)), 0.3);
  const Vec3 axis_b = d.chance(0.5) ? axis : Vec3((axis + 0.5 * d.direction()).normalized());
  k.hinge_at(carrier, Side::on(a), first, axis, false);
  k.hinge_at(carrier, Side::on(b), second, axis_b, false);
  MachineJoint g = k.joint("gear", Side::on(a), Side::on(b), first);
  g.axis = axis, g.x = axis.unitOrthogonal(), g.axis_b = axis_b, g.carrier = carrier;
  g.ratio = d.logarithmic(0.2, 5) * (d.chance(0.5) ? -1 : 1);
  k.m.joints.push_back(g);
  if (d.chance(0.5)) {
    const Vec3 at = first + R * Vec3(0, 0.2, 0), along = R.col(0);
    const int rack = k.add_body(at, 0.5);
    MachineJoint guide = k.joint("prismatic", carrier, Side::on(rack), at), r = k.joint("rack", Side::on(a), Side::on(rack), at);
    guide.axis = along, guide.x = axis;
    r.axis = axis, r.x = axis.unitOrthogonal(), r.axis_b = along, r.carrier = carrier, r.radius = 0.2;
    k.m.joints.push_back(guide), k.m.joints.push_back(r);
  }
  if (d.chance(0.5)) {
    const int nut = k.add_body(second + 0.3 * axis_b, 0.2);
    MachineJoint s = k.joint("screw", Side::on(b), Side::on(nut), second);
    s.axis = axis_b, s.x = axis_b.unitOrthogonal();
    k.m.joints.push_back(s);
  }
}

void stopped(Maker& k) {
  Dice& d = k.dice;
  k.grow(2 + d.pick(4), d.chance(0.5), true, true);
  const bool lossy = d.chance(0.4);
  for (int i = 0; i < 1 + d.pick(3); ++i) {
    MachineSpring s;
    const int b = d.pick(static_cast<int>(k.m.bodies.size()));
    s.kind = "stop", s.a = Side::ground(), s.b = Side::on(b);
    s.at_b = k.m.bodies[b].com + 0.3 * d.vector(1), s.at_a = s.at_b + d.in(0.3, 1) * d.direction();
    const double apart = (s.at_a - s.at_b).norm();
    s.lower = apart * d.in(0.3, 0.95), s.upper = apart * d.in(1.05, 1.5);
    s.stiffness = k.m.bodies[b].mass * d.logarithmic(1e2, 1e5);
    if (lossy) s.restitution = d.in(0, 0.9);
    k.m.springs.push_back(s);
  }
  k.m.energy = lossy ? Energy::unknown : Energy::kept;
}

void rubbing(Maker& k) {
  Dice& d = k.dice;
  k.grow(2 + d.pick(4), d.chance(0.5), true, d.chance(0.5));
  for (size_t i = 0; i < k.m.joints.size(); ++i) {
    const std::string& kind = k.m.joints[i].kind;
    if (kind != "revolute" && kind != "cylindrical" && kind != "prismatic" && kind != "screw" && kind != "spherical") continue;
    k.m.more += fmt::format("[[friction]]\nname = \"f{0}\"\njoint = \"j{0}\"\ncoefficient = {1:.17g}\n", i, d.in(0.02, 0.4));
    if (kind != "prismatic") k.m.more += "radius = 0.05\n";
    if (d.chance(0.3)) k.m.more += fmt::format("preload = {:.17g}\n", d.in(0, 20));
  }
  k.m.energy = Energy::falls;
}

void driven(Maker& k) {
  Dice& d = k.dice;
  if (d.chance(0.5))
    k.polygon(3 + d.pick(3));
  else
    k.grow(2 + d.pick(4), d.chance(0.5), true, true);
  MachineJoint& j = k.m.joints[0];
  j.kind = "revolute";
  j.turn = d.in(0.2, 0.8) * (d.chance(0.5) ? 1 : -1), j.turn_over = d.in(0.3, 1);
  k.m.energy = Energy::unknown;
}

void motored(Maker& k) {
  Dice& d = k.dice;
  k.grow(2 + d.pick(4), d.chance(0.5), true, true);
  k.m.joints[0].kind = "revolute";
  const double torque = k.m.bodies[0].mass * d.logarithmic(0.5, 20);
  k.m.more += fmt::format("[[motor]]\nkind = \"rotary\"\nname = \"m\"\njoint = \"j0\"\nrate = [0, {:.17g}]\ntorque = [{:.17g}, 0]\n",
                          d.in(1, 10), torque);
  if (d.chance(0.5)) k.m.more += fmt::format("history = {{ t = [0, 0.1, 0.1], value = [0, {:.17g}, 1] }}\n", d.in(0, 1));
  k.m.energy = Energy::unknown;
}

/// Six links, hinges at corners of a cube along its edges: one freedom, one redundant row (verify/bricard).
void bricard(Maker& k) {
  const Mat3 R = k.rotation();
  const Vec3 corner[6] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}};
  const Vec3 axis[6] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  for (int i = 0; i < 5; ++i) {
    const int b = k.add_body(R * ((corner[i] + corner[i + 1]) / 2 + 0.1 * k.dice.vector(1)), 1);
    k.hinge_at(i ? Side::on(b - 1) : Side::ground(), Side::on(b), R * corner[i], R * axis[i], false);
  }
  k.hinge_at(Side::on(4), Side::ground(), R * corner[5], R * axis[5], false);
}

void compliant(Maker& k) {
  Dice& d = k.dice;
  k.grow(2 + d.pick(4), d.chance(0.5), true, true);
  for (auto& j : k.m.joints)
    if ((j.kind == "revolute" || j.kind == "spherical") && d.chance(0.6))
      j.gives = true,
      j.more = fmt::format("stiffness = {:.17g}\n{}", d.logarithmic(1e3, 1e6),
                           j.kind == "revolute" ? fmt::format("angular_stiffness = {:.17g}\n", d.logarithmic(1e2, 1e4)) : "");
  k.m.energy = Energy::unknown;
}

}  // namespace

Machine wide_machine(const std::string& family, Maker& k) {
  Dice& d = k.dice;
  if (family == "geared")
    geared(k);
  else if (family == "stopped")
    stopped(k);
  else if (family == "rubbing")
    rubbing(k);
  else if (family == "driven")
    driven(k);
  else if (family == "motored")
    motored(k);
  else if (family == "flat")
    k.parallelogram(2 + d.pick(3), d.pick(2) * pi);
  else if (family == "bricard")
    bricard(k);
  else if (family == "compliant")
    compliant(k);
  else
    throw std::invalid_argument("no family " + family);
  k.throw_bodies(d.logarithmic(0.5, 5));
  return k.m;
}

}  // namespace hilo::test
