// SPDX-License-Identifier: GPL-3.0-or-later
// The types of elements of gmsh by number, and which of our shapes they are.
#pragma once
#include <cstddef>
#include <vector>

#include "import/imported.hpp"

namespace hilo {

/// A type of element by its number in gmsh.  One that is read has our shape and the order of its nodes, ours[i] = gmsh[p[i]].
struct GmshType {
  int type, dimension, n_nodes;
  const char* name;
  Shape shape = Shape::bar2;
  std::vector<int> p = {};
  const char* reduced = nullptr;  // what it was before nodes were left out
  [[nodiscard]] bool is_read() const { return !p.empty(); }
};
/// Null for one that is not known here.
const GmshType* gmsh_type(int type);

/// Corners of a 2-D element type, 0 where it is none.
size_t face_corners(int type);

}  // namespace hilo
