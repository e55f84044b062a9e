// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/resolved.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/mesh.hpp"
#include "system/linear_regions.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

/// Twice the r.m.s. distance of the corners from their middle along the longest direction: the longest edge of a box.
double length_of(std::span<const int> corners, const std::vector<Vec3>& X) {
  Vec3 middle = Vec3::Zero();
  for (const int n : corners) middle += X[n] / static_cast<double>(corners.size());
  Mat3 spread = Mat3::Zero();
  for (const int n : corners) spread += (X[n] - middle) * (X[n] - middle).transpose() / static_cast<double>(corners.size());
  return 2 * std::sqrt(Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvalues()[2]);
}

double frequency_of(const SolidBatch& batch, const std::vector<Vec3>& X) {
  const ShapeInfo& shape = info(batch.shape);
  double longest = 0;
  for (size_t c = 0; c < batch.cells.size(); ++c)
    longest = std::max(longest,
                       length_of({batch.nodes.data() + c * static_cast<size_t>(shape.n_nodes), static_cast<size_t>(shape.n_corners)}, X));
  const bool linear = shape.n_nodes == shape.n_corners;
  const double kL = linear ? std::sqrt(24 * 0.01) : std::pow(1440 * 0.01, 0.25);
  return kL / longest * std::sqrt(linear_moduli(batch.material).mu / batch.density) / (2 * std::numbers::pi);
}

}  // namespace

std::vector<double> resolved_frequencies(const System& system) {
  if (!system.mesh) return {};
  std::vector<double> lowest(system.mesh->mesh.region_name.size(),
                             -std::numeric_limits<double>::infinity());  // negative, for the largest of all ranks
  const auto bound = [&](int region, double frequency) { lowest[region] = std::max(lowest[region], -frequency); };
  const LinearRegions& linear = system.part<LinearRegions>();
  for (const auto* batches : {&system.part<Solids>().batches, &linear.cells})
    for (const SolidBatch& batch : *batches) bound(batch.region, frequency_of(batch, system.X));
  for (const LinearRegion& r : linear.regions)
    if (r.held_frequency > 0)
      for (size_t k = 0; k < linear.cells.size(); ++k)
        if (linear.body_of_cells[k] == system.modes[r.modes].body) bound(linear.cells[k].region, r.held_frequency);
  system.comm->max(lowest);
  for (double& f : lowest) f = -f;
  return lowest;
}

}  // namespace hilo
