// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/stress_over_yield.hpp"

#include <algorithm>
#include <cmath>

#include "base/shell_shape.hpp"
#include "physics/stress.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

std::span<const int> nodes_of(const SolidBatch& batch, size_t number) {
  const auto n = static_cast<size_t>(info(batch.shape).n_nodes);
  return std::span(batch.nodes).subspan(n * number, n);
}

/// Of the points, over yield stress; by small strain, or where that is `large` by that of Green and Lagrange.
double largest_of_points(const SolidBatch& batch, std::span<const Vec3> X, std::span<const Vec3> x, bool large) {
  if (info(batch.shape).dimension < 3) return von_mises(bar_stress(batch.material, X, x)) / batch.yield;
  static thread_local std::vector<StressPoint> points;
  if (large) {
    stress_points(batch.shape, batch.material, X, x, StressPoints::integration, points);
    for (StressPoint& p : points) p.S = cauchy(p.F, p.S);
  } else if (batch.shape == shell8) {  // with as many points across as it flows at
    small_strain_points(batch.shape, batch.material, X, x, StressPoints::integration, points);
  } else {
    small_strain_points(batch.shape, StVenantKirchhoff{linear_moduli(batch.material)}, X, x, StressPoints::integration, points);
  }
  double most = 0;
  for (const StressPoint& p : points) most = std::max(most, von_mises(p.S));
  return most / batch.yield;
}

}  // namespace

StressOverYield::StressOverYield(const System& system) : system_(system) {
  const auto& linear = system.part<LinearRegions>();
  for (const LinearRegion& r : linear.regions) {
    const Modes& m = system.modes[r.modes];
    Region& of = regions_.emplace_back();
    for (size_t b = 0; b < linear.cells.size(); ++b) {
      const SolidBatch& batch = linear.cells[b];
      if (linear.body_of_cells[b] != m.body || !std::isfinite(batch.yield)) continue;
      for (size_t e = 0; e < batch.cells.size(); ++e)
        of.cells.push_back(
            {&batch, e, !m.stiffens && std::ranges::all_of(nodes_of(batch, e), [&](int i) { return system.follower[i] == m.body; })});
    }
    of.of_mode.setZero(m.n_modes, static_cast<Eigen::Index>(of.cells.size()));
    for (size_t c = 0; c < of.cells.size(); ++c)
      if (of.cells[c].by_modes) of.of_mode.col(static_cast<Eigen::Index>(c)) = of_modes(m, of.cells[c]);
    has_metal_ = has_metal_ || !of.cells.empty();
  }
  has_metal_ = system.comm->max(has_metal_ ? 1 : 0) > 0;
}

Eigen::VectorXd StressOverYield::of_modes(const Modes& m, const Cell& cell) const {
  constexpr double small = 1e-6;  // displacements, over the size of the cell
  Eigen::VectorXd out = Eigen::VectorXd::Zero(m.n_modes);
  const std::span<const int> nodes = nodes_of(*cell.batch, cell.number);
  std::vector<Vec3> X, x(nodes.size());
  for (const int i : nodes) X.push_back(system_.X[i]);
  double size = 0;
  for (const Vec3& at : X) size = std::max(size, (at - X[0]).norm());
  for (int j = 0; j < m.n_modes; ++j) {
    double most = 0;
    for (const int i : nodes) most = std::max(most, system_.shapes_at(i)[j].norm());
    if (most == 0) continue;
    const double scale = small * size / most;
    for (size_t a = 0; a < nodes.size(); ++a) x[a] = X[a] + scale * system_.shapes_at(nodes[a])[j];
    out[j] = largest_of_points(*cell.batch, X, x, false) / scale;
  }
  return out;
}

double StressOverYield::of_cell(const Modes& m, const Cell& cell, const Config& q) const {
  std::vector<Vec3> X, x;
  for (const int i : nodes_of(*cell.batch, cell.number)) {
    X.push_back(system_.X[i]), x.push_back(X.back());
    if (system_.follower[i] == m.body) {
      const auto shapes = system_.shapes_at(i);
      for (size_t j = 0; j < shapes.size(); ++j) x.back() += q.eta[m.first + j / 3][j % 3] * shapes[j];
    } else {
      x.back() = system_.bodies[m.body].Xc + q.R[m.body].transpose() * (system_.at(q, i) - q.c[m.body]);
    }
  }
  return largest_of_points(*cell.batch, X, x, m.stiffens);
}

double StressOverYield::largest(size_t k, const Config& q, const Eigen::VectorXd& eta, double least) const {
  const Region& r = regions_[k];
  const Modes& m = system_.modes[system_.part<LinearRegions>().regions[k].modes];
  const Eigen::VectorXd bound = r.of_mode.transpose() * eta.cwiseAbs();
  std::vector<std::pair<double, size_t>> order;
  for (size_t c = 0; c < r.cells.size(); ++c)
    if (!r.cells[c].by_modes)
      order.emplace_back(HUGE_VAL, c);
    else if (const double b = bound[static_cast<Eigen::Index>(c)]; b > least)
      order.emplace_back(b, c);
  std::ranges::sort(order, std::greater{});
  for (const auto& [at_most, c] : order) {
    if (at_most <= least) break;
    least = std::max(least, of_cell(m, r.cells[c], q));
  }
  return least;
}

}  // namespace hilo
