// SPDX-License-Identifier: GPL-3.0-or-later
// Coulomb friction, regularised: tanh(u/slip_velocity) instead of the jump at rest, so that sticking is a creep of at most about the slip
// velocity: a force of the fraction p of the limit creeps at slip_velocity artanh(p).
//
// The force is against the slip of the step itself, f.dx >= 0 at any step size: it never feeds energy in.  Its limit follows the joint's
// reaction of the same step, whose multipliers the tangent knows (Response::by_load), so Newton converges quadratically and the
// friction is as accurate in time as the reaction: of second order.
#include <algorithm>
#include <cmath>

#include "physics/coordinates.hpp"

namespace hilo {
namespace {

struct Friction final : SpringLaw {
  double coefficient, preload, slow;
  Values lever{};
  size_t n;
  explicit Friction(const FrictionLaw& f) : coefficient(f.coefficient), preload(f.preload), slow(f.slip_velocity), n(f.lever.size()) {
    std::copy(f.lever.begin(), f.lever.end(), lever.begin());
  }
  void elastic(const Values&, const Values&, Response&) const override {}
  void viscous(const Values& x0, const Values& x1, const Interval& step, Response& out) const override {
    const double limit = coefficient * (preload + step.load), h = step.h;
    Values w{};  // lever_i^2 dx_i/dt: the slip seen by coordinate i
    double square = 0;
    for (size_t i = 0; i < n; ++i) {
      const double rate = (x1[i] - x0[i]) / h;
      w[i] = lever[i] * lever[i] * rate, square += w[i] * rate;
    }
    // g = tanh(u/slow)/u and (dg/du)/u, by series where the slip is small
    const double u = std::sqrt(square), z = u / slow, t = std::tanh(z);
    const bool small = z < 1e-2;
    const double g = (small ? 1 - z * z / 3 + 2 * z * z * z * z / 15 : t / z) / slow;
    const double dg = (small ? -2.0 / 3 + 8 * z * z / 15 : ((1 - t * t) - t / z) / (z * z)) / (slow * slow * slow);
    for (size_t i = 0; i < n; ++i) {
      out.s[i] += limit * g * w[i];
      out.by_load[i] += coefficient * g * w[i];
      out.D[i][i] += limit * g * lever[i] * lever[i] / h;
      for (size_t j = 0; j < n; ++j) out.D[i][j] += limit * dg * w[i] * w[j] / h;
    }
    out.dissipated += limit * g * square * h;
  }
};

}  // namespace

std::unique_ptr<SpringLaw> make_friction(const FrictionLaw& friction) { return std::make_unique<Friction>(friction); }

}  // namespace hilo
