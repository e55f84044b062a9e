// SPDX-License-Identifier: GPL-3.0-or-later
// BDDC [dohrmann-2003]: exact static condensation with the inverse of the assembled Schur complement replaced by  E_D S~^-1 E_D^T
// (dual_primal.hpp). With the interface last in its factor, an application reads the factor once forwards and once backwards; PETSc's
// PCBDDC solves three times with two factors.
//
// The tangent of averaged methods is unsymmetric by what turns in a step; GMRES works on it, and only the preconditioner is symmetrised.
#include <utility>

#include "linear/petsc/dual_primal.hpp"

namespace hilo::petsc {
namespace {

class Bddc final : public FlexibleInverse {
 public:
  explicit Bddc(const SubdomainMatrix& F) : spaces_(F) {}

  bool set_up() override {
    const bool good = spaces_.set_up(is_adaptive_);
    if (good && is_single_) spaces_.narrow();
    return good;
  }
  void apply(Eigen::Ref<Eigen::MatrixXd> X) override { spaces_.expand(spaces_.solve(spaces_.condense(X)), X); }
  /// Rigid motions of classes as constraints serve smooth stiffness; where it jumps within subdomains, others are looked for.  Where they
  /// do not help, single precision is given up.
  bool strengthen(int iterations, bool failed) override {
    if (!failed && iterations <= too_many_iterations) return false;
    if (!is_adaptive_) return is_adaptive_ = true;
    return std::exchange(is_single_, false);
  }
  bool varies() const override { return true; }
  int most_iterations() const override { return is_adaptive_ ? 150 : 60; }
  double undivided_seconds() const override { return spaces_.coarse_seconds(); }
  std::string name() const override { return is_adaptive_ ? "adaptive BDDC" : "BDDC"; }
  double bytes() const override { return spaces_.bytes(); }

 private:
  DualPrimal spaces_;
  bool is_single_ = true;     // factors are kept in single precision: GMRES mends the digits
  bool is_adaptive_ = false;  // further constraints are looked for
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_bddc(const SubdomainMatrix& F) { return std::make_unique<Bddc>(F); }

}  // namespace hilo::petsc
