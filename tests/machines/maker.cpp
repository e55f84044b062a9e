// SPDX-License-Identifier: GPL-3.0-or-later
#include "machines/maker.hpp"

#include <algorithm>
#include <numbers>

namespace hilo::test {
namespace {

constexpr double pi = std::numbers::pi;

/// Rows of a joint that are independent in general position.
int rows_of(const std::string& kind) {
  if (kind == "fixed") return 6;
  if (kind == "revolute" || kind == "prismatic" || kind == "screw") return 5;
  if (kind == "cylindrical" || kind == "universal" || kind == "constant-velocity") return 4;
  if (kind == "spherical" || kind == "planar") return 3;
  return kind == "in-line" ? 2 : 1;
}

}  // namespace

Mat3 Maker::rotation() { return Eigen::AngleAxisd(dice.in(-pi, pi), dice.direction()).toRotationMatrix(); }

int Maker::add_body(const Vec3& com, double size) {
  MachineBody b;
  b.mass = wide ? dice.logarithmic(1e-2, 1e2) : dice.logarithmic(0.3, 3);
  b.com = com;
  const Vec3 edge(size * dice.in(0.5, 1.5), size * dice.logarithmic(0.05, 1), size * dice.logarithmic(0.05, 1));
  const Vec3 J = b.mass / 12 *
                 Vec3(edge[1] * edge[1] + edge[2] * edge[2], edge[0] * edge[0] + edge[2] * edge[2], edge[0] * edge[0] + edge[1] * edge[1]);
  const Mat3 R = rotation();
  b.inertia = R * J.asDiagonal() * R.transpose();
  m.bodies.push_back(b);
  return static_cast<int>(m.bodies.size()) - 1;
}
void Maker::throw_bodies(double speed) {
  for (auto& b : m.bodies)
    if (dice.chance(0.7)) b.spin = speed * dice.unit() * dice.direction(), b.velocity = speed / 3 * dice.unit() * dice.direction();
}
MachineJoint Maker::joint(const std::string& kind, const Side& a, const Side& b, const Vec3& at) {
  MachineJoint j;
  j.kind = kind, j.a = a, j.b = b, j.at = at, j.axis = dice.direction();
  do j.x = dice.direction();
  while (std::abs(j.x.dot(j.axis)) > 0.9);
  if (kind == "universal") j.x = j.axis.cross(j.x).normalized();
  j.pitch = dice.in(-0.3, 0.3);
  if (kind == "distance") j.at_b = at + dice.in(0.1, 0.5) * dice.direction();
  return j;
}
std::string Maker::any_kind() {
  static const std::vector<std::string> kinds{"revolute",  "revolute",  "revolute",  "revolute",  "spherical",
                                              "spherical", "spherical", "universal", "universal", "cylindrical",
                                              "screw",     "prismatic", "in-line",   "in-plane",  "constant-velocity",
                                              "planar",    "distance",  "fixed",     "revolute",  "spherical"};
  return kinds[dice.pick(static_cast<int>(kinds.size()))];
}
std::string Maker::hinge() {
  static const std::vector<std::string> kinds{"revolute", "revolute", "spherical", "universal", "constant-velocity", "cylindrical"};
  return kinds[dice.pick(static_cast<int>(kinds.size()))];
}
int Maker::mobility() const {
  int free = 6 * static_cast<int>(m.bodies.size());
  for (const auto& j : m.joints) free -= rows_of(j.kind);
  return free;
}

void Maker::grow(int n, bool chain, bool grounded, bool hinges_alone) {
  std::vector<Vec3> tip;
  for (int i = 0; i < n; ++i) {
    const int parent = i == 0 ? -1 : chain ? i - 1 : dice.pick(i + (grounded ? 1 : 0)) - (grounded ? 1 : 0);
    const double size = dice.in(0.3, 1.2);
    const Vec3 at = parent < 0 ? Vec3(i == 0 ? Vec3::Zero() : Vec3(dice.vector(1))) : tip[parent], along = size * dice.direction();
    const int b = add_body(at + along * dice.in(0.3, 0.7) + 0.1 * size * dice.vector(1), size);
    tip.push_back(at + along);
    if (i == 0 && !grounded) continue;
    m.joints.push_back(joint(hinges_alone ? hinge() : any_kind(), parent < 0 ? Side::ground() : Side::on(parent), Side::on(b), at));
  }
}
void Maker::close(int loops) {
  const int n = static_cast<int>(m.bodies.size());
  for (int k = 0; k < loops; ++k) {
    static const std::vector<std::string> kinds{"revolute", "spherical", "universal", "cylindrical", "in-line", "distance", "spherical"};
    std::string kind = kinds[dice.pick(static_cast<int>(kinds.size()))];
    if (mobility() - rows_of(kind) < 1) kind = "distance";
    if (mobility() - rows_of(kind) < 1) return;
    const int b = n - 1 - dice.pick(std::max(1, n / 2)), a = dice.chance(0.6) || b < 2 ? -1 : dice.pick(b - 1);
    m.joints.push_back(joint(kind, a < 0 ? Side::ground() : Side::on(a), Side::on(b), m.bodies[b].com + 0.5 * dice.vector(1)));
  }
}
void Maker::polygon(int links) {
  const Mat3 R = rotation();
  std::vector<Vec3> corner;
  for (int i = 0; i <= links; ++i) {
    const double angle = 2 * pi * (i + dice.in(-0.25, 0.25)) / (links + 1);
    corner.push_back(R * (dice.in(0.6, 1.4) * Vec3(std::cos(angle), std::sin(angle), 0)));
  }
  for (int i = 0; i < links; ++i) {
    const int b = add_body((corner[i] + corner[i + 1]) / 2 + R * (0.1 * dice.vector(1)), (corner[i + 1] - corner[i]).norm());
    hinge_at(i ? Side::on(b - 1) : Side::ground(), Side::on(b), corner[i], R.col(2), i == 1 && dice.chance(0.25));
  }
  hinge_at(Side::ground(), Side::on(links - 1), corner[links], R.col(2), false);
}
void Maker::hinge_at(const Side& a, const Side& b, const Vec3& at, const Vec3& axis, bool ball) {
  MachineJoint j = joint(ball ? "spherical" : "revolute", a, b, at);
  j.axis = axis, j.x = axis.unitOrthogonal();
  m.joints.push_back(j);
}
void Maker::parallelogram(int cranks, double angle) {
  const Mat3 R = rotation();
  const double length = dice.in(0.3, 0.8);
  const Vec3 crank = length * (R.col(0) * std::cos(angle) + R.col(1) * std::sin(angle));
  const int coupler = add_body(R.col(0) * 0.7 + crank, 1.4);
  for (int i = 0; i < cranks; ++i) {
    const Vec3 foot = R.col(0) * (1.4 * i / std::max(1, cranks - 1));
    const int b = add_body(foot + crank / 2, length);
    hinge_at(Side::ground(), Side::on(b), foot, R.col(2), false);
    hinge_at(Side::on(b), Side::on(coupler), foot + crank, R.col(2), false);
  }
}
void Maker::add_springs(int n, double damping_share) {
  for (int k = 0; k < n; ++k) {
    MachineSpring s;
    const int b = dice.pick(static_cast<int>(m.bodies.size()));
    const double mass = m.bodies[b].mass, frequency = dice.logarithmic(1, 10), stiffness = mass * frequency * frequency;
    const bool damped = dice.chance(damping_share);
    std::vector<const MachineJoint*> hinges;
    for (const auto& j : m.joints)
      if (j.kind == "revolute") hinges.push_back(&j);
    if (!hinges.empty() && dice.chance(0.3)) {
      const MachineJoint& j = *hinges[dice.pick(static_cast<int>(hinges.size()))];
      s.kind = "torsion", s.a = j.a, s.b = j.b, s.axis = j.axis, s.rest = dice.in(-1, 1);
      s.stiffness = 0.1 * stiffness;
    } else {
      const int a = dice.pick(static_cast<int>(m.bodies.size()) + 1) - 1;
      s.kind = "axial", s.a = a < 0 || a == b ? Side::ground() : Side::on(a), s.b = Side::on(b);
      s.at_a = (s.a.of == Side::Of::ground ? m.bodies[b].com + dice.direction() : m.bodies[a].com) + 0.2 * dice.vector(1);
      s.at_b = m.bodies[b].com + 0.3 * dice.vector(1);
      s.rest = (s.at_a - s.at_b).norm() * dice.in(0.5, 1.3);
      s.stiffness = stiffness;
    }
    if (damped) s.damping = 2 * dice.in(0.02, 0.5) * s.stiffness / frequency;
    if (damped && dice.chance(0.2)) s.stiffness = 0;
    m.springs.push_back(s);
  }
}
}  // namespace hilo::test
