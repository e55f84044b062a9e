// SPDX-License-Identifier: GPL-3.0-or-later
// Surface integrals over facets of three, four, six or eight nodes.
#pragma once
#include <span>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// Shape functions of a facet of n nodes at (r, s), and their slopes; of a triangle r and s from 0 to 1, else from -1 to 1.
struct FacetShape {
  double N[8], dr[8], ds[8];
};
FacetShape facet_shape(size_t n, double r, double s);

/// Reference area belonging to each node: int N_a dA [m^2].
std::vector<double> facet_weights(std::span<const Vec3> X);

/// Force of a pressure p on the facet's nodes, averaged over the straight path from x0 to x1:  f_a = -p int N_a n dA.
/// The pressure force is quadratic in x, so two Gauss points along the path are exact and sum f.(x1 - x0) is p times the change of the
/// volume below the facet.  K = df/dx1 (3n x 3n, row major) when given.
void pressure_force(double p, std::span<const Vec3> x0, std::span<const Vec3> x1, std::span<Vec3> f, double* K);

/// w with R1 - R0 = skew(w) (R0 + R1)/2.
Vec3 rotation_increment(const Mat3& R0, const Mat3& R1);

}  // namespace hilo
