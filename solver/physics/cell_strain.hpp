// SPDX-License-Identifier: GPL-3.0-or-later
// How far a cell is compressed, and whether it is folded.
#pragma once
#include <span>

#include "base/math.hpp"
#include "base/shape.hpp"

namespace hilo {

/// Square root of the least eigenvalue of F^T F [1]; points whose stretches are certainly above `floor` are not looked at, so the value is
/// exact below it.
double least_stretch(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, double floor);

/// Smallest det F over the points of the mass rule, between which those of the stress see less: hex20r has 8 of 27, hex8 one of 8.  Values
/// above zero are not made exact: 1.
double least_det(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x);

}  // namespace hilo
