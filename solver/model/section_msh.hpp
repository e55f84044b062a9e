// SPDX-License-Identifier: GPL-3.0-or-later
// A text file of gmsh (.msh 2.2 or 4.1) that holds the face of a section, as it was read: nothing but its words is checked.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/math.hpp"

namespace hilo {

struct SectionMsh {
  struct Element {
    int corners, nodes;                // of a triangle or quadrangle; 9 nodes at most
    std::array<std::int64_t, 9> node;  // by their numbers
    int line;
  };
  std::string path;
  std::unordered_map<std::int64_t, std::pair<Vec3, int>> nodes;  // place and line
  std::vector<Element> elements;

  /// Throws Error at this line of the file.
  [[noreturn]] void fail_at(int line, const std::string& what, const std::string& hint = "") const;
};
/// Throws Error with line and column where the text is no such file, is cut off, or holds a solid.
SectionMsh read_section_msh(const std::string& text, const std::string& path);

}  // namespace hilo
