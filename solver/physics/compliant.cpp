// SPDX-License-Identifier: GPL-3.0-or-later
// Joints that give way: the rows of any joint on springs and dampers instead of multipliers.
#include <utility>

#include "physics/coordinates.hpp"
#include "physics/spring.hpp"

namespace hilo {
std::string missing_stiffness(const JointKind& kind, const Stiffness& s) {
  for (const char r : kind.holds) {
    if (r >= 'x' && !(s.along[r - 'x'] > 0)) return "stiffness";
    if (r <= 'C' && !(s.about[r - 'A'] > 0)) return "angular_stiffness";
  }
  return {};
}

Spring make_compliant(JointPlace place, const Stiffness& s, const Config& q) {
  place.gives_way = true;
  Joint joint = make_joint(place, q);
  const JointKind& kind = *joint.kind;
  std::vector<double> stiffness, viscosity, free;
  for (const char r : kind.holds) {
    stiffness.push_back(r >= 'x' ? s.along[r - 'x'] : s.about[r - 'A']);
    viscosity.push_back(r >= 'x' ? s.damping[r - 'x'] : s.angular_damping[r - 'A']);
  }
  if (kind.soften) kind.soften(joint, free);
  Spring c;
  static_cast<Connector&>(c) = std::move(static_cast<Connector&>(joint));
  c.law = make_linear(stiffness, viscosity, free);
  if (joint.rows) c.law = std::make_unique<OnCoordinates>(std::move(joint.rows), std::move(c.law));
  c.group = "joint", c.axes = Spring::Axes::of_joint, c.gives_way = &kind;
  return c;
}

}  // namespace hilo
