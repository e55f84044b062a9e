// SPDX-License-Identifier: GPL-3.0-or-later
// Composite of trapezoidal rule and three-point backward difference [bathe-2007].
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct Bathe : Method {
  static constexpr std::string_view
      name = "bathe",
      meaning =
          "trapezoidal rule, then backward difference: two solves a step, damps strongly; joint forces are of first "
          "order";
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};

}  // namespace hilo
