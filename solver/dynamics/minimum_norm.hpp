// SPDX-License-Identifier: GPL-3.0-or-later
// Reactions where joint rows are redundant.
#pragma once
#include <memory>
#include <vector>

#include "linear/factors.hpp"
#include "system/system.hpp"

namespace hilo {

/// Minimum-norm multipliers that give the same forces as those of the rows kept: lambda = G y with G^T G y = G^T lambda_kept, by sparse
/// factors of the slightly shifted matrix and refinement; what the shift adds lies in the null space of G and drops out.
class MinimumNorm {
 public:
  explicit MinimumNorm(const System& system);
  /// All rows of all joints counted, at the stage's left configuration; laid out like lambda.
  std::vector<double> operator()(const Stage& stage, std::span<const double> lambda);

 private:
  const System& system_;
  Cliques cliques_;  // of joints
  BlockCsr A_;       // G^T G, shifted
  std::unique_ptr<Factors> factors_;
};

}  // namespace hilo
