// SPDX-License-Identifier: GPL-3.0-or-later
// Masses at nodes.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

class PointMasses final : public Contribution, public Equations, public Loading, public Clocked {
 public:
  explicit PointMasses(const Points& points) : points_(points) {}
  /// Those of one entry at local nodes [kg], and their centre; all ranks' masses at a node add up.  Collective.
  void add(const std::vector<std::pair<int, double>>& masses, const Vec3& centre);
  Traits traits() const override { return {.lumps_masses = !masses_.empty()}; }
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  /// They push along and about each axis, as they do on a linear region that moves below them.
  void add_reference_forces(std::vector<NodalForces>& list) const override;
  void tie(Ties&) const override {}
  void add_inertia(std::span<const int> group, const Config& v, const Config& w, std::span<double> sum) const override;

 private:
  const Points& points_;
  struct OfEntry {
    size_t end;  // of its masses, behind those of the entry before
    Vec3 centre;
  };
  std::vector<std::pair<int, double>> masses_;
  std::vector<OfEntry> entries_;  // on all ranks
};

}  // namespace hilo
