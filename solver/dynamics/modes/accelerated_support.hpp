// SPDX-License-Identifier: GPL-3.0-or-later
// Supports that drives and motions accelerate: what they carry is at rest relative to them where it feels gravity less their acceleration.
#pragma once
#include <optional>
#include <string>

#include "system/system.hpp"

namespace hilo {

struct AcceleratedSupport {
  std::string who;          // 'joint "p"', which accelerates what it moves at the start; "": nothing does
  std::optional<Vec3> all;  // acceleration of everything [m/s^2], where a translation of all meets what joints and motions ask for, and
                            // nothing that stands holds it
};
/// Collective.
AcceleratedSupport accelerated_support(const System& system, const Config& q);

/// As long as it lives, everything feels the acceleration `by` less.
class FeltLess {
 public:
  FeltLess(System& system, const Vec3& by) : system_(system), gravity_(system.gravity) { system.gravity -= by; }
  ~FeltLess() { system_.gravity = gravity_; }
  FeltLess(const FeltLess&) = delete;
  FeltLess& operator=(const FeltLess&) = delete;

 private:
  System& system_;
  Vec3 gravity_;
};

/// Velocities or accelerations u of all but the ground.
Config uniform(const System& system, const Config& q, const Vec3& u);

}  // namespace hilo
