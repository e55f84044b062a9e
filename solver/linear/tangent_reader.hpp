// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for a linear solver where an evaluation's tangent is only looked at.
#pragma once
#include "linear/kkt.hpp"

namespace hilo {

/// `add` is given the matrix of each clique; nothing is solved.
class TangentReader : public KktSolver {
 public:
  void structure(const Cliques&, const BlockMap&) override {}
  void zero() override {}
  void add_diagonal(int, const double*) override {}
  void sum_shared(std::span<double>) override {}
  SolveReport solve(std::span<const double>, std::span<double>, double) override { return {}; }
  std::string name() const override { return "reader"; }
};

}  // namespace hilo
