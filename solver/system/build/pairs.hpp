// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of numbers that ranks find, each its own.
#pragma once
#include <array>
#include <set>
#include <vector>

#include "base/comm.hpp"

namespace hilo {

using Pairs = std::set<std::array<int, 2>>;  // each once, in order

/// What any rank has found, on all of them.  Collective.
inline void agree(Pairs& pairs, const Comm& comm) {
  const auto all = comm.gather(std::vector<std::array<int, 2>>(pairs.begin(), pairs.end()));
  pairs.insert(all.begin(), all.end());
}

}  // namespace hilo
