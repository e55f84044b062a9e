// SPDX-License-Identifier: GPL-3.0-or-later
// Cells to parts, by METIS, with what METIS does not promise checked: no part empty, the work balanced.
#pragma once
#include <cstdint>
#include <vector>

#include "part/graph.hpp"

namespace hilo {

/// What a partition is worth.
struct PartReport {
  std::vector<std::int64_t> cells, nonlinear_cells, nonlinear_work, other_work;  // per part
  std::vector<int> pieces, nonlinear_pieces;                                     // connected pieces per part; of its nonlinear cells alone
  std::int64_t cut = 0, nonlinear_cut = 0;                                       // facets between parts; those between two nonlinear cells
  double nonlinear_balance = 1, other_balance = 1;                               // largest work over the mean
  double speed_up = 1;                                                           // all work over the largest of a part
};
PartReport report(const CellGraph& graph, const std::vector<std::int32_t>& part, int n_parts);

/// Balance nonlinear and other work separately (weighted), or the number of cells (uniform).  Throws Error when there are more parts than
/// cells, or than nonlinear cells while there are some.  Of several attempts the best is returned: first no empty part, then balance, then
/// few pieces, then a small cut.
std::vector<std::int32_t> partition(const CellGraph& graph, const Mesh& mesh, int n_parts, bool weighted);

}  // namespace hilo
