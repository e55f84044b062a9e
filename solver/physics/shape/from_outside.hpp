// SPDX-License-Identifier: GPL-3.0-or-later
// A solid shape that a program outside the tree brings: what is done with its cells.  add_shape (system/add_shape.hpp) makes the functions
// from a struct like those of this folder.
#pragma once
#include <Eigen/Core>

#include "physics/stress.hpp"

namespace hilo {

struct ShapeFunctions {
  int n_points;  // where a law remembers
  int width;     // cells that a kernel takes at once
  /// Null for a law that the shape has none of: one from outside that it was not added with.
  KernelFunction (*kernel)(size_t law);
  double (*least_stretch)(std::span<const Vec3> X, std::span<const Vec3> x, double floor);
  double (*least_det)(std::span<const Vec3> X, std::span<const Vec3> x);
  /// False for such a law.
  bool (*stress_points)(const Material&, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, StressPoints which,
                        std::vector<StressPoint>& out);
  const Eigen::MatrixXd& (*to_nodes)();
  void (*nodal_gradients)(std::span<const Vec3> X, std::span<const Vec3> x, std::span<Mat3> F);
};

/// Null for the shapes of the tree.
const ShapeFunctions* shape_from_outside(Shape shape);
void add_shape_functions(Shape shape, const ShapeFunctions& functions);

}  // namespace hilo
