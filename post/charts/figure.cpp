// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/charts/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/charts/ticks.hpp"
#include "post/picture/picture.hpp"

namespace hilo {
namespace {

constexpr double tick_size = 15, label_size = 17, title_size = 20, legend_size = 15;

/// One axis of one panel: the shown range (log10 of it on a logarithmic axis) and its ticks.
struct Scale {
  double low = 0, high = 1;
  bool log = false;
  int exponent = 0;  // the ticks show value / 10^exponent
  Ticks ticks;
  double operator()(double v) const {  // 0..1, NaN where the value cannot be shown
    if (log) v = v > 0 ? std::log10(v) : std::numeric_limits<double>::quiet_NaN();
    return (v - low) / (high - low);
  }
};

Scale scale_of(const Panel& panel, bool y_axis, int n_ticks) {
  Scale s;
  s.log = y_axis ? panel.y.log : panel.x.log;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool marked = false;
  for (const ChartCurve& c : panel.curves) {
    marked = marked || c.marker >= 0;
    for (size_t i = 0; i < c.x.size(); ++i) {
      const double v = y_axis ? c.y[i] : c.x[i];
      if (!std::isfinite(c.x[i]) || !std::isfinite(c.y[i]) || (s.log && v <= 0)) continue;
      low = std::min(low, v), high = std::max(high, v);
    }
  }
  for (const Band& b : panel.bands)  // they widen the ordinate, not the abscissa
    for (size_t i = 0; y_axis && !s.log && i < b.x.size(); ++i) low = std::min(low, b.low[i]), high = std::max(high, b.high[i]);
  if (!(low <= high)) low = s.log ? 1 : 0, high = s.log ? 10 : 1;
  const Axis& axis = y_axis ? panel.y : panel.x;
  const bool given_low = std::isfinite(axis.low) && (!s.log || axis.low > 0), given_high = std::isfinite(axis.high);
  if (given_low) low = axis.low, high = std::max(high, low);
  if (given_high) high = axis.high, low = std::min(low, high);
  if (s.log) {
    s.low = std::log10(low), s.high = std::log10(high);
    const double room = std::max(0.05 * (s.high - s.low), s.high > s.low ? 0.04 : 0.5);
    s.low -= given_low ? 0 : room, s.high += given_high ? 0 : room;
    s.ticks = log_ticks(std::pow(10, s.low), std::pow(10, s.high), n_ticks);
    return s;
  }
  if (!(high - low > 1e-12 * std::max(std::abs(high), std::abs(low)))) {  // a constant
    const double half = high == 0 ? 1 : 0.5 * std::abs(high);
    low -= half, high += half;
  } else if (y_axis || marked) {  // a marker at the edge would be cut
    const double room = 0.05 * (high - low);
    low -= low == 0 || given_low ? 0 : room, high += high == 0 || given_high ? 0 : room;
  }
  s.exponent = common_exponent(std::max(std::abs(low), std::abs(high)));
  const double unit = std::pow(10, s.exponent);
  s.low = low, s.high = high;
  s.ticks = linear_ticks(low / unit, high / unit, n_ticks);
  for (double& t : s.ticks.at) t *= unit;
  return s;
}

std::string label_of(const Axis& axis, const Scale& s) {
  if (s.exponent == 0) return axis.label;
  const auto bracket = axis.label.rfind('[');
  const std::string power = fmt::format("10^{}", s.exponent);
  if (bracket == std::string::npos) return fmt::format("{} [{}]", axis.label, power);
  const std::string unit = axis.label.substr(bracket + 1);
  return axis.label.substr(0, bracket) + "[" + power + (unit == "1]" ? "]" : " " + unit);
}

/// Widest tick text.
double widest(Painter& p, const Ticks& ticks) {
  double w = 0;
  for (const auto& t : ticks.text) w = std::max(w, p.extent(t, tick_size).x());
  return w;
}

/// Shapes that differ in outline as well as in filling, so that a grey print keeps them apart.
void draw_marker(Painter& p, int n, const Vec2& at, const Rgb& colour) {
  const double r = 5 * p.scale;
  const int shape = n % 6;
  const bool hollow = n / 6 % 2 != 0;
  const auto ring = [&](int corners, double turn, double size) {
    std::vector<Vec2> outline;
    for (int i = 0; i < corners; ++i) {
      const double angle = turn + 2 * M_PI * i / corners;
      outline.push_back(at + size * r * Vec2(std::cos(angle), std::sin(angle)));
    }
    p.polygon(outline, hollow ? white : colour);
    outline.push_back(outline.front());
    p.line(outline, colour, 1.6);
  };
  const auto stroke = [&](double turn) {
    const Vec2 d = r * Vec2(std::cos(turn), std::sin(turn));
    p.line(at - d, at + d, colour, 2.2);
  };
  if (shape == 0) ring(24, 0, 0.95);
  if (shape == 1) ring(4, M_PI / 4, 1.15);
  if (shape == 2) ring(3, M_PI / 2, 1.25);
  if (shape == 3) ring(4, 0, 1.25);
  if (shape == 4) ring(3, -M_PI / 2, 1.25);
  if (shape == 5) {
    for (const double turn : {M_PI / 4, 3 * M_PI / 4}) stroke(turn);
    if (hollow) stroke(0);
  }
}

/// Dashed lines y ~ x^slope in the corner that falling or rising curves leave free, one beside the other, named at their lower end.
void draw_guides(Painter& p, const Panel& panel, const Scale& sx, const Scale& sy, const Box& box) {
  if (!sx.log || !sy.log) return;
  const Rgb grey{0.45, 0.46, 0.48};
  const double width = sx.high - sx.low, height = sy.high - sy.low;
  double taken = 0.06 * width;  // from the side inwards
  for (const Guide& g : panel.guides) {
    const double run = std::min(0.25 * width, 0.3 * height / std::max(std::abs(g.slope), 1e-9)), rise = std::abs(g.slope) * run;
    const auto pixel = [&](double from_side, double from_top) {
      const double x = (g.slope < 0 ? width - from_side : from_side) / width;
      return Vec2(box.x + x * box.w, box.y + (1 - 0.05 - from_top / height) * box.h);
    };
    const std::array ends{pixel(taken, rise), pixel(taken + run, 0)};
    p.line(ends, grey, 1.5, 1, true);
    p.text(ends[0] - Vec2(0, 4 * p.scale), g.label, legend_size, Across::centre, Up::top, grey);
    taken += std::max(run, 0.09 * width) + 0.04 * width;
  }
}

void draw_curve(Painter& p, const ChartCurve& c, const Scale& sx, const Scale& sy, const Box& box) {
  std::vector<Vec2> stretch;
  const auto flush = [&] {
    if (c.width > 0) p.line(stretch, c.colour, c.width, c.opacity, c.dashed);
    stretch.clear();
  };
  // Many samples per pixel column: its first, lowest, highest and last point show the same picture.
  const bool dense = static_cast<double>(c.x.size()) > 6 * box.w && std::is_sorted(c.x.begin(), c.x.end());
  std::vector<Vec2> column;
  const auto close_column = [&] {
    if (column.empty()) return;
    const auto below = [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); };
    const auto [low, high] = std::minmax_element(column.begin(), column.end(), below);
    stretch.push_back(column.front());
    stretch.push_back(low < high ? *low : *high);
    stretch.push_back(low < high ? *high : *low);
    stretch.push_back(column.back());
    column.clear();
  };
  for (size_t i = 0; i < c.x.size(); ++i) {
    const double u = sx(c.x[i]), v = sy(c.y[i]);
    if (!std::isfinite(u) || !std::isfinite(v)) {
      close_column(), flush();
      continue;
    }
    const Vec2 at(box.x + u * box.w, box.y + v * box.h);
    if (!dense) {
      stretch.push_back(at);
      continue;
    }
    if (!column.empty() && std::floor(at.x()) != std::floor(column.front().x())) close_column();
    column.push_back(at);
  }
  close_column(), flush();
  if (c.marker < 0) return;
  for (size_t i = 0; i < c.x.size(); ++i) {
    const double u = sx(c.x[i]), v = sy(c.y[i]);
    if (std::isfinite(u) && std::isfinite(v)) draw_marker(p, c.marker, {box.x + u * box.w, box.y + v * box.h}, c.colour);
  }
}

void draw_axes(Painter& p, const Panel& panel, const Box& box, const Scale& sx, const Scale& sy) {
  const double gap = 7 * p.scale;
  for (size_t i = 0; i < sx.ticks.at.size(); ++i) {
    const double x = box.x + sx(sx.ticks.at[i]) * box.w;
    p.line({x, box.y}, {x, box.y + box.h}, faint, 1);
    p.text({x, box.y - gap}, sx.ticks.text[i], tick_size, Across::centre, Up::top);
  }
  for (size_t i = 0; i < sy.ticks.at.size(); ++i) {
    const double y = box.y + sy(sy.ticks.at[i]) * box.h;
    p.line({box.x, y}, {box.x + box.w, y}, sy.ticks.at[i] == 0 && !sy.log ? Rgb{0.6, 0.61, 0.62} : faint, 1);
    p.text({box.x - gap, y}, sy.ticks.text[i], tick_size, Across::right, Up::middle);
  }
  p.outline(box, {0.45, 0.46, 0.48}, 1);
  p.text({box.x + box.w / 2, box.y - gap - 22 * p.scale}, label_of(panel.x, sx), label_size, Across::centre, Up::top);
}

void draw_band(Painter& p, const Band& b, const Scale& sx, const Scale& sy, const Box& box) {
  std::vector<Vec2> low, high;
  const double step = 0.5;  // [pixel]: many samples per column show as their envelope
  for (size_t i = 0; i < b.x.size(); ++i) {
    const double u = sx(b.x[i]), v0 = sy(b.low[i]), v1 = sy(b.high[i]);
    if (!std::isfinite(u) || !std::isfinite(v0) || !std::isfinite(v1)) continue;
    const double x = box.x + u * box.w, y0 = box.y + v0 * box.h, y1 = box.y + v1 * box.h;
    if (!low.empty() && x - low.back().x() < step) {
      low.back().y() = std::min(low.back().y(), y0), high.back().y() = std::max(high.back().y(), y1);
      continue;
    }
    low.emplace_back(x, y0), high.emplace_back(x, y1);
  }
  for (size_t i = 1; i < low.size(); ++i) p.polygon(std::array{low[i - 1], low[i], high[i], high[i - 1]}, b.colour);
}

double legend_width(Painter& p, const Panel& panel) {
  double w = 0;
  for (const ChartCurve& c : panel.curves)
    if (!c.label.empty()) w = std::max(w, p.extent(c.label, legend_size).x());
  for (const Band& b : panel.bands)
    if (!b.label.empty()) w = std::max(w, p.extent(b.label, legend_size).x());
  return w == 0 ? 0 : w + 62 * p.scale;
}

void draw_legend(Painter& p, const Panel& panel, const Box& box) {
  const double row = 22 * p.scale, x = box.x + box.w + 14 * p.scale;
  double y = box.y + box.h - row / 2;
  for (const ChartCurve& c : panel.curves) {
    if (c.label.empty()) continue;
    if (c.width > 0) p.line(std::array{Vec2(x, y), Vec2(x + 30 * p.scale, y)}, c.colour, c.width, c.opacity, c.dashed);
    if (c.marker >= 0) draw_marker(p, c.marker, {x + 15 * p.scale, y}, c.colour);
    p.text({x + 38 * p.scale, y}, c.label, legend_size);
    y -= row;
  }
  for (const Band& b : panel.bands) {
    if (b.label.empty()) continue;
    p.rectangle({x, y - 6 * p.scale, 30 * p.scale, 12 * p.scale}, b.colour);
    p.text({x + 38 * p.scale, y}, b.label, legend_size);
    y -= row;
  }
}

}  // namespace

