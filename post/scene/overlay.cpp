// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "post/charts/ticks.hpp"

namespace hilo {
namespace {

constexpr double title_size = 21, line_size = 17, text_size = 16;

/// Words of a text in lines no wider than `width`.
std::vector<std::string> wrapped(Painter& p, const std::string& text, double size, double width) {
  std::vector<std::string> lines{""};
  size_t at = 0;
  while (at < text.size()) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string longer = lines.back() + (lines.back().empty() ? "" : " ") + text.substr(at, end - at);
    if (!lines.back().empty() && p.extent(longer, size).x() > width)
      lines.push_back(text.substr(at, end - at));
    else
      lines.back() = longer;
    at = end + 1;
  }
  return lines;
}

/// A text cut with an ellipsis where it is wider than `width`.
std::string shortened(Painter& p, std::string text, double size, double width) {
  if (p.extent(text, size).x() <= width) return text;
  while (text.size() > 1 && p.extent(text + "...", size).x() > width) text.pop_back();
  return text + "...";
}

}  // namespace

Frame frame_of(int width, int height, double side_width, bool two_titles) {
  const double s = picture_scale(width, height), top = std::round((two_titles ? 74 : 48) * s), side = std::round(side_width * s),
               rim = std::round(12 * s);
  Frame f;
  f.model = {rim, rim, width - side - 2 * rim, height - top - rim};
  f.side = {width - side - rim, rim, side, height - top - rim};
  return f;
}

void draw_title(Painter& p, const std::string& title, const std::string& line) {
  const double x = 20 * p.scale, width = p.width - 2 * x;
  p.text({x, p.height - 26 * p.scale}, shortened(p, title, title_size, width), title_size, Across::left, Up::middle, ink, true);
  p.text({x, p.height - 54 * p.scale}, shortened(p, line, line_size, width), line_size, Across::left, Up::middle, {0.33, 0.34, 0.36});
}

void draw_colour_bar(Painter& p, const Box& side, const ColourBar& bar) {
  const double s = p.scale, row = 1.35 * text_size * s, x = side.x + 4 * s;
  double top = side.y + side.h - row / 2;
  for (const auto& line : wrapped(p, bar.quantity, text_size, side.w - 4 * s)) p.text({x, top}, line, text_size), top -= row;
  p.text({x, top}, fmt::format("[{}]", bar.unit), text_size);
  const bool signs = bar.low < 0;  // then the least is told too
  const double foot = side.y + ((bar.neutral.empty() ? 44 : 86) + (signs ? 24 : 0)) * s;
  const Box box{std::round(x), std::round(foot), std::round(24 * s), std::round(top - 1.6 * row - foot)};
  constexpr int strips = 256;
  for (int i = 0; i < strips; ++i) {  // strips overlap, so that no seam shows
    const double from = box.y + box.h * i / strips;
    p.rectangle({box.x, from, box.w, box.y + box.h - from}, map_colour(bar.map, (i + 0.5) / strips));
  }
  const double tip = 12 * s, slack = 1e-6 * (bar.high - bar.low);
  if (bar.most > bar.high + slack)
    p.polygon(std::array{Vec2(box.x, box.y + box.h), Vec2(box.x + box.w, box.y + box.h), Vec2(box.x + box.w / 2, box.y + box.h + tip)},
              map_colour(bar.map, 1));
  if (bar.least < bar.low - slack)
    p.polygon(std::array{Vec2(box.x, box.y), Vec2(box.x + box.w / 2, box.y - tip), Vec2(box.x + box.w, box.y)}, map_colour(bar.map, 0));
  p.outline(box, ink, 1);
  for (const double m : bar.marks) {
    const double y = box.y + box.h * (m - bar.low) / (bar.high - bar.low);
    if (y < box.y || y > box.y + box.h) continue;
    p.line({box.x, y}, {box.x + box.w, y}, white, 4), p.line({box.x, y}, {box.x + box.w, y}, ink, 2);
  }
  const Ticks ticks = linear_ticks(bar.low, bar.high, std::clamp(static_cast<int>(box.h / (44 * s)), 2, 8));
  for (size_t i = 0; i < ticks.at.size(); ++i) {
    const double y = box.y + box.h * (ticks.at[i] - bar.low) / (bar.high - bar.low);
    p.line({box.x + box.w, y}, {box.x + box.w + 6 * s, y}, ink, 1);
    p.text({box.x + box.w + 11 * s, y}, ticks.text[i], text_size);
  }
  double y = side.y + (bar.neutral.empty() ? 0 : 42) * s + 12 * s;
  if (signs) p.text({x, y}, fmt::format("min {}", short_number(bar.least)), text_size), y += 24 * s;
  p.text({x, y}, fmt::format("max {}", short_number(bar.most)), text_size);
  if (bar.neutral.empty()) return;
  y = side.y + 12 * s;
  p.rectangle({x, y - 8 * s, 24 * s, 16 * s}, neutral);
  p.outline({x, y - 8 * s, 24 * s, 16 * s}, ink, 1);
  p.text({x + 35 * s, y}, bar.neutral, text_size);
}

