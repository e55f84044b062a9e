// SPDX-License-Identifier: GPL-3.0-or-later
// Stops: an elastic limit that gives its energy back exactly, and a damper that keeps what the restitution asks.
//
// A mass m that hits f = k d (1 + alpha dd/dt) at speed v obeys u du/dd = -(k/m) d (1 + alpha u).  The penetration d is 0 at the start and
// at the end, so int u/(1 + alpha u) du from v to -e v vanishes:  y (1 + e) = ln((1 + y)/(1 - e y)),  y = alpha v.  Mass and stiffness drop
// out; near e = 1 it is the y = 3/2 (1 - e) of [hunt-crossley-1975].
#include <cmath>
#include <utility>

#include "physics/coordinates.hpp"
#include "physics/impact_loss.hpp"

namespace hilo {

double hunt_crossley(double e) {
  e = std::max(e, least_restitution);  // y tends to 1/e
  if (e > 1 - 1e-4) return 1.5 * (1 - e);
  const auto f = [e](double y) { return y * (1 + e) - std::log1p(y) + std::log1p(-e * y); };
  double low = 0.5 * (1 - e * e) / (1 + e * e * e), high = 1 / e;  // f > 0 below the root: f = (1 - e^2) y^2/2 - (1 + e^3) y^3/3 + ...
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double mid = (low + high) / 2;
    (f(mid) > 0 ? low : high) = mid;
  }
  return (low + high) / 2;
}

namespace {

struct Stop final : SpringLaw {
  double lower, upper, k, slow;
  ImpactLoss loss;
  double towards_lower = 0, towards_upper = 0;  // speed at the last accepted state before contact, and the largest since
  explicit Stop(const StopLaw& s) : lower(s.lower), upper(s.upper), k(s.stiffness), slow(s.rest_speed), loss(s.restitution) {}

  /// Signed depth: positive beyond the upper, negative beyond the lower limit.
  double depth(double x) const { return x > upper ? x - upper : x < lower ? x - lower : 0; }
  double potential(double x) const { return k / 2 * depth(x) * depth(x); }
  /// Quotient (W1 - W0)/(x1 - x0) and its derivative by x1.
  std::pair<double, double> quotient(double x0, double x1) const {
    if ((x0 >= upper && x1 >= upper) || (x0 <= lower && x1 <= lower)) return {k * (depth(x0) + depth(x1)) / 2, k / 2};
    if (depth(x0) == 0 && depth(x1) == 0) return {0, 0};
    const double s = (potential(x1) - potential(x0)) / (x1 - x0);
    return {s, (k * depth(x1) - s) / (x1 - x0)};
  }
  void elastic(const Values& x0, const Values& x1, Response& out) const override {
    const auto [s, D] = quotient(x0[0], x1[0]);
    out.s[0] += s, out.D[0][0] += D;
    out.energy += potential(x1[0]);
  }
  void viscous(const Values& x0, const Values& x1, const Interval& step, Response& out) const override {
    if (!loss.any() || step.no_impacts) return;
    const auto [s, D] = quotient(x0[0], x1[0]);
    if (s == 0) return;
    const double into = std::copysign(1, s) / step.h, rate = into * (x1[0] - x0[0]);
    const double speed = std::max(s > 0 ? towards_upper : towards_lower, slow), c = loss.factor(rate / speed);
    const bool between = c > loss.least && c < 1 + loss.y;
    const double f = s * (c - 1);
    out.s[0] += f;
    out.D[0][0] += D * (c - 1) + (between ? s * loss.y * into / speed : 0);
    out.dissipated += f * (x1[0] - x0[0]);
  }
  bool needs_rate() const override { return loss.any(); }
  bool only_presses() const override { return true; }
  void archive(Archive& a) override { a("stop", towards_lower, towards_upper); }
  /// What is pressed faster than its contact began begins anew with its own speed.
  void commit(const Values& x, const Values& rate) override {
    const double d = depth(x[0]);
    double& towards = (d == 0 ? rate[0] : d) > 0 ? towards_upper : towards_lower;
    towards = d == 0 ? std::abs(rate[0]) : std::max(towards, d > 0 ? rate[0] : -rate[0]);
  }
};

}  // namespace

std::unique_ptr<SpringLaw> make_stop(const StopLaw& stop) { return std::make_unique<Stop>(stop); }

}  // namespace hilo
