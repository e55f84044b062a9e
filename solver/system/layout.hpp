// SPDX-License-Identifier: GPL-3.0-or-later
// Where everything stands in the vectors and the matrix of a solve: a value, which another one replaces when the structure of a system
// changes while it runs.
//
// Blocks of points (nodes, bodies, amplitudes of modes) come first and keep their numbers for the whole run.  Blocks of multipliers follow
// them.  What remembers multipliers from step to step moves them from one layout to the next by what they belong to.
#pragma once
#include <compare>
#include <map>
#include <span>
#include <vector>

#include "linear/kkt.hpp"

namespace hilo {

struct Layout {
  /// What a block of multipliers belongs to: a contribution, a thing of it by a number that it keeps, a block of that thing.
  struct Row {
    int part, item, block;
    auto operator<=>(const Row&) const = default;
  };
  BlockMap map;
  Cliques cliques;
  int first_row = 0;      // blocks of multipliers begin here
  std::vector<Row> rows;  // of these blocks, the same on all ranks
  int part = 0;           // the contribution that is being numbered

  int n_blocks() const { return static_cast<int>(map.global.size()); }
  /// Blocks of multipliers for thing `item` of the contribution; the first of them.  On all ranks alike.
  int add_rows(int item, int n) {
    const int first = first_row + static_cast<int>(rows.size());
    for (int k = 0; k < n; ++k) rows.push_back({part, item, k});
    return first;
  }
};

/// Multipliers of one layout, laid out like those of the next: what is new begins at zero.
class Carry {
 public:
  Carry(const Layout& from, const Layout& to) : n_from_(3 * from.rows.size()) {
    std::map<Layout::Row, int> place;
    for (size_t k = 0; k < from.rows.size(); ++k) place[from.rows[k]] = static_cast<int>(k);
    for (const Layout::Row& row : to.rows) {
      const auto found = place.find(row);
      from_.push_back(found == place.end() ? -1 : found->second);
    }
  }
  /// Multipliers, three to a block; nothing stays nothing.
  std::vector<double> operator()(const std::vector<double>& old) const {
    if (old.size() != n_from_) return old;
    std::vector<double> out(3 * from_.size(), 0.0);
    for (size_t k = 0; k < from_.size(); ++k)
      for (int i = 0; i < 3 && from_[k] >= 0; ++i) out[3 * k + i] = old[3 * static_cast<size_t>(from_[k]) + i];
    return out;
  }

 private:
  size_t n_from_;
  std::vector<int> from_;  // block of the old layout, or -1
};

}  // namespace hilo
