// SPDX-License-Identifier: GPL-3.0-or-later
// What acts along the free directions of joints: stops, motors, friction.
#include <algorithm>
#include <cmath>

#include "physics/coordinates.hpp"
#include "physics/joint_rows.hpp"
#include "physics/spring.hpp"

namespace hilo {
namespace {

/// A connector between the ends of a joint, with the joint's points as entities 0 (on a) and 1 (on b).
Spring beside(const Connector& joint) {
  Spring c;
  c.axes = Spring::Axes::of_joint;
  c.end[0] = joint.end[0], c.end[1] = joint.end[1];
  c.entities = {joint.entities[0], joint.entities[1]};
  c.frame_a = joint.frame_a, c.point_b = joint.point_b;
  return c;
}

/// Column i of the joint's frame carried by end 0 or 1.
int column(Connector& c, const Config& q, int end, int i) {
  const Vec3 d = q.R[c.end[0].body] * c.frame_a.col(i);
  c.entities.push_back({end, q.R[c.end[end].body].transpose() * d, false});
  return static_cast<int>(c.entities.size()) - 1;
}

void add_slide(Connector& c, const Config& q) {
  c.measures.push_back({{{Term::slide, column(c, q, 0, 2), 0, 1}}, 0});
  c.measures.back().offset = c.value(static_cast<int>(c.measures.size()) - 1, q);
}

/// Sine and cosine.
void add_angle(Connector& c, const Config& q) {
  const int x = column(c, q, 0, 0), y = column(c, q, 0, 1), turned = column(c, q, 1, 0);
  c.measures.push_back({{{Term::dot, y, turned}}, 0});
  c.measures.push_back({{{Term::dot, x, turned}}, 0});
}

std::unique_ptr<RowLaw> plain_and_angle(int n_plain, bool angle) {
  std::vector<std::vector<SumRows::Part>> sums;
  if (angle) sums.push_back({{1, n_plain, SumRows::angle}});
  return std::make_unique<SumRows>(n_plain, std::move(sums));
}

}  // namespace

Spring along_joint(const Connector& joint, const Config& q, Freedom freedom, std::unique_ptr<SpringLaw> law) {
  Spring c = beside(joint);
  const bool angle = freedom == Freedom::angle;
  angle ? add_angle(c, q) : add_slide(c, q);
  c.law = std::make_unique<OnCoordinates>(plain_and_angle(angle ? 0 : 1, angle), std::move(law));
  return c;
}

Connector coordinates_of(const Connector& joint, const JointKind& kind, const Config& q) {
  Spring c = beside(joint);
  if (kind.frees(Freedom::slide)) add_slide(c, q);
  if (kind.frees(Freedom::angle)) add_angle(c, q);
  return c;
}

Spring friction_in(const Connector& joint, const JointKind& kind, const Config& q, const FrictionIn& f) {
  Spring c = beside(joint);
  c.pressing.rows = kind.pressing;
  const auto law = [&](std::vector<double> lever) {
    return FrictionLaw{.coefficient = f.coefficient, .preload = f.preload, .slip_velocity = f.slip_velocity, .lever = std::move(lever)};
  };
  const bool slides = kind.frees(Freedom::slide), turns = kind.frees(Freedom::angle);
  if (!slides && !turns) {  // a ball
    // the nine products of directions are the entries of the relative rotation; the sum of the squares of their rates is twice that of
    // the relative angular velocity
    int u[3], v[3];
    for (int i = 0; i < 3; ++i) {
      c.entities.push_back({0, Vec3::Unit(i), false}), u[i] = static_cast<int>(c.entities.size()) - 1;
      c.entities.push_back({1, Vec3::Unit(i), false}), v[i] = static_cast<int>(c.entities.size()) - 1;
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) c.add_measure({{Term::dot, u[i], v[j]}});
    c.law = make_friction(law(std::vector<double>(9, f.radius / std::sqrt(2.0))));
    return c;
  }
  std::vector<double> lever;
  if (slides) add_slide(c, q), lever.push_back(1);
  if (turns) add_angle(c, q), lever.push_back(f.radius);
  c.law = std::make_unique<OnCoordinates>(plain_and_angle(slides, turns), make_friction(law(std::move(lever))));
  return c;
}

}  // namespace hilo
