// SPDX-License-Identifier: GPL-3.0-or-later
// The quantities that a scene asks for, [[quantity]], of a run.
#pragma once
#include <limits>

#include "base/table.hpp"
#include "model/quantity_schema.hpp"
#include "post/run/columns.hpp"

namespace hilo {

/// What a history is of, where that decides what to advise.
enum class Measured { other, raw_acceleration, stress };

struct QuantityValue {
  std::string name, kind, of, unit;                                    // "hinge force", "peak", "joint hinge: force", "N"
  double value = std::numeric_limits<double>::quiet_NaN(), t = value;  // t: of a peak or a value at a time  [s]
  double until = t;                                                    // of a peak: the last instant at half of it or more; else t  [s]
  std::string tolerance;                                               // as written
  double allowed = std::numeric_limits<double>::quiet_NaN();           // [unit]
  Measured measured = Measured::other;
  std::string why;  // it has no value
};

/// What a quantity of kind peak, at or rms is taken of.  Error where this run does not have it.
Column history_of(const Entry& quantity, RunFile& run);
/// In the order of the scene.
std::vector<QuantityValue> quantities(const Scene& scene, RunFile& run);
/// A row each; numbers are numbers in JSON.
Table quantity_table(const std::vector<QuantityValue>& values);

}  // namespace hilo
