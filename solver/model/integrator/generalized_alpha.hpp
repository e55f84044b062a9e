// SPDX-License-Identifier: GPL-3.0-or-later
// Generalized-alpha for index 3 in the form of Arnold and Bruls [arnold-bruls-2007]; Newmark, HHT and WBZ are members of it.
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct GeneralizedAlpha : Method {
  static constexpr std::string_view name = "generalized-alpha", meaning = "damps what a step does not resolve as rho asks, of second order";
  static std::vector<Param> keys() { return {spectral_radius}; }
  static constexpr bool carries_state = true;
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};
struct Newmark : GeneralizedAlpha {
  static constexpr std::string_view name = "newmark", meaning = "generalized-alpha without shifts, by gamma and beta";
  static std::vector<Param> keys() {
    return {{"gamma", Type::number, "1", "0.5", "Newmark's gamma", from_to(0.5, 2)},
            {"beta", Type::number, "1", "", "Newmark's beta; (gamma + 1/2)^2/4 when absent", from_to(1e-3, 10)}};
  }
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};
struct Hht : GeneralizedAlpha {
  static constexpr std::string_view name = "hht", meaning = "generalized-alpha with alpha_m = 0, rho from 1/2 to 1";
  static std::unique_ptr<Integrator> make(const Entry& time);
};
struct Wbz : GeneralizedAlpha {
  static constexpr std::string_view name = "wbz", meaning = "generalized-alpha with alpha_f = 0";
  static std::unique_ptr<Integrator> make(const Entry& time);
};

}  // namespace hilo
