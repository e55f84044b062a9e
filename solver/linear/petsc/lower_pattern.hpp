// SPDX-License-Identifier: GPL-3.0-or-later
// The lower half of a symmetric pattern in an order in which factors without fill are good and neighbours are near.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace hilo::petsc {

struct LowerPattern {
  std::vector<int> row;          // of the matrix, for each place in the order
  std::vector<int> place;        // and back
  std::vector<size_t> start{0};  // of each place's columns (n + 1)
  std::vector<int> column;       // places before, ascending

  int n() const { return static_cast<int>(row.size()); }
};

/// Breadth first from a peripheral row, turned round [cuthill-mckee-1969].  Rows of the pattern: columns[start[i] .. start[i + 1]).  Those
/// from `n_ordered` on keep their places at the end.
LowerPattern order_lower(std::span<const int> start, std::span<const int> columns, int n_ordered);

}  // namespace hilo::petsc
