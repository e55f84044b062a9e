// SPDX-License-Identifier: GPL-3.0-or-later
// What an analysis of modes puts out beside displacements and forces: a row for every mode.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

struct NaturalMode {
  double omega2 = 0;         // squared circular frequency, below zero where the state is not stable  [1/s^2]
  double damping = 0;        // ratio to the critical one
  Vec6 mass = Vec6::Zero();  // effective: along x, y, z [kg], about axes through the centre of mass [kg m^2]
  Vec6 part = Vec6::Zero();  // phi.M i, i a motion of the whole scene along and about these: with signs, mass where squared; 0 of a whirl
  double error = 0;          // of the shape: what the equations of motion leave of it
  double amplitude = 0;      // with which a mode of unit mass is put out [m kg^0.5]
  /// [Hz]; of an unstable mode minus its rate of growth over 2 pi.
  double frequency() const;
};

/// Takes part in no equation: it holds the row that is written next.
class NaturalModes final : public Contribution {
 public:
  NaturalMode now;
  void evaluate(Pass&) const override {}
  void tie(Ties&) const override {}
  std::vector<Output> outputs() const override {
    return {{.group = "", .name = "mode", .n_end = 10}, {.group = "", .name = "participation", .n_end = 6}};
  }
  void add_end_values(const Config& q, const Config& v, std::vector<double>& out) const override;
};

}  // namespace hilo
