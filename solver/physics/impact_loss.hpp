// SPDX-License-Identifier: GPL-3.0-or-later
// What restitution does to the force of a contact or a stop [hunt-crossley-1975].
#pragma once
#include <algorithm>

#include "physics/contact/jet.hpp"

namespace hilo {

/// What rebounds with less of its speed is taken to stay.
inline constexpr double least_restitution = 0.01;
/// y = alpha v of the damper f = k d (1 + alpha dd/dt) for which a mass that hits at speed v leaves at restitution * v.
double hunt_crossley(double restitution);
/// What restitution multiplies the elastic force by: 1 + y rate/v, of an impact from 1 + y as it begins to 1 - restitution y as it ends. It
/// is never outside, so that what was pressed without an impact comes back as what leaves after one.
struct ImpactLoss {
  double y = 0, least = 1;
  ImpactLoss() = default;
  explicit ImpactLoss(double restitution)
      : y(hunt_crossley(restitution)), least(std::max(0., 1 - std::max(restitution, least_restitution) * y)) {}
  bool any() const { return y > 0; }
  /// At a rate into the stop, over the speed v.
  template <class T>
  T factor(const T& rate) const {
    if (value(rate) >= 1) return T(1 + y);
    const T c = T(1.0) + T(y) * rate;
    return value(c) > least ? c : T(least);
  }
};

}  // namespace hilo
