// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of shells from one line that does not let them turn freely, a fold or a clamp, to the next.
//
// Of n shells in such a row, clamped at both ends, the deflection in the middle is 4/n^2 too small: each bends evenly, as its edges lie on
// straight lines, and the mid-points of n straight pieces of a beam lack just this under an even load (n even).  With one end free or
// both hinged it is exact.
#pragma once
#include <cstdint>
#include <vector>

namespace hilo {

struct Imported;
class Sheets;

struct ShortRows {
  std::int64_t n_shells = 0;  // in rows of less than enough_in_a_row
  int fewest = 0;             // shells in the shortest of them,
  std::int64_t cell = -1;     // and the first of that
};
inline constexpr int enough_in_a_row = 8;

/// Of quadrangles, all of them in `sheets`.
ShortRows short_rows(const Imported& in, const Sheets& sheets, const std::vector<std::int64_t>& cells);

}  // namespace hilo
