// SPDX-License-Identifier: GPL-3.0-or-later
// Random machines by family.  Every joint is put together in the configuration in which it is drawn, so a scene needs no assembly.
#include <numbers>

#include "machines/maker.hpp"

namespace hilo::test {
namespace {

/// A block between rigid bodies, or between one and the ground.
void add_block(Maker& k, bool damped, bool free, bool metal = false) {
  Dice& d = k.dice;
  MachineBlock b;
  static constexpr Shape shapes[] = {Shape::hex8, Shape::hex8, Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex20};
  b.shape = shapes[d.pick(7)];
  const bool big = b.shape == Shape::hex20 || b.shape == Shape::wedge15 || b.shape == Shape::tet10;
  b.n[0] = big ? 2 : 2 + d.pick(3), b.n[1] = big ? 1 : 1 + d.pick(2);
  b.high = Vec3(d.in(0.6, 1.5), d.in(0.15, 0.4), d.in(0.15, 0.4));
  b.low = Vec3::Zero();
  b.E = d.logarithmic(1e6, 1e10), b.nu = d.in(0, 0.45), b.density = d.logarithmic(300, 3000);
  b.neo_hookean = d.chance(0.4), b.hub = d.chance(0.3);
  if (damped) b.damping = d.logarithmic(1e-4, 1e-2);
  if (metal) {
    b.yield = b.E * d.logarithmic(1e-3, 3e-2), b.hardening = d.chance(0.5) ? b.E * d.logarithmic(1e-4, 0.1) : 0;
    b.kinematic = d.chance(0.4) ? b.E * d.logarithmic(1e-3, 0.1) : 0;
  }
  k.m.blocks.push_back(b);
  const Vec3 near(0, b.high[1] / 2, b.high[2] / 2), far(b.high[0], b.high[1] / 2, b.high[2] / 2);
  const Side end = Side::at(b.hub ? "hub" : "xmax");
  static const std::vector<std::string> kinds{"revolute", "spherical", "universal", "fixed", "revolute", "spherical"};
  if (free) {
    const int first = k.add_body(near - Vec3(d.in(0.1, 0.4), 0, 0), 0.5);
    k.m.joints.push_back(k.joint(kinds[d.pick(6)], Side::on(first), Side::at("xmin"), near));
  } else {
    k.m.joints.push_back(k.joint(kinds[d.pick(6)], Side::ground(), Side::at("xmin"), near));
  }
  if (free || d.chance(0.7)) {
    const int last = k.add_body(far + Vec3(d.in(0.1, 0.4), 0, 0), 0.5);
    k.m.joints.push_back(k.joint(kinds[d.pick(6)], end, Side::on(last), far));
    if (d.chance(0.4)) {
      const Vec3 at = k.m.bodies[last].com + 0.3 * d.direction();
      const int next = k.add_body(at + 0.3 * d.direction(), 0.5);
      k.m.joints.push_back(k.joint(k.hinge(), Side::on(last), Side::on(next), at));
    }
    if (d.chance(0.4)) k.add_springs(1, damped ? 1 : 0);
  }
  for (auto& body : k.m.bodies) body.mass *= b.density * b.high.prod(), body.inertia *= b.density * b.high.prod();
  for (auto& s : k.m.springs) s.stiffness *= b.density * b.high.prod(), s.damping *= b.density * b.high.prod();
  if (d.chance(0.6)) k.m.blocks[0].spin = d.in(0, 4) * d.direction();
}

}  // namespace

const std::vector<Family>& families() {
  static const std::vector<Family> list{
      {"chain", "bodies one after another, joints of any kind"},
      {"tree", "each body on a random earlier one, joints of any kind"},
      {"loop", "chains closed in space by one to three joints"},
      {"polygon", "closed chains of parallel hinges: three rows are redundant"},
      {"parallelogram", "two to four equal cranks on a coupler"},
      {"sprung", "trees and chains with axial and torsion springs"},
      {"damped", "the same with dampers"},
      {"floating", "trees without ground: momentum is kept"},
      {"bricard", "Bricard's six hinges, bodies of any mass: one redundant row, another at each pose"},
      {"block", "a flexible block on the ground, bodies behind it", true},
      {"floating-block", "bodies on both sides of a flexible block, no ground: momentum is kept", true},
      {"damped-block", "a block with material damping", true},
      {"metal-block", "a block of metal on the ground: what flow takes is told", true},
      {"floating-metal", "the same without ground: momentum is kept", true},
      {"geared", "wheels on a carrier, gears, racks and screws", false, false},
      {"stopped", "trees with ropes and buffers", false, false},
      {"rubbing", "friction in joints", false, false},
      {"driven", "a hinge of a tree or polygon turned by its drive", false, false},
      {"motored", "a motor in a hinge", false, false},
      {"flat", "parallelograms drawn flat, two to four cranks: they start where branches meet"},
      {"compliant", "trees whose joints give way", false, false},
  };
  return list;
}

Machine random_machine(const std::string& family, std::uint64_t seed) {
  std::uint64_t salt = 1469598103934665603ull;
  for (char c : family) salt = (salt ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  Maker k{{}, Dice(seed * 1000003 + salt)};
  Dice& d = k.dice;
  k.m.family = family, k.m.seed = seed;
  k.wide = d.chance(0.5);
  const bool weight = d.chance(0.6), thrown = d.chance(0.6);
  if (weight) k.m.gravity = d.chance(0.7) ? Vec3(0, 0, -9.81) : Vec3(9.81 * d.direction());
  if (family == "chain") {
    k.grow(2 + d.pick(5), true, true, d.chance(0.5));
  } else if (family == "tree") {
    k.grow(3 + d.pick(5), false, true, d.chance(0.3));
  } else if (family == "loop") {
    k.grow(3 + d.pick(4), d.chance(0.7), true, true);
    k.close(1 + d.pick(3));
  } else if (family == "polygon") {
    k.polygon(3 + d.pick(4));
  } else if (family == "parallelogram") {
    k.parallelogram(2 + d.pick(3), d.in(0.3, 1.2) * (d.chance(0.5) ? 1 : -1) + std::numbers::pi / 2);
  } else if (family == "sprung" || family == "damped") {
    k.grow(2 + d.pick(5), d.chance(0.5), true, d.chance(0.6));
    k.add_springs(1 + d.pick(4), family == "damped" ? 0.8 : 0);
    if (family == "damped" && !k.m.damped()) k.m.springs[0].damping = 0.1 * k.m.springs[0].stiffness;
  } else if (family == "floating") {
    k.grow(2 + d.pick(5), d.chance(0.5), false, d.chance(0.6));
    for (auto& j : k.m.joints)
      if (j.kind == "in-line" || j.kind == "in-plane") j.kind = "spherical";
  } else if (family == "block" || family == "damped-block") {
    add_block(k, family == "damped-block", false);
  } else if (family == "floating-block") {
    add_block(k, false, true);
  } else if (family == "metal-block" || family == "floating-metal") {
    add_block(k, false, family == "floating-metal", true);
  } else {
    return wide_machine(family, k);
  }
  if (thrown || !weight) k.throw_bodies(d.logarithmic(0.5, 8));
  k.m.energy = k.m.damped() ? Machine::Energy::falls : Machine::Energy::kept;
  return k.m;
}

}  // namespace hilo::test
