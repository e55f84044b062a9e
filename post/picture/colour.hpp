// SPDX-License-Identifier: GPL-3.0-or-later
// Colours: perceptually uniform maps for values, well separated colours for names.
#pragma once
#include <array>
#include <cstdint>

namespace hilo {

/// Red, green, blue from 0 to 1 (sRGB).
struct Rgb {
  double r = 0, g = 0, b = 0;
};

enum class ColourMap { viridis, cividis, diverging };
/// Colour of s in [0, 1] (clamped).  Viridis and cividis rise in lightness, so that grey print keeps their order; cividis looks the same to
/// colour-blind eyes.  Diverging goes from blue through white, its middle, to orange, which no kind of colour blindness takes for blue.
Rgb map_colour(ColourMap map, double s);
/// The n-th of an endless row of colours for categories, neighbours well apart; the first eight survive colour blindness.
Rgb category_colour(int n);
/// Colour of the n-th curve of a chart: dark enough for thin lines on white.
Rgb curve_colour(int n);
/// w = 0 gives a, w = 1 gives b.
Rgb blend(const Rgb& a, const Rgb& b, double w);
/// Relative luminance, 0 to 1: what grey print keeps [iec-61966-2-1].
double luminance(const Rgb& c);
std::array<std::uint8_t, 3> bytes(const Rgb& c);

inline constexpr Rgb white{1, 1, 1}, ink{0.13, 0.14, 0.16}, faint{0.86, 0.87, 0.88};
inline constexpr Rgb neutral{0.78, 0.79, 0.80};  ///< what has no value: rigid regions in a picture of stress

}  // namespace hilo
