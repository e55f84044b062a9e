// SPDX-License-Identifier: GPL-3.0-or-later
// Two-step backward difference formula at changing steps, started by one step of backward Euler.
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct Bdf2 : Method {
  static constexpr std::string_view name = "bdf2", meaning = "two-step backward difference, damps strongly";
  static constexpr bool carries_state = true;
  static std::unique_ptr<Integrator> make(const Entry& time);
};

}  // namespace hilo
