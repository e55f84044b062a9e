// SPDX-License-Identifier: GPL-3.0-or-later
// Stress of one cell at points of it, as its kernel sees it: what recovery (dynamics/stress_recovery) is made from.
#pragma once
#include <span>
#include <vector>

#include "base/math.hpp"
#include "base/shape.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo {

/// Which points of a cell.
///  - integration: those of its stiffness; of the one-point hexahedron 2 x 2 x 2, where its assumed strains vary;
///  - samples: where stresses are best.  Of quadratic hexahedra 2 x 2 x 2, whatever they are integrated with [barlow-1976]; else
///  integration;
///  - everywhere: those of its mass, enough to integrate the square of an error.
enum class StressPoints { integration, samples, everywhere };

struct StressPoint {
  Vec3 X;              // reference position                         [m]
  double w;            // reference volume                           [m^3]
  Mat3 F;              // deformation gradient; of hex8 its mean     [1]
  Vec6 S;              // second Piola-Kirchhoff xx yy zz yz xz xy   [Pa]
  const double* N;     // shape functions of the cell                 [1]
  double plastic = 0;  // equivalent plastic strain                [1]
};

/// Points of a solid cell at positions x of its nodes; where its law remembers, the integration points, with their state (null: as new).
void stress_points(Shape shape, const Material& material, std::span<const Vec3> X, std::span<const Vec3> x, StressPoints which,
                   std::vector<StressPoint>& out, const double* state = nullptr);

/// The same to first order in the displacements x - X, of a cell as new; F is that of x or near the identity.
void small_strain_points(Shape shape, const Material& material, std::span<const Vec3> X, std::span<const Vec3> x, StressPoints which,
                         std::vector<StressPoint>& out);

/// Whether integration, samples and everywhere are the same points.
bool has_one_set_of_points(Shape shape, bool remembers);

/// Deformation gradient at each node of a solid cell; where the cell has no volume at a node (collapsed corners), its mean.
void nodal_gradients(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, std::span<Mat3> F);

/// Values at the nodes of a cell from those at its samples (n_nodes x n_samples), by least squares in the cell's own coordinates: linear
/// functions, of hexahedra, wedges and shells their products across the axes too; the mean where cells are linear.  With four layers of
/// samples in a shell, by the two next to each face.
const Eigen::MatrixXd& to_nodes(Shape shape, size_t n_samples);

/// Of a shell8 the linear functions across its thickness with the same mean and moment as the samples (8 x n_samples).
const Eigen::MatrixXd& shell_moments_to_nodes(size_t n_samples);

/// Cauchy stress F S F^T / det F.
Vec6 cauchy(const Mat3& F, const Vec6& S);
/// Cauchy stress of a bar of two nodes: along the bar alone.
Vec6 bar_stress(const Material& material, std::span<const Vec3> X, std::span<const Vec3> x);

/// A norm of deviators: |von_mises(a) - von_mises(b)| <= von_mises(a - b).
double von_mises(const Vec6& s);

}  // namespace hilo
