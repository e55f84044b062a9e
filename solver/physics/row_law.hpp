// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of the measures of a connector: rows of joints, and coordinates that forces act along.
#pragma once
#include <algorithm>
#include <string>

#include "base/archive.hpp"
#include "physics/connector.hpp"

namespace hilo {

/// Rows of a joint that are functions g_r(e) of its measures.
class RowLaw {
 public:
  using Values = std::array<double, max_measures>;
  /// Gradients of the rows by the measures, and their derivatives; of rows that there are not, nothing is said.
  struct Gradient {
    std::array<std::array<double, max_measures>, max_rows> d;                            // d_r                    (rows x measures)
    std::array<std::array<std::array<double, max_measures>, max_measures>, max_rows> D;  // d(d_r)/de1
    void clear(int n_rows) {
      std::fill_n(d.begin(), n_rows, std::array<double, max_measures>{});
      for (int r = 0; r < n_rows; ++r) D[r].fill({});
    }
  };
  virtual ~RowLaw() = default;
  virtual int n_rows() const = 0;
  virtual void values(const Values& e, double* g) const = 0;
  /// Discrete gradient, symmetric in its ends, with d_r.(e1 - e0) = g_r(e1) - g_r(e0); at e0 = e1 the gradient, D half its derivative.
  virtual void gradient(const Values& e0, const Values& e1, Gradient& out) const = 0;
  /// Accept e as the state to go on from (unwrapped angles).
  virtual void commit(const Values&) {}
  /// All that commit() leaves.
  virtual void archive(Archive&) {}
  /// Why the joint cannot be at e, or nothing.
  virtual std::string fault(const Values&) const { return {}; }
  /// What e has passed, beyond which the rows are no measure of what they stand for, or nothing.
  virtual std::string beyond(const Values&) const { return {}; }
};

}  // namespace hilo
