// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/glyphs.hpp"

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "post/scene/overlay.hpp"
#include "post/scene/stage.hpp"

namespace hilo {

Projection::Projection(vtkRenderer* stage, const Box& box) : box_(box) {
  vtkCamera* camera = stage->GetActiveCamera();
  vtkMatrix4x4* m = camera->GetCompositeProjectionTransformMatrix(box.w / box.h, -1, 1);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix_(i, j) = m->GetElement(i, j);
  metre_ = 1 / pixels_per_metre(stage, box.h);
}

Vec2 Projection::operator()(const Vec3& x) const {
  const Eigen::Vector4d h = matrix_ * Eigen::Vector4d(x.x(), x.y(), x.z(), 1);
  return {box_.x + box_.w * 0.5 * (h.x() / h.w() + 1), box_.y + box_.h * 0.5 * (h.y() / h.w() + 1)};
}

Vec2 Projection::direction(const Vec3& at, const Vec3& along) const {
  if (along.norm() == 0) return Vec2::Zero();
  return ((*this)(at + metre_ * along.normalized()) - (*this)(at));
}

namespace {

constexpr double pen = 2;

void ring(Painter& p, const Vec2& at, double r, const Rgb& colour) {
  p.disc(at, r, colour);
  p.disc(at, r - 1.8 * p.scale, white);
}

void dot_between(Painter& p, const Vec2& at, const Vec2& to, const Rgb& colour, double size) {
  p.disc(at, 0.16 * size, colour), p.disc(to, 0.16 * size, colour);
}

/// A stretch of a circle with an arrow's head.
void turn(Painter& p, const Vec2& at, double r, double turns, double from, const Rgb& colour, bool head, bool spiral) {
  std::vector<Vec2> arc;
  const int n = 40;
  for (int i = 0; i <= n; ++i) {
    const double a = from + 2 * M_PI * turns * i / n, grow = spiral ? 0.25 + 0.75 * i / n : 1;
    arc.emplace_back(at + grow * r * Vec2(std::cos(a), std::sin(a)));
  }
  p.line(arc, colour, pen);
  if (head) draw_arrow(p, arc[n - 5], arc[n] + 0.3 * (arc[n] - arc[n - 5]), colour, pen);
}

void coil(Painter& p, const Vec2& a, const Vec2& b, const Rgb& colour, double amplitude) {
  const Vec2 d = b - a;
  const double length = d.norm();
  if (length < 4 * p.scale) return p.disc(a, 0.5 * amplitude, colour);
  const Vec2 across = Vec2(-d.y(), d.x()) / length;
  const int teeth = 2 * static_cast<int>(std::clamp(length / (1.6 * amplitude), 3.0, 8.0));
  std::vector<Vec2> path{a, a + 0.18 * d};
  for (int i = 0; i < teeth; ++i) path.emplace_back(a + (0.18 + 0.64 * (i + 0.5) / teeth) * d + (i % 2 ? -0.5 : 0.5) * amplitude * across);
  path.insert(path.end(), {a + 0.82 * d, b});
  p.line(path, colour, pen);
}

}  // namespace

void draw_glyph(Painter& p, Glyph glyph, const Vec2& at, const Vec2& along, const Vec2& above, const Vec2& to, const Rgb& colour,
                double size) {
  const double r = 0.22 * size;
  const Vec2 axis = size * along;
  const auto square = [&](double half, const Rgb& fill) { p.rectangle({at.x() - half, at.y() - half, 2 * half, 2 * half}, fill); };
  switch (glyph) {
    case Glyph::ball:
      ring(p, at, r, colour);
      p.disc(at, 0.45 * r, colour);
      break;
    case Glyph::hinge:
      p.line(at - axis, at + axis, colour, pen);
      ring(p, at, r, colour);
      break;
    case Glyph::slider:
      draw_arrow(p, at, at + axis, colour, pen), draw_arrow(p, at, at - axis, colour, pen);
      square(r, colour), square(r - 1.8 * p.scale, white);
      break;
    case Glyph::block:
      square(r, colour);
      break;
    case Glyph::link:
      p.line(at, to, colour, pen);
      dot_between(p, at, to, colour, size);
      break;
    case Glyph::coil:
      coil(p, at, to, colour, 0.4 * size);
      dot_between(p, at, to, colour, 0.7 * size);
      break;
    case Glyph::spiral:
      p.line(at - axis, at + axis, blend(colour, white, 0.4), 0.6 * pen);
      turn(p, at, 1.8 * r, 2, 0, colour, false, true);
      break;
    case Glyph::bushing:
      square(r, colour), square(r - 1.8 * p.scale, white);
      p.line(at - Vec2(r, r), at + Vec2(r, r), colour, 0.7 * pen), p.line(at - Vec2(r, -r), at + Vec2(r, -r), colour, 0.7 * pen);
      break;
    case Glyph::ground: {
      const Vec2 below = at - Vec2(0, 1.1 * size);
      coil(p, at, below, colour, 0.32 * size);
      p.line(below - Vec2(0.4 * size, 0), below + Vec2(0.4 * size, 0), colour, pen);
      break;
    }
    case Glyph::arrow:
      if (along.norm() < 0.1)
        ring(p, at, r, colour), p.disc(at, 0.4 * r, colour);  // along the line of sight
      else
        draw_arrow(p, at - 2.2 * axis, at, colour, 1.5 * pen);
      break;
    case Glyph::turn:
      p.line(at - axis, at + axis, colour, pen);
      turn(p, at, 0.45 * size, 0.72, -0.3, colour, true, false);
      break;
    case Glyph::clamp:
      p.polygon(std::array{at, Vec2(at + Vec2(-0.3 * size, -0.5 * size)), Vec2(at + Vec2(0.3 * size, -0.5 * size))}, colour);
      break;
    case Glyph::triad:
      draw_arrow(p, at, at + 1.1 * axis, colour, pen), draw_arrow(p, at, at + 1.1 * size * above, colour, pen);
      p.polygon(std::array{Vec2(at - Vec2(r, 0)), Vec2(at - Vec2(0, r)), Vec2(at + Vec2(r, 0)), Vec2(at + Vec2(0, r))}, colour);
      break;
    case Glyph::cross:
      p.line(at - Vec2(r, r), at + Vec2(r, r), colour, pen), p.line(at - Vec2(r, -r), at + Vec2(r, -r), colour, pen);
      break;
    case Glyph::stop: {  // two walls across the axis
      const Vec2 d = along.norm() > 0.2 ? Vec2(along.normalized()) : Vec2(1, 0), across(-d.y(), d.x());
      for (const double side : {-0.62, 0.62})
        p.line(at + side * size * d - 0.34 * size * across, at + side * size * d + 0.34 * size * across, colour, 1.6 * pen);
      break;
    }
    case Glyph::outline:  // its lines are drawn where they are; in legends a frame
      p.line(std::vector<Vec2>{at + Vec2(-r, -r), at + Vec2(r, -r), at + Vec2(r, r), at + Vec2(-r, r), at + Vec2(-r, -r)}, colour,
             0.7 * pen);
      break;
    case Glyph::friction:  // teeth around
      for (int k = 0; k < 12; ++k) {
        const Vec2 d(std::cos(M_PI * k / 6), std::sin(M_PI * k / 6));
        p.line(at + 0.30 * size * d, at + 0.44 * size * d, colour, pen);
      }
      break;
    case Glyph::mass: {
      ring(p, at, r, colour);
      for (const double from : {0.0, M_PI}) {
        std::vector<Vec2> quarter{at};
        for (int i = 0; i <= 8; ++i) quarter.emplace_back(at + r * Vec2(std::cos(from + M_PI * i / 16), std::sin(from + M_PI * i / 16)));
        p.polygon(quarter, colour);
      }
      break;
    }
  }
}

void draw_labels(Painter& p, const std::vector<Label>& labels, const Box& box, double size) {
  std::vector<Box> taken;
  const double rim = 9 * p.scale;
  for (const Label& l : labels) taken.push_back({l.anchor.x() - rim, l.anchor.y() - rim, 2 * rim, 2 * rim});
  const auto overlap = [](const Box& a, const Box& b) {
    const double w = std::min(a.x + a.w, b.x + b.w) - std::max(a.x, b.x), h = std::min(a.y + a.h, b.y + b.h) - std::max(a.y, b.y);
    return w > 0 && h > 0 ? w * h : 0;
  };
  std::vector<Box> places;
  for (const Label& l : labels) {
    const Vec2 e = p.extent(l.text, size);
    Box best{};
    double least = 1e300;
    for (const double away : {14.0, 26.0, 42.0, 62.0, 86.0, 112.0})
      for (int k = 0; k < 16; ++k) {  // around the anchor, to the right first
        const double a = (k % 2 ? -1 : 1) * M_PI * ((k + 1) / 2) / 8;
        const Vec2 end = l.anchor + away * p.scale * Vec2(std::cos(a), std::sin(a));
        const Box place{end.x() - 0.5 * e.x() * (1 - std::cos(a)), end.y() - 0.5 * e.y() * (1 - std::sin(a)), e.x(), e.y()};
        double cost = 0.02 * away * p.scale * size + 0.6 * k * p.scale;
        for (const Box& t : taken) cost += 4 * overlap(place, t);
        cost += 8 * (place.w * place.h - overlap(place, box));
        if (cost < least) least = cost, best = place;
      }
    taken.push_back(best);
    places.push_back(best);
  }
  for (size_t i = 0; i < labels.size(); ++i) {
    const Box& b = places[i];
    const Vec2 nearest(std::clamp(labels[i].anchor.x(), b.x, b.x + b.w), std::clamp(labels[i].anchor.y(), b.y, b.y + b.h));
    if ((nearest - labels[i].anchor).norm() > 22 * p.scale) p.line(labels[i].anchor, nearest, blend(labels[i].colour, white, 0.3), 0.8);
  }
  for (size_t i = 0; i < labels.size(); ++i) {
    const Box& b = places[i];
    const double pad = 2 * p.scale;
    p.rectangle({b.x - pad, b.y, b.w + 2 * pad, b.h}, white, 0.72);
    p.text({b.x, b.y}, labels[i].text, size, Across::left, Up::bottom, blend(labels[i].colour, ink, 0.25));
  }
}

}  // namespace hilo
