// SPDX-License-Identifier: GPL-3.0-or-later
// What all ranks have of a linear region, brought to rank 0, where its modes are found.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "system/welds.hpp"

namespace hilo {

/// Lists by ranks.
struct RegionParcel {
  std::string where;
  bool modes_given = false;
  double modal_damping = 0, up_to = 0;
  int n_vibrations = 0;
  bool stiffening = false;
  std::string shapes, shapes_where;  // file of modes that are given, or ""
  std::vector<Weld*> welds;
  std::vector<std::vector<std::int64_t>> words;                         // cells: region, shape, rows of nodes
  std::vector<std::vector<double>> places;                              // of these nodes
  std::vector<std::vector<std::vector<std::int64_t>>> interfaces;       // rows: of nonlinear neighbours, then of each weld
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> tied;  // rows of nodes that ties hold, and their names; on rank 0
  std::vector<std::vector<std::int64_t>> load_sizes;                    // how many forces of each load, the same loads on all ranks
  std::vector<std::vector<double>> loads;                               // rows and forces
  std::vector<std::vector<std::int64_t>> numbers;                       // rows and numbers in the deck, where shapes are given
  std::vector<std::vector<std::int64_t>> blocks;                        // rows and numbers of blocks, of nodes that move as one
  std::map<std::int64_t, int> local;                                    // of rows, in the order of their numbers

  /// Numbers of the nodes in the region, rising.
  std::vector<int> nodes_of(size_t interface) const {
    std::vector<int> out;
    for (const auto& list : interfaces[interface])
      for (const std::int64_t row : list) out.push_back(local.at(row));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  /// Visit region, shape, rows of nodes and their places of each cell.
  template <class Visit>
  void each_cell(Visit&& visit) const {
    for (size_t k = 0; k < words.size(); ++k) {
      const double* X = places[k].data();
      for (size_t at = 0; at < words[k].size();) {
        const auto region = static_cast<int>(words[k][at]);
        const auto shape = static_cast<Shape>(words[k][at + 1]);
        const auto n = static_cast<size_t>(info(shape).n_nodes);
        visit(region, shape, std::span(words[k].data() + at + 2, n), X);
        at += 2 + n, X += 3 * n;
      }
    }
  }
};

}  // namespace hilo
