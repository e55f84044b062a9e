// SPDX-License-Identifier: GPL-3.0-or-later
// Three-stage Radau IIA for index 3, all stages solved together; for references, serial [hairer-wanner-1996].
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct Radau : Method {
  static constexpr std::string_view name = "radau",
                                    meaning = "Radau IIA of three stages, of fifth order in positions, serial, for references";
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};

}  // namespace hilo
