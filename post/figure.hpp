// Charts: panels of curves stacked in one picture, with axes in units and a legend beside the data.
#pragma once
#include <string>
#include <vector>

#include "post/colour.hpp"

namespace hilo {

struct Curve {
  std::string label;
  std::vector<double> x, y;
  Rgb colour;
  double width = 2;  // [unit of text, see Painter]
  double opacity = 1;
  bool markers = false, dashed = false;
};

struct Axis {
  std::string label;  // with its unit: "time [s]"
  bool log = false;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
};

struct Figure {
  std::string title;
  std::vector<Panel> panels;  // from top to bottom
  int width = 1280, height = 720;
};

/// Draw and write as PNG.  Points that are not finite, or not positive on a logarithmic axis, break a curve.
void write_chart(const Figure& figure, const std::string& path);

}  // namespace hilo
