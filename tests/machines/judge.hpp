// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a run from outside: energy, momentum, joints and turns recomputed from the positions and velocities in the results file and
// from the data of the machine.  It shares no line with the solver but the readers of files,
// the shape functions of cells and the hourglass energy of reduced hexahedra.
#pragma once
#include <string>
#include <vector>

#include "machines/machine.hpp"

namespace hilo::test {

struct Limits {
  double energy = 1e-8;    // of a run, and of each step, over the energies at hand
  double joint = 1e-9;     // lengths over the scene's length, directions as they are
  double momentum = 1e-9;  // over the largest momentum
  double turn = 2.000001;  // of a body in one accepted step: the solver refuses more than 2 rad (dynamics/audit)
};

/// The worst of each kind found in a run; an entry of `wrong` for each limit that was passed.
struct Verdict {
  double energy = 0, step_energy = 0, joint = 0, momentum = 0, angular = 0, turn = 0, least_det = 1e300;
  std::vector<std::string> wrong;
  double fastest = 0;  // largest spin at the start [rad/s]
  bool right() const { return wrong.empty(); }
  std::string text() const;
};
Verdict judge(const Machine& m, const std::string& results, const Limits& limits = {});

/// What became of a scene: its exit code, and the verdict where it ran to its end.
struct Outcome {
  int exit = 0;
  bool complete = false;
  std::string reason;
  double step = 0, t = 0;
  long steps = 0, cuts = 0;
  Verdict verdict;
};
/// Runs a machine in this process, as hilo-solve does.
Outcome run_machine(const Machine& m, const TimeAxis& time, const std::string& folder, const Limits& limits = {});
/// Positions of all probes, row by row, at the end of the run in `folder`; empty where there is no run.
std::vector<Vec3> end_positions(const Machine& m, const std::string& folder);
/// A step at which nothing turns, swings or oscillates by more than a few degrees: from the speeds after the projection on the joints.
double sensible_step(const Machine& m, const std::string& folder);

}  // namespace hilo::test
