// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks that several ranks hold: who owns them, and sums and copies between the holders.
#pragma once
#include <span>
#include <vector>

#include "linear/kkt.hpp"
#include "linear/petsc/session.hpp"

namespace hilo::petsc {

class SharedBlocks {
 public:
  explicit SharedBlocks(const BlockMap& map);
  /// Sum over the holders; then all of them have the sum.  3 values per local block.
  void sum(std::span<double> local) const;
  /// The owners' values to the other holders.
  void copy_out(std::span<double> local) const;

  int owner(std::int64_t global) const;
  /// Local number of a block this rank owns.
  int owned(std::int64_t k) const { return owned_[k]; }
  std::int64_t n_owned() const { return static_cast<std::int64_t>(owned_.size()); }
  bool is_owned(int local) const { return is_owned_[local]; }
  /// Do other ranks hold it too?
  bool is_shared(int local) const { return is_shared_[local]; }

 private:
  std::vector<std::int64_t> first_;         // first block of each rank, and n_global
  std::vector<int> owned_;                  // local number of each owned block
  std::vector<char> is_owned_, is_shared_;  // (n_local)
  std::vector<std::vector<int>> ghosts_;    // local blocks owned by each rank
  std::vector<std::vector<int>> lent_;      // owned blocks that each rank holds too
};

}  // namespace hilo::petsc
