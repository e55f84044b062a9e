// Springs and dampers: discrete gradients of potentials in quadratic measures, so that the elastic work of a step is exact and a
// damper never feeds energy in.
#include <algorithm>
#include <cmath>

#include "physics/connector.hpp"
#include "physics/turn.hpp"

namespace hilo {
namespace {

using Values = SpringLaw::Values;

/// e = l^2, W = k/2 (l - l_free)^2:  s = dW/de = k/2 (l0 + l1 - 2 l_free)/(l0 + l1);  damper s = c (l1 - l0)/(h (l0 + l1)).
struct Axial final : SpringLaw {
  double k, c, free_length;
  Axial(double k_, double c_, double l) : k(k_), c(c_), free_length(l) {}
  void elastic(const Values& e0, const Values& e1, Response& out) const override {
    const double l0 = std::sqrt(e0[0]), l1 = std::sqrt(e1[0]), sum = std::max(l0 + l1, 1e-300);
    out.s[0] += k / 2 * (sum - 2 * free_length) / sum;
    out.D[0][0] += k * free_length / (sum * sum) / (2 * std::max(l1, 1e-300));
    out.energy += k / 2 * (l1 - free_length) * (l1 - free_length);
  }
  void viscous(const Values& r0, const Values& r1, double h, Response& out) const override {
    const double l0 = std::sqrt(r0[0]), l1 = std::sqrt(r1[0]), sum = std::max(l0 + l1, 1e-300);
    out.s[0] += c / h * (l1 - l0) / sum;
    out.D[0][0] += c / h * 2 * l0 / (sum * sum) / (2 * std::max(l1, 1e-300));
    out.dissipated += c / h * (l1 - l0) * (l1 - l0);
  }
};

/// Independent linear springs on each measure.
struct Diagonal final : SpringLaw {
  Values k{}, c{};
  void elastic(const Values& e0, const Values& e1, Response& out) const override {
    for (int i = 0; i < max_measures; ++i) {
      out.s[i] += k[i] * (e0[i] + e1[i]) / 2;
      out.D[i][i] += k[i] / 2;
      out.energy += k[i] / 2 * e1[i] * e1[i];
    }
  }
  void viscous(const Values& r0, const Values& r1, double h, Response& out) const override {
    for (int i = 0; i < max_measures; ++i) {
      const double rate = (r1[i] - r0[i]) / h;
      out.s[i] += c[i] * rate;
      out.D[i][i] += c[i] / h;
      out.dissipated += c[i] * rate * rate * h;
    }
  }
};

/// Angle from its sine and cosine: the moment M acts through the discrete gradient of the angle, so that s.(e1 - e0) = M (theta1 - theta0).
struct Torsion final : SpringLaw {
  double k, c, free_angle;
  Turn turn;
  Torsion(double k_, double c_, double a) : k(k_), c(c_), free_angle(a) {}
  double angle(const Values& e) const { return turn.unwrap(e[0], e[1]); }
  void spread(double M, double dM, const Values& e0, const Values& e1, Response& out) const {
    const Turn::Gradient g = turn.gradient(e0.data(), e1.data());
    for (int i = 0; i < 2; ++i) {
      out.s[i] += M * g.d[i];
      for (int j = 0; j < 2; ++j) out.D[i][j] += dM * g.d[i] * g.dtheta[j] + M * g.D[i][j];
    }
  }
  void elastic(const Values& e0, const Values& e1, Response& out) const override {
    const double t0 = angle(e0), t1 = angle(e1);
    spread(k * ((t0 + t1) / 2 - free_angle), k / 2, e0, e1, out);
    out.energy += k / 2 * (t1 - free_angle) * (t1 - free_angle);
  }
  void viscous(const Values& r0, const Values& r1, double h, Response& out) const override {
    const double rate = (angle(r1) - angle(r0)) / h;
    spread(c * rate, c / h, r0, r1, out);
    out.dissipated += c * rate * rate * h;
  }
  void commit(const Values& e) override { turn.committed = angle(e); }
};

/// Measure 0 is the gap: W = k/2 <-gap>^2 with its quotient as discrete gradient; the damper acts while the mean gap is closed and
/// never pulls.  Measures 1 and 2 are springs in the plane.
struct Support final : SpringLaw {
  double k, c;
  Diagonal plane;
  Support(double k_, double c_) : k(k_), c(c_) {}
  double potential(double gap) const { return gap < 0 ? k / 2 * gap * gap : 0; }
  /// Quotient (W1 - W0)/(e1 - e0) and its derivative in e1.
  std::pair<double, double> normal(double g0, double g1) const {
    if (g0 <= 0 && g1 <= 0) return {k * (g0 + g1) / 2, k / 2};
    if (g0 >= 0 && g1 >= 0) return {0, 0};
    const double d = g1 - g0, s = (potential(g1) - potential(g0)) / d;
    return {s, ((g1 < 0 ? k * g1 : 0) - s) / d};
  }
  void elastic(const Values& e0, const Values& e1, Response& out) const override {
    const auto [s, D] = normal(e0[0], e1[0]);
    out.s[0] += s, out.D[0][0] += D;
    out.energy += potential(e1[0]);
    plane.elastic(e0, e1, out);
  }
  void viscous(const Values& r0, const Values& r1, double h, Response& out) const override {
    plane.viscous(r0, r1, h, out);
    if (r0[0] + r1[0] >= 0) return;
    const double elastic_force = normal(r0[0], r1[0]).first, s = c * (r1[0] - r0[0]) / h;
    if (elastic_force + s > 0) {  // would pull: the contact carries no force
      out.s[0] -= elastic_force, out.D[0][0] -= normal(r0[0], r1[0]).second;
      out.dissipated -= elastic_force * (r1[0] - r0[0]);
    } else {
      out.s[0] += s, out.D[0][0] += c / h;
      out.dissipated += s * (r1[0] - r0[0]);
    }
  }
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
  c.law = std::make_unique<Axial>(stiffness, damping, length);
  return c;
}

Connector make_torsion_spring(const Carrier& a, const Carrier& b, const Config& q, const Mat3& frame, double stiffness, double damping,
                              double angle) {
  Connector c = start("torsion", a, b, q, b.body >= 0 ? q.c[b.body] : Vec3::Zero(), frame);
  const int ua = add_direction(c, 0, q, frame.col(0)), va = add_direction(c, 0, q, frame.col(1)), ub = add_direction(c, 1, q, frame.col(0));
  c.measures.push_back({{{Term::dot, va, ub}}, 0});  // sine
  c.measures.push_back({{{Term::dot, ua, ub}}, 0});  // cosine
  c.law = std::make_unique<Torsion>(stiffness, damping, angle);
  return c;
}

Connector make_bushing(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, const Vec3& k,
                       const Vec3& c_, const Vec3& k_angle, const Vec3& c_angle) {
  Connector c = start("bushing", a, b, q, at, frame);
  const int pa = add_point(c, 0, q, at), pb = add_point(c, 1, q, at);
  int u[3];
  for (int i = 0; i < 3; ++i) u[i] = add_direction(c, 0, q, frame.col(i));
  for (int i = 0; i < 3; ++i) c.measures.push_back({{{Term::slide, u[i], pa, pb}}, 0});
  auto law = std::make_unique<Diagonal>();
  for (int i = 0; i < 3; ++i) law->k[i] = k[i], law->c[i] = c_[i];
  if (k_angle.norm() + c_angle.norm() > 0) {  // sin(angle) n_i = (d_j . e_k - d_k . e_j)/2 with d on a, e on b
    int v[3];
    for (int i = 0; i < 3; ++i) v[i] = add_direction(c, 1, q, frame.col(i));
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      c.measures.push_back({{{Term::dot, u[l], v[j], 0, 0.5}, {Term::dot, u[j], v[l], 0, -0.5}}, 0});
      law->k[3 + i] = k_angle[i], law->c[3 + i] = c_angle[i];
    }
  }
  c.law = std::move(law);
  return c;
}

Connector make_support(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, double k, double c_,
                       double clearance, const Vec3& k_plane, const Vec3& c_plane) {
  Connector c = start("support", a, b, q, at, frame);
  const int pa = add_point(c, 0, q, at), pb = add_point(c, 1, q, at);
  auto law = std::make_unique<Support>(k, c_);
  c.measures.push_back({{{Term::slide, add_direction(c, 0, q, frame.col(2)), pa, pb}}, -clearance});
  for (int i = 0; i < 2; ++i) {
    c.measures.push_back({{{Term::slide, add_direction(c, 0, q, frame.col(i)), pa, pb}}, 0});
    law->plane.k[1 + i] = k_plane[i], law->plane.c[1 + i] = c_plane[i];
  }
  c.law = std::move(law);
  return c;
}

}  // namespace hilo
