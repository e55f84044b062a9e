// SPDX-License-Identifier: GPL-3.0-or-later
// FETI-DP [farhat-2001] on the symmetric part of the flexible block: conjugate gradients on the forces lambda between subdomains,
//
//     F lambda = B S~^-1 g,    F = B S~^-1 B^T,    preconditioned by  B_D S B_D^T  (Dirichlet),    B_D^T B = P_D = 1 - E_D,
//
// with the spaces, primal constraints and weights of BDDC (dual_primal.hpp), so that the spectrum is that of BDDC but for zeros and ones
// [mandel-dohrmann-tezaur-2005].  lambda is held as the forces B^T lambda on the pieces, which cancel where pieces meet, the residual as
// w = S~^-1 (g - B^T lambda), which still jumps: no B is needed, and at the end w is the answer.  The first w, averaged, is what BDDC
// gives.  An iteration reads of the factors what belongs to the interface alone.
#include <algorithm>
#include <utility>

#include "linear/petsc/dual_primal.hpp"

namespace hilo::petsc {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;

class FetiDp final : public FlexibleInverse {
 public:
  explicit FetiDp(const SubdomainMatrix& F) : spaces_(F) {}

  bool set_up() override {
    failed_ = false, most_ = 0;
    return spaces_.set_up(is_adaptive_);
  }

  /// Columns side by side, each with its own steps.
  void apply(Eigen::Ref<MatrixXd> X) override {
    const MatrixXd g = spaces_.condense(X);
    MatrixXd w = spaces_.solve(g), p = MatrixXd::Zero(w.rows(), w.cols());
    const ArrayXd energy = dot(g, w);
    const int most = is_adaptive_ ? 150 : 60;
    ArrayXd before = ArrayXd::Ones(w.cols()), enough;
    int k = 0;
    for (;; ++k) {
      const MatrixXd jump = w - spaces_.average(w), force = spaces_.multiply(jump);
      const ArrayXd now = dot(jump, force);  // the residual B w, squared, in the norm of the preconditioner
      if (k == 0) enough = (tolerance * tolerance * now).max(round_off * round_off * energy);
      const Eigen::Array<bool, Eigen::Dynamic, 1> open = now > enough;
      const bool fails = !now.allFinite() || (open.any() && k == most);
      failed_ |= fails;
      if (fails || !open.any()) break;
      taken_.all += static_cast<int>(open.count());
      const ArrayXd beta = open.select(now / before, 0);
      p = force - spaces_.average_transposed(force) + p * beta.matrix().asDiagonal();
      const MatrixXd q = spaces_.solve(p);
      const ArrayXd alpha = open.select(now / dot(p, q), 0);
      w -= q * alpha.matrix().asDiagonal();
      before = now;
    }
    taken_.most = std::max(taken_.most, k), most_ = std::max(most_, k);
    spaces_.expand(w, X);
  }

  bool strengthen(int, bool) override {
    if (is_adaptive_ || most_ <= too_many_iterations) return false;
    return is_adaptive_ = true;
  }
  bool varies() const override { return true; }
  bool has_failed() const override { return failed_; }
  int most_iterations() const override { return 30; }
  Within take_iterations() override { return std::exchange(taken_, {}); }
  double undivided_seconds() const override { return spaces_.coarse_seconds(); }
  std::string name() const override { return is_adaptive_ ? "adaptive FETI-DP" : "FETI-DP"; }
  double bytes() const override { return spaces_.bytes(); }

 private:
  /// Of each column, over all ranks.
  static ArrayXd dot(const MatrixXd& a, const MatrixXd& b) {
    ArrayXd sum = a.cwiseProduct(b).colwise().sum();
    comm().sum({sum.data(), static_cast<size_t>(sum.size())});
    return sum;
  }

  static constexpr double tolerance = 1e-8;   // of the first residual
  static constexpr double round_off = 1e-14;  // of the answer
  DualPrimal spaces_;
  bool is_adaptive_ = false, failed_ = false;
  Within taken_;
  int most_ = 0;  // iterations of an application since the set-up
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_feti_dp(const SubdomainMatrix& F) { return std::make_unique<FetiDp>(F); }

}  // namespace hilo::petsc
