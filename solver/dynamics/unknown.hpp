// SPDX-License-Identifier: GPL-3.0-or-later
// The unknown end of a step, q = q0 + dq.  The increment is known to its own precision, not to that of q: velocities (dq/h) lose no digits
// to a small step, and momentum does not drift with the round-off of positions.
#pragma once
#include <span>

#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

struct Unknown {
  Config q0, q, dq;
  std::vector<Vec3> turn;  // Cayley vector of each free body's rotation from q0 to q

  Unknown() = default;
  Unknown(const System& system, const Config& q0, const Config& guess) { start(system, q0, guess); }
  /// From q0, first guess `guess`; what is prescribed in the guess stays.
  void start(const System& system, const Config& q0, const Config& guess);
  /// Add the increments z (3 x n_blocks).
  void move(const System& system, std::span<const double> z);
  /// Add z to the increments from q0 themselves: Cayley vectors are added, not composed.
  void shift(const System& system, std::span<const double> z);
  /// The increments from q0, as `shift` adds them (3 x blocks of nodes and bodies).
  std::vector<double> increments(const System& system) const;
  void increments(const System& system, std::vector<double>& out) const;

 private:
  void turn_body(size_t b);
  void multiply(const System& system);
  template <class Turned>
  void add(const System& system, std::span<const double> z, Turned turned);
};

}  // namespace hilo
