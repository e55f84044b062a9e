// SPDX-License-Identifier: GPL-3.0-or-later
// An unstructured grid as a VTK file holds it.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace hilo {

struct VtkGrid {
  std::vector<double> points;                            // (n_points x 3)
  std::vector<std::int64_t> connectivity, offsets;       // offsets: one more than cells, from 0
  std::vector<int> types;                                // VTK cell types
  std::map<std::string, std::vector<double>> cell_data;  // arrays of one component
  std::set<std::string> not_read;                        // arrays of nodes, and of cells with several components
};

/// Legacy .vtk, ASCII or binary, versions up to 5.1.
VtkGrid read_vtk_legacy(const std::string& path, const std::string& bytes);
/// .vtu: ASCII, inline base64 and appended arrays, plain or zlib.
VtkGrid read_vtu(const std::string& path, const std::string& bytes);

}  // namespace hilo
