// SPDX-License-Identifier: GPL-3.0-or-later
// Impulses: instants at which laws of motion ask for a jump of velocities, as at every point of a history that is interpolated linearly.
#pragma once
#include <string>

#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

struct Impulse {
  std::string by;         // `motion "drive"`, the one that jumps most; empty: no law jumps
  double speed = 0;       // how far, largest over its points, or rate of its joint
  const char* unit = "";  // of speed
  double work = 0;        // change of the kinetic energy [J]
  double change = 0;      // largest of what is free [m/s]
  std::string text(double t) const;
};

/// Velocities of the state from s.t on: those of the laws, and of the rest what masses and joints make of it.  At the start the velocities
/// before are those given in the scene.
Impulse strike(const System& system, KktSolver& solver, State& s);

/// The impulses of a run, told as they come.
class Impulses {
 public:
  Impulse strike(const System& system, KktSolver& solver, State& s, bool talk);
  Json json() const;
  void archive(Archive& a) { a("impulses", count_, work_); }

 private:
  long count_ = 0;
  double work_ = 0;  // [J]
};

}  // namespace hilo
