// FETI-DP [farhat-2001] on the symmetric part of the flexible block, by PETSc [zampini-2016]: a solve to round-off nearly, by conjugate
// gradients on the forces between subdomains.  PETSc factors each subdomain twice (its inside, and all of it but the corners).
#include <petscksp.h>

#include <string>
#include <utility>

#include "linear/petsc/flexible.hpp"
#include "linear/petsc/subdomain_matrix.hpp"

namespace hilo::petsc {
namespace {

/// Unless PETSC_OPTIONS has its own.
void suggest(const std::string& key, const char* value) {
  PetscBool given;
  check(PetscOptionsHasName(nullptr, nullptr, key.c_str(), &given));
  if (!given) check(PetscOptionsSetValue(nullptr, key.c_str(), value));
}

/// What worked on bars, tubes and the vehicle: corners for three-dimensional elasticity, averages over edges and faces.
void suggest_options(const std::string& prefix, bool corners) {
  const std::string p = "-" + prefix;
  if (corners) suggest(p + "pc_bddc_corner_selection", "1");
  suggest(p + "pc_bddc_use_faces", "1");
  suggest(p + "pc_bddc_detect_disconnected", "1");
  for (const char* local : {"pc_bddc_dirichlet_", "pc_bddc_neumann_"}) {
    suggest(p + local + "pc_type", "cholesky");
    suggest(p + local + "pc_factor_mat_solver_type", "mumps");
  }
}

class FetiDp final : public FlexibleInverse {
 public:
  FetiDp(SubdomainMatrix& F, std::vector<double> positions) : F_(F), positions_(std::move(positions)) {
    for (size_t i = 0; i < positions_.size(); i += 3)  // PETSc wants the node's position once for each of its unknowns
      for (int c = 0; c < 3; ++c) by_unknown_.insert(by_unknown_.end(), positions_.begin() + i, positions_.begin() + i + 3);
  }
  ~FetiDp() override { KSPDestroy(&ksp_); }

  bool set_up() override {
    failed_ = false;
    const Mat S = F_.symmetric_part();
    if (!ksp_) make(S);
    check(KSPSetOperators(ksp_, S, S));
    check(KSPSetUp(ksp_));
    PC inner;
    PCFailedReason reason;
    check(KSPFETIDPGetInnerBDDC(ksp_, &inner));
    check(PCGetFailedReason(inner, &reason));
    int failed = reason != PC_NOERROR;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
    return !failed;
  }

  void apply(Vec b, Vec x) override {
    check(KSPSolve(ksp_, b, x));
    KSP inner;
    PetscInt iterations;
    KSPConvergedReason reason;
    check(KSPFETIDPGetInnerKSP(ksp_, &inner));
    check(KSPGetIterationNumber(inner, &iterations));
    check(KSPGetConvergedReason(inner, &reason));
    iterations_ += static_cast<int>(iterations);
    failed_ |= reason < 0;
  }

  bool strengthen(int, bool) override { return false; }
  bool is_iterative() const override { return true; }
  bool has_failed() const override { return failed_; }
  int most_iterations() const override { return 10; }
  int take_iterations() override { return std::exchange(iterations_, 0); }
  std::string name() const override { return "FETI-DP"; }
  double bytes() const override { return 6 * F_.bytes(); }  // an estimate: PETSc does not tell

 private:
  void make(Mat S) {
    corners_ = set_near_null_space(S, positions_);
    suggest_options("hilo_fetidp_bddc_", corners_);
    check(KSPCreate(PETSC_COMM_WORLD, &ksp_));
    check(KSPSetOptionsPrefix(ksp_, "hilo_"));
    check(KSPSetErrorIfNotConverged(ksp_, PETSC_FALSE));
    check(KSPSetType(ksp_, KSPFETIDP));
    check(KSPSetOperators(ksp_, S, S));
    PC inner;
    check(KSPFETIDPGetInnerBDDC(ksp_, &inner));
    if (corners_) check(PCSetCoordinates(inner, 3, static_cast<PetscInt>(positions_.size()), by_unknown_.data()));
    KSP dual;
    check(KSPFETIDPGetInnerKSP(ksp_, &dual));
    check(KSPSetTolerances(dual, dual_tolerance, 1e-300, PETSC_DEFAULT, 150));
    check(KSPSetFromOptions(ksp_));
  }

  static constexpr double dual_tolerance = 1e-10;  // on the dual residual: a digit more than the primal one gets
  SubdomainMatrix& F_;
  std::vector<double> positions_, by_unknown_;
  bool corners_ = false, failed_ = false;
  int iterations_ = 0;
  KSP ksp_ = nullptr;
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_feti_dp(SubdomainMatrix& F, std::vector<double> positions) {
  return std::make_unique<FetiDp>(F, std::move(positions));
}

}  // namespace hilo::petsc
