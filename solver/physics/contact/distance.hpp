// SPDX-License-Identifier: GPL-3.0-or-later
// Signed distances of obstacles, in axes of their own: above zero in free space, gradients of unit length.
#pragma once
#include <algorithm>
#include <memory>

#include "base/math.hpp"
#include "physics/contact/height_field.hpp"
#include "physics/contact/jet.hpp"

namespace hilo {

/// Plane: below z = 0.  Sphere about the origin.  Cylinder about z, without ends or of a length.  Capsule: a cylinder of a length with half
/// spheres.  Torus about z.  Box about the origin.  Height field: below the heights, with walls straight down from its border.
struct Distance {
  enum class Kind { plane, sphere, cylinder, capsule, torus, box, height_field } kind = Kind::plane;
  double radius = 0;         // of sphere, cylinder, capsule; of the circle of a torus [m]
  double tube = 0;           // of a torus [m]
  double half_length = 0;    // of cylinder (0: no ends) and capsule [m]
  Vec3 half = Vec3::Zero();  // of a box [m]
  bool inside = false;       // what moves is within: bowl, bore, container
  int wall = -1;             // of such a box, or cylinder with ends: this wall alone, of `n_walls`
  std::shared_ptr<const HeightField> field{};
  double reach = 0;  // radius of what meets a field: farther off, its distance is one to first order [m]

  /// Half the least extent, which a step must not jump over [m]; of a plane, nothing.
  double least_extent() const {
    if (inside || kind == Kind::plane) return 0;
    if (kind == Kind::height_field) return (field->high() - field->low()) / 2;
    if (kind == Kind::box) return half.minCoeff();
    if (kind == Kind::torus) return tube;
    return kind == Kind::cylinder && half_length > 0 ? std::min(radius, half_length) : radius;
  }
  /// That a point may meet at once: in an edge or a corner it presses several, whose nearest one alone would leave it out of balance.
  int n_walls() const {
    if (!inside || (kind != Kind::box && (kind != Kind::cylinder || half_length == 0))) return 1;
    return kind == Kind::box ? 6 : 3;
  }
  Distance of_wall(int k) const {
    Distance out = *this;
    out.wall = k;
    return out;
  }
  /// A length of it, for round-off [m].
  double extent() const { return std::max({radius + tube, half_length, half.maxCoeff(), field ? field->extent() : 0}); }
  /// Points of a hull see all of it: free space is convex.
  bool is_container() const { return kind == Kind::plane || (inside && kind != Kind::torus); }