void draw_legend(Painter& p, const Box& side, const std::string& title, const std::vector<LegendEntry>& entries) {
  const double s = p.scale, x = side.x + 4 * s;
  double size = text_size, y = side.y + side.h - 0.7 * text_size * s;
  if (!title.empty()) {
    p.text({x, y}, title, text_size, Across::left, Up::middle, ink, true);
    y -= 1.6 * text_size * s;
  }
  double rows = 0;
  for (const auto& e : entries) rows += e.heading ? 1.35 : 1;
  const double space = y - side.y, wanted = 1.42 * text_size * s * rows;
  if (wanted > space) size = std::max(11.0, text_size * space / wanted);
  const double row = 1.42 * size * s;
  const auto fits = static_cast<size_t>(std::max(2.0, std::floor(space / row) + 1));
  for (size_t i = 0; i < entries.size(); ++i) {
    const LegendEntry& e = entries[i];
    if (i + 1 == fits && entries.size() > fits) {
      p.text({x, y}, fmt::format("and {} more", entries.size() - i), size);
      break;
    }
    const double r = 0.38 * size * s, from = e.heading ? x : x + 34 * s;
    if (e.heading && i > 0) y -= 0.35 * row;
    if (e.symbol) {
      e.symbol(p, {x + 12 * s, y});
    } else if (!e.heading) {
      p.rectangle({x, y - r, 24 * s, 2 * r}, e.colour);
      p.outline({x, y - r, 24 * s, 2 * r}, {0.4, 0.4, 0.42}, 1);
    }
    p.text({from, y}, shortened(p, e.label, size, side.x + side.w - from), size, Across::left, Up::middle, ink, e.heading);
    y -= row;
  }
}

void draw_arrow(Painter& p, const Vec2& a, const Vec2& b, const Rgb& colour, double width) {
  const Vec2 d = b - a;
  const double length = d.norm(), head = std::min(4.2 * width * p.scale, length);
  if (length < 1e-9) return;
  const Vec2 along = d / length, across(-along.y(), along.x());
  p.line(a, b - 0.8 * head * along, colour, width);
  p.polygon(std::array{b, Vec2(b - head * along + 0.42 * head * across), Vec2(b - head * along - 0.42 * head * across)}, colour);
}

void draw_axes_cross(Painter& p, const Vec3& right, const Vec3& up, const Vec3& back) {
  const double s = p.scale, length = 38 * s;
  const Vec2 origin(64 * s, 62 * s);
  constexpr std::array<Rgb, 3> colours{{{0.75, 0.18, 0.18}, {0.13, 0.52, 0.22}, {0.15, 0.30, 0.70}}};
  constexpr const char* names[] = {"x", "y", "z"};
  std::array<int, 3> order{0, 1, 2};  // the farthest first
  std::sort(order.begin(), order.end(), [&](int a, int b) { return back[a] < back[b]; });
  for (const int i : order) {
    const Vec2 d(right[i], up[i]);
    const auto& colour = colours[static_cast<size_t>(i)];
    if (d.norm() < 0.05) {  // along the line of sight
      p.disc(origin, 4 * s, colour);
      continue;
    }
    draw_arrow(p, origin, origin + length * d, colour, 2.2);
    p.text(origin + length * d + 12 * s * d.normalized(), names[i], text_size, Across::centre, Up::middle, colour, true);
  }
}

}  // namespace hilo
