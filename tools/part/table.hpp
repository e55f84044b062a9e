// SPDX-License-Identifier: GPL-3.0-or-later
// What hilo-part prints.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/table.hpp"
#include "part/partition.hpp"

namespace hilo {

struct Division {
  std::string weights;             // weighted or uniform
  std::vector<std::int32_t> part;  // (n_cells)
  PartReport report;
  std::optional<PartReport> other;  // with the other weights, where they differ
};
std::string division_text(const Division& d, const CellGraph& graph);
std::string division_json(const Division& d, const CellGraph& graph, const std::string& output);
/// Uniform and weighted partitions into 2, 4, 8 ... `most` parts: the largest nonlinear work over its mean, and the speed-up that the work
/// allows (exchange left out); work of rigid and linear cells, pieces and cut facets of the weighted ones.
Table comparison(const CellGraph& graph, const Mesh& mesh, int most);
std::string csv(const Table& table);
/// What is less than good about a partition, one line each.
std::vector<std::string> doubts(const Division& d);

}  // namespace hilo
