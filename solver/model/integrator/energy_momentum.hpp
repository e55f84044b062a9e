// SPDX-License-Identifier: GPL-3.0-or-later
// Energy-momentum: mid-point inertia and constraint gradients, discrete-gradient stress [simo-tarnow-1992, betsch-steinmann-2001].
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct EnergyMomentum : Method {
  static constexpr std::string_view name = "energy-momentum", meaning = "keeps energy and momentum, of second order";
  static std::vector<Param> keys() {
    return {{"dissipation", Type::number, "1", "0", "chi, damping of what steps do not resolve in flexible parts, of order two",
             from_to(0, 100)}};
  }
  static constexpr bool keeps_energy = true, carries_state = true;
  static std::unique_ptr<Integrator> make(const Entry& time);
};

}  // namespace hilo
