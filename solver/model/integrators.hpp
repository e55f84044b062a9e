// SPDX-License-Identifier: GPL-3.0-or-later
// The time integrators that the program knows: one file each, one name here.  A program outside the tree adds its own by
// add_integrator<M>() (dynamics/integrator_kinds).
#pragma once
#include "base/registry.hpp"
#include "model/integrator/bathe.hpp"
#include "model/integrator/bdf2.hpp"
#include "model/integrator/energy_momentum.hpp"
#include "model/integrator/gauss.hpp"
#include "model/integrator/generalized_alpha.hpp"
#include "model/integrator/mid_point.hpp"
#include "model/integrator/radau.hpp"
#include "model/integrator/zhou_tamma.hpp"

namespace hilo {

template <class... M>
struct Methods {};
using Integrators = Methods<EnergyMomentum, MidPoint, GeneralizedAlpha, Newmark, Hht, Wbz, U0, V0, Bathe, Bdf2, Radau, Gauss>;

/// What a scene may say of an integrator.
struct IntegratorWords {
  std::string_view name, meaning;
  std::vector<Param> keys;  // of [time]
};
template <class M>
IntegratorWords integrator_words_of() {
  return {M::name, M::meaning, M::keys()};
}

/// Of all of them, the default first; closed once the scene's schema is made of it.
inline Registry<IntegratorWords>& integrator_words() {
  static auto words = []<class... M>(Methods<M...>) {
    return Registry<IntegratorWords>("integrator", {integrator_words_of<M>()...});
  }(Integrators{});
  return words;
}

}  // namespace hilo
