// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of unknowns and residuals about a state, without multipliers.
#pragma once
#include <Eigen/Dense>
#include <algorithm>

#include "dynamics/linear_step.hpp"
#include "dynamics/state.hpp"

namespace hilo {

class AboutState {
 public:
  AboutState(const System& system, KktSolver& solver, const State& state)
      : system_(system), solver_(solver), state_(state), n_(3 * system.first_joint_block()) {
    combine(zero_, {{0, &state.q}});
  }

 protected:
  /// As increments of all unknowns (3 x n_blocks).
  std::vector<double> padded(const Eigen::VectorXd& x) const {
    std::vector<double> z(3 * static_cast<size_t>(system_.n_blocks()), 0.0);
    std::copy(x.begin(), x.end(), z.begin());
    return z;
  }
  /// As velocities or accelerations at q.
  Config rates(const Config& q, const Eigen::VectorXd& x) const {
    Config v = zero_;
    system_.add_rates(v, q, padded(x));
    return v;
  }
  /// Forces on what no law moves.  Collective.
  Eigen::VectorXd free_part(std::vector<double>& r) const {
    complete(system_, solver_, r);
    return Eigen::Map<const Eigen::VectorXd>(r.data(), n_);
  }

  const System& system_;
  KktSolver& solver_;
  const State& state_;
  Eigen::Index n_;
  Config zero_;
};

}  // namespace hilo
