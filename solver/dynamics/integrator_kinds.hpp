// SPDX-License-Identifier: GPL-3.0-or-later
// What makes an integrator of the word of a scene, and what is known of a method before it is made.
#pragma once
#include "model/integrators.hpp"
#include "model/scene.hpp"

namespace hilo {

struct IntegratorKind {
  std::string_view name;
  bool keeps_energy, carries_state;
  std::unique_ptr<Integrator> (*make)(const Entry& time);
  std::string (*weakness)(const Entry& time, const System& system);
};
template <class M>
IntegratorKind integrator_kind_of() {
  return {M::name, M::keeps_energy, M::carries_state, &M::make, &M::weakness};
}

Registry<IntegratorKind>& integrator_kinds();
/// One more, from outside the tree, before the first scene is read: what M offers says model/integrator/method.
template <class M>
void add_integrator() {
  integrator_words().add(integrator_words_of<M>());
  integrator_kinds().add(integrator_kind_of<M>());
}

/// The one that [time] asks for.
const IntegratorKind& integrator_kind(const Entry& time);
/// Keys of [time] that are given and belong to other methods.
void warn_of_idle_keys(const Entry& time);
std::unique_ptr<Integrator> make_integrator(const Entry& time);

}  // namespace hilo
