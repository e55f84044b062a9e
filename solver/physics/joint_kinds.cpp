// The kinds of joints as lists of quadratic measures and rows: every kind has its minimal number of independent rows.
#include <cmath>

#include "physics/coordinates.hpp"
#include "physics/joint_rows.hpp"
#include "physics/rolling.hpp"

namespace hilo {
namespace {

using Sum = std::vector<SumRows::Part>;

/// A joint under construction.
class Maker {
 public:
  Maker(const JointPlace& place, const Config& q)
      : j(place), q(q), axis(place.frame.col(2)), axis_b(place.axis_b.isZero() ? axis : place.axis_b) {
    c.join(j.a, j.b, q, j.at_b, j.frame);
  }
  const JointPlace& j;
  const Config& q;
  const Vec3 axis, axis_b;
  Joint c;

  int zero(std::vector<Term> terms) { return c.add_zero_measure(std::move(terms), q); }
  void dot(int i, int k) { zero({{Term::dot, i, k}}); }
  /// Sine and cosine of the angle that x, carried by `turning`, has turned from where it is now about `axis`, carried by `base`.
  /// Returns the measure of the sine.
  int angle(int base, int turning, const Vec3& about, const Vec3& x) {
    const int u_ = c.add_direction(base, q, x), v_ = c.add_direction(base, q, about.cross(x)), w = c.add_direction(turning, q, x);
    const int sine = c.add_measure({{Term::dot, v_, w}});
    c.add_measure({{Term::dot, u_, w}});
    return sine;
  }
  int pa() { return pa_ < 0 ? points(), pa_ : pa_; }
  int pb() { return pb_ < 0 ? points(), pb_ : pb_; }
  /// Columns of the frame carried by a and by b.
  int u(int i) { return ua_[i] < 0 ? ua_[i] = c.add_direction(0, q, j.frame.col(i)) : ua_[i]; }
  int v(int i) {
    const Mat3 frame_b = Eigen::Quaterniond::FromTwoVectors(axis, axis_b).toRotationMatrix() * j.frame;
    return vb_[i] < 0 ? vb_[i] = c.add_direction(1, q, frame_b.col(i)) : vb_[i];
  }
  void same_point() {
    for (int i = 0; i < 3; ++i) zero({{Term::coordinate, pa(), pb(), 0, 1, Vec3::Unit(i)}});
  }
  int slide(int i) {
    points();
    return zero({{Term::slide, u(i), pa_, pb_}});
  }
  void parallel() { dot(u(0), v(2)), dot(u(1), v(2)); }
  int slid() { return along_ < 0 ? along_ = slide(2) : along_; }
  int turned() { return turned_ < 0 ? turned_ = angle(0, 1, axis, j.frame.col(0)) : turned_; }

  /// The measures so far are rows, then these sums, then what drives the joint.
  Joint with(std::vector<Sum> sums = {}, int n_plain = -1) {
    if (n_plain < 0) n_plain = static_cast<int>(c.measures.size());
    if (j.driven == JointPlace::Driven::slide) sums.push_back({{1, slid()}});
    if (j.driven == JointPlace::Driven::angle) sums.push_back({{1, turned(), true}});
    if (!sums.empty()) c.rows = std::make_unique<SumRows>(n_plain, std::move(sums));
    if (j.driven != JointPlace::Driven::none) c.drive.row = c.n_rows() - 1;
    return std::move(c);
  }

