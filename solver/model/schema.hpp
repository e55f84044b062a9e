// SPDX-License-Identifier: GPL-3.0-or-later
// Every array of every hilo file: path, type, shape, unit, meaning, writer.  docs/format.md is generated from this table.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace hilo {

inline constexpr std::int64_t schema_version = 1;

/// One array.  In `path`, <name> stands for any name and <step> for a six-digit field number (000000, 000001, ...).
struct ArraySchema {
  std::string_view file;  // mesh.h5, tags.h5, parts.h5, reduced.h5, run.h5
  std::string_view path;
  std::string_view type;   // f8, i8, i4, u1, string
  std::string_view shape;  // in the letters of docs/notation.md
  std::string_view unit;
  std::string_view meaning;
};
const std::vector<ArraySchema>& file_schema();
/// One more, from outside the tree, of a program that writes it.  Error where the path is taken.
void add_array(const ArraySchema& array);
/// The row of the table that an array of a file is written by, or null: "/history/joint/pin" is "/history/joint/<name>".
const ArraySchema* find_array(std::string_view file, std::string_view path);
/// The same of run.h5; a path that the table does not have is an Error (our own fault).
const ArraySchema& run_array(std::string_view path);
/// Shape of a row, from that of the array: {6} of "(n_t, 6)", {} of "(n_t)".
std::vector<std::int64_t> row_shape(const ArraySchema& array);

}  // namespace hilo