  template <class T>
  void operator()(const Triple<T>& x, T& phi, Triple<T>& n) const {
    const T zero(0.0), one(1.0);
    const auto about = [&](const T& a, const T& b, T& r, T& na, T& nb) {
      const T square = a * a + b * b;
      if (value(square) > 0) {
        r = sqrt(square), na = a / r, nb = b / r;
      } else {
        r = zero, na = one, nb = zero;
      }
    };
    // of a rectangle or box, from what each coordinate lies beyond its side
    const auto beyond = [&](const T* q, int m, T& distance, T* slope) {
      int most = 0;
      T square = zero;
      for (int i = 0; i < m; ++i) {
        if (value(q[i]) > value(q[most])) most = i;
        if (value(q[i]) > 0) square = square + q[i] * q[i];
        slope[i] = zero;
      }
      if (value(square) > 0) {
        distance = sqrt(square);
        for (int i = 0; i < m; ++i)
          if (value(q[i]) > 0) slope[i] = q[i] / distance;
      } else {
        distance = q[most], slope[most] = one;
      }
    };
    switch (kind) {
      case Kind::plane:
        phi = x[2], n = {{zero, zero, one}};
        break;
      case Kind::sphere:
      case Kind::capsule: {
        T z = x[2];
        if (kind == Kind::capsule) z = std::abs(value(z)) > half_length ? z - T(value(z) > 0 ? half_length : -half_length) : zero;
        const Triple<T> y{{x[0], x[1], z}};
        const T square = dot(y, y);
        if (value(square) > 0) {
          const T r = sqrt(square);
          phi = r - T(radius), n = (one / r) * y;
        } else {
          phi = T(-radius), n = {{one, zero, zero}};
        }
        break;
      }
      case Kind::cylinder: {
        T r, nx, ny;
        about(x[0], x[1], r, nx, ny);
        if (half_length <= 0) {
          phi = r - T(radius), n = {{nx, ny, zero}};
          break;
        }
        const double side = wall == 1 || (wall < 0 && value(x[2]) < 0) ? -1 : 1;
        const T q[2] = {r - T(radius), T(side) * x[2] - T(half_length)};
        T slope[2] = {wall == 0 ? one : zero, wall == 0 ? zero : one};
        if (wall < 0)
          beyond(q, 2, phi, slope);
        else
          phi = q[wall == 0 ? 0 : 1];
        n = {{slope[0] * nx, slope[0] * ny, T(side) * slope[1]}};
        break;
      }
      case Kind::torus: {
        T r, nx, ny, d, nr, nz;
        about(x[0], x[1], r, nx, ny);
        about(r - T(radius), x[2], d, nr, nz);
        phi = d - T(tube), n = {{nr * nx, nr * ny, nz}};
        break;
      }
      case Kind::height_field:
        over_heights(x, phi, n);
        break;
      case Kind::box: {
        T q[3], slope[3];
        double side[3];
        for (int i = 0; i < 3; ++i)
          side[i] = wall % 2 == 1 || (wall < 0 && value(x[i]) < 0) ? -1 : 1, q[i] = T(side[i]) * x[i] - T(half[i]);
        if (wall < 0)
          beyond(q, 3, phi, slope);
        else
          phi = q[wall / 2], slope[0] = slope[1] = slope[2] = zero, slope[wall / 2] = one;
        for (int i = 0; i < 3; ++i) n[i] = T(side[i]) * slope[i];
        break;
      }
    }
    if (inside) phi = -phi, n = {{-n[0], -n[1], -n[2]}};
  }
  double at(const Vec3& x) const {
    double phi;
    Triple<double> n;
    (*this)(triple<double>(x), phi, n);
    return phi;
  }

 private:
  /// The distance from the nearest point of the surface, and n the normal there: both are exact, n to first order in x, as the foot is one
  /// step of Newton's method from where it is found to be.  Far above all that may touch: the height above the surface times the cosine of
  /// its slope, and the normal below.
  template <class T>
  void over_heights(const Triple<T>& x, T& phi, Triple<T>& n) const {
    const Vec3 p = values(x);
    const bool far = field->is_beyond(p, reach);
    const auto [u, v] = far ? std::array{p[0], p[1]} : field->nearest(p);
    const HeightField::Height s = field->at(u, v);
    const double up = p[2] - s.h;
    double a = 1 + s.hx * s.hx - up * s.hxx, b = s.hx * s.hy - up * s.hxy, d = 1 + s.hy * s.hy - up * s.hyy;
    if (!(a > 0 && a * d - b * b > 1e-3 * a * d)) a = 1 + s.hx * s.hx, b = s.hx * s.hy, d = 1 + s.hy * s.hy;
    const double det = a * d - b * b;
    const Triple<T> r{{x[0] - T(u), x[1] - T(v), x[2] - T(s.h)}};
    const T gu = r[0] + T(s.hx) * r[2], gv = r[1] + T(s.hy) * r[2];
    const double share = far ? 0 : 1 / det;
    const T du = T(share * d) * gu - T(share * b) * gv, dv = T(share * a) * gv - T(share * b) * gu;
    const T sx = T(s.hx) + T(s.hxx) * du + T(s.hxy) * dv, sy = T(s.hy) + T(s.hxy) * du + T(s.hyy) * dv;
    const T size = sqrt(sx * sx + sy * sy + T(1.0));
    n = {{-sx / size, -sy / size, T(1.0) / size}};
    phi = dot(n, r);
    const HeightField::Outside out = field->outside(p);
    if (out.distance <= value(phi)) return;
    const T zero(0.0);
    n = {{zero, zero, zero}};
    n[out.axis] = T(out.sign);
    phi = T(out.sign) * (x[out.axis] - T(p[out.axis])) + T(out.distance);
  }
};

}  // namespace hilo
