// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems of Newton steps, by hilo's own assembly.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "linear/kkt.hpp"

namespace hilo::bench {

struct Case {
  const Cliques* cliques = nullptr;
  const BlockMap* map = nullptr;
  std::function<void(KktSolver&)> fill;  // zero, and add this rank's share
  std::vector<double> b;                 // full values of the local blocks
  std::shared_ptr<void> keeps;           // what they refer to
};

/// The tangent of energy-momentum in the drawn position at rest, for a step of h [s], and its residual under the loads at time `t`.
Case scene_case(const std::string& scene, const std::string& mesh, double h, double t, const Comm& comm);

/// A block of n x n x n cubes between two bodies, stiffness times `jump` in every other of `regions` scattered ones; a random right-hand
/// side.
Case block_case(int n, double cfl, double jump, int regions, const Comm& comm);

}  // namespace hilo::bench
