// SPDX-License-Identifier: GPL-3.0-or-later
// A point against a flat triangle whose corners move: discrete gradient of the gap, pressure as a secant, friction by a bristle.
//
// With n0 and n1 the unit normals at the ends of a step, d = (n0 + n1)/2, and the point in the mean of both ends at
// x - x_1 = alpha t1 + beta t2 + gamma d, the edges t1 = x_2 - x_1 and t2 = x_3 - x_1 of that mean:
//   D = d on the point, -(1 - alpha - beta) d, -alpha d, -beta d on the corners;   D:(q1 - q0) = g1 - g0,   g = n.(x - x_1)
// D has neither a resultant nor a moment in the mean of the step, so that a step keeps energy and both momenta at any length: dn.t = -dt.d
// as n.t = 0 at both ends, and dn.d = 0 as |n| = 1.  It is the normal as a point [hesch-betsch-2011], eliminated.
// Slip: gradients S_e of unit tangents e of the triangle in the mean, e on the point, its opposite at the foot, forces along the normal
// that take up the moment of e, and a couple within the triangle; they vanish in rigid motions.
// The gap of the law is g*, which the way D:(q1 - q0) moves on.  Where a point comes to another triangle, o = g - g* is paid by the slip:
//   D* = D + sum_e o sigma_e/(sigma.sigma + 4 o^2) S_e,   a tilt of at most 1/4.
// So is what a point is deep that a side which slides has come over: it was open, g* = 0, and is pressed as the slip goes on.
#pragma once
#include <array>

#include "physics/contact/point_contact.hpp"

