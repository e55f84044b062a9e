// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse LU of the small system that is left of bodies and multipliers: S = D + what the flexible part gives to the unknowns it touches.
// Rows and columns of bodies and of constraints differ by many orders: they are scaled before KLU [davis-2010] factors.
#pragma once
#include <suitesparse/klu.h>

#include <Eigen/Core>
#include <vector>

#include "linear/petsc/coupling.hpp"

namespace hilo::petsc {

class SchurFactor {
 public:
  SchurFactor() { klu_defaults(&common_), common_.scale = -1; }
  ~SchurFactor() { forget(); }
  SchurFactor(const SchurFactor&) = delete;

  /// D with `given` (k x k) added at rows and columns `touched`.  False when it is singular.
  bool factor(const Coupling& coupling, const std::vector<int>& touched, const Eigen::MatrixXd& given);
  /// x := S^-1 x
  void solve(double* x);

 private:
  void forget() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }
  int n_ = 0;
  std::vector<int> start_, row_;  // by columns
  std::vector<double> value_, row_scale_, column_scale_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace hilo::petsc
