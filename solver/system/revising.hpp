// SPDX-License-Identifier: GPL-3.0-or-later
// Choices within a step that a system's answers make others.
#pragma once
#include <algorithm>

#include "system/system.hpp"

namespace hilo {

/// Whether there is anything that chooses; the same on all ranks.  What solves a step otherwise than by `newton` refuses it.
inline bool revises(const System& system) { return std::ranges::any_of(system.all<Revising>(), &Revising::chooses); }

/// Whether a step has to be solved again, as its answer makes other choices.  Collective.
inline bool revise(const System& system, const Stage& stage) {
  if (!revises(system)) return false;
  bool changes = false;
  for (Revising* part : system.all<Revising>()) changes |= part->revise(stage);
  return system.comm->max(changes ? 1 : 0) > 0;
}

}  // namespace hilo
