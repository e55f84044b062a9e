// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.hpp"
#include "post/charts/figure.hpp"
#include "post/picture/picture.hpp"

namespace hilo {
namespace {

constexpr int width = 1654, height = 2339;  // A4 at 200 dots per inch
constexpr double small = 13, middle = 14.5, large = 17, huge = 25, row = 22;
constexpr Rgb grey{0.36, 0.37, 0.39};

/// Writes from the top of the page down.
class Page {
 public:
  explicit Page(Painter& p) : p_(p), left(56 * p.scale), right(p.width - 56 * p.scale), y(p.height - 60 * p.scale) {}
  Painter& p_;
  const double left, right;
  double y;  // of the next line  [pixel]

  double unit(double x) const { return x * p_.scale; }
  void gap(double x) { y -= unit(x); }
  void line(const std::string& text, double size, const Rgb& colour = ink, bool bold = false) {
    p_.text({left, y}, text, size, Across::left, Up::middle, colour, bold);
    gap(1.45 * size);
  }
  /// A paragraph, broken at blanks.
  void paragraph(const std::string& text, double size) {
    std::istringstream words(text);
    std::string word, so_far;
    while (words >> word) {
      const std::string longer = so_far.empty() ? word : so_far + " " + word;
      if (p_.extent(longer, size).x() > right - left && !so_far.empty())
        line(so_far, size, grey), so_far = word;
      else
        so_far = longer;
    }
    if (!so_far.empty()) line(so_far, size, grey);
  }
  /// A name cut to a share of the width.
  std::string fitted(std::string name, double share) {
    const auto wide = [&](const std::string& text) { return p_.extent(text, middle, true).x() > share * (right - left); };
    if (!wide(name)) return name;
    while (name.size() > 1 && wide(name + "...")) name.pop_back();
    return name + "...";
  }
  void rule(const Rgb& colour, double thick) { p_.line({left, y + unit(row / 2)}, {right, y + unit(row / 2)}, colour, thick); }
  /// A row of cells; the first `n_left` are set to the left at their place, the others end there.
  void cells(const std::vector<std::string>& text, const std::vector<double>& at, const std::vector<Across>& across, bool bold = false) {
    for (size_t i = 0; i < text.size(); ++i) p_.text({left + at[i] * (right - left), y}, text[i], middle, across[i], Up::middle, ink, bold);
    gap(row);
  }
};

std::string number(double x, int digits) { return std::isfinite(x) ? fmt::format("{:.{}f}", x, digits) : "-"; }

const InjuryMeasure& measure(const Crew& c, const std::string& key) {
  return *std::find_if(c.measures.begin(), c.measures.end(), [&](const InjuryMeasure& m) { return m.key == key; });
}

Figure pulses(const std::vector<Crew>& crew, double cfc, const Corridor& corridor) {
  Figure figure;
  constexpr const char* title[] = {"x: forward +", "y: to the left +", "z: upward +"};
  for (size_t a = 0; a < 3; ++a) {
    Panel panel{title[a], {a == 2 ? "time [s]" : ""}, {"change [g]"}, {}};
    Band band{a == 0 ? "corridor" : "", crew[0].record.uniform, crew[0].change[a], crew[0].change[a], {0.87, 0.88, 0.9}};
    for (size_t i = 0; i < crew.size(); ++i) {
      const auto& x = crew[i].change[a];
      for (size_t n = 0; n < std::min(band.x.size(), x.size()); ++n)
        band.low[n] = std::min(band.low[n], x[n]), band.high[n] = std::max(band.high[n], x[n]);
      panel.curves.push_back({a == 0 ? fmt::format("{}, CFC {:g}", crew[i].record.name, cfc) : "", crew[i].record.uniform, x,
                              curve_colour(static_cast<int>(i)), 1.6 + 1.6 * static_cast<double>(i)});  // what coincides shows as a border
    }
    if (const auto& given = corridor.axis[a]) band = {band.label, given->t, given->low, given->high, band.colour};
    if (crew.size() > 1 || corridor.axis[a]) panel.bands.push_back(std::move(band));
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

void pulse_table(Page& page, const std::vector<Crew>& crew) {
  std::vector<double> at{0};
  std::vector<Across> across{Across::left};
  for (int i = 0; i < 9; ++i) at.push_back(0.29 + 0.079 * i + 0.03 * (i / 3 - 1)), across.push_back(Across::right);
  page.line("Pulse: largest change, its time, its duration above half of it", large, ink, true);
  page.gap(4);
  page.cells({"", "x [g]", "at [ms]", "for [ms]", "y [g]", "at [ms]", "for [ms]", "z [g]", "at [ms]", "for [ms]"}, at, across, true);
  page.rule(grey, 1.2);
  for (const Crew& c : crew) {
    std::vector<std::string> text{page.fitted(c.record.name, 0.15)};
    for (const char* axis : {"x", "y", "z"})
      for (const char* what : {"peak_", "t_", "width_"}) {
        const InjuryMeasure& m = measure(c, std::string(what) + axis);
        text.push_back(number(m.value, m.digits));
      }
    page.cells(text, at, across);
  }
}

void measure_table(Page& page, const std::vector<Crew>& crew) {
  const double first = 0.35, last = 0.745, n = static_cast<double>(crew.size());
  std::vector<double> at{0, 0.13};
  std::vector<Across> across{Across::left, Across::left};
  for (size_t i = 0; i < crew.size(); ++i)
    at.push_back(first + (last - first) * (static_cast<double>(i) + 1) / n), across.push_back(Across::right);
  at.push_back(0.76), across.push_back(Across::left);
  page.line("What it does to people", large, ink, true);
  page.gap(4);
  std::vector<std::string> head{"", ""};
  for (const Crew& c : crew) head.push_back(page.fitted(c.record.name, (last - first) / n - 0.012));
  head.push_back("reference level");
  page.cells(head, at, across, true);
  page.rule(grey, 1.2);
  for (size_t k = 9; k < crew[0].measures.size(); ++k) {
    const InjuryMeasure& m = crew[0].measures[k];
    if (m.key == "aw_x" || m.key == "DR_x") page.rule(faint, 1);
    std::vector<std::string> text{
        m.key, m.unit == "1" ? m.what : fmt::format("{} [{}]", m.what, m.unit == "m/s^1.75" ? "m/s\u00b9\u00b7\u2077\u2075" : m.unit)};
    for (const Crew& c : crew) text.push_back(number(c.measures[k].value, m.digits));
    text.push_back(std::isfinite(m.reference) ? fmt::format("{:g}: {}", m.reference, m.source) : "");
    page.cells(text, at, across);
  }
}

void draw(Painter& p, const std::vector<Crew>& crew, double cfc, const Corridor& corridor, const std::string& title,
          const std::string& run) {
  p.rectangle({0, 0, p.width, p.height}, white);
  Page page(p);
  const auto& t = crew[0].record.t;
  page.line("G-loads on people", huge, ink, true);
  page.line(title, large);
  page.line(fmt::format("{}, {} samples from {:g} to {:g} s", run, t.size(), t.front(), t.back()), middle, grey);
  page.gap(2);
  page.paragraph(
      "Axes of each sensor (ISO 8855): x forward, y to the left, z upward. Proper acceleration, in g = 9.80665 m/s^2: what a seat does to "
      "whom it carries, 1 g upward at rest. Shown is the change from the start of the run; HIC, SI and 3 ms use the whole. The corridor "
      "is "
      "as given, or from the lowest to the highest sensor.",
      middle);
  const double rows = static_cast<double>(crew.size() + crew[0].measures.size());  // the tables' share comes first
  const double h = page.unit(795 - row * (rows - 34));
  draw_figure(p, pulses(crew, cfc, corridor), {page.left - page.unit(20), page.y - h, page.right - page.left + page.unit(20), h});
  page.y -= h + page.unit(14);
  pulse_table(page, crew);
  page.gap(14);
  measure_table(page, crew);
  page.gap(10);
  page.paragraph(
      fmt::format(
          "DRI: one-mass model of the spine (52.9 rad/s, 0.224) from rest. HIC, SI: of the resultant, taken as that of a head "
          "fixed to the sensor, CFC {:g}; 3 ms: in all, CFC {:g}; CFC filters: SAE J211-1, forwards and backwards. Where the record "
          "is too coarse for CFC 1000 the highest class it holds is taken.",
          crew[0].head_class, crew[0].chest_class),
      small);
  page.paragraph(
      "Brinkley: one mass per axis (62.8, 58.0, 52.9 rad/s); the limits 35/40/46 (+x), 28/35/46 (-x), 14/17/22 (y), 15.2/18/22.8 (+z), "
      "13.4/16.5/20.4 (-z) were not checked against their source (a second one agrees on +z). Weighted r.m.s.: Wd, Wk of ISO 2631-1 with "
      "the "
      "parameters of ISO 8041; a record shorter than a second understates MTVV's window. Reference levels are for comparison: this page "
      "is no proof of safety.",
      small);
}

}  // namespace

void write_report(const std::vector<Crew>& crew, double cfc, const Corridor& corridor, const std::string& title, const std::string& run,
                  const std::string& path) {
  if (crew.size() > 5)
    throw Error("--png", fmt::format("{} sensors do not fit on a page", crew.size()), "five at most: choose with --sensor");
  Picture picture(width, height);
  picture.paint([&](Painter& p) { draw(p, crew, cfc, corridor, title, run); });
  picture.write(path);
}

}  // namespace hilo
