// SPDX-License-Identifier: GPL-3.0-or-later
// A run at any time: its outputs as stored, and between two of them positions by the cubic through positions and velocities (linear where
// a run holds no velocities), fields linearly.
//
// An analysis of modes has no time: from t = k on, for one unit, mode k swings once about the state of rest, from its turning point at t =
// k. Shapes, a hundred thousandth of the scene in the file, are drawn `drawn_larger` times larger.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/math.hpp"
#include "post/run/run_file.hpp"

namespace hilo {

class Playback {
 public:
  explicit Playback(RunFile& run);

  RunFile& run() const { return run_; }
  static constexpr double drawn_larger = 6000;
  bool has_modes() const { return !run_.shapes.empty(); }
  double first() const { return run_.steps[has_modes() && run_.steps.size() > 1 ? 1 : 0].t; }  // [s]
  double last() const { return run_.steps.back().t + (has_modes() ? 1 - 1e-6 : 0); }
  /// "t = 3.200 ms", "mode 3, 51.2 Hz", or "state 7, 0.35 of the loads" of a path.
  std::string caption(double t) const;
  /// Current positions of all nodes at a time within the run  (n_nodes)  [m].
  const std::vector<Vec3>& positions(double t);
  /// A field at that time, row by row, and its number of columns; displacements are those of positions().
  RunFile::Field field(double t, const std::string& array);

 private:
  /// Outputs around a time: both the same where it is that of an output (to 1e-6 of their distance).
  struct Between {
    size_t a, b;
    double w;  // 0 at a, 1 at b
  };
  Between between(double t) const;
  const RunFile::Field& stored(size_t step, const std::string& array);
  RunFile::Field linear(const Between& at, const std::string& array);
  RunFile::Field of_mode(double t, const std::string& array, double larger);

  struct Kept {
    size_t step;
    std::string array;
    RunFile::Field field;
  };
  RunFile& run_;
  const Mesh& mesh_;
  std::optional<Series> path_;  // share of the loads, its rise, eigenvalues below zero
  std::vector<Kept> kept_;      // of the two outputs last asked for
  std::vector<Vec3> x_;         // positions at x_time_
  double x_time_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace hilo
