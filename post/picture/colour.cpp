// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/picture/colour.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace hilo {
namespace {

// Sampled at equal distances from the published maps: viridis (Smith and van der Walt 2015), cividis (Nunez et al. 2018).
constexpr std::array<Rgb, 11> viridis{{{0.267004, 0.004874, 0.329415},
                                       {0.282623, 0.140926, 0.457517},
                                       {0.253935, 0.265254, 0.529983},
                                       {0.206756, 0.371758, 0.553117},
                                       {0.163625, 0.471133, 0.558148},
                                       {0.127568, 0.566949, 0.550556},
                                       {0.134692, 0.658636, 0.517649},
                                       {0.266941, 0.748751, 0.440573},
                                       {0.477504, 0.821444, 0.318195},
                                       {0.741388, 0.873449, 0.149561},
                                       {0.993248, 0.906157, 0.143936}}};
constexpr std::array<Rgb, 6> cividis{{{0.000, 0.133, 0.306},
                                      {0.208, 0.271, 0.424},
                                      {0.400, 0.412, 0.439},
                                      {0.580, 0.557, 0.467},
                                      {0.784, 0.722, 0.400},
                                      {0.996, 0.910, 0.220}}};

Rgb table_colour(std::span<const Rgb> table, double s) {
  const double x = std::clamp(s, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const size_t i = std::min(static_cast<size_t>(x), table.size() - 2);
  return blend(table[i], table[i + 1], x - static_cast<double>(i));
}

/// OKLab (Ottosson 2020) lightness, chroma and hue to sRGB, clipped.
Rgb oklch(double L, double C, double hue) {
  const double a = C * std::cos(hue), b = C * std::sin(hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(L + 0.3963377774 * a + 0.2158037573 * b), m = cube(L - 0.1055613458 * a - 0.0638541728 * b),
               s = cube(L - 0.0894841775 * a - 1.2914855480 * b);
  const auto gamma = [](double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  };
  return {gamma(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s), gamma(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          gamma(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

Rgb blend(const Rgb& a, const Rgb& b, double w) { return {a.r + w * (b.r - a.r), a.g + w * (b.g - a.g), a.b + w * (b.b - a.b)}; }

Rgb map_colour(ColourMap map, double s) {
  if (map == ColourMap::cividis) return table_colour(cividis, s);
  if (map == ColourMap::diverging) {  // OKLab lightness falls evenly to both ends, hues of 255 and 55 degrees
    const double x = std::clamp(2 * s - 1, -1.0, 1.0), far = std::abs(x);
    return oklch(0.97 - 0.52 * far, 0.13 * far * (1.8 - 0.8 * far), (x < 0 ? 255 : 55) * M_PI / 180);
  }
  constexpr double dark = 0.09;  // the darkest violet is left out: under a shade it would be black
  return table_colour(viridis, dark + (1 - dark) * std::clamp(s, 0.0, 1.0));
}

Rgb category_colour(int n) {
  // Wong's eight (Nature Methods 8, 441, 2011) without black, a little lighter for surfaces; then hues at the golden angle on three
  // lightnesses.
  constexpr std::array<Rgb, 7> wong{{{0.337, 0.706, 0.914},
                                     {0.902, 0.624, 0.000},
                                     {0.000, 0.620, 0.451},
                                     {0.800, 0.475, 0.655},
                                     {0.000, 0.447, 0.698},
                                     {0.835, 0.369, 0.000},
                                     {0.941, 0.894, 0.259}}};
  if (n < static_cast<int>(wong.size())) return blend(wong[static_cast<size_t>(std::max(n, 0))], white, 0.12);
  const int k = n - static_cast<int>(wong.size());
  constexpr double lightness[] = {0.72, 0.56, 0.84}, chroma[] = {0.13, 0.11, 0.09};
  return oklch(lightness[k % 3], chroma[k % 3], 0.6 + 2.399963 * k);
}

Rgb curve_colour(int n) {
  constexpr std::array<Rgb, 7> dark{{{0.000, 0.447, 0.698},
                                     {0.835, 0.369, 0.000},
                                     {0.000, 0.545, 0.400},
                                     {0.690, 0.290, 0.520},
                                     {0.25, 0.25, 0.28},
                                     {0.740, 0.520, 0.000},
                                     {0.250, 0.600, 0.830}}};
  if (n < static_cast<int>(dark.size())) return dark[static_cast<size_t>(std::max(n, 0))];
  return oklch(0.55, 0.12, 0.3 + 2.399963 * n);
}

double luminance(const Rgb& c) {
  const auto linear = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

std::array<std::uint8_t, 3> bytes(const Rgb& c) {
  const auto byte = [](double x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
  return {byte(c.r), byte(c.g), byte(c.b)};
}

}  // namespace hilo
