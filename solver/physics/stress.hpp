// Stress recovery: Cauchy stress at the nodes of a cell.
#pragma once
#include <span>

#include "base/math.hpp"
#include "base/shape.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo {

/// Cauchy stress xx yy zz yz xz xy at each node of a cell [Pa]: from the integration points by a least-squares linear field in the
/// cell's own coordinates; for the one-point hexahedron from its assumed strain field.
void nodal_stress(Shape shape, Law law, const Lame& c, std::span<const Vec3> X, std::span<const Vec3> x, std::span<Vec6> stress);

double von_mises(const Vec6& s);

}  // namespace hilo