 private:
  void points() {
    if (pa_ < 0) pa_ = c.add_point(0, q, j.at), pb_ = c.add_point(1, q, j.at_b);
  }
  int pa_ = -1, pb_ = -1, along_ = -1, turned_ = -1, ua_[3] = {-1, -1, -1}, vb_[3] = {-1, -1, -1};
};

Joint spherical(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.same_point();
  return m.with();
}

Joint fixed(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.same_point();
  m.dot(m.u(0), m.v(1)), m.dot(m.u(1), m.v(2)), m.dot(m.u(2), m.v(0));
  return m.with();
}

Joint revolute(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.same_point(), m.parallel();
  return m.with();
}

Joint universal(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.same_point();
  m.dot(m.u(2), m.v(0));
  return m.with();
}

/// u.v' - v.u' = 4 q0 q3 of the rotation between the frames: no twist about the shafts, so the joint's plane halves their angle.
Joint constant_velocity(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.same_point();
  const int u0 = m.u(0), v1 = m.v(1), u1 = m.u(1), v0 = m.v(0);
  m.zero({{Term::dot, u0, v1}, {Term::dot, u1, v0, 0, -1}});
  return m.with();
}

Joint planar(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(2), m.parallel();
  return m.with();
}

Joint in_plane(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(2);
  return m.with();
}

Joint in_line(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(0), m.slide(1);
  return m.with();
}

Joint point_on_curve(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(0), m.slide(1), m.slide(2);
  m.c.rows = std::make_unique<CurveRows>(*j.curve);
  return m.with();
}

Joint cylindrical(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(0), m.slide(1), m.parallel();
  return m.with();
}

Joint prismatic(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(0), m.slide(1), m.parallel();
  m.dot(m.u(0), m.v(1));
  return m.with();
}

Joint screw(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.slide(0), m.slide(1), m.parallel();
  const int plain = static_cast<int>(m.c.measures.size()), slid = m.slid(), turned = m.turned();
  return m.with({{{1, slid}, {-j.ratio, turned, true}}}, plain);
}

Joint distance(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  const int pa = m.pa(), pb = m.pb();
  m.zero({{Term::distance2, pa, pb}});
  if (j.length > 0) m.c.measures.back().offset = j.length * j.length;
  return m.with();
}

Joint gear(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.c.n_ends = 3, m.c.end[2] = j.carrier;
  const int turn_a = m.angle(2, 0, m.axis, j.frame.col(0)), turn_b = m.angle(2, 1, m.axis_b, frame_of_axis(m.axis_b).col(0));
  return m.with({{{1, turn_b, true}, {-j.ratio, turn_a, true}}}, 0);
}

Joint rack(const JointPlace& j, const Config& q) {
  Maker m(j, q);
  m.c.n_ends = 3, m.c.end[2] = j.carrier;
  const int turn_a = m.angle(2, 0, m.axis, j.frame.col(0));
  const int along = m.c.add_direction(2, q, m.axis_b), from = m.c.add_point(2, q, j.at), to = m.c.add_point(1, q, j.at);
  const int slide = m.zero({{Term::slide, along, from, to}});
  return m.with({{{1, slide}, {-j.ratio, turn_a, true}}}, 0);
}

/// The row is twice the twist.
void soften_twist(Joint& joint, std::vector<double>&) { joint.rows = std::make_unique<SumRows>(3, std::vector<Sum>{{{0.5, 3}}}); }

void soften_distance(Joint& joint, std::vector<double>& free) {
  free = {std::sqrt(joint.measures[0].offset)};
  joint.measures[0].offset = 0;
  joint.rows = std::make_unique<Length>();
}

}  // namespace

const std::vector<JointKind>& joint_kinds() {
  constexpr auto angle = Freedom::angle, slide = Freedom::slide;
  static const std::vector<JointKind> kinds{
      {"fixed", fixed, "xyzCAB", {}, {}},
      {"spherical", spherical, "xyz", {}, {0, 1, 2}},
      {"revolute", revolute, "xyzBA", {angle}, {0, 1, 2}},
      {"universal", universal, "xyzB", {}, {}},
      {"constant-velocity", constant_velocity, "xyzC", {}, {}, soften_twist},
      {"planar", planar, "zBA", {angle}, {}},
      {"in-plane", in_plane, "z", {}, {}},
      {"in-line", in_line, "xy", {slide}, {}},
      {"cylindrical", cylindrical, "xyBA", {angle, slide}, {0, 1}},
      {"prismatic", prismatic, "xyBAC", {slide}, {0, 1}},
      {"screw", screw, "xyBAz", {angle, slide}, {0, 1, 4}},
      {"gear", gear, "C", {}, {}},
      {"rack", rack, "z", {}, {}},
      {"distance", distance, "z", {}, {}, soften_distance},
      {"point-on-curve", point_on_curve, "xx", {}, {}},
      {"rolling", make_rolling, "", {}, {}},
      {"knife-edge", make_knife_edge, "", {}, {}},
  };
  return kinds;
}

}  // namespace hilo
