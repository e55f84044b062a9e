// Joints and springs: quadratic measures of points and directions carried by two ends, or three where a joint needs a carrier.
//
// Every measure e(q) is of degree two in the points, so G(q_mid)(q1 - q0) = e(q1) - e(q0) exactly.  A joint holds its measures, or
// functions of them, at zero or at a given course with multipliers; a spring gives them a potential.  Functions and potentials enter
// through discrete gradients, d.(e1 - e0) = g1 - g0 and s.(e1 - e0) = W1 - W0 [gonzalez-1996].
// An end is a body (6 unknowns: translation and rotation vector), a node (3) or something whose motion is known (0).
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "physics/config.hpp"
#include "physics/curve.hpp"
#include "physics/motion_law.hpp"

namespace hilo {

/// What carries an end.
struct Carrier {
  int body = -1, node = -1;
};

/// A point (c + R r) or direction (R r) on one of the ends.
struct Entity {
  int end;  // 0: a, 1: b, 2: carrier
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

inline constexpr int max_measures = 9, max_rows = 6, max_ends = 3, max_entities = 12;
inline constexpr int max_directions = 6 * max_ends;  // generalised directions: translation and rotation of each end

/// Stress-like response of a spring to its measures over a step.
struct Response {
  std::array<double, max_measures> s{};                            // conjugate forces
  std::array<std::array<double, max_measures>, max_measures> D{};  // ds/de1
  double energy = 0, dissipated = 0, supplied = 0;                 // at e1 [J]; over the step [J]
  std::array<double, max_measures> by_load{};                      // ds/d Interval::load
};

/// What a rate force may ask of the step besides its measures.
struct Interval {
  double h;           // [s]
  double factor = 1;  // of a motor's history
  double load = 0;    // what presses the surfaces of a joint together [N]
};

/// The law of a spring.  Elastic forces see (e0, e1), rate forces (r0, r1) over h.
class SpringLaw {
 public:
  using Values = std::array<double, max_measures>;
  virtual ~SpringLaw() = default;
  virtual void elastic(const Values& e0, const Values& e1, Response& out) const = 0;
  virtual void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const = 0;
  /// Accept e and its rate as the state to go on from (unwrapped angles, speed of approach).
  virtual void commit(const Values& /*e*/, const Values& /*rate*/) {}
  virtual bool needs_rate() const { return false; }
  /// All that commit() leaves.
  virtual void archive(Archive&) {}
  /// Whether it is a potential and nothing else.
  virtual bool conserves() const { return false; }
};

/// Rows of a joint that are functions g_r(e) of its measures.
class RowLaw {
 public:
  using Values = std::array<double, max_measures>;
  /// Gradients of the rows by the measures, and their derivatives.
  struct Gradient {
    std::array<std::array<double, max_measures>, max_rows> d{};                            // d_r                    (rows x measures)
    std::array<std::array<std::array<double, max_measures>, max_measures>, max_rows> D{};  // d(d_r)/de1
  };
  virtual ~RowLaw() = default;
  virtual int n_rows() const = 0;
  virtual void values(const Values& e, double* g) const = 0;
  /// Discrete gradient, symmetric in its ends, with d_r.(e1 - e0) = g_r(e1) - g_r(e0); at e0 = e1 the gradient, D half its derivative.
  virtual void gradient(const Values& e0, const Values& e1, Gradient& out) const = 0;
  /// Accept e as the state to go on from (unwrapped angles).
  virtual void commit(const Values&) {}
  /// All that commit() leaves.
  virtual void archive(Archive&) {}
  /// Why the joint cannot be at e, or nothing.
  virtual std::string fault(const Values&) const { return {}; }
};

/// A row that is held to a law: g = law(t).
struct Drive {
  int row = -1;
  MotionLaw law;
  const char* unit = "";  // of its rate
};

class VelocityRows;

struct Connector {
  Connector();
  Connector(Connector&&) noexcept;
  Connector& operator=(Connector&&) noexcept;
  ~Connector();
  std::string name, kind;
  Carrier end[max_ends];
  int n_ends = 2;
  std::vector<Entity> entities;
  std::vector<Measure> measures;
  std::unique_ptr<SpringLaw> law;               // springs only
  std::unique_ptr<RowLaw> rows;                 // joints whose rows are not their measures
  std::unique_ptr<VelocityRows> velocity_rows;  // joints that hold velocities (rolling.hpp); their rows follow the others
  std::string section = "spring";               // of the scene, springs only
  int load_joint = -1;                          // joint whose multipliers `load_rows` make up Interval::load, springs only
  std::vector<int> load_rows;
  std::function<double(double t0, double t1)> factor;  // Interval::factor, mean over a step; 1 where empty
  Drive drive;
  Vec3 point_b = Vec3::Zero();                                            // joint point in b: arm from its centre, body axes [m]
  Mat3 frame_a = Mat3::Identity();                                        // joint frame in a, body axes
  std::array<bool, max_rows> active{true, true, true, true, true, true};  // rows kept by the redundancy check

