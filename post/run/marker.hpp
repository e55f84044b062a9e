// SPDX-License-Identifier: GPL-3.0-or-later
// A marker: where something named of a run is and how it is turned. It is a region, a set, a probe, a sensor, a body, or a point.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/math.hpp"
#include "post/run/playback.hpp"

namespace hilo {

/// A rigid motion: x = to + R (X - from).
struct Pose {
  Mat3 R = Mat3::Identity();
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Vec3 operator()(const Vec3& X) const { return to + R * (X - from); }
  Vec3 back(const Vec3& x) const { return from + R.transpose() * (x - to); }
};
/// The rigid motion nearest to the displacement of points (least squares); no turn where they lie on a line.
Pose best_pose(const std::vector<Vec3>& X, const std::vector<Vec3>& x);

class Marker {
 public:
  /// `name` is that of a region, set, probe, sensor or body, or "x,y,z" for the nearest node.  Error at `option`, with a suggestion.
  Marker(RunFile& run, const std::string& name, const std::string& option);

  /// Pose at a time, given the positions of the nodes then.
  Pose pose(double t, const std::vector<Vec3>& x) const;
  Vec3 reference() const { return reference_; }
  bool of_nodes() const { return !nodes_.empty(); }
  /// Its way from the start to t: that of a probe or body at each step, else at the outputs.
  std::vector<Vec3> way(double t, Playback& playback);

 private:
  const Mesh* mesh_;
  std::vector<std::int64_t> nodes_;
  std::optional<Series> series_;  // of a probe or body
  std::vector<Vec3> body_;        // reference points of a body
  std::vector<Vec3> passed_;      // where it was at the outputs
  Vec3 reference_ = Vec3::Zero();
};

/// A history at a time, linear between its rows.
std::vector<double> at_time(const Series& s, double t);

}  // namespace hilo
