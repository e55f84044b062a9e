// SPDX-License-Identifier: GPL-3.0-or-later
// Heights over a grid, of a file: a CSV of a word and the x of the columns, then lines of a y and the heights there; or a grey PNG image.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace hilo {

struct Entry;
class Scene;

/// x and y rise, two at least; heights row by row.
struct HeightGrid {
  std::vector<double> x, y, heights;
};
/// Of a CSV, in its own numbers.  Errors with the place in the file; `where` names it.
HeightGrid read_height_grid(const std::string& path, const std::string& where);
/// Of a grey PNG image, whose left lowest pixel is x = y = 0: `size` from the first pixel to the last along x and y, `range` of black and
/// of white [m].
HeightGrid read_height_image(const std::string& path, const std::string& where, std::span<const double> size,
                             std::span<const double> range);
/// Of an [[obstacle]] of kind height-field [m].
HeightGrid height_grid_of(const Entry& e, const Scene& scene);

}  // namespace hilo
