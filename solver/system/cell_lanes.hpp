// SPDX-License-Identifier: GPL-3.0-or-later
// What kernels of cells are called with: numbers of as many cells as there are lanes, side by side.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "system/solids.hpp"

namespace hilo {

/// Cache-line aligned scratch that grows.
class Scratch {
 public:
  double* get(size_t n) {
    if (n + 8 > store_.size()) store_.resize(n + 8);
    const auto at = reinterpret_cast<std::uintptr_t>(store_.data());
    return reinterpret_cast<double*>((at + 63) / 64 * 64);
  }

 private:
  std::vector<double> store_;
};

/// Vectors of the nodes of W cells, (entry x lanes).
inline void gather(const SolidBatch& b, int first, int W, const std::vector<Vec3>& from, double* to) {
  const int n = info(b.shape).n_nodes, count = static_cast<int>(b.cells.size());
  for (int l = 0; l < W; ++l) {
    const int* nodes = b.nodes.data() + static_cast<size_t>(std::min(first + l, count - 1)) * n;
    for (int k = 0; k < n; ++k) {
      const Vec3& v = from[nodes[k]];
      for (int i = 0; i < 3; ++i) to[(3 * k + i) * W + l] = v[i];
    }
  }
}

}  // namespace hilo