namespace hilo {

/// From the first corner of a triangle: to the point, and to the other two corners [m].
template <class T>
struct OverTriangle {
  Triple<T> r, t1, t2;
};

/// How a point and a triangle stand at the beginning of a step.
struct FacetPast {
  double gap = 0;                // of the law, g* [m]
  double offset = 0;             // of the gap to the triangle, g - g* [m]
  std::array<double, 2> bent{};  // the bristle, along the first edge and across it [m]
  double approach = 0;           // speed at which the contact began [m/s]
};

/// What acts, conjugate to r, t1 and t2 [N].
template <class T>
struct FacetForce {
  Triple<T> on_point, on_second, on_third;
  T gap;                            // g* at the end [m]
  std::array<double, 2> bent{};     // [m]
  Vec3 normal = Vec3::Zero();       // of the mean of the step, not of unit length
  double pressing = 0;              // [N]
  double slid = 0, dissipated = 0;  // in the step [m, J]
  bool acts = false;
};

/// Unit tangents of a triangle: along its first edge, and across it; its normal.
struct TriangleAxes {
  Vec3 along, across, normal;
  explicit TriangleAxes(const OverTriangle<double>& z) {
    normal = values(cross(z.t1, z.t2)).normalized(), along = values(z.t1).normalized(), across = normal.cross(along);
  }
};

template <class T>
Triple<T> unit(const Triple<T>& a) {
  return (T(1.0) / sqrt(dot(a, a))) * a;
}
inline double gap_of(const OverTriangle<double>& z) { return dot(unit(cross(z.t1, z.t2)), z.r); }

/// A gradient over r, t1 and t2, and its way over increments.
template <class T>
struct FacetGradient {
  Triple<T> r, t1, t2;
  T operator()(const OverTriangle<T>& dz) const { return dot(r, dz.r) + dot(t1, dz.t1) + dot(t2, dz.t2); }
  void add(const T& f, FacetForce<T>& out) const {
    out.on_point = out.on_point + f * r, out.on_second = out.on_second + f * t1, out.on_third = out.on_third + f * t2;
  }
};

/// The gradient of the gap along d, at a configuration m; `foot`: alpha and beta.
template <class T>
FacetGradient<T> gap_gradient(const OverTriangle<T>& m, const Triple<T>& d, std::array<T, 2>& foot) {
  const T volume = dot(cross(m.t1, m.t2), d);
  foot = {dot(cross(m.r, m.t2), d) / volume, dot(cross(m.t1, m.r), d) / volume};
  return {d, (-foot[0]) * d, (-foot[1]) * d};
}

/// Those of the slip along both tangents.
template <class T>
std::array<FacetGradient<T>, 2> slip_gradients(const OverTriangle<T>& m, const std::array<T, 2>& foot) {
  const Triple<T> c = cross(m.t1, m.t2);
  const T size = sqrt(dot(c, c));
  const Triple<T> n = (T(1.0) / size) * c, g1 = (T(1.0) / size) * cross(m.t2, n), g2 = (T(1.0) / size) * cross(n, m.t1);
  const Triple<T> arm = m.r - foot[0] * m.t1 - foot[1] * m.t2;
  std::array<FacetGradient<T>, 2> out;
  Triple<T> e = unit(m.t1);
  for (FacetGradient<T>& S : out) {
    const Triple<T> moment = cross(e, arm), turned = cross(n, moment);  // -arm x e
    const T half_twist = T(0.5) * dot(moment, n);
    S.r = e;
    S.t1 = (-foot[0]) * e + dot(g1, turned) * n + half_twist * cross(n, g1);
    S.t2 = (-foot[1]) * e + dot(g2, turned) * n + half_twist * cross(n, g2);
    e = cross(n, e);
  }
  return out;
}

/// The bristle, stiffened by q, after a slip sigma, shortened to mu p/(q kt), and its force along S.
template <class T>
void bend(const PointLaw& law, const std::array<T, 2>& sigma, const std::array<FacetGradient<T>, 2>& S, const T& p, const T& q,
          const FacetPast& past, FacetForce<T>& out) {
  std::array<T, 2> u{T(past.bent[0]) + q * sigma[0], T(past.bent[1]) + q * sigma[1]};
  const T limit = law.limit(p, q), square = u[0] * u[0] + u[1] * u[1];
  if (value(square) > value(limit) * value(limit)) {
    const T size = sqrt(square);
    out.slid = (value(size) - value(limit)) / value(q);
    u = {limit / size * u[0], limit / size * u[1]};
  }
  for (int e = 0; e < 2; ++e) {
    S[e].add(T(law.kt) * q * u[e], out);
    out.bent[e] = value(u[e]);
    out.dissipated += law.kt * out.bent[e] * (value(q) * value(sigma[e]) - out.bent[e] / 2);
  }
}

/// Over the step from z0 to z1.
template <class T>
FacetForce<T> over_step(const PointLaw& law, const OverTriangle<double>& z0, const OverTriangle<T>& z1, const FacetPast& past,
                        double h = 0) {
  FacetForce<T> out;
  const T zero(0.0), half(0.5);
  out.on_point = out.on_second = out.on_third = {{zero, zero, zero}};
  const double lost = law.kt / 2 * (past.bent[0] * past.bent[0] + past.bent[1] * past.bent[1]);
  const Triple<T> n1 = unit(cross(z1.t1, z1.t2));
  const Triple<double> n0 = unit(cross(z0.t1, z0.t2));
  out.gap = dot(n1, z1.r) - T(dot(n0, z0.r)) + T(past.gap);
  const bool comes_in = past.gap >= 0 && past.offset < 0;
  if (past.gap >= 0 && value(out.gap) >= 0 && !comes_in) return out.dissipated = lost, out;
  const auto lifted = [](const Triple<double>& a) { return Triple<T>{{T(a[0]), T(a[1]), T(a[2])}}; };
  const OverTriangle<T> start{lifted(z0.r), lifted(z0.t1), lifted(z0.t2)}, dz{z1.r - start.r, z1.t1 - start.t1, z1.t2 - start.t2},
      mean{half * (z1.r + start.r), half * (z1.t1 + start.t1), half * (z1.t2 + start.t2)};
  std::array<T, 2> foot;
  FacetGradient<T> D = gap_gradient(mean, half * (lifted(n0) + n1), foot);
  T way = D(dz);
  std::array<FacetGradient<T>, 2> S;
  std::array<T, 2> sigma{zero, zero};
  const bool pays = comes_in || (past.gap < 0 && past.offset != 0);
  if (law.friction > 0 || pays) {
    S = slip_gradients(mean, foot);
    sigma = {S[0](dz), S[1](dz)};
  }
  if (pays) {
    const T share = T(past.offset) / (sigma[0] * sigma[0] + sigma[1] * sigma[1] + T(4 * past.offset * past.offset));
    for (int e = 0; e < 2; ++e) {
      const T f = share * sigma[e];
      D.r = D.r + f * S[e].r, D.t1 = D.t1 + f * S[e].t1, D.t2 = D.t2 + f * S[e].t2;
      way = way + f * sigma[e];
    }
  }
  out.gap = T(past.gap) + way, out.acts = true;
  const T stored = secant(law, past.gap, out.gap), c = damping(law, stored, past.gap, out.gap, {h, past.approach}), p = c * stored;
  D.add(-p, out);
  out.pressing = value(p), out.normal = values(D.r), out.dissipated = lost + (value(p) - value(stored)) * (past.gap - value(out.gap));
  if (law.friction <= 0 || !(value(p) > 0)) return out;
  bend(law, sigma, S, p, stiffening(c), past, out);
  return out;
}

/// What the gradient's own change adds to a tangent, times f.
template <class T>
void slow_down(FacetGradient<T>& D, double f) {
  for (Triple<T>* a : {&D.r, &D.t1, &D.t2})
    for (T& x : a->x) slow_down(x, f);
}

/// In small motions about a state z0, at z1: what was pressed there is held by the slopes of its law, whichever way it moves.
template <class T>
FacetForce<T> about(const HeldPoint& held, const PointLaw& law, const OverTriangle<double>& z0, const OverTriangle<T>& z1,
                    const FacetPast& past) {
  FacetForce<T> out;
  const T zero(0.0), half(0.5);
  out.on_point = out.on_second = out.on_third = {{zero, zero, zero}};
  const Triple<T> n = unit(cross(z1.t1, z1.t2));
  out.gap = dot(n, z1.r) - T(past.offset);
  out.bent = past.bent;
  if (!held.pressed) return out;
  out.acts = true;
  std::array<T, 2> foot, foot_of_mean;
  const FacetGradient<T> D = gap_gradient(z1, n, foot);
  const T p = held.pressing_at(law, out.gap);
  D.add(-p, out);
  out.pressing = value(p), out.normal = values(n);
  if (!held.sticks) return out;
  const auto lifted = [](const Triple<double>& a) { return Triple<T>{{T(a[0]), T(a[1]), T(a[2])}}; };
  const OverTriangle<T> start{lifted(z0.r), lifted(z0.t1), lifted(z0.t2)}, dz{z1.r - start.r, z1.t1 - start.t1, z1.t2 - start.t2},
      mean{half * (z1.r + start.r), half * (z1.t1 + start.t1), half * (z1.t2 + start.t2)};
  gap_gradient(mean, unit(cross(mean.t1, mean.t2)), foot_of_mean);
  const auto way = slip_gradients(mean, foot_of_mean), S = slip_gradients(z1, foot);
  for (size_t e = 0; e < 2; ++e) S[e].add(T(law.kt) * (T(past.bent[e]) + way[e](dz)), out);
  return out;
}

/// At the configuration z1 that a load step from z0 leads to: the gradient of the potential, `touch` as of is_closed.  A guess may be far
/// deeper than any answer, `deep`; the tangent then has no more of the stiffness of a turning normal than at that depth, as a matrix with
/// all of it would not be definite.
template <class T>
FacetForce<T> at_end(const PointLaw& law, const OverTriangle<double>& z0, const OverTriangle<T>& z1, const FacetPast& past, double touch,
                     double deep) {
  FacetForce<T> out;
  const T zero(0.0), half(0.5);
  out.on_point = out.on_second = out.on_third = {{zero, zero, zero}};
  const double lost = law.kt / 2 * (past.bent[0] * past.bent[0] + past.bent[1] * past.bent[1]);
  const Triple<T> n = unit(cross(z1.t1, z1.t2));
  out.gap = dot(n, z1.r) - T(past.offset);
  if (value(out.gap) >= touch || !is_closed(value(out.gap), gap_of(z0) - past.offset, touch)) return out.dissipated = lost, out;
  std::array<T, 2> foot;
  FacetGradient<T> D = gap_gradient(z1, n, foot);
  if (value(out.gap) < -deep) slow_down(D, deep / -value(out.gap));
  const T p = T(-law.k) * out.gap;
  D.add(-p, out);
  out.acts = true, out.pressing = value(p), out.normal = values(n), out.dissipated = lost;
  if (law.friction <= 0) return out;
  const auto lifted = [](const Triple<double>& a) { return Triple<T>{{T(a[0]), T(a[1]), T(a[2])}}; };
  const OverTriangle<T> start{lifted(z0.r), lifted(z0.t1), lifted(z0.t2)}, dz{z1.r - start.r, z1.t1 - start.t1, z1.t2 - start.t2},
      mean{half * (z1.r + start.r), half * (z1.t1 + start.t1), half * (z1.t2 + start.t2)};
  std::array<T, 2> foot_of_mean;
  gap_gradient(mean, unit(cross(mean.t1, mean.t2)), foot_of_mean);
  const auto way = slip_gradients(mean, foot_of_mean), S = slip_gradients(z1, foot);
  bend(law, {way[0](dz), way[1](dz)}, S, p, T(1.0), past, out);
  out.dissipated = law.kt * std::hypot(out.bent[0], out.bent[1]) * out.slid;
  return out;
}

}  // namespace hilo
