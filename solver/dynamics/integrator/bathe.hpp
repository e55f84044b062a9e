// Composite of trapezoidal rule and three-point backward difference [bathe-2007].
#pragma once
#include "dynamics/integrator/method.hpp"

namespace hilo {

struct Bathe : Method {
  static constexpr std::string_view name = "bathe",
                                    meaning = "trapezoidal rule, then backward difference: two solves a step, damps strongly";
  static std::unique_ptr<Integrator> make(const Entry& time);
};

std::unique_ptr<StageIntegrator> make_bathe();

}  // namespace hilo
