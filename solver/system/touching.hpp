// SPDX-License-Identifier: GPL-3.0-or-later
// What holds parts by touching them.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <span>

#include "system/system.hpp"

namespace hilo {

/// A role that a contribution may play besides those of contribution.hpp.
class Touching {
 public:
  virtual ~Touching() = default;
  /// Whether there is anything to touch; the same on all ranks.
  virtual bool touches() const = 0;
  /// Whether facets of the mesh do; the same on all ranks.
  virtual bool has_facets() const = 0;
  /// Which of its pairs are known to be apart, and by how much: "contact "c" begins 1e-05 m apart", or "".  Collective.
  virtual std::string apart(const Config& q) const = 0;
  /// From now on, small motions about q: what is pressed there is held, and nothing else meets.
  virtual void hold(const Config& q) = 0;
  /// Pressure of the points of a facet [Pa], their shares of its nodes (points x nodes) and their areas [m^2].
  struct Pressed {
    std::span<const int> nodes;
    Eigen::MatrixXd share;
    Eigen::VectorXd pressure, area;
  };
  /// From now on none is stiffer than this share of E/l, the facet's own cell, on the way to an answer; HUGE_VAL: all as they are.
  virtual void soften(double most) = 0;
  /// From now on friction holds whatever pulls, on the way to an answer, or no more.
  virtual void stick(bool on) = 0;
  /// Largest depth, as a share of the facet's cell.  Collective.
  virtual double depth(const Config& q) const = 0;
  /// For each facet of this rank.
  virtual void each_facet(const Config& q, const std::function<void(const Pressed&)>& visit) const = 0;
};

/// That of the scene, or null.
inline Touching* touching(const System& system) {
  for (const auto& part : system.parts())
    if (auto* found = dynamic_cast<Touching*>(part.get()); found && found->touches()) return found;
  return nullptr;
}

}  // namespace hilo
