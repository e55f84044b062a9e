// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a region or body against one obstacle.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "physics/contact/point_contact.hpp"
#include "system/contact/surface_pair.hpp"

namespace hilo {

/// A point of a facet, or one that a body carries.
struct ContactPoint {
  std::vector<int> nodes;  // none: of the body
  std::vector<int> facet;  // nodes of its facet, whose shape functions `share` are
  double area = 0;         // of the facet [m^2]
  std::vector<double> share;
  Vec3 arm = Vec3::Zero();  // from the centre of the body, body axes [m]
  PointLaw law;
  double cell = 0;                         // the depth that is told as a share of this [m]
  double deep = HUGE_VAL;                  // the depth at which the pressure is the modulus of what lies behind [m]
  Vec3 u = Vec3::Zero();                   // the bristle, in axes of the obstacle [m]
  Vec3 next = Vec3::Zero();                // at the end of the step tried last
  double approach = 0, next_approach = 0;  // speed at which the contact began; after the step tried last [m/s]
  Vec3 last = Vec3::Zero();                // measures of the state accepted last, where forces are those at an instant [m]
  HeldPoint held;                          // in small motions about a state
  bool parts = false;                      // touches without pressure, and would be pulled in the step at work
  int clique = -1;
  int wall = -1;  // of the obstacle, that this point meets alone; -1: all of it
};

struct ContactPair {
  std::string name, told;  // `told`: what the stiffness is and from what
  Distance shape;
  std::vector<Distance> walls;  // of it, that points have by number
  int carrier = 0;              // the body that carries it
  Vec3 at = Vec3::Zero();       // from its centre, body axes [m]
  Mat3 axes = Mat3::Identity();
  int body = -1;  // of the points, or -1: they have nodes
  double friction = 0;
  bool loses = false;                // by restitution
  std::vector<ContactPoint> points;  // that this rank evaluates: of facets of its cells; those of a body without mesh are on one rank
  std::vector<std::int64_t> number;  // of these, among all
  std::int64_t n_points = 0;         // of all
  bool has_facets = false;
  int outside = 0;  // points that start past the border of a height field
  ContactSums sums, next;

  const Distance& met_by(const ContactPoint& point) const { return point.wall < 0 ? shape : walls[static_cast<size_t>(point.wall)]; }
};

}  // namespace hilo
