// SPDX-License-Identifier: GPL-3.0-or-later
// What an analysis of buckling puts out beside displacements and forces: a row for every shape.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

struct BucklingMode {
  double factor = 0;  // of the loads, at which the shape appears; below zero: where they are reversed
  double error = 0;   // of the shape: what the equations leave of it, in the norm of the stiffness
};

/// Takes part in no equation: it holds the row that is written next.
class BucklingModes final : public Contribution, public Observer {
 public:
  BucklingMode now;
  std::vector<Output> outputs() const override { return {{.group = "", .name = "buckling", .n_end = 2}}; }
  void observe(const Sight& at) override { at.end.insert(at.end.end(), {now.factor, now.error}); }
};

}  // namespace hilo
