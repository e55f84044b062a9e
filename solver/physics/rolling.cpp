// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/rolling.hpp"

#include <cmath>

#include "base/keys.hpp"
#include "physics/axes.hpp"

namespace hilo {

/// Angular velocity from the directors d_i and their rates: sum d_i x d_i' = sum d_i x (w x d_i) = (tr(D) I - D) w, D = sum d_i d_i^T;
/// exact for the mean of two turned triads as well, where the directors are shorter than one.
Slip::End Slip::end_of(const Config& q, const Config* v, int body) {
  End e;
  e.c = q.c[body], e.R = q.R[body];
  e.v = v ? v->c[body] : Vec3::Zero();
  e.V = v ? v->R[body] : Mat3::Zero();
  const Mat3 D = e.R * e.R.transpose();
  e.T = ((D.trace() * Mat3::Identity() - D) / 2).inverse();
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 3; ++i) sum += e.R.col(i).cross(e.V.col(i)) / 2;
  e.w = e.T * sum;
  return e;
}

Vec3 Slip::spin_change(const End& e, const Move& m) {
  const Mat3 half = m.R * e.R.transpose(), dD = half + half.transpose();
  Vec3 sum = -(dD.trace() * e.w - dD * e.w) / 2;
  for (int i = 0; i < 3; ++i) sum += (m.R.col(i).cross(e.V.col(i)) + e.R.col(i).cross(m.V.col(i))) / 2;
  return e.T * sum;
}

void Slip::fill(const VelocityRows::Contact& at, const Vec3& arm_a, Eigen::Matrix<double, 2, 12>& out) const {
  for (int r = 0; r < n; ++r)
    out.row(r) << -at.t[r].transpose(), -arm_a.cross(at.t[r]).transpose(), at.t[r].transpose(), at.arm.cross(at.t[r]).transpose();
}

Slip::Slip(const Joint& joint, const Config& q, const Config* v)
    : n(joint.velocity_rows->n_rows()),
      rows_(*joint.velocity_rows),
      a_(end_of(q, v, joint.end[0].body)),
      b_(end_of(q, v, joint.end[1].body)),
      at_(rows_.contact(a_.R, b_.R)),
      arm_a_(b_.c + at_.arm - a_.c) {
  fill(at_, arm_a_, A);
  const Vec3 slip = b_.v + b_.w.cross(at_.arm) - a_.v - a_.w.cross(arm_a_);
  for (int r = 0; r < n; ++r) value[r] = at_.t[r].dot(slip);
}

Slip::Change Slip::change(const Move& a, const Move& b) const {
  Change out;
  const VelocityRows::Contact d = rows_.change(a_.R, b_.R, a.R, b.R);
  const Vec3 d_arm_a = b.c + d.arm - a.c, dw_a = spin_change(a_, a), dw_b = spin_change(b_, b);
  const Vec3 slip = b_.v + b_.w.cross(at_.arm) - a_.v - a_.w.cross(arm_a_);
  const Vec3 d_slip = b.v + dw_b.cross(at_.arm) + b_.w.cross(d.arm) - a.v - dw_a.cross(arm_a_) - a_.w.cross(d_arm_a);
  for (int r = 0; r < n; ++r) {
    out.value[r] = d.t[r].dot(slip) + at_.t[r].dot(d_slip);
    out.A.row(r) << -d.t[r].transpose(), -(d_arm_a.cross(at_.t[r]) + arm_a_.cross(d.t[r])).transpose(), d.t[r].transpose(),
        (d.arm.cross(at_.t[r]) + at_.arm.cross(d.t[r])).transpose();
  }
  return out;
}

