// SPDX-License-Identifier: GPL-3.0-or-later
// Symbols of mechanisms, and names beside them that do not overlap.
#pragma once
#include <vector>

#include "post/picture/picture.hpp"
#include "post/scene/scene_items.hpp"

class vtkRenderer;

namespace hilo {

/// From the model to pixels, as the camera of a stage in `box` sees it.
class Projection {
 public:
  Projection(vtkRenderer* stage, const Box& box);
  Vec2 operator()(const Vec3& x) const;
  /// A direction in pixels per unit length: 1 when seen from the side, 0 when along the line of sight.
  Vec2 direction(const Vec3& at, const Vec3& along) const;

 private:
  Eigen::Matrix4d matrix_;
  Box box_;
  double metre_;  // model length of one pixel near the focal point
};

/// A symbol about `at`: `along` and `above` are its directions (length at most one), `to` the far end of links and coils; `size` in pixels.
void draw_glyph(Painter& p, Glyph glyph, const Vec2& at, const Vec2& along, const Vec2& above, const Vec2& to, const Rgb& colour,
                double size);

struct Label {
  Vec2 anchor;
  std::string text;
  Rgb colour;
};
/// Names near their anchors, inside `box`, kept off each other and off the anchors; those moved away get a thin line.
void draw_labels(Painter& p, const std::vector<Label>& labels, const Box& box, double size);

}  // namespace hilo
