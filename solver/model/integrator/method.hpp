// SPDX-License-Identifier: GPL-3.0-or-later
// What a time integrator offers.  A method is a header with a struct like this, its equations in the source beside it, and a name in the
// list of model/integrators.hpp; the scene's words and keys, its checks and the page of the format, and what a run asks of the method
// come from there:
//
//   struct M : Method {
//     static constexpr std::string_view name, meaning;          the word of time.integrator, and a line for the page of the format
//     static std::vector<Param> keys();                         its keys of [time]
//     static constexpr bool keeps_energy = true;                the balance of energy closes over every step, up to what Newton leaves
//     static constexpr bool carries_state = true;               its stages take materials that remember from one state to the next
//     static std::unique_ptr<Integrator> make(const Entry& time);
//     static std::string weakness(const Entry& time, const System& system);     why it is known to fail there, or ""
//   };
//
// The scene's schema reads these headers and knows no dynamics: they include base alone.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/param.hpp"

namespace hilo {

class Integrator;
class StageIntegrator;
class System;
struct Entry;

/// What holds of a method that says nothing else.
struct Method {
  static std::vector<Param> keys() { return {}; }
  static constexpr bool keeps_energy = false, carries_state = false;
  static std::string weakness(const Entry&, const System&) { return {}; }
};

constexpr Param spectral_radius{"rho", Type::number, "1", "0.8", "spectral radius at infinite frequency", from_to(0, 1)};

}  // namespace hilo
