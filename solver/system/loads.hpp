// SPDX-License-Identifier: GPL-3.0-or-later
// Loads: forces of nodes and bodies, torques, pressures, each times a history.
#pragma once
#include "base/history.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// A load: nodal weights or facets or a body, times a history.
struct Load {
  enum class Kind { nodal, pressure, body_force, body_torque } kind = Kind::nodal;
  std::string name;
  Vec3 value = Vec3::Zero();  // force [N] or torque [N m]; for nodal loads per unit weight
  double pressure = 0;        // [Pa]
  bool follower = false;
  std::vector<int> nodes;                // nodal
  std::vector<double> weight;            // share of each node; for a traction its reference area [m^2]
  std::vector<std::vector<int>> facets;  // pressure: nodes of each facet, outward
  std::vector<int> cliques;              // of the facets
  int body = -1;
  Vec3 arm = Vec3::Zero();   // body axes
  Vec3 line = Vec3::Zero();  // of a torque, body axes: nothing resists its part about that
  History history;
  bool ramped = false;  // follows the load factor: without a history, and all of modes and buckling
  double factor(double t0, double t1, double ramp) const { return (ramped ? ramp : 1) * (t1 > t0 ? history.mean(t0, t1) : history(t0)); }
};

class Loads final : public Contribution, public Equations, public Loading, public Clocked {
 public:
  explicit Loads(const Points& points) : points_(points) {}
  std::vector<Load> list;

  std::string count() const override;
  void number(Layout& layout) override;
  void evaluate(Pass& p) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void add_reference_forces(std::vector<NodalForces>& list) const override;
  void tie(Ties&) const override {}
  void add_timed(std::span<const int> group, double t, double T, std::span<double> sum) const override;

 private:
  /// Force or torque on a body at the time of a stage.
  static Vec3 acting(const Load& load, double factor, const Stage& s);
  void on_nodes(const Load& load, double factor, Pass& p) const;
  void on_body(const Load& load, double factor, Pass& p) const;
  void on_facets(const Load& load, double factor, Pass& p) const;
  const Points& points_;
};

}  // namespace hilo
