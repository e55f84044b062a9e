// SPDX-License-Identifier: GPL-3.0-or-later
// The Cholesky factor of a symmetric positive definite matrix, front by front [liu-1992], by all ranks of one machine: each takes branches
// of the elimination tree and, of a solve, some of the columns.  Its values are in memory that all of them see, so that they are there
// once.
//
// Rank 0 leads; between its calls the others are in serve().  The factor, and what it solves, is bit by bit the same on any number of
// ranks.
//
// Its arithmetic is in double precision.  Its values may be kept in single precision, which halves them: L L^T stays positive definite
// and is off by the square root of the condition alone, |L^-1 dL| <= sqrt(cond A) 6e-8, so that few conjugate gradients mend it.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "linear/front_order.hpp"
#include "linear/shared_array.hpp"

namespace hilo {

class SharedCholesky {
 public:
  using Told = std::function<void(double part)>;  // how much of the work is done, now and then
  explicit SharedCholesky(const Comm& comm);
  ~SharedCholesky();
  SharedCholesky(const SharedCholesky&) = delete;

  // On rank 0
  /// The order of the blocks that the cliques join, and an empty matrix.
  void structure(Cliques cliques, int n_blocks);
  double entries() const { return order_->entries; }
  double flops() const { return order_->flops; }
  /// Add the dense matrix (3n x 3n, row major) of a clique.
  void add(int clique, const double* K);
  void add_diagonal(int block, const double d[3]);
  /// False when it is not positive definite.  The matrix is given up.  `folder`: where the values go to a file.
  bool factor(bool single, const std::string& folder, const Told& tell);
  /// X := (L L^T)^-1 X   (3 n_blocks x columns)
  void solve(Eigen::Ref<Eigen::MatrixXd> X);
  /// As many columns as the ranks solve in one pass over the factor.
  int columns_at_once() const { return at_once_ * static_cast<int>(helpers_.size()); }
  /// Give all memory back; the others leave serve().
  void end();

  // On the others
  /// Take part until rank 0 ends.
  void serve();

 private:
  struct Work;
  enum class Call { structure, factor, solve, end };
  void call(Call what);
  void share_structure();
  bool factor_shared();
  bool ended_ = false;
  void solve_shared();
  void divide();
  bool eliminate(int front, Work& work);
  double* handed(int front) const;
  size_t n() const { return 3 * order_->place.size(); }

  const Comm& comm_;
  std::optional<FrontOrder> order_;
  std::vector<size_t> start_;      // of each front's values
  std::vector<int> rank_;          // that eliminates each front: a branch, or rank 0 at the root
  std::vector<size_t> handed_at_;  // of what branches leave to rank 0
  std::vector<int> helpers_;       // ranks that see what rank 0 has
  std::unique_ptr<LowerBlocks> lower_;
  Cliques cliques_;  // by places
  SharedArray<double> matrix_, handed_updates_, columns_;
  SharedArray<double> double_values_;
  SharedArray<float> single_values_;
  bool single_ = false;
  int at_once_ = 1, n_columns_ = 0;  // columns of a rank in one pass; of all, in the one at hand
  std::string folder_;
  Told tell_;
  std::vector<std::unique_ptr<double[]>> updates_;  // of fronts whose parents wait for them
};

}  // namespace hilo
