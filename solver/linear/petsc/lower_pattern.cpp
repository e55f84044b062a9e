// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/lower_pattern.hpp"

#include <algorithm>

namespace hilo::petsc {

LowerPattern order_lower(std::span<const int> start, std::span<const int> columns, int n_ordered) {
  const int n = static_cast<int>(start.size()) - 1;
  LowerPattern p;
  p.place.assign(n, -1);
  for (int seed = 0; seed < n_ordered; ++seed) {
    if (p.place[seed] >= 0) continue;
    int from = seed;
    for (int sweep = 0; sweep < 2; ++sweep) {  // the last row reached is far away: start there
      const size_t first = p.row.size();
      p.row.push_back(from), p.place[from] = 0;
      for (size_t k = first; k < p.row.size(); ++k)
        for (int e = start[p.row[k]]; e < start[p.row[k] + 1]; ++e)
          if (columns[e] < n_ordered && p.place[columns[e]] < 0) p.place[columns[e]] = 0, p.row.push_back(columns[e]);
      if (sweep == 1) break;
      from = p.row.back();
      for (size_t k = first; k < p.row.size(); ++k) p.place[p.row[k]] = -1;
      p.row.resize(first);
    }
  }
  std::reverse(p.row.begin(), p.row.end());
  for (int i = n_ordered; i < n; ++i) p.row.push_back(i);
  for (int k = 0; k < n; ++k) p.place[p.row[k]] = k;
  for (int i = 0; i < n; ++i) {
    for (int e = start[p.row[i]]; e < start[p.row[i] + 1]; ++e)
      if (p.place[columns[e]] < i) p.column.push_back(p.place[columns[e]]);
    std::sort(p.column.begin() + static_cast<std::ptrdiff_t>(p.start.back()), p.column.end());
    p.start.push_back(p.column.size());
  }
  p.column.shrink_to_fit();
  return p;
}

}  // namespace hilo::petsc
