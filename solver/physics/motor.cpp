// SPDX-License-Identifier: GPL-3.0-or-later
// Motors: a force (torque) that depends on the rate of a coordinate, pushing it along; b is driven, a takes the reaction.
#include <algorithm>
#include <utility>

#include "physics/coordinates.hpp"

namespace hilo {
namespace {

struct Motor final : SpringLaw {
  std::vector<double> rate, force;
  explicit Motor(MotorLaw m) : rate(std::move(m.rate)), force(std::move(m.force)) {}
  /// Force and slope at a rate; beyond the table its first or last segment goes on.
  std::pair<double, double> at(double r) const {
    if (rate.size() == 1) return {force[0], 0};
    const auto above = std::upper_bound(rate.begin() + 1, rate.end() - 1, r);
    const size_t i = static_cast<size_t>(above - rate.begin());
    const double slope = (force[i] - force[i - 1]) / (rate[i] - rate[i - 1]);
    return {force[i - 1] + slope * (r - rate[i - 1]), slope};
  }
  void elastic(const Values&, const Values&, Response&) const override {}
  void viscous(const Values& x0, const Values& x1, const Interval& step, Response& out) const override {
    const auto [f, slope] = at((x1[0] - x0[0]) / step.h);
    out.s[0] -= step.factor * f;
    out.D[0][0] -= step.factor * slope / step.h;
    out.supplied += step.factor * f * (x1[0] - x0[0]);
  }
};

}  // namespace

std::unique_ptr<SpringLaw> make_motor(MotorLaw motor) { return std::make_unique<Motor>(std::move(motor)); }

}  // namespace hilo
