// SPDX-License-Identifier: GPL-3.0-or-later
// The whole system in four blocks, and a preconditioner of it in which only F is approximated:
//
//     P = [ F~  B ]     with  S = D - C F~^-1 B  sparse and exact for F~:  p = S^-1 (g - C F~^-1 f),   u = F~^-1 f - Z p,   Z = F~^-1 B.
//         [ C   D ]
//
// P^-1 A - 1 then vanishes outside the flexible block, so bodies and multipliers cost no iterations beyond those of F~ on F (for
// C = B^T, D = 0: the constraint preconditioner [keller-gould-wathen-2000]).  Cost: one application of F~ per dense unknown that touches a
// flexible node (6 per attached body, 3 per multiplier block) and set-up, and one per iteration.
#pragma once
#include "linear/petsc/coupling.hpp"
#include "linear/petsc/flexible.hpp"
#include "linear/petsc/schur_factor.hpp"
#include "linear/petsc/solver.hpp"

namespace hilo::petsc {

class Saddle {
 public:
  Saddle(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, Flexible flexible);
  Saddle(const Saddle&) = delete;

  void zero() { matrix_->zero(), coupling_.zero(); }
  void add(int clique, const double* K);
  void add_diagonal(int block, const double d[3]);
  void assemble() { matrix_->assemble(), coupling_.assemble(); }

  /// Make the preconditioner for the matrix as it is.
  SolveReport set_up();
  /// y = A x.
  void multiply(Vec x, Vec y);
  /// y = P^-1 x.
  void precondition(Vec x, Vec y);

  FlexibleMatrix& matrix() { return *matrix_; }
  FlexibleInverse& inverse() { return *inverse_; }
  const FlexibleInverse& inverse() const { return *inverse_; }
  Coupling& coupling() { return coupling_; }
  size_t n_flexible() const { return n_flexible_; }  // owned unknowns
  size_t n_all() const { return n_all_; }
  double bytes() const { return matrix_->bytes() + coupling_.bytes() + inverse_->bytes() + 8. * static_cast<double>(Z_.size()); }

 private:
  bool factor_schur();
  void get_dense(const double* x);
  void subtract_Z(double* u);

  const Cliques& cliques_;
  std::unique_ptr<FlexibleMatrix> matrix_;
  std::unique_ptr<FlexibleInverse> inverse_;
  Coupling coupling_;
  std::vector<char> touches_dense_;  // (n_cliques)
  int m_ = 0;
  size_t n_flexible_ = 0, n_all_ = 0;
  bool keep_ = true;
  Eigen::MatrixXd Z_;
  std::vector<double> p_, q_;  // dense part, on all ranks
  SchurFactor schur_;
  Vector f_, u_;
};

}  // namespace hilo::petsc
