// SPDX-License-Identifier: GPL-3.0-or-later
// Where the camera stands: presets in vehicle axes (x forward, y left, z up), and the exact distance at which given points fill the
// picture.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/math.hpp"

class vtkCamera;

namespace hilo {

struct View {
  Vec3 towards{1, -1, 1};  // from the model to the camera
  Vec3 up{0, 0, 1};
  bool parallel = false;  // presets along an axis are drawn without perspective
};

/// "iso", "front", ... or "x,y,z" (direction to the camera) or "x,y,z,ux,uy,uz" (with the upward direction).  Error (exit 1) otherwise.
View parse_view(const std::string& text);
const std::vector<std::string>& view_names();

/// Gathers points, of several steps if wanted, and aims a camera so that all are seen.
class Fit {
 public:
  /// `aspect` is width / height of the box drawn in; `room` the fraction of it left free at each border.
  Fit(const View& view, double aspect, double room = 0.04);
  void add(const Vec3& x);
  bool empty() const { return !(high_[0] >= low_[0]); }
  void aim(vtkCamera* camera) const;
  Vec3 right() const { return right_; }
  Vec3 up() const { return up_; }
  Vec3 back() const { return back_; }

 private:
  View view_;
  Vec3 right_, up_, back_;            // axes of the camera; it looks along -back
  std::array<double, 2> slope_;       // half width and half height of what is seen, per distance; 0 without perspective
  std::array<double, 2> high_, low_;  // extreme values of (right + slope back), (right - slope back); the same of up
  double nearest_, farthest_;         // along back
  double aspect_, room_;
};

}  // namespace hilo
