// SPDX-License-Identifier: GPL-3.0-or-later
// Things that several ranks hold (a node, a patch of cells about it), known by a number of their own, and sums over their holders.
#pragma once
#include "base/comm.hpp"

namespace hilo {

class Sharing {
 public:
  /// `key` of each local thing, the same on all ranks that hold it and of no other thing.  Collective.
  Sharing(const Comm& comm, const std::vector<std::int64_t>& key);

  enum class By { sum, largest };
  /// Combine the values (n x width) over all holders; every holder ends with the same bits.  Collective.
  void combine(std::vector<double>& values, int width, By by = By::sum) const;

 private:
  const Comm* comm_;
  std::vector<std::vector<std::int64_t>> to_;    // local things whose values this rank sends to each rank that combines them
  std::vector<std::vector<std::int64_t>> from_;  // what each rank sends to this one, by its place in a list of this rank's own
  std::int64_t n_combined_ = 0;
};

}  // namespace hilo