void draw_figure(Painter& p, const Figure& f, const Box& page) {
  const double s = p.scale, top = f.title.empty() ? 14 * s : 50 * s;
  if (!f.title.empty()) p.text({page.x + page.w / 2, page.y + page.h - 26 * s}, f.title, title_size, Across::centre, Up::middle, ink, true);
  const double slot = (page.h - top - 8 * s) / static_cast<double>(f.panels.size());
  // Panels share their left and right edges, so that their time axes can be compared.
  std::vector<Scale> sx, sy;
  double left = 0, right = 20 * s;
  for (const Panel& panel : f.panels) {
    sx.push_back(scale_of(panel, false, 8));
    sy.push_back(scale_of(panel, true, std::clamp(static_cast<int>(slot / (42 * s)), 3, 9)));
    left = std::max(left, widest(p, sy.back().ticks) + 50 * s);
    right = std::max(right, legend_width(p, panel));
    if (!sx.back().ticks.text.empty()) right = std::max(right, p.extent(sx.back().ticks.text.back(), tick_size).x() / 2 + 6 * s);
  }
  for (size_t i = 0; i < f.panels.size(); ++i) {
    const Panel& panel = f.panels[i];
    const double head = panel.title.empty() ? 8 * s : 30 * s, foot = 58 * s;
    const Box box{std::round(page.x + left), std::round(page.y + page.h - top - static_cast<double>(i + 1) * slot + foot),
                  std::round(page.w - left - right), std::round(slot - head - foot)};
    if (!panel.title.empty()) p.text({box.x, box.y + box.h + 6 * s}, panel.title, label_size, Across::left, Up::bottom, ink, true);
    p.clip(box);
    for (const Band& b : panel.bands) draw_band(p, b, sx[i], sy[i], box);
    p.unclip();
    draw_axes(p, panel, box, sx[i], sy[i]);
    p.text({page.x + 18 * s, box.y + box.h / 2}, label_of(panel.y, sy[i]), label_size, Across::centre, Up::middle, ink, false, 90);
    p.clip(box);
    draw_guides(p, panel, sx[i], sy[i], box);
    for (auto c = panel.curves.rbegin(); c != panel.curves.rend(); ++c) draw_curve(p, *c, sx[i], sy[i], box);  // the first on top
    p.unclip();
    draw_legend(p, panel, box);
  }
}

void write_chart(const Figure& figure, const std::string& path) {
  Picture picture(figure.width, figure.height);
  picture.paint([&](Painter& p) {
    p.rectangle({0, 0, p.width, p.height}, white);
    draw_figure(p, figure, {0, 0, p.width, p.height});
  });
  picture.write(path);
}

}  // namespace hilo
