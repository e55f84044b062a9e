// SPDX-License-Identifier: GPL-3.0-or-later
// reduced.h5: what linear regions were reduced to, each with digests of what it was found from.  Where nothing of that has changed it
// serves again; where something has, it is refused by name.
#pragma once
#include "model/store.hpp"
#include "system/reduction/reduction.hpp"

namespace hilo {

/// Digests of what a reduction depends on, the same on any number of ranks.
struct ReductionKey {
  std::string mesh, material, loads, basis;
  std::vector<std::string> interfaces, digests;  // names, and digests of their nodes
};
ReductionKey key_of(const ReductionInput& in);

struct KeptReduction {
  std::string region;
  ReductionKey key;
  Reduction found;
};

class ReducedFile {
 public:
  explicit ReducedFile(const std::string& path);
  /// Why the file does not serve a region ("it is of another mesh"), or nothing.
  std::string unfit(const std::string& region, const ReductionKey& wanted) const;
  /// Errors: arrays that do not fit each other, or nodes and modes that are not as many.
  Reduction read(const std::string& region, size_t n_nodes) const;

 private:
  Store store_;
};

void write_reduced(const std::string& path, const std::vector<KeptReduction>& regions, const std::vector<std::string>& provenance);

}  // namespace hilo
