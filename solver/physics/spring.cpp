// Springs and dampers: discrete gradients of potentials in quadratic measures, so that the elastic work of a step is exact and a
// damper never feeds energy in.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/coordinates.hpp"
#include "physics/joint_rows.hpp"

namespace hilo {
namespace {

using Values = SpringLaw::Values;

/// Measure 0 is the gap, a stop at 0, with a damper of its own where no restitution is asked: it acts while the mean gap is closed and
/// never pulls.  Measures 1 and 2 are springs in the plane.
struct Support final : SpringLaw {
  double c;
  std::unique_ptr<SpringLaw> gap, plane;
  Support(double k, double c_, double restitution, double rest_speed, const Vec3& k_plane, const Vec3& c_plane)
      : c(c_),
        gap(make_stop(0, std::numeric_limits<double>::infinity(), k, restitution, rest_speed)),
        plane(make_linear({0, k_plane[0], k_plane[1]}, {0, c_plane[0], c_plane[1]})) {}
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

int add_point(Connector& c, int end, const Config& q, const Vec3& at) {
  const int b = c.end[end].body;
  c.entities.push_back({end, b < 0 ? Vec3::Zero() : Vec3(q.R[b].transpose() * (at - q.c[b])), true});
  return static_cast<int>(c.entities.size()) - 1;
}
int add_direction(Connector& c, int end, const Config& q, const Vec3& d) {
  c.entities.push_back({end, q.R[c.end[end].body].transpose() * d, false});
  return static_cast<int>(c.entities.size()) - 1;
}
/// The angle whose sine and cosine are measures 0 and 1.
std::unique_ptr<RowLaw> angle_row() { return std::make_unique<SumRows>(0, std::vector<std::vector<SumRows::Part>>{{{1, 0, true}}}); }

Connector start(const char* kind, const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_b, const Mat3& frame) {
  Connector c;
  c.kind = kind;
  c.end[0] = a, c.end[1] = b;
  if (a.body >= 0) c.frame_a = q.R[a.body].transpose() * frame;
  if (b.body >= 0) c.point_b = q.R[b.body].transpose() * (at_b - q.c[b.body]);
  return c;
}

}  // namespace

Connector make_axial_spring(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_a, const Vec3& at_b, double stiffness,
                            double damping, double length) {
  Connector c = start("axial", a, b, q, at_b, Mat3::Identity());
  const int pa = add_point(c, 0, q, at_a), pb = add_point(c, 1, q, at_b);
  c.measures.push_back({{{Term::distance2, pa, pb}}, 0});
  c.law = std::make_unique<OnCoordinates>(std::make_unique<Length>(), make_linear({stiffness}, {damping}, {length}));
  return c;
}

Connector make_torsion_spring(const Carrier& a, const Carrier& b, const Config& q, const Mat3& frame, double stiffness, double damping,
                              double angle) {
  Connector c = start("torsion", a, b, q, b.body >= 0 ? q.c[b.body] : Vec3::Zero(), frame);
  const int ua = add_direction(c, 0, q, frame.col(0)), va = add_direction(c, 0, q, frame.col(1)), ub = add_direction(c, 1, q, frame.col(0));
  c.measures.push_back({{{Term::dot, va, ub}}, 0});  // sine
  c.measures.push_back({{{Term::dot, ua, ub}}, 0});  // cosine
  c.law = std::make_unique<OnCoordinates>(angle_row(), make_linear({stiffness}, {damping}, {angle}));
  return c;
}

Connector make_bushing(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, const Vec3& k,
                       const Vec3& c_, const Vec3& k_angle, const Vec3& c_angle) {
  Connector c = start("bushing", a, b, q, at, frame);
  const int pa = add_point(c, 0, q, at), pb = add_point(c, 1, q, at);
  int u[3];
  for (int i = 0; i < 3; ++i) u[i] = add_direction(c, 0, q, frame.col(i));
  for (int i = 0; i < 3; ++i) c.measures.push_back({{{Term::slide, u[i], pa, pb}}, 0});
  std::vector<double> stiffness(k.begin(), k.end()), damping(c_.begin(), c_.end());
  if (k_angle.norm() + c_angle.norm() > 0) {  // sin(angle) n_i = (d_j . e_k - d_k . e_j)/2 with d on a, e on b
    int v[3];
    for (int i = 0; i < 3; ++i) v[i] = add_direction(c, 1, q, frame.col(i));
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      c.measures.push_back({{{Term::dot, u[l], v[j], 0, 0.5}, {Term::dot, u[j], v[l], 0, -0.5}}, 0});
      stiffness.push_back(k_angle[i]), damping.push_back(c_angle[i]);
    }
  }
  c.law = make_linear(stiffness, damping);
  return c;
}

Connector make_distance_stop(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_a, const Vec3& at_b,
                             std::unique_ptr<SpringLaw> law) {
  Connector c = start("stop", a, b, q, at_b, Mat3::Identity());
  const int pa = add_point(c, 0, q, at_a), pb = add_point(c, 1, q, at_b);
  c.measures.push_back({{{Term::distance2, pa, pb}}, 0});
  c.law = std::make_unique<OnCoordinates>(std::make_unique<Length>(), std::move(law));
  return c;
}

Connector make_support(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, double k, double c_,
                       double restitution, double rest_speed, double clearance, const Vec3& k_plane, const Vec3& c_plane) {
  Connector c = start("support", a, b, q, at, frame);
  const int pa = add_point(c, 0, q, at), pb = add_point(c, 1, q, at);
  c.measures.push_back({{{Term::slide, add_direction(c, 0, q, frame.col(2)), pa, pb}}, -clearance});
  for (int i = 0; i < 2; ++i) c.measures.push_back({{{Term::slide, add_direction(c, 0, q, frame.col(i)), pa, pb}}, 0});
  c.law = std::make_unique<Support>(k, c_, restitution, rest_speed, k_plane, c_plane);
  return c;
}

}  // namespace hilo
