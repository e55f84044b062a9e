// SPDX-License-Identifier: GPL-3.0-or-later
// Three-stage Gauss collocation with rates in the rows and the strain as a variable (docs/gauss.md).
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct Gauss : Method {
  static constexpr std::string_view name = "gauss", meaning = "keeps energy and momentum, of sixth order; no contact or plasticity";
  static constexpr bool keeps_energy = true;
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};

}  // namespace hilo
