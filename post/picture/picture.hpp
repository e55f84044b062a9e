// SPDX-License-Identifier: GPL-3.0-or-later
// One picture: 3-D layers below, painting in pixels above, written as PNG.
#pragma once
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "post/picture/colour.hpp"

class vtkContext2D;
class vtkRenderWindow;
class vtkWindowToImageFilter;

namespace hilo {

using Vec2 = Eigen::Vector2d;
enum class Across { left, centre, right };
enum class Up { bottom, middle, top };

/// Rectangle in pixels, origin at the lower left of the picture.
struct Box {
  double x = 0, y = 0, w = 0, h = 0;
};

/// Draws in pixels.  Sizes of text and widths of lines are given for a picture 720 high and scaled with it.
class Painter {
 public:
  Painter(vtkContext2D* context, double width, double height, double scale)
      : width(width), height(height), scale(scale), context_(context) {}
  const double width, height;  // of the picture  [pixel]
  const double scale;          // pixels per unit of text size and line width

  void line(std::span<const Vec2> points, const Rgb& colour, double width, double opacity = 1, bool dashed = false);
  void line(const Vec2& a, const Vec2& b, const Rgb& colour, double width) { line(std::array{a, b}, colour, width); }
  void polygon(std::span<const Vec2> points, const Rgb& fill, double opacity = 1);
  void rectangle(const Box& box, const Rgb& fill, double opacity = 1);
  void outline(const Box& box, const Rgb& colour, double width);
  void disc(const Vec2& centre, double radius, const Rgb& fill);
  void text(const Vec2& at, const std::string& text, double size, Across across = Across::left, Up up = Up::middle, const Rgb& colour = ink,
            bool bold = false, double angle = 0);
  /// Width and height of a text in pixels.
  Vec2 extent(const std::string& text, double size, bool bold = false);
  /// What is painted until unclip() is cut at the box.
  void clip(const Box& box);
  void unclip();

 private:
  void font(double size, const Rgb& colour, bool bold);
  vtkContext2D* context_;
};

/// Scale of text and lines for a picture of this size.
double picture_scale(int width, int height);

class Picture {
 public:
  Picture(int width, int height);
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  /// A 3-D layer in a box of the picture; later layers hide earlier ones.
  vtkRenderer* layer(const Box& box);
  /// Painting above all layers, called once per written picture.
  void paint(std::function<void(Painter&)> paint);
  /// Render and write a PNG, whole or not at all; folders are made.
  void write(const std::string& path);
  /// Render: the same as bytes of a PNG, or as rows of red, green and blue from the top.
  std::string png();
  std::string pixels();
  const int width, height;

 private:
  vtkSmartPointer<vtkWindowToImageFilter> grab();
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> top_;
  class Item;
  vtkSmartPointer<Item> item_;
};

/// "1280x720" as width and height; Error (exit 1) for anything else.
std::pair<int, int> parse_size(const std::string& text);

}  // namespace hilo
