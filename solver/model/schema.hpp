// Every array of every hilo file: path, type, shape, unit, meaning, writer.  docs/format.md is generated from this table.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace hilo {

inline constexpr std::int64_t schema_version = 1;

/// One array.  In `path`, <name> stands for any name and <step> for a six-digit field number (000000, 000001, ...).
struct ArraySchema {
  std::string_view file;  // mesh.h5, tags.h5, parts.h5, run.h5
  std::string_view path;
  std::string_view type;   // f8, i8, i4, u1, string
  std::string_view shape;  // in the letters of docs/notation.md
  std::string_view unit;
  std::string_view meaning;
};
const std::vector<ArraySchema>& file_schema();

}  // namespace hilo
