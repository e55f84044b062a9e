// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cell_strain.hpp"

#include "physics/cell_strain_of_shape.hpp"
#include "physics/shape/from_outside.hpp"
#include "physics/shape/shapes.hpp"

namespace hilo {

double least_stretch(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, double floor) {
  if (shape == Shape::bar2) return (x[1] - x[0]).norm() / (X[1] - X[0]).norm();
  if (const ShapeFunctions* other = shape_from_outside(shape)) return other->least_stretch(X, x, floor);
  return of_shape(shape, 1.0, [&]<class S>() { return least_stretch_of<S>(X, x, floor); });
}

double least_det(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x) {
  if (const ShapeFunctions* other = shape_from_outside(shape)) return other->least_det(X, x);
  return of_shape(shape, 1.0, [&]<class S>() { return least_det_of<S>(X, x); });
}

}  // namespace hilo
