// SPDX-License-Identifier: GPL-3.0-or-later
// The coarse problem of BDDC and FETI-DP: the stiffness K_c of the primal unknowns of all subdomains, which every rank factors whole.
#pragma once
#include <suitesparse/cholmod.h>

#include <Eigen/Core>
#include <vector>

namespace hilo::petsc {

class CoarseProblem {
 public:
  CoarseProblem();
  ~CoarseProblem();
  CoarseProblem(const CoarseProblem&) = delete;

  /// Entry of the lower triangle; those of all ranks are summed.
  struct Entry {
    double row, column, value;
  };
  /// Factor K_c (n x n).  False when it is not positive definite.  Collective.
  bool factor(int n, const std::vector<Entry>& mine);
  /// x := K_c^-1 x, columns side by side.
  void solve(Eigen::MatrixXd& x);
  /// Seconds so far of what is not divided among ranks.
  double seconds() const { return seconds_; }
  double bytes() const { return L_ ? 8. * static_cast<double>(L_->xsize) : 0; }

 private:
  cholmod_common common_{};
  cholmod_factor* L_ = nullptr;
  std::vector<int> start_, rows_;  // the pattern that was analysed
  std::vector<double> scratch_;
  double seconds_ = 0;
};

}  // namespace hilo::petsc
