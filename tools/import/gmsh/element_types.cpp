// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/element_types.hpp"

#include <numeric>

namespace hilo {

const GmshType* gmsh_type(int type) {
  static const auto first = [](int n) {
    std::vector<int> p(static_cast<size_t>(n));
    std::iota(p.begin(), p.end(), 0);
    return p;
  };
  static const std::vector<int> hex20{0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
  static const std::vector<int> wedge15{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
  static const std::vector<GmshType> types = {
      {1, 1, 2, "Line 2", Shape::bar2, first(2)},
      {2, 2, 3, "Triangle 3", tri3, first(3)},
      {3, 2, 4, "Quadrilateral 4", quad4, first(4)},
      {4, 3, 4, "Tetrahedron 4", Shape::tet4, first(4)},
      {5, 3, 8, "Hexahedron 8", Shape::hex8, first(8)},
      {6, 3, 6, "Prism 6", Shape::wedge6, first(6)},
      {7, 3, 5, "Pyramid 5"},
      {8, 1, 3, "Line 3", Shape::bar2, first(2), "line3"},
      {9, 2, 6, "Triangle 6", tri6, first(6)},
      {10, 2, 9, "Quadrilateral 9", quad8, first(8), "quad9"},
      {11, 3, 10, "Tetrahedron 10", Shape::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
      {12, 3, 27, "Hexahedron 27", Shape::hex20r, hex20, "hex27"},
      {13, 3, 18, "Prism 18", Shape::wedge15, wedge15, "wedge18"},
      {14, 3, 14, "Pyramid 14"},
      {15, 0, 1, "Point"},
      {16, 2, 8, "Quadrilateral 8", quad8, first(8)},
      {17, 3, 20, "Hexahedron 20", Shape::hex20r, hex20},
      {18, 3, 15, "Prism 15", Shape::wedge15, wedge15},
      {19, 3, 13, "Pyramid 13"},
      {20, 2, 9, "Triangle 9"},
      {21, 2, 10, "Triangle 10"},
      {22, 2, 12, "Triangle 12"},
      {23, 2, 15, "Triangle 15"},
      {24, 2, 15, "Triangle 15I"},
      {25, 2, 21, "Triangle 21"},
      {26, 1, 4, "Line 4"},
      {27, 1, 5, "Line 5"},
      {28, 1, 6, "Line 6"},
      {29, 3, 20, "Tetrahedron 20"},
      {30, 3, 35, "Tetrahedron 35"},
      {31, 3, 56, "Tetrahedron 56"},
      {36, 2, 16, "Quadrilateral 16"},
      {37, 2, 25, "Quadrilateral 25"},
      {92, 3, 64, "Hexahedron 64"},
      {93, 3, 125, "Hexahedron 125"},
  };
  for (const auto& t : types)
    if (t.type == type) return &t;
  return nullptr;
}

size_t face_corners(int type) {
  const GmshType* t = gmsh_type(type);
  return t && t->dimension == 2 && t->is_read() ? static_cast<size_t>(info(t->shape).n_corners) : 0;
}

}  // namespace hilo
