// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces and lines on a lit stage.
#pragma once
#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "post/picture/colour.hpp"
#include "post/surface/skin.hpp"

namespace hilo {

/// Even light from all sides, so that no face is black.
void light(vtkRenderer* stage);

/// How a surface looks: one colour, colours of cells, or nodal values through a colour map between low and high.
struct Look {
  enum class By { colour, cells, values } by = By::colour;
  Rgb colour = neutral;
  double opacity = 1;
  ColourMap map = ColourMap::viridis;
  double low = 0, high = 1;
  double bar_width = 4;  // of bars  [pixel]
};
void add_skin(vtkRenderer* stage, const Skin& skin, const Look& look);
/// A surface with values of its points, through the colour map of a look.
void add_values(vtkRenderer* stage, vtkPolyData* data, const Look& look);
/// A closed surface with normals, and lines.
vtkActor* add_surface(vtkRenderer* stage, vtkPolyData* data, const Rgb& colour, double opacity = 1);
vtkActor* add_lines(vtkRenderer* stage, vtkPolyData* data, const Rgb& colour, double width, double opacity = 1);

void add_dots(vtkRenderer* stage, const std::vector<Vec3>& at, const Rgb& colour, double size);
/// Borders of the facets, fading where they are so near to each other that they would hide the colours.  Aim the camera first.
void add_grid(vtkRenderer* stage, const Skin& skin, double width, double opacity, double pixels_per_metre);
/// Height of the layer in pixels over the height it shows at the focal point  [pixel/m].
double pixels_per_metre(vtkRenderer* stage, double height);

}  // namespace hilo
