// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of forces along the measures of a connector.
#pragma once
#include <array>
#include <memory>

#include "base/archive.hpp"
#include "physics/connector.hpp"

namespace hilo {

/// Stress-like response of a spring to its measures over a step.
struct Response {
  std::array<double, max_measures> s{};                            // conjugate forces
  std::array<std::array<double, max_measures>, max_measures> D{};  // ds/de1
  double energy = 0, dissipated = 0, supplied = 0;                 // at e1 [J]; over the step [J]
  std::array<double, max_measures> by_load{};                      // ds/d Interval::load
};

/// What a rate force may ask of the step besides its measures.
struct Interval {
  double h;                 // [s]
  double factor = 1;        // of a motor's history
  double load = 0;          // what presses the surfaces of a joint together [N]
  bool no_impacts = false;  // restitution takes nothing
  bool is_instant = false;  // rates are those half-way between r0 and r1, and not means over a step
};

/// The law of a spring.  Elastic forces see (e0, e1), rate forces (r0, r1) over h.
class SpringLaw {
 public:
  using Values = std::array<double, max_measures>;
  virtual ~SpringLaw() = default;
  virtual void elastic(const Values& e0, const Values& e1, Response& out) const = 0;
  virtual void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const = 0;
  /// Accept e and its rate as the state to go on from (unwrapped angles, speed of approach).
  virtual void commit(const Values& /*e*/, const Values& /*rate*/) {}
  virtual bool needs_rate() const { return false; }
  /// Whether it only presses, and begins and ends at any instant.
  virtual bool only_presses() const { return false; }
  /// All that commit() leaves.
  virtual void archive(Archive&) {}
  /// Whether it is a potential and nothing else.
  virtual bool conserves() const { return false; }
  /// Whether forces at an instant have no kinks, and rate forces are those of its rates: what methods of high order ask for.
  virtual bool is_smooth() const { return conserves(); }
  /// What e has passed, beyond which the law is not meant, or nothing: "half a turn".
  virtual std::string beyond(const Values& /*e*/) const { return {}; }
};

}  // namespace hilo
