// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies turning about a fixed point, and the slider-crank, integrated in the test itself without joints or multipliers.
#pragma once
#include <cmath>
#include <vector>

#include "base/math.hpp"

namespace hilo::test {

struct Truth {
  Vec3 x, v, a, force;  // of a point; force of the pin on the body
  Mat3 R;
};

/// Euler's equations about the fixed point, J_O w' = -w x J_O w + c x m g in inertial axes, by RK4.
struct FixedPoint {
  double mass;
  Vec3 centre;   // of mass, from the fixed point [m]
  Mat3 inertia;  // about the centre of mass [kg m^2]
  Vec3 spin, gravity{0, 0, -9.81}, point;

  Truth at(double end, int n) const { return series({end}, end / n).front(); }

  /// At rising instants, with steps of at most `step`.
  std::vector<Truth> series(const std::vector<double>& times, double step) const {
    std::vector<Truth> out;
    const Mat3 JO = inertia + mass * (centre.squaredNorm() * Mat3::Identity() - centre * centre.transpose());
    struct State {
      Mat3 R;
      Vec3 w;
    };
    const auto spin_rate = [&](const State& s) -> Vec3 {
      const Mat3 J = s.R * JO * s.R.transpose();
      return J.inverse() * (-s.w.cross(J * s.w) + (s.R * centre).cross(mass * gravity));
    };
    const auto rate = [&](const State& s) { return State{skew(s.w) * s.R, spin_rate(s)}; };
    const auto plus = [](const State& s, const State& d, double h) { return State{s.R + h * d.R, s.w + h * d.w}; };
    State s{Mat3::Identity(), spin};
    double now = 0;
    for (const double end : times) {
      const int n = end > now ? static_cast<int>(std::ceil((end - now) / step - 1e-9)) : 0;
      const double h = n > 0 ? (end - now) / n : 0;
      for (int i = 0; i < n; ++i) {
        const State k1 = rate(s), k2 = rate(plus(s, k1, h / 2)), k3 = rate(plus(s, k2, h / 2)), k4 = rate(plus(s, k3, h));
        s.R += h / 6 * (k1.R + 2 * k2.R + 2 * k3.R + k4.R), s.w += h / 6 * (k1.w + 2 * k2.w + 2 * k3.w + k4.w);
      }
      now = end;
      const Vec3 wd = spin_rate(s), x = s.R * point, c = s.R * centre;
      const auto acceleration = [&](const Vec3& r) { return Vec3(wd.cross(r) + s.w.cross(s.w.cross(r))); };
      out.push_back({x, s.w.cross(x), acceleration(x), mass * (acceleration(c) - gravity), s.R});
    }
    return out;
  }
};

/// Slider-crank without gravity: uniform crank r and rod l, block; one coordinate theta with M(theta) theta'^2/2 = E constant.
/// x, v, a of the block; force: of the guide on the block.
struct SliderCrank {
  double r = 0.5, l = 1, m1 = 1, m2 = 2, m3 = 0.5, theta = 0.5, rate = 6;

  /// Block x, centre of the rod, rod angle at crank angle t.
  template <class T>
  static void place(T r, T l, T t, T& x, T& xc, T& yc, T& phi) {
    phi = -std::asin(r / l * std::sin(t));
    x = r * std::cos(t) + l * std::cos(phi);
    xc = r * std::cos(t) + l / 2 * std::cos(phi), yc = r / 2 * std::sin(t);
  }
  struct Derivatives {  // by theta: first and second
    double x1, x2, xc1, xc2, yc1, yc2, phi1, phi2;
  };
  Derivatives derivatives(double t) const {
    const double s = std::sin(t), c = std::cos(t), k = r / l, phi = -std::asin(k * s), cp = std::cos(phi), sp = std::sin(phi);
    Derivatives d{};
    d.phi1 = -k * c / cp;
    d.phi2 = (k * s + sp * d.phi1 * d.phi1) / cp;  // from cos(phi) phi' = -k cos t
    d.x1 = -r * s - l * sp * d.phi1;
    d.x2 = -r * c - l * (cp * d.phi1 * d.phi1 + sp * d.phi2);
    d.xc1 = -r * s - l / 2 * sp * d.phi1;
    d.xc2 = -r * c - l / 2 * (cp * d.phi1 * d.phi1 + sp * d.phi2);
    d.yc1 = r / 2 * c, d.yc2 = -r / 2 * s;
    return d;
  }
  double inertia(double t) const {
    const Derivatives d = derivatives(t);
    return m1 * r * r / 3 + m2 * (d.xc1 * d.xc1 + d.yc1 * d.yc1) + m2 * l * l / 12 * d.phi1 * d.phi1 + m3 * d.x1 * d.x1;
  }
  Truth at(double end, int n) const {
    const double E2 = inertia(theta) * rate * rate;  // M w^2
    const auto w = [&](double t) { return std::sqrt(E2 / inertia(t)); };
    double t = theta;
    for (int i = 0; i < n; ++i) {
      const double h = end / n, k1 = w(t), k2 = w(t + h / 2 * k1), k3 = w(t + h / 2 * k2), k4 = w(t + h * k3);
      t += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const Derivatives d = derivatives(t);
    const double w0 = w(t);
    const double dM = 2 * m2 * (d.xc1 * d.xc2 + d.yc1 * d.yc2) + 2 * m2 * l * l / 12 * d.phi1 * d.phi2 + 2 * m3 * d.x1 * d.x2;
    const double alpha = -dM * w0 * w0 / (2 * inertia(t));
    double x, xc, yc, phi;
    place(r, l, t, x, xc, yc, phi);
    const double ax = d.x1 * alpha + d.x2 * w0 * w0, axc = d.xc1 * alpha + d.xc2 * w0 * w0, ayc = d.yc1 * alpha + d.yc2 * w0 * w0,
                 aphi = d.phi1 * alpha + d.phi2 * w0 * w0;
    // rod about its centre: J aphi = (r_wrist x F_wrist) + (r_pin x F_pin), F_pin = m2 a_c - F_wrist; block: -F_wrist_x = m3 ax
    const double J = m2 * l * l / 12, px = l / 2 * std::cos(phi), py = l / 2 * std::sin(phi);
    const double Fx = -m3 * ax;  // of the block on the rod
    // J aphi = px Fy - py Fx - (px (m2 ayc - Fy) - py (m2 axc - Fx))
    const double Fy = (J * aphi + 2 * py * Fx - py * m2 * axc + px * m2 * ayc) / (2 * px);
    Truth out;
    out.x = Vec3(x, 0, 0), out.v = Vec3(d.x1 * w0, 0, 0), out.a = Vec3(ax, 0, 0), out.force = Vec3(0, Fy, 0);  // guide holds the block
    out.R = Mat3::Identity();
    return out;
  }
};

}  // namespace hilo::test
