// SPDX-License-Identifier: GPL-3.0-or-later
// A point against an obstacle: discrete gradient of its signed distance, pressure as a secant, friction by a bristle.
//
// With the measures xi of the point in the axes of the obstacle, of degree two in all points, and n = grad phi at their mean:
//   D = n + (phi1 - phi0 - n.dxi)/|dxi|^2 dxi,   D.dxi = phi1 - phi0;   f = s D,   s = (V1 - V0)/(phi1 - phi0)
// so that a step keeps energy and momentum at any length [gonzalez-1996].  Friction: u is how far a bristle of stiffness kt is bent,
//   u1 = u0 + sigma, shortened to mu p/kt,   f = kt u1,   D = kt u1.sigma - kt (|u1|^2 - |u0|^2)/2 >= 0
// Restitution: the pressure is c s, c = 1 + alpha times the speed of approach within its limits (`ImpactLoss`): what it takes is above zero
// in and out, and it acts along D, so that momenta stay.  The bristle is stiffened with the pressure, to q^2 kt with q =
// sqrt(c):
//   u1 = u0 + q sigma, shortened to mu p/(q kt),   f = q kt u1,   D = kt u1.(q sigma) - kt (|u1|^2 - |u0|^2)/2 >= 0
// u^2 kt/2 is what it stores at any q, which is of the step alone: a change of q neither adds nor takes any.
#pragma once
#include "physics/contact/distance.hpp"
#include "physics/impact_loss.hpp"

