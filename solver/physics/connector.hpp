// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry of joints and springs: quadratic measures of points and directions carried by two ends, or three where a joint needs a carrier.
//
// Every measure e(q) is of degree two in the points, so G(q_mid)(q1 - q0) = e(q1) - e(q0) exactly.  A joint holds its measures, or
// functions of them, at zero or at a given course with multipliers; a spring gives them a potential.  Functions and potentials enter
// through discrete gradients, d.(e1 - e0) = g1 - g0 and s.(e1 - e0) = W1 - W0 [gonzalez-1996].
// An end is a body (6 unknowns: translation and rotation vector), a node (3) or something whose motion is known (0).
#pragma once
#include <array>
#include <span>
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

inline constexpr int max_measures = 12, max_rows = 6, max_ends = 3, max_entities = 12;
inline constexpr int max_directions = 6 * max_ends;  // generalised directions: translation and rotation of each end

struct Connector {
  std::string name;
  Carrier end[max_ends];
  int n_ends = 2;
  std::vector<Entity> entities;
  std::vector<Measure> measures;
  Vec3 point_b = Vec3::Zero();      // joint point in b: arm from its centre, body axes [m]
  Mat3 frame_a = Mat3::Identity();  // joint frame in a, body axes

  std::span<const Carrier> ends() const { return {end, static_cast<size_t>(n_ends)}; }
  int n_directions() const { return 6 * n_ends; }
  double value(int measure, const Config& q) const;
  std::array<double, max_measures> values(const Config& q) const;

  // in the making, at rest in q
  /// A point at `at` or a direction, carried by an end; returns its number.
  int add_point(int of_end, const Config& q, const Vec3& at);
  int add_direction(int of_end, const Config& q, const Vec3& d);
  /// A measure; with its value in q taken off.
  int add_measure(std::vector<Term> terms);
  int add_zero_measure(std::vector<Term> terms, const Config& q);
  /// The nine products of three directions u of a and v of b, by columns: u_i.v_j is entry (i, j) of the rotation from a to b.
  int add_rotation(const std::array<int, 3>& u, const std::array<int, 3>& v);
  /// Ends, joint point on b and joint frame on a.
  void join(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_b, const Mat3& frame);
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

}  // namespace hilo
