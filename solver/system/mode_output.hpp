// SPDX-License-Identifier: GPL-3.0-or-later
// What an analysis of modes puts out beside displacements and forces: a row for every mode.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

struct NaturalMode {
  double omega2 = 0;         // squared circular frequency, below zero where the state is not stable  [1/s^2]
  double pole2 = 0;          // the same with damping: the product of the two poles, or minus the square of the one that grows  [1/s^2]
  double damping = 0;        // ratio to the critical one
  Vec6 mass = Vec6::Zero();  // effective: along x, y, z [kg], about axes through the centre of mass [kg m^2]
  Vec6 part = Vec6::Zero();  // phi.M i, i a motion of the whole scene along and about these: with signs, mass where squared; 0 of a whirl
  double error = 0;          // of the shape: what the equations of motion leave of it
  double amplitude = 0;      // with which a mode of unit mass is put out [m kg^0.5]
  Vec6 drag = Vec6::Zero();  // phi.C i along x, y, z: of mass-proportional damping, and of dampers to what stands still too  [kg^0.5/s]
  double load = 0;           // phi.F of the loads at the start; 0 of a whirl  [N kg^-0.5]
  double pull = 0;           // phi.M a, a the acceleration of a state that is not at rest; 0 of a whirl  [N kg^-0.5]
  std::vector<double> coupling;  // phi.C phi_k of all modes [1/s]
  /// [Hz]; of an unstable mode minus its rate of growth over 2 pi.
  double frequency() const;
};

/// Takes part in no equation: it holds the row that is written next.
class ModeOutput final : public Contribution, public Observer {
 public:
  explicit ModeOutput(int most) : most_(most) {}
  NaturalMode now;
  std::vector<Output> outputs() const override {
    return {{.group = "", .name = "mode", .n_end = 10},          {.group = "", .name = "participation", .n_end = 6},
            {.group = "", .name = "mode_stiffness", .n_end = 1}, {.group = "", .name = "mode_damping", .n_end = most_},
            {.group = "", .name = "mode_drag", .n_end = 6},      {.group = "", .name = "mode_load", .n_end = 1}};
  }
  void observe(const Sight& at) override;

 private:
  int most_;  // modes that are asked for
};

}  // namespace hilo
