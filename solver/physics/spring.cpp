// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dampers: discrete gradients of potentials in quadratic measures, so that the elastic work of a step is exact and a
// damper never feeds energy in.
#include "physics/spring.hpp"

#include <algorithm>

#include "physics/joint_rows.hpp"

namespace hilo {
namespace {

using Values = SpringLaw::Values;

/// Measure 0 is the gap, a stop at 0, with a damper of its own where no restitution is asked: it acts while the mean gap is closed and
/// never pulls.  Measures 1 and 2 are springs in the plane.
struct Contact final : SpringLaw {
  double c;
  std::unique_ptr<SpringLaw> gap, plane;
  explicit Contact(const Support& s)
      : c(s.damping),
        gap(make_stop({.lower = 0, .stiffness = s.stiffness, .restitution = s.restitution, .rest_speed = s.rest_speed})),
        plane(make_linear({0, s.tangential_stiffness[0], s.tangential_stiffness[1]},
                          {0, s.tangential_damping[0], s.tangential_damping[1]})) {}
  void elastic(const Values& e0, const Values& e1, Response& out) const override { gap->elastic(e0, e1, out), plane->elastic(e0, e1, out); }
  void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const override {
    plane->viscous(r0, r1, step, out);
    gap->viscous(r0, r1, step, out);
    if (c == 0 || r0[0] + r1[0] >= 0) return;
    Response elastic;
    gap->elastic(r0, r1, elastic);
    const double s = c * (r1[0] - r0[0]) / step.h;
    const bool pulls = elastic.s[0] + s > 0;  // then the contact carries no force
    out.s[0] += pulls ? -elastic.s[0] : s;
    out.D[0][0] += pulls ? -elastic.D[0][0] : c / step.h;
    out.dissipated += (pulls ? -elastic.s[0] : s) * (r1[0] - r0[0]);
  }
  void commit(const Values& e, const Values& rate) override { gap->commit(e, rate); }
  bool needs_rate() const override { return gap->needs_rate(); }
  void archive(Archive& a) override { gap->archive(a), plane->archive(a); }
};

/// The angle whose sine and cosine are measures 0 and 1.
std::unique_ptr<RowLaw> angle_row() {
  return std::make_unique<SumRows>(0, std::vector<std::vector<SumRows::Part>>{{{1, 0, SumRows::angle}}});
}

std::vector<double> listed(const Vec3& v) { return {v.begin(), v.end()}; }

}  // namespace

Spring along_distance(const Carrier& a, const Carrier& b, const Vec3& at_a, const Vec3& at_b, const Config& q,
                      std::unique_ptr<SpringLaw> law) {
  Spring c;
  c.join(a, b, q, at_b, Mat3::Identity());
  const int pa = c.add_point(0, q, at_a), pb = c.add_point(1, q, at_b);
  c.add_measure({{Term::distance2, pa, pb}});
  c.law = std::make_unique<OnCoordinates>(std::make_unique<Length>(), std::move(law));
  return c;
}

Spring make_axial_spring(const AxialSpring& s, const Config& q) {
  Spring c = along_distance(s.a, s.b, s.at_a, s.at_b, q, make_linear({s.stiffness}, {s.damping}, {s.length}));
  c.stiffness = s.stiffness;
  return c;
}

Spring make_torsion_spring(const TorsionSpring& s, const Config& q) {
  Spring c;
  c.join(s.a, s.b, q, s.b.body >= 0 ? q.c[s.b.body] : Vec3::Zero(), s.frame);
  const int ua = c.add_direction(0, q, s.frame.col(0)), va = c.add_direction(0, q, s.frame.col(1)),
            ub = c.add_direction(1, q, s.frame.col(0));
  c.add_measure({{Term::dot, va, ub}});  // sine
  c.add_measure({{Term::dot, ua, ub}});  // cosine
  c.law = std::make_unique<OnCoordinates>(angle_row(), make_linear({s.stiffness}, {s.damping}, {s.angle}));
  return c;
}

Spring make_bushing(const Bushing& s, const Config& q) {
  Spring c;
  c.join(s.a, s.b, q, s.at, s.frame);
  const int pa = c.add_point(0, q, s.at), pb = c.add_point(1, q, s.at);
  std::array<int, 3> u;
  for (int i = 0; i < 3; ++i) u[i] = c.add_direction(0, q, s.frame.col(i));
  for (int i = 0; i < 3; ++i) c.add_measure({{Term::slide, u[i], pa, pb}});
  std::vector<double> stiffness = listed(s.stiffness.along), damping = listed(s.stiffness.damping);
  const Vec3 &k = s.stiffness.about, &d = s.stiffness.angular_damping;
  std::vector<std::vector<SumRows::Part>> angles;
  if (k.norm() + d.norm() > 0) {
    std::array<int, 3> v;
    for (int i = 0; i < 3; ++i) v[i] = c.add_direction(1, q, s.frame.col(i));
    const auto resists = [&](const Vec3& by, std::initializer_list<int> axes) {
      for (const int i : axes) stiffness.push_back(k[i]), damping.push_back(by[i]);
    };
    const auto stiff = (k.array() > 0).count();
    if (stiff == 0) {  // the squares of the rates of row i of the rotation sum
                       // up to those of the two other angular velocities
      c.add_rotation(u, v);
      for (int column = 0; column < 3; ++column) resists(Vec3::Constant(d.sum() / 2) - d, {0, 1, 2});
    } else if (stiff == 3) {
      const int m = c.add_rotation(u, v);
      for (int i = 0; i < 3; ++i) angles.push_back({{1, m, SumRows::rotation, i}});
      resists(d, {0, 1, 2});
    } else {  // of the axis that differs from the two others
      int z = 0;
      while ((k[z] > 0) != (stiff == 1)) ++z;
      const int x = (z + 1) % 3, y = (z + 2) % 3;
      const int tilt = c.add_measure({{Term::dot, u[x], v[z]}});
      c.add_measure({{Term::dot, u[y], v[z]}}), c.add_measure({{Term::dot, u[z], v[z]}});
      const int twist = c.add_measure({{Term::dot, u[y], v[x]}, {Term::dot, u[x], v[y], 0, -1}});
      c.add_measure({{Term::dot, u[x], v[x]}, {Term::dot, u[y], v[y]}});
      angles = {{{1, tilt, SumRows::tilt, 0}}, {{1, tilt, SumRows::tilt, 1}}, {{1, twist, SumRows::angle}}};
      resists(d, {x, y, z});
    }
  }
  c.law = make_linear(stiffness, damping);
  if (!angles.empty()) c.law = std::make_unique<OnCoordinates>(std::make_unique<SumRows>(3, std::move(angles)), std::move(c.law));
  c.stiffness = s.stiffness.along.maxCoeff();
  return c;
}

Spring make_distance_stop(const DistanceStop& s, const Config& q) {
  Spring c = along_distance(s.a, s.b, s.at_a, s.at_b, q, make_stop(s.stop));
  c.stiffness = s.stop.stiffness;
  return c;
}

Spring make_support(const Support& s, const Config& q) {
  Spring c;
  c.join(s.a, s.b, q, s.at, s.frame);
  const int pa = c.add_point(0, q, s.at), pb = c.add_point(1, q, s.at);
  for (const int i : {2, 0, 1}) c.add_measure({{Term::slide, c.add_direction(0, q, s.frame.col(i)), pa, pb}});
  c.measures[0].offset = -s.clearance;
  c.law = std::make_unique<Contact>(s);
  c.stiffness = s.stiffness;
  return c;
}

}  // namespace hilo
