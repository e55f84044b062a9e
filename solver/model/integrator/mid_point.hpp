// SPDX-License-Identifier: GPL-3.0-or-later
// Mid-point rule: everything at (q0 + q1)/2, stress included.
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct MidPoint : Method {
  static constexpr std::string_view name = "mid-point", meaning = "everything at the middle of the step, stress too";
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};

}  // namespace hilo
