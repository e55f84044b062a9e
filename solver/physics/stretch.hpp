// Largest compression of a cell: the least principal stretch over its integration points.
#pragma once
#include <span>

#include "base/math.hpp"
#include "base/shape.hpp"

namespace hilo {

/// Square root of the least eigenvalue of F^T F [1]; points whose stretches are certainly above `floor` are not looked at, so the value is
/// exact below it.
double least_stretch(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, double floor);

}  // namespace hilo
