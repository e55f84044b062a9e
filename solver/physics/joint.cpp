// The joints as lists of quadratic measures and rows: every kind has its minimal number of independent rows.
#include <cmath>

#include "physics/connector.hpp"
#include "physics/joint_rows.hpp"
#include "physics/rolling.hpp"

namespace hilo {
namespace {

/// Entities of a connector under construction, in the carriers' own axes.
struct Maker {
  Connector c;
  const Config& q;

  int point(int end, const Vec3& at) {
    const int b = c.end[end].body;
    c.entities.push_back({end, b < 0 ? Vec3::Zero() : Vec3(q.R[b].transpose() * (at - q.c[b])), true});
    return static_cast<int>(c.entities.size()) - 1;
  }
  int direction(int end, const Vec3& d) {
    c.entities.push_back({end, q.R[c.end[end].body].transpose() * d, false});
    return static_cast<int>(c.entities.size()) - 1;
  }
  /// A measure whose value is zero in the configuration given.
  int zero(std::vector<Term> terms) {
    c.measures.push_back({std::move(terms), 0});
    const int m = static_cast<int>(c.measures.size()) - 1;
    c.measures.back().offset = c.value(m, q);
    return m;
  }
  int dot(int i, int j) { return zero({{Term::dot, i, j}}); }
  /// Sine and cosine of the angle that x, carried by `turning`, has turned from where it is now about `axis`, carried by `base`.
  /// Returns the measure of the sine.
  int angle(int base, int turning, const Vec3& axis, const Vec3& x) {
    const int u = direction(base, x), v = direction(base, axis.cross(x)), w = direction(turning, x);
    c.measures.push_back({{{Term::dot, v, w}}, 0});
    c.measures.push_back({{{Term::dot, u, w}}, 0});
    return static_cast<int>(c.measures.size()) - 2;
  }
};

}  // namespace

Connector make_joint(const JointPlace& j, const Config& q) {
  if (j.kind == "rolling") return make_rolling(j, q);
  if (j.kind == "knife-edge") return make_knife_edge(j, q);
  Maker m{{}, q};
  Connector& c = m.c;
  const std::string& kind = j.kind;
  const Mat3& frame = j.frame;
  const Vec3 axis = frame.col(2), axis_b = j.axis_b.isZero() ? axis : j.axis_b;
  c.kind = kind;
  c.end[0] = j.a, c.end[1] = j.b;
  if (j.a.body >= 0) c.frame_a = q.R[j.a.body].transpose() * frame;
  if (j.b.body >= 0) c.point_b = q.R[j.b.body].transpose() * (j.at_b - q.c[j.b.body]);

  if (kind == "gear" || kind == "rack") {
    c.n_ends = 3, c.end[2] = j.carrier;
    const int turn_a = m.angle(2, 0, axis, frame.col(0));
    if (kind == "gear") {
      const int turn_b = m.angle(2, 1, axis_b, frame_of_axis(axis_b).col(0));
      c.rows = std::make_unique<SumRows>(0, std::vector<std::vector<SumRows::Part>>{{{1, turn_b, true}, {-j.ratio, turn_a, true}}});
    } else {
      const int slide = m.zero({{Term::slide, m.direction(2, axis_b), m.point(2, j.at), m.point(1, j.at)}});
      c.rows = std::make_unique<SumRows>(0, std::vector<std::vector<SumRows::Part>>{{{1, slide}, {-j.ratio, turn_a, true}}});
    }
    return std::move(c);
  }

  const int pa = m.point(0, j.at), pb = m.point(1, j.at_b);
  if (kind == "distance") {
    m.zero({{Term::distance2, pa, pb}});
    if (j.length > 0) c.measures.back().offset = j.length * j.length;
    return std::move(c);
  }
  const auto same_point = [&] {
    for (int i = 0; i < 3; ++i) m.zero({{Term::coordinate, pa, pb, 0, 1, Vec3::Unit(i)}});
  };
  // columns of the frame carried by a and by b, made when first asked for
  int ua[3] = {-1, -1, -1}, vb[3] = {-1, -1, -1};
  const Mat3 frame_b = Eigen::Quaterniond::FromTwoVectors(axis, axis_b).toRotationMatrix() * frame;
  const auto u = [&](int i) { return ua[i] < 0 ? ua[i] = m.direction(0, frame.col(i)) : ua[i]; };
  const auto v = [&](int i) { return vb[i] < 0 ? vb[i] = m.direction(1, frame_b.col(i)) : vb[i]; };
  const auto slide = [&](int i) { return m.zero({{Term::slide, u(i), pa, pb}}); };
  const auto parallel = [&] { m.dot(u(0), v(2)), m.dot(u(1), v(2)); };
  if (kind == "spherical") {
    same_point();
  } else if (kind == "fixed") {
    same_point();
    m.dot(u(0), v(1)), m.dot(u(1), v(2)), m.dot(u(2), v(0));
  } else if (kind == "revolute") {
    same_point();
    parallel();
  } else if (kind == "universal") {
    same_point();
    m.dot(u(2), v(0));
  } else if (kind == "constant-velocity") {
    // u.v' - v.u' = 4 q0 q3 of the rotation between the frames: no twist about the shafts, so the joint's plane halves their angle
    same_point();
    m.zero({{Term::dot, u(0), v(1)}, {Term::dot, u(1), v(0), 0, -1}});
  } else if (kind == "planar") {
    slide(2);
    parallel();
  } else if (kind == "in-plane") {
    slide(2);
  } else if (kind == "in-line") {
    slide(0), slide(1);
  } else if (kind == "point-on-curve") {
    slide(0), slide(1), slide(2);
  } else {  // cylindrical, prismatic, screw
    slide(0), slide(1);
    parallel();
    if (kind == "prismatic") m.dot(u(0), v(1));
  }
  if (kind == "point-on-curve") c.rows = std::make_unique<CurveRows>(*j.curve);
  const int n = static_cast<int>(c.measures.size());
  std::vector<std::vector<SumRows::Part>> sums;
  int along = -1, turned = -1;
  const auto slid = [&] { return along < 0 ? along = slide(2) : along; };
  const auto turn = [&] { return turned < 0 ? turned = m.angle(0, 1, axis, frame.col(0)) : turned; };
  if (kind == "screw") sums.push_back({{1, slid()}, {-j.ratio, turn(), true}});
  if (j.driven == JointPlace::Driven::slide) sums.push_back({{1, slid()}});
  if (j.driven == JointPlace::Driven::angle) sums.push_back({{1, turn(), true}});
  if (!sums.empty()) c.rows = std::make_unique<SumRows>(n, std::move(sums));
  if (j.driven != JointPlace::Driven::none) c.drive.row = c.n_rows() - 1;
  return std::move(c);
}

}  // namespace hilo
