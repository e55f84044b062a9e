// SPDX-License-Identifier: GPL-3.0-or-later
// Which of n things hang together, when pairs of them are joined one after the other.
#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

namespace hilo {

template <class Index = int>
class Joined {
 public:
  explicit Joined(size_t n) : up_(n) { std::iota(up_.begin(), up_.end(), Index{0}); }
  size_t size() const { return up_.size(); }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    up_[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
  }
  /// The least thing that k hangs together with.
  Index root(Index k) {
    while (up(k) != k) k = up(k) = up(up(k));
    return k;
  }

 private:
  Index& up(Index k) { return up_[static_cast<size_t>(k)]; }
  std::vector<Index> up_;  // another one that it hangs together with, never a later one
};

}  // namespace hilo
