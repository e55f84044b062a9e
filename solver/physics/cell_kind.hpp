// Solid shapes from outside the tree.  A program that has one writes its struct S (shape/shape.hpp), adds its facets and numbers to the
// shapes of meshes (add_shape of model/mesh.hpp) and cell_kind<S>() of cell_of_shape.hpp here, before it reads the first mesh.
#pragma once
#include "physics/stress.hpp"

namespace hilo {

/// What is done with cells of a shape; see solid_kernel.hpp, stress.hpp and stretch.hpp.
struct CellKind {
  Shape shape;
  int n_points, width;  // points where a law remembers; cells that the kernels take at once
  KernelFunction (*kernel)(size_t law);
  double (*least_stretch)(std::span<const Vec3> X, std::span<const Vec3> x, double floor);
};
void add_cell(const CellKind& kind);
/// Null for the shapes of the tree.
const CellKind* cell_from_outside(Shape shape);

}  // namespace hilo
