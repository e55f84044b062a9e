// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn above a run: arrows of the forces of its joints and springs, and the ways of points.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "post/run/marker.hpp"
#include "post/scene/frame_options.hpp"
#include "post/scene/glyphs.hpp"

namespace hilo {

/// The force of one joint, spring, stop, motor, friction or held set: history, and what turns and carries it.
struct ForceArrow {
  std::string name;
  Rgb colour;
  Series history;
  Mat3 frame = Mat3::Identity();                           // axes of the history in the reference position
  Vec3 at = Vec3::Zero();                                  // point on b in the reference position  [m]
  std::optional<Marker> a, b;                              // none: ground
  Vec3 force(double t, const std::vector<Vec3>& x) const;  // on b, inertial axes  [N]
  Vec3 point(double t, const std::vector<Vec3>& x) const;  // [m]
};
/// Those of a run that match one of the globs, by name ("trunnion") or with their group ("joint.trunnion").
std::vector<ForceArrow> force_arrows(RunFile& run, const std::vector<std::string>& globs);

class Annotations {
 public:
  Annotations(const FrameOptions& o, RunFile& run);
  /// The largest force drawn at these times  [N].
  double largest_force(const std::vector<double>& times) const;
  /// What the picture must hold besides the model: the ways up to t.
  void frame(double t, Playback& playback, const Pose& drawn, std::vector<Vec3>& extremes);
  /// Arrows of `metres` for each newton, ways up to t; `back` takes true positions to drawn ones.
  void draw(Painter& p, const Projection& project, const Box& box, double t, Playback& playback, const Pose& drawn, double metres);

 private:
  std::vector<ForceArrow> arrows_;
  std::vector<std::pair<std::string, Marker>> traced_;
};

/// A force in N, kN or MN.
std::string force_text(double newton);
/// The largest of 1, 2 or 5 times a power of ten that is no more than x.
double round_below(double x);

}  // namespace hilo