namespace hilo {

/// Forces of a point, in N: V = k g^2/2, or of a ball 2/5 hertz g^(5/2), for a depth g.
struct PointLaw {
  double k = 0;         // [N/m]
  double hertz = 0;     // [N/m^1.5]; above zero: k is not used
  double kt = 0;        // [N/m]
  double friction = 0;  // coefficient
  double radius = 0;    // of the ball that the point is the centre of [m]
  ImpactLoss loss;      // of restitution
  double slow = 0;      // speed below which no larger share is lost [m/s]
  bool fixed = false;   // tangents without the change of mu p
  double potential(double gap) const;
  /// Of a ball of relative radius R on a ball, plane or bowl: 4/3 E* sqrt(R), and along the surface the slope at a depth of R/1000.
  void take_hertz(double E, double R) { hertz = 4. / 3 * E * std::sqrt(R), kt = (2 * 0.7 / 1.7) * 2 * E * R * std::sqrt(1e-3); }
  /// How far the bristle bends at most, mu p/(q kt) [m].
  template <class T>
  T limit(const T& p, const T& q) const {
    return value(p) > 0 ? T(friction / kt) * (fixed ? T(value(p)) : p) / q : T(0.0);
  }
  /// On the way to an answer: a share of the stiffness; with or without the change of mu p; with friction that holds whatever pulls.
  PointLaw as(double share, bool is_fixed, bool sticks) const {
    constexpr double any = 1e30;
    PointLaw out = *this;
    out.k *= share, out.hertz *= share, out.kt *= share;
    out.fixed = is_fixed;
    if (sticks && friction > 0) out.friction = any;
    return out;
  }
};

/// -dV/dgap > 0 as a quotient over the step.
template <class T>
T secant(const PointLaw& law, double g0, const T& g1) {
  const double v1 = value(g1);
  if (g0 >= 0 && v1 >= 0) return T(0.0);
  if (law.hertz > 0) {  // quotient of fifth powers over squares of the roots
    const double a = g0 < 0 ? std::sqrt(-g0) : 0;
    if (v1 >= 0) return T(0.4 * law.hertz * a * a * a * a * a) / (g1 - T(g0));
    if (a == 0 && g0 > 0) return T(0.4 * law.hertz) * (g1 * g1 * sqrt(-g1)) / (T(g0) - g1);
    const T b = sqrt(-g1);
    const T b2 = b * b, sum = b2 * b2 + T(a) * b2 * b + T(a * a) * b2 + T(a * a * a) * b + T(a * a * a * a);
    return T(0.4 * law.hertz) * sum / (b + T(a));
  }
  if (g0 <= 0 && v1 <= 0) return T(law.k / 2) * (T(-g0) - g1);
  if (g0 > 0) return T(law.k / 2) * g1 * g1 / (T(g0) - g1);
  return T(law.k / 2 * g0 * g0) / (g1 - T(g0));
}

/// The step, and the largest speed of approach of the contact at work.
struct Approach {
  double h = 0, speed = 0;  // [s, m/s]
  /// After a step from gap g0 to g1; what is open begins with its own.
  double after(double g0, double g1) const {
    const double rate = h > 0 ? std::max(0., (g0 - g1) / h) : 0;
    return g0 > 0 || g1 >= 0 ? rate : std::max(speed, rate);
  }
};

/// What restitution multiplies the pressure p of a step from gap g0 to g1 by.  What comes faster than the contact began, as a part at rest
/// that is hit, begins anew with its own speed.
template <class T>
T damping(const PointLaw& law, const T& p, double g0, const T& g1, const Approach& approach) {
  if (!law.loss.any() || approach.h <= 0 || !(value(p) > 0)) return T(1.0);
  return law.loss.factor((T(g0) - g1) / T(approach.h * std::max(g0 > 0 ? 0. : approach.speed, law.slow)));
}

/// q of the bristle, sqrt(c); below 1 what goes on from there straight, so that it stays above zero.
template <class T>
T stiffening(const T& c) {
  return value(c) > 1 ? sqrt(c) : T(0.5) * (T(1.0) + c);
}

/// What a point feels, in axes of the obstacle.
template <class T>
struct PointForce {
  Triple<T> normal, tangential;     // conjugate to the measures of the point, and to those of the material point that slides [N]
  Triple<T> n;                      // normal of the obstacle
  Triple<T> u;                      // of the bristle at the end [m]
  double pressing = 0;              // [N]
  double slid = 0, dissipated = 0;  // in the step [m, J]
  bool acts = false;
};

/// The bristle, stiffened by q, after the material point has gone `way` along an obstacle of normal out.n, shortened to mu p/(q kt).
template <class T>
void bend(const PointLaw& law, const Triple<T>& way, const Vec3& u0, const T& p, const T& q, PointForce<T>& out) {
  if (law.friction <= 0) return;
  const Triple<T> bent = triple<T>(u0);
  const Triple<T> sigma = q * (way - dot(out.n, way) * out.n);
  const Triple<T> trial = bent - dot(out.n, bent) * out.n + sigma;
  const T limit = law.limit(p, q), square = dot(trial, trial);
  out.u = trial;
  if (value(square) > value(limit) * value(limit)) {
    const T size = sqrt(square);
    out.u = (limit / size) * trial;
    out.slid = (value(size) - value(limit)) / value(q);
  }
  out.tangential = (T(law.kt) * q) * out.u;
  const Vec3 u1 = values(out.u), s = values(sigma);
  out.dissipated = law.kt * (u1.dot(s) - (u1.squaredNorm() - u0.squaredNorm()) / 2);
}

/// Over the step from measures x0 to x1, `way` that of the material point, from a bristle u0.
template <class T>
PointForce<T> over_step(const Distance& shape, const PointLaw& law, const Vec3& x0, const Triple<T>& x1, const Triple<T>& way,
                        const Vec3& u0, const Approach& approach = {}) {
  PointForce<T> out;
  const T zero(0.0);
  out.normal = out.tangential = out.n = out.u = {{zero, zero, zero}};
  double phi0;
  Triple<double> unused;
  shape(triple<double>(x0), phi0, unused);
  T phi1;
  Triple<T> n1;
  shape(x1, phi1, n1);
  const double g0 = phi0 - law.radius;
  const T g1 = phi1 - T(law.radius);
  if (g0 >= 0 && value(g1) >= 0) {
    out.dissipated = law.kt / 2 * u0.squaredNorm();
    return out;
  }
  out.acts = true;
  const T half(0.5);
  const Triple<T> start = triple<T>(x0), dx = x1 - start, middle = half * (start + x1);
  T phi;
  shape(middle, phi, out.n);
  Triple<T> D = out.n;
  const T rest = phi1 - T(phi0) - dot(out.n, dx);
  if (std::abs(value(rest)) > 1e-14 * (shape.extent() + x0.norm())) D = D + (rest / dot(dx, dx)) * dx;
  const T stored = secant(law, g0, g1), c = damping(law, stored, g0, g1, approach), p = c * stored;
  out.normal = (-p) * D, out.pressing = value(p);
  bend(law, way, u0, p, stiffening(c), out);
  out.dissipated += (value(p) - value(stored)) * (g0 - value(g1));
  return out;
}

/// Whether what has this gap at the end of a load step that began with the gap `before` is taken as closed: what touched, nearer than
/// `touch`, is too, so that it holds and sticks without pressure, unless it parts.
inline bool is_closed(double gap, double before, double touch) { return gap < 0 || (gap < touch && gap <= before + 1e-6 * touch); }
/// Whether that pulls.
inline bool is_pulled(double gap, double before, double touch) { return gap > 1e-4 * touch && is_closed(gap, before, touch); }

/// At the measures x1 that a load step from x0 leads to: the gradient of the potential, `touch` as of is_closed [m].  A guess may be far
/// deeper than any answer, `deep` [m]; the tangent then has no more of the stiffness of a turning normal than at that depth.  What it
/// dissipates is mu p times the slip.
template <class T>
PointForce<T> at_end(const Distance& shape, const PointLaw& law, const Vec3& x0, const Triple<T>& x1, const Triple<T>& way, const Vec3& u0,
                     double touch, double deep) {
  PointForce<T> out;
  const T zero(0.0);
  out.normal = out.tangential = out.u = {{zero, zero, zero}};
  T phi;
  shape(x1, phi, out.n);
  const T gap = phi - T(law.radius);
  if (value(gap) >= touch || !is_closed(value(gap), shape.at(x0) - law.radius, touch)) {
    out.dissipated = law.kt / 2 * u0.squaredNorm();
    return out;
  }
  out.acts = true;
  const double depth = -value(gap), least = 1e-6 * law.radius;  // of a ball: below, as stiff as there, so that what rests is held
  const T p = law.hertz > 0 ? T(law.hertz) * (-gap) * (depth > least ? sqrt(-gap) : T(std::sqrt(least))) : T(-law.k) * gap;
  Triple<T> n = out.n;
  if (depth > deep)
    for (T& x : n.x) slow_down(x, deep / depth);
  out.normal = (-p) * n, out.pressing = value(p);
  bend(law, way, u0, p, T(1.0), out);
  out.dissipated = law.kt * values(out.u).norm() * out.slid;
  return out;
}

/// At one place, for starts: the gradient of the potential, the bristle as it is.
template <class T>
PointForce<T> at_rest(const Distance& shape, const PointLaw& law, const Triple<T>& x, const Vec3& u0) {
  PointForce<T> out;
  const T zero(0.0);
  out.normal = out.tangential = out.u = {{zero, zero, zero}};
  T phi;
  shape(x, phi, out.n);
  const T gap = phi - T(law.radius);
  if (value(gap) >= 0) return out;
  out.acts = true;
  const T p = law.hertz > 0 ? T(law.hertz) * (-gap) * sqrt(-gap) : T(-law.k) * gap;
  out.pressing = value(p);
  out.normal = (-p) * out.n;
  out.u = triple<T>(u0), out.tangential = T(law.kt) * out.u;
  return out;
}

/// How a point was when small motions about a state began: one that is pressed is held by the slopes of its law, whichever way it moves.
/// With friction it sticks, also where it slid to the state: once it has turned, a vibration bends its bristle no farther than at first.
struct HeldPoint {
  bool pressed = false, sticks = false;
  double gap = 0, pressing = 0;  // [m, N]
  /// Of a gap g.
  static HeldPoint at(const PointLaw& law, double g) {
    HeldPoint out{.pressed = g < 0, .sticks = g < 0 && law.friction > 0, .gap = g};
    out.pressing = g >= 0 ? 0 : law.hertz > 0 ? -law.hertz * g * std::sqrt(-g) : -law.k * g;
    return out;
  }
  /// Pressure at another gap.
  template <class T>
  T pressing_at(const PointLaw& law, const T& g) const {
    const double slope = law.hertz > 0 ? 1.5 * law.hertz * std::sqrt(-gap) : law.k;
    return T(pressing) + T(slope) * (T(gap) - g);
  }
};

/// In small motions about a state: `way` of the material point since then, from a bristle u0.
template <class T>
PointForce<T> about(const HeldPoint& held, const Distance& shape, const PointLaw& law, const Triple<T>& x, const Triple<T>& way,
                    const Vec3& u0) {
  PointForce<T> out;
  const T zero(0.0);
  out.normal = out.tangential = out.u = {{zero, zero, zero}};
  T phi;
  shape(x, phi, out.n);
  if (!held.pressed) return out;
  out.acts = true;
  const T p = held.pressing_at(law, phi - T(law.radius));
  out.pressing = value(p), out.normal = (-p) * out.n;
  out.u = triple<T>(u0);
  if (held.sticks) out.u = out.u + way - dot(out.n, way) * out.n;
  out.tangential = T(law.kt) * out.u;
  return out;
}

}  // namespace hilo
