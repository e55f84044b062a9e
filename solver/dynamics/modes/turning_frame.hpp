// SPDX-License-Identifier: GPL-3.0-or-later
// Frames from which small motions about a spinning state are seen: every block of unknowns is turned at a constant rate of its own.  Where
// the equations later are those of now, turned, they have constant coefficients seen from there.
#pragma once
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

class TurningFrame {
 public:
  /// `rates`: of each block of unknowns [rad/s]; `all`: that there are.
  TurningFrame(std::vector<Vec3> rates, const std::vector<Vec3>& all);
  /// It is that of space.
  bool stands() const { return stands_; }
  /// The blocks of x by their rates, w x.
  Eigen::VectorXd across(const Eigen::VectorXd& x) const;
  /// Blocks a while later (`turned_further`), of each column.
  Eigen::MatrixXd turned(Eigen::MatrixXd shapes) const;
  /// What motions that joints and motions allow now break at the pose q of a while later, turned by then: 'joint "j"', or "".
  std::string broken_row(const System& system, const Config& q, const Eigen::MatrixXd& shapes) const;

 private:
  std::vector<Vec3> rates_;
  std::vector<Mat3> turn_;
  bool stands_;
};

/// By what something of the rate w turns in that while, between half a radian and one: what has another rate turns by another angle.
Mat3 turned_further(const Vec3& w, const std::vector<Vec3>& all);

/// Space; what spins turns along, each body by its rate; where there is one rate alone, everything turns along.
std::vector<TurningFrame> turning_frames(const System& system, const State& state);

}  // namespace hilo
