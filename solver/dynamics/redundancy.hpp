// Redundant joint rows: found by rank, switched off, and their share of the reactions.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "linear/factors.hpp"
#include "system/system.hpp"

namespace hilo {

/// What the rank check found.
struct Redundancy {
  int rows = 0, rank = 0;
  std::vector<std::string> dropped;  // "joint \"b\" row 3 (depends on joints a, c)"
};
/// Rank of the joint rows at q by QR, group by group of connected rows; dependent ones are switched off in the system's joints.
Redundancy drop_redundant_rows(System& system, const Config& q);
/// The same at a later q, where a step failed: another choice of as many rows is taken, fewer (a singular position) are not.
/// True where the choice has changed.
bool recheck_redundant_rows(System& system, const Config& q, const Redundancy& before);

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
