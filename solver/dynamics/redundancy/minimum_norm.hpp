// SPDX-License-Identifier: GPL-3.0-or-later
// Reactions where joint rows are redundant.
#pragma once
#include <memory>
#include <vector>

#include "linear/factors.hpp"
#include "system/system.hpp"

namespace hilo {

/// Minimum-norm multipliers that give the same forces as those of the rows kept: lambda = G y with G^T G y = G^T lambda_kept, by conjugate
/// gradients with sparse factors of the slightly shifted matrix, unknowns scaled block by block: beside a gear of 1:1e6 its rows would
/// otherwise be all that counts.
class MinimumNorm {
 public:
  explicit MinimumNorm(const System& system);
  /// All rows of all joints counted, at the stage's left configuration; laid out like lambda.  Where their forces differ from those of the
  /// rows kept by more than 1e-8, the latter, and a warning.
  std::vector<double> operator()(const Stage& stage, std::span<const double> lambda);

 private:
  /// The rows of all joints, scaled, and A_ of them.
  void take_rows(const Stage& stage);
  /// G^T lambda, of all rows or of those kept.
  Eigen::VectorXd forces(std::span<const double> lambda, bool all_rows) const;
  /// G y, laid out like the n numbers of lambda.
  std::vector<double> shares(const Eigen::VectorXd& y, size_t n) const;

  struct Row {
    int joint, place;  // in lambda
    bool active;
    size_t end;  // of its entries
  };
  const System& system_;
  Cliques cliques_;  // of joints
  BlockCsr A_;       // G^T G, scaled and shifted
  std::vector<Row> rows_;
  std::vector<int> column_;    // of the entries of G, scaled, row by row
  std::vector<double> value_;  //
  std::unique_ptr<Factors> factors_;
  bool serves_ = false;  // the factors of an instant before, of many unknowns: a few more passes cost less than factors
  bool told_ = false;
};

}  // namespace hilo
