// SPDX-License-Identifier: GPL-3.0-or-later
// A grid of heights in a CSV file: a word and the x of the columns, then lines of a y and the heights there.
#pragma once
#include <string>
#include <vector>

namespace hilo {

/// x and y rise, two at least; heights row by row, in the numbers of the file.
struct HeightGrid {
  std::vector<double> x, y, heights;
};
/// Errors with the place in the file; `where` names it.
HeightGrid read_height_grid(const std::string& path, const std::string& where);

}  // namespace hilo
