// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: panels of curves stacked in one picture, with axes in units and a legend beside the data.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "post/picture/colour.hpp"

namespace hilo {

class Painter;
struct Box;

struct ChartCurve {
  std::string label;
  std::vector<double> x, y;
  Rgb colour;
  double width = 2;  // of its line, 0: none, its marks alone  [unit of text, see Painter]
  double opacity = 1;
  int marker = -1;  // the n-th of an endless row of shapes, none when negative
  bool dashed = false;
};

struct Axis {
  std::string label;  // with its unit: "time [s]"
  bool log = false;
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;  // what is shown; fitted to the curves where not a number
};

/// A guide of power law y ~ x^slope through the middle of a panel with two logarithmic axes.
struct Guide {
  std::string label;
  double slope = 1;
};

/// The room between two curves over the same abscissa, filled.
struct Band {
  std::string label;
  std::vector<double> x, low, high;
  Rgb colour;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<ChartCurve> curves;
  std::vector<Guide> guides = {};
  std::vector<Band> bands = {};
};

struct Figure {
  std::string title;
  std::vector<Panel> panels;  // from top to bottom
  int width = 1280, height = 720;
};

/// Draw into a box of a page.
void draw_figure(Painter& painter, const Figure& figure, const Box& page);

/// Draw and write as PNG.  Points that are not finite, or not positive on a logarithmic axis, break a curve.
void write_chart(const Figure& figure, const std::string& path);

}  // namespace hilo