  std::span<const Carrier> ends() const { return {end, static_cast<size_t>(n_ends)}; }
  int n_directions() const { return 6 * n_ends; }
  int n_position_rows() const { return law ? 0 : rows ? rows->n_rows() : static_cast<int>(measures.size()); }
  int n_rows() const;
  double value(int measure, const Config& q) const;
  std::array<double, max_measures> values(const Config& q) const;
  /// Rows from the values of the measures, 0 for velocity rows; what a drive wants is not yet taken off.
  void row_values(const std::array<double, max_measures>& e, double* g) const;
};

/// Gradients of the measures over the generalised directions of the ends: translation and rotation of a, of b, of the carrier.
struct ConnectorGradient {
  Vec3 y[max_entities], arm[max_entities];  // entities and their arms
  std::array<double, max_measures> e;
  Eigen::Matrix<double, max_measures, max_directions, Eigen::RowMajor> G;  // d e / d(u_a, theta_a, u_b, theta_b, u_c, theta_c)
  Vec3 dy[max_measures][max_entities];                                     // d e / d y
};
/// At q; the arms that turn an increment of the unknowns into one of the entities are those of `turned`.
void gradient(const Connector& c, const Config& q, const Config& turned, ConnectorGradient& out);
inline void gradient(const Connector& c, const Config& q, ConnectorGradient& out) { gradient(c, q, q, out); }

/// Matrix over the directions of a connector; lives on the stack.
using ConnectorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_directions, max_directions>;
/// Second derivative term: slope * d/dz1 of (G(q_left)^T s), added to K.
void add_geometric(const Connector& c, const ConnectorGradient& left, const ConnectorGradient& right, const double* s, double slope,
                   ConnectorMatrix& K);

/// Force and moment on b at its joint point, inertial axes, for conjugate forces s: -(G^T s)_b.
Vec6 force_on_b(const Connector& c, const ConnectorGradient& left, const double* s, const Config& q);

/// Where a joint is, what it joins, and what its kind needs besides.
struct JointPlace {
  std::string kind;
  Carrier a, b, carrier{0, -1};          // the carrier of a gear or rack
  Vec3 at, at_b;                         // joint point on a and on b; they differ for the distance joint only [m]
  Mat3 frame = Mat3::Identity();         // third column the axis
  Vec3 axis_b = Vec3::Zero();            // axis of b: gear, constant-velocity; direction of a rack; zero: the axis
  double ratio = 1;                      // turns of b per turn of a; [m/rad] of a rack or screw
  double length = 0;                     // of a distance joint, 0: as placed [m]
  std::shared_ptr<const Curve> curve{};  // of point-on-curve: points in inertial axes from `at`
  enum class Driven { none, angle, slide } driven = Driven::none;  // a row held to a course: angle or slide of b along the axis
};
/// The joint with its ends at rest in `q`.
Connector make_joint(const JointPlace& place, const Config& q);

/// Springs.  Stiffness and damping triples go with the columns of `frame`.
Connector make_axial_spring(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_a, const Vec3& at_b, double stiffness,
                            double damping, double length);
Connector make_torsion_spring(const Carrier& a, const Carrier& b, const Config& q, const Mat3& frame, double stiffness, double damping,
                              double angle);
Connector make_bushing(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, const Vec3& k, const Vec3& c,
                       const Vec3& k_angle, const Vec3& c_angle);
/// A law along the distance of two points.
Connector make_distance_stop(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_a, const Vec3& at_b,
                             std::unique_ptr<SpringLaw> law);
/// Unilateral: with damper c, or with a restitution below 1.
Connector make_support(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Mat3& frame, double k, double c,
                       double restitution, double rest_speed, double clearance, const Vec3& k_plane, const Vec3& c_plane);

}  // namespace hilo
