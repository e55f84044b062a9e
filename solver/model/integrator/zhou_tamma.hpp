// SPDX-License-Identifier: GPL-3.0-or-later
// Generalized single-step single-solve family of Zhou and Tamma, U0 (zero-order overshoot in displacement) or V0 (in velocity)
// [zhou-tamma-2004]; averaged: stress at the averaged strain, B((1-w) q0 + w q1)^T C [(1-w) E0 + w E1].
#pragma once
#include "model/integrator/method.hpp"

namespace hilo {

struct U0 : Method {
  static constexpr std::string_view name = "U0", meaning = "no overshoot in displacements, damps as its three radii ask";
  static std::vector<Param> keys() {
    return {spectral_radius,
            {"rho1", Type::number, "1", "", "principal spectral radius; rho when absent", from_to(0, 1)},
            {"rho2", Type::number, "1", "", "second principal spectral radius; rho when absent", from_to(0, 1)},
            {"rho3", Type::number, "1", "", "spurious spectral radius; rho when absent", from_to(0, 1)},
            {"averaged", Type::boolean, "", "true", "stress of the averaged strain, not of the averaged position"}};
  }
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};
struct V0 : U0 {
  static constexpr std::string_view name = "V0", meaning = "no overshoot in velocities, damps as its three radii ask";
  static std::unique_ptr<Integrator> make(const Entry& time);
  static std::string weakness(const Entry& time, const System& system);
};

}  // namespace hilo
