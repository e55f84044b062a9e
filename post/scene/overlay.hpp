// SPDX-License-Identifier: GPL-3.0-or-later
// What stands around a 3-D picture: title, colour bar, legend, axes.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/math.hpp"
#include "post/picture/picture.hpp"

namespace hilo {

/// Boxes of a picture: the model, and the column beside it.
struct Frame {
  Box model, side;
};
Frame frame_of(int width, int height, double side_width, bool two_titles);

void draw_title(Painter& p, const std::string& title, const std::string& line);

struct ColourBar {
  std::string quantity, unit;  // "von Mises stress", "MPa"
  ColourMap map = ColourMap::viridis;
  double low = 0, high = 1;    // of the colours, in `unit`
  double least = 0, most = 0;  // in this picture, in `unit`; beyond the range the bar gets a point
  std::vector<double> marks;   // values of iso-surfaces, in `unit`
  std::string neutral;         // what the neutral tone means; "" when it is not used
};
void draw_colour_bar(Painter& p, const Box& side, const ColourBar& bar);

/// A line of a legend: a symbol drawn around a point (a patch of `colour` when there is none) and its meaning; or a heading.
struct LegendEntry {
  std::string label;
  Rgb colour;
  std::function<void(Painter&, const Vec2&)> symbol;
  bool heading = false;
};
/// Entries from the top of `side`; letters shrink and the end is counted ("and 12 more") when they do not fit.
void draw_legend(Painter& p, const Box& side, const std::string& title, const std::vector<LegendEntry>& entries);

/// Directions of x, y and z as seen by a camera with axes right and up, at the lower left.
void draw_axes_cross(Painter& p, const Vec3& right, const Vec3& up, const Vec3& back);

/// An arrow from a to b with a filled head.
void draw_arrow(Painter& p, const Vec2& a, const Vec2& b, const Rgb& colour, double width);

}  // namespace hilo
