// SPDX-License-Identifier: GPL-3.0-or-later
// In which order the blocks of a symmetric matrix are eliminated, and what its Cholesky factor then looks like: columns with the same rows
// below them are one front [liu-1992].
#pragma once
#include <vector>

#include "linear/kkt.hpp"

namespace hilo {

/// Rows of the lower triangle, by columns, of the matrix that the cliques make: rows[start[c] .. start[c + 1]), rising from c.
struct LowerBlocks {
  std::vector<std::int64_t> start;
  std::vector<int> rows;
  LowerBlocks() = default;
  LowerBlocks(const Cliques& cliques, int n);
};

struct FrontOrder {
  std::vector<int> place;          // of each block in the elimination
  std::vector<int> first;          // column of each front, and n_blocks
  std::vector<std::int64_t> from;  // of its rows among `rows`, and their number
  std::vector<int> rows;           // of each front, rising: its own columns, then those below
  std::vector<int> parent;         // front that takes what this one leaves, or -1
  double entries = 0, flops = 0;   // of the factor

  FrontOrder() = default;
  /// Nested dissection.  Errors: no memory for it.
  FrontOrder(const Cliques& cliques, int n_blocks);
  int n_fronts() const { return static_cast<int>(parent.size()); }
  int columns(int front) const { return first[front + 1] - first[front]; }
  int height(int front) const { return static_cast<int>(from[front + 1] - from[front]); }
  double flops_of(int front) const;
};

}  // namespace hilo
