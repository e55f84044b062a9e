// SPDX-License-Identifier: GPL-3.0-or-later
// An angle from its sine and cosine, two measures of degree two: unwrapped over any number of turns, with an exact discrete gradient.
//
// With x = (theta1 - theta0)/2, the vector d = x/sin(x) (cos(theta_mid), -sin(theta_mid))/rho over (sin, cos) has d.(e1 - e0) =
// theta1 - theta0 wherever both ends lie on the unit circle, which the rows that align the axes see to; rho, the mean radius, makes it
// the gradient of the angle off the circle as well when e0 = e1.
#pragma once
#include <cmath>

#include "base/archive.hpp"

namespace hilo {

struct Turn {
  double committed = 0;  // angle to unwrap towards [rad]
  void archive(Archive& a) { a("turn", committed); }

  /// The angle of (sin, cos) nearest to the committed one.
  double unwrap(double sine, double cosine) const {
    const double theta = std::atan2(sine, cosine), turn = 2 * M_PI;
    return theta + turn * std::round((committed - theta) / turn);
  }

  /// d over (sin, cos), its derivative by (sin, cos) at the end, and the derivative of the end angle.
  struct Gradient {
    double d[2], D[2][2], dtheta[2];
  };
  Gradient gradient(const double* e0, const double* e1) const {
    const double theta0 = unwrap(e0[0], e0[1]), theta1 = unwrap(e1[0], e1[1]), x = (theta1 - theta0) / 2, mid = (theta0 + theta1) / 2;
    const double rho1 = std::hypot(e1[0], e1[1]), rho = (std::hypot(e0[0], e0[1]) + rho1) / 2;
    const double kappa = (std::abs(x) < 1e-3 ? 1 + x * x / 6 : x / std::sin(x)) / rho;
    const double slope = (std::abs(x) < 1e-3 ? x / 6 : (std::sin(x) - x * std::cos(x)) / (2 * std::sin(x) * std::sin(x))) / rho;
    Gradient g;
    g.d[0] = kappa * std::cos(mid), g.d[1] = -kappa * std::sin(mid);
    g.dtheta[0] = e1[1] / (rho1 * rho1), g.dtheta[1] = -e1[0] / (rho1 * rho1);
    const double by_theta[2] = {slope * std::cos(mid) - kappa * std::sin(mid) / 2, -slope * std::sin(mid) - kappa * std::cos(mid) / 2};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) g.D[i][j] = by_theta[i] * g.dtheta[j] - g.d[i] / (2 * rho) * e1[j] / rho1;
    return g;
  }
};

}  // namespace hilo
