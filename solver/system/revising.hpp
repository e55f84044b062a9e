// SPDX-License-Identifier: GPL-3.0-or-later
// What is chosen within a step and not solved for: which facet a point meets.
#pragma once
#include "system/system.hpp"

namespace hilo {

/// A role that a contribution may play besides those of contribution.hpp; Newton's method asks for it.
class Revising {
 public:
  virtual ~Revising() = default;
  /// Chooses again by an answer that Newton's method has converged to; true where the equations became others by it.  May be collective;
  /// the answer need not be the same on all ranks.
  virtual bool revise(const Stage& stage) = 0;
  /// Whether it has anything to choose; the same on all ranks.
  virtual bool chooses() const { return true; }
};

/// Whether there is anything that chooses; the same on all ranks.  What solves a step otherwise than by `newton` refuses it.
inline bool revises(const System& system) {
  for (const auto& part : system.parts())
    if (const auto* revising = dynamic_cast<const Revising*>(part.get()); revising && revising->chooses()) return true;
  return false;
}

/// Whether a step has to be solved again, as its answer makes other choices.  Collective.
inline bool revise(const System& system, const Stage& stage) {
  if (!revises(system)) return false;
  bool changes = false;
  for (const auto& part : system.parts())
    if (auto* revising = dynamic_cast<Revising*>(part.get())) changes |= revising->revise(stage);
  return system.comm->max(changes ? 1 : 0) > 0;
}

}  // namespace hilo
