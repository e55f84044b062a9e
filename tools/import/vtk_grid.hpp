// SPDX-License-Identifier: GPL-3.0-or-later
// An unstructured grid as a VTK file holds it.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
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
VtkGrid read_vtk_legacy(const std::string& path, std::string bytes);
/// .vtu: ASCII, inline base64 and appended arrays, plain or zlib.
VtkGrid read_vtu(const std::string& path, std::string bytes);

/// A number out of bytes, in the order of this machine or in the other one.
template <class U>
U vtk_number(const char* bytes, bool swap) {
  std::array<char, sizeof(U)> raw;
  std::copy_n(bytes, sizeof(U), raw.begin());
  if (swap) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<U>(raw);
}
/// Calls `use` with a number of the type that VTK calls so; false where there is none.
template <class Use>
bool with_vtk_type(std::string_view name, const Use& use) {
  if (name == "Float64") return use(double{}), true;
  if (name == "Float32") return use(float{}), true;
  if (name == "Int64") return use(std::int64_t{}), true;
  if (name == "UInt64") return use(std::uint64_t{}), true;
  if (name == "Int32") return use(std::int32_t{}), true;
  if (name == "UInt32") return use(std::uint32_t{}), true;
  if (name == "Int16") return use(std::int16_t{}), true;
  if (name == "UInt16") return use(std::uint16_t{}), true;
  if (name == "Int8") return use(std::int8_t{}), true;
  if (name == "UInt8") return use(std::uint8_t{}), true;
  return false;
}

}  // namespace hilo
