// Joints and springs: quadratic measures of points and directions carried by two ends.
//
// Every measure e(q) is of degree two in the points, so G(q_mid)(q1 - q0) = e(q1) - e(q0) exactly.  A joint holds its measures at zero
// with multipliers; a spring gives them a potential through a discrete gradient s with s.(e1 - e0) = W1 - W0 [gonzalez-1996].
// An end is a body (6 unknowns: translation and rotation vector), a node (3) or something whose motion is known (0).
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "physics/config.hpp"

namespace hilo {

/// What carries an end.
struct Carrier {
  int body = -1, node = -1;
};

/// A point (c + R r) or direction (R r) on one of the ends.
struct Entity {
  int end;  // 0: a, 1: b
  Vec3 r;   // arm from the body's centre, or direction, body axes
  bool point;
};

/// One product of a measure, times coef.
struct Term {
  enum Kind { dot, slide, distance2, coordinate } kind;  // y_i.y_j | y_i.(y_k - y_j) | |y_j - y_i|^2 | unit.(y_j - y_i)
  int i = 0, j = 0, k = 0;                               // entities
  double coef = 1;
  Vec3 unit = Vec3::Zero();  // inertial direction of a coordinate
};

struct Measure {
  std::vector<Term> terms;
  double offset = 0;  // subtracted, so that the reference configuration gives the value wanted
};

inline constexpr int max_measures = 6;

/// Stress-like response of a spring to its measures over a step.
struct Response {
  std::array<double, max_measures> s{};                            // conjugate forces
  std::array<std::array<double, max_measures>, max_measures> D{};  // ds/de1
  double energy = 0, dissipated = 0;                               // at e1 [J]; over the step [J]
};

/// The law of a spring.  Elastic forces see (e0, e1), rate forces (r0, r1) over h.
class SpringLaw {
 public:
  using Values = std::array<double, max_measures>;
  virtual ~SpringLaw() = default;
  virtual void elastic(const Values& e0, const Values& e1, Response& out) const = 0;
  virtual void viscous(const Values& r0, const Values& r1, double h, Response& out) const = 0;
  /// Accept e1 as the state to go on from (unwrapped angles).
  virtual void commit(const Values&) {}
};

struct Connector {
  std::string name, kind;
  Carrier end[2];
  std::vector<Entity> entities;
  std::vector<Measure> measures;
  std::unique_ptr<SpringLaw> law;                                             // null for a joint
  Vec3 point_b = Vec3::Zero();                                                // joint point in b: arm from its centre, body axes [m]
  Mat3 frame_a = Mat3::Identity();                                            // joint frame in a, body axes
  int first_row = -1;                                                         // first multiplier, joints only
  std::array<bool, max_measures> active{true, true, true, true, true, true};  // rows kept by the redundancy check

  int n_rows() const { return law ? 0 : static_cast<int>(measures.size()); }
  double value(int measure, const Config& q) const;
};

/// Gradients of the measures over the 12 generalised directions of the two ends: translation and rotation of a, then of b.
struct ConnectorGradient {
  Vec3 y[12], arm[12];  // entities and their arms
  double e[max_measures];
  Eigen::Matrix<double, max_measures, 12> G;  // d e / d(u_a, theta_a, u_b, theta_b)
  Vec3 dy[max_measures][12];                  // d e / d y
};
/// At q; the arms that turn an increment of the unknowns into one of the entities are those of `turned`.
void gradient(const Connector& c, const Config& q, const Config& turned, ConnectorGradient& out);
inline void gradient(const Connector& c, const Config& q, ConnectorGradient& out) { gradient(c, q, q, out); }

/// Second derivative term: slope * d/dz1 of (G(q_left)^T s), 12 x 12, added to K.
void add_geometric(const Connector& c, const ConnectorGradient& left, const ConnectorGradient& right, const double* s, double slope,
                   Eigen::Matrix<double, 12, 12>& K);

/// Force and moment on b at its joint point, inertial axes, for conjugate forces s: -(G^T s)_b.
Vec6 force_on_b(const Connector& c, const ConnectorGradient& left, const double* s, const Config& q);

/// Joint of a kind ("revolute", ...) at `at` with frame `frame` (third column the axis), ends at rest in `q`.
/// `at_b` differs from `at` for the distance joint only.
Connector make_joint(const std::string& kind, const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Vec3& at_b,
                     const Mat3& frame);

/// Springs.  Stiffness and damping triples go with the columns of `frame`.
Connector make_axial_spring(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_a, const Vec3& at_b, double stiffness,
                            double damping, double length);
Connector make_torsion_spring(const Carrier& a, const Carrier& b, const Config& q, const Mat3& frame, double stiffness, double damping,
                              double angle);
Connector make_bushing(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, const Vec3& k, const Vec3& c,
                       const Vec3& k_angle, const Vec3& c_angle);
Connector make_support(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, double k, double c,
                       double clearance, const Vec3& k_plane, const Vec3& c_plane);

}  // namespace hilo