namespace {

/// v of unit length, and the change of that by dv.
Vec3 unit_change(const Vec3& v, const Vec3& dv) {
  const double l = v.norm();
  return (dv - v * (v.dot(dv) / (l * l))) / l;
}

struct Rolling final : VelocityRows {
  Mat3 frame;         // on a
  Vec3 centre, axle;  // on b; no axle: a ball
  double radius;
  int n_rows() const override { return 2; }
  /// The lowest point of the rim: down the normal, less what of it goes along the axle.
  Contact contact(const Mat3& Ra, const Mat3& Rb) const override {
    const Vec3 n = (Ra * frame.col(2)).normalized(), e = axle.isZero() ? axle : (Rb * axle).normalized();
    return {Rb * centre - radius * (n - n.dot(e) * e).normalized(), {Ra * frame.col(0), Ra * frame.col(1)}};
  }
  Contact change(const Mat3& Ra, const Mat3& Rb, const Mat3& dRa, const Mat3& dRb) const override {
    const Vec3 n0 = Ra * frame.col(2), n = n0.normalized(), dn = unit_change(n0, dRa * frame.col(2));
    Vec3 p = n, dp = dn;
    if (!axle.isZero()) {
      const Vec3 e0 = Rb * axle, e = e0.normalized(), de = unit_change(e0, dRb * axle);
      p = n - n.dot(e) * e;
      dp = dn - (dn.dot(e) + n.dot(de)) * e - n.dot(e) * de;
    }
    return {dRb * centre - radius * unit_change(p, dp), {dRa * frame.col(0), dRa * frame.col(1)}};
  }
};

struct KnifeEdge final : VelocityRows {
  Vec3 point, across;  // on b
  int n_rows() const override { return 1; }
  Contact contact(const Mat3&, const Mat3& Rb) const override { return {Rb * point, {Rb * across, Vec3::Zero()}}; }
  Contact change(const Mat3&, const Mat3&, const Mat3&, const Mat3& dRb) const override {
    return {dRb * point, {dRb * across, Vec3::Zero()}};
  }
};

/// Height of the centre of a disc over its plane: measure 0 is that height, measure 1 the sine m of the tilt:  g = e_0 - r (sqrt(1 - m^2) -
/// c), with the quotient (m0 + m1)/(sqrt(1 - m0^2) + sqrt(1 - m1^2)) as discrete gradient of -sqrt(1 - m^2).
struct Height final : RowLaw {
  double radius, start;
  static double cosine(double m) { return std::sqrt(std::max(1 - m * m, 1e-24)); }
  int n_rows() const override { return 1; }
  void values(const Values& e, double* g) const override { g[0] = e[0] - radius * (cosine(e[1]) - start); }
  void gradient(const Values& e0, const Values& e1, Gradient& out) const override {
    const double c1 = cosine(e1[1]), sum = cosine(e0[1]) + c1, m = e0[1] + e1[1];
    out.clear(n_rows());
    out.d[0][0] = 1, out.d[0][1] = radius * m / sum;
    out.D[0][1][1] = radius * (1 / sum + m / (sum * sum) * e1[1] / c1);
  }
  std::string fault(const Values& e) const override { return std::abs(e[1]) > 1 - 1e-8 ? "the disc lies flat on the plane" : ""; }
};

/// Ends, frame and the joint's points.
Joint between(const JointPlace& j, const Config& q) {
  Joint c;
  c.end[0] = j.a, c.end[1] = j.b;
  c.frame_a = q.R[j.a.body].transpose() * j.frame;
  c.point_b = q.R[j.b.body].transpose() * (j.at - q.c[j.b.body]);
  c.entities = {{0, q.R[j.a.body].transpose() * (j.at - q.c[j.a.body]), true}, {1, c.point_b, true}};
  return c;
}

}  // namespace

Joint make_rolling(const JointPlace& j, const Config& q) {
  Joint c = between(j, q);
  auto rolling = std::make_unique<Rolling>();
  rolling->frame = c.frame_a, rolling->centre = c.point_b, rolling->radius = j.ratio;
  rolling->axle = q.R[j.b.body].transpose() * j.axis_b;
  c.entities.push_back({0, c.frame_a.col(2), false});
  c.measures.push_back({{{Term::slide, 2, 0, 1}}, 0});
  c.measures[0].offset = c.value(0, q);
  if (!j.axis_b.isZero()) {
    c.entities.push_back({1, rolling->axle, false});
    c.measures.push_back({{{Term::dot, 2, 3}}, 0});
    auto height = std::make_unique<Height>();
    height->radius = j.ratio, height->start = Height::cosine(c.value(1, q));
    c.rows = std::move(height);
  }
  c.velocity_rows = std::move(rolling);
  return c;
}

Joint make_knife_edge(const JointPlace& j, const Config& q) {
  Joint c = between(j, q);
  auto edge = std::make_unique<KnifeEdge>();
  edge->point = c.point_b;
  edge->across = q.R[j.b.body].transpose() * j.frame.col(2).cross(j.axis_b).normalized();
  c.velocity_rows = std::move(edge);
  return c;
}

namespace {

void not_along_axis(const EntryValues& e, const char* key, const JointPlace& j, const char* hint) {
  if (std::abs(j.axis_b.dot(j.frame.col(2))) > 1 - 1e-9) e.refuse(key, std::string(key) + " is parallel to the axis", hint);
}

void read_rolling(const EntryValues& e, JointPlace& j) {
  j.ratio = e.number("radius");
  if (!e.has("axle")) return;
  j.axis_b = direction(e, "axle");
  not_along_axis(e, "axle", j, "a disc that lies flat does not roll");
}

void read_knife_edge(const EntryValues& e, JointPlace& j) {
  j.axis_b = direction(e, "edge");
  not_along_axis(e, "edge", j, "the edge lies in the plane");
}

}  // namespace

std::vector<JointKind> rolling_kinds() {
  using enum Type;
  return {
      {"rolling",
       "a disc, wheel or ball b rolls without slip on a plane carried by a (3 rows, two of them of velocities); the contact also pulls",
       {{"at", vector3, "m", "!", "centre of the disc or ball"},
        {"axis", vector3, "1", "!", "normal of the plane, from the contact to the centre of an upright disc"},
        keys::x_axis,
        {"radius", number, "m", "!", "from the centre to the contact", above(0)},
        {"axle", vector3, "1", "", "axis of the disc or wheel, carried by b; absent: a ball"}},
       make_rolling,
       "",
       {},
       {},
       JointKind::Turns::both,
       read_rolling},
      {"knife-edge",
       "a point of b moves along an edge of b and not across it (1 row of velocities); joints of their own keep it on its plane",
       {{"at", vector3, "m", "!", "contact point of the edge, carried by b"},
        {"axis", vector3, "1", "!", "normal of the plane, carried by b for the direction across: axis x edge"},
        {"edge", vector3, "1", "!", "direction in which b may move"}},
       make_knife_edge,
       "",
       {},
       {},
       JointKind::Turns::both,
       read_knife_edge},
  };
}

}  // namespace hilo
