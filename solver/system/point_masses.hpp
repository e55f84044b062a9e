// SPDX-License-Identifier: GPL-3.0-or-later
// Masses at nodes.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

class PointMasses final : public Contribution, public Equations, public Clocked {
 public:
  explicit PointMasses(const Points& points) : points_(points) {}
  /// At a local node [kg]; all ranks' masses there add up.
  void add(int node, double mass) { masses_.emplace_back(node, mass); }
  Traits traits() const override { return {.lumps_masses = !masses_.empty()}; }
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void tie(Ties&) const override {}
  void add_inertia(std::span<const int> group, const Config& v, const Config& w, std::span<double> sum) const override;

 private:
  const Points& points_;
  std::vector<std::pair<int, double>> masses_;
};

}  // namespace hilo
