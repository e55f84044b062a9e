// SPDX-License-Identifier: GPL-3.0-or-later
// What an analysis of a path puts out beside displacements and forces: a row for every state of equilibrium.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

struct PathPoint {
  double share = 0;  // of the loads
  double rise = 1;   // of that share along the path, whose length is measured in shares and in first displacements
  double below = 0;  // eigenvalues of the tangent below zero, 0: stable; NaN: not known
};

/// Takes part in no equation: it holds the row that is written next.
class LoadPath final : public Contribution, public Observer {
 public:
  PathPoint now;
  std::vector<Output> outputs() const override { return {{.group = "", .name = "path", .n_end = 3}}; }
  void observe(const Sight& at) override { at.end.insert(at.end.end(), {now.share, now.rise, now.below}); }
};

}  // namespace hilo
