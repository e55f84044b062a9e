// SPDX-License-Identifier: GPL-3.0-or-later
// The value largest in size that a field has in every region over steps of a run.
#pragma once
#include <functional>

#include "post/run/run_file.hpp"

namespace hilo {

struct FieldPeak {
  double value = 0, t = 0;  // [unit of the file], [s]
  std::int64_t place = -1;  // node or cell; -1: none
};
/// One for each region of the mesh; those that are not `wanted` have none.  `values` gives a number for each node at a step, as a region
/// has it (-1: as nodes have it), or for each cell.
std::vector<FieldPeak> field_peaks(RunFile& run, const std::vector<Step>& steps, const std::vector<bool>& wanted,
                                   const std::function<std::vector<double>(const Step&, int region)>& values, bool of_cells = false);

/// Regions, of those shown, whose stress at nodes shared with regions before them no envelope has: named in a warning.
std::vector<bool> warn_of_envelope(RunFile& run, const std::vector<bool>& shown, const std::string& field);

}  // namespace hilo
