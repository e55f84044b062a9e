#include "physics/stretch.hpp"

#include "physics/shape/from_outside.hpp"
#include "physics/shape/shapes.hpp"
#include "physics/stretch_of_shape.hpp"

namespace hilo {

double least_stretch(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, double floor) {
  if (shape == Shape::bar2) return (x[1] - x[0]).norm() / (X[1] - X[0]).norm();
  if (const ShapeFunctions* other = shape_from_outside(shape)) return other->least_stretch(X, x, floor);
  return of_shape(shape, 1.0, [&]<class S>() { return least_stretch_of<S>(X, x, floor); });
}

}  // namespace hilo
