// SPDX-License-Identifier: GPL-3.0-or-later
#include "peers.hpp"

#include <petscksp.h>

#include <algorithm>
#include <string>
#include <vector>

#include "linear/petsc/block_matrix.hpp"
#include "linear/petsc/solver.hpp"
#include "linear/petsc/subdomain_matrix.hpp"

namespace hilo::bench {
namespace {

using namespace petsc;
using Options = std::vector<std::pair<std::string, std::string>>;

void set_options(const std::string& prefix, const Options& options) {
  for (const auto& [key, value] : options) check(PetscOptionsSetValue(nullptr, ("-" + prefix + key).c_str(), value.c_str()));
}

/// The symmetric matrix as PETSc keeps it: its upper half in blocks.
class UpperBlocks final : public FlexibleMatrix {
 public:
  explicit UpperBlocks(const FlexibleInput& in) : n_owned_(0) {
    {
      const BlockMatrix pattern(in.cliques, in.map, in.shared, in.map.first_dense);
      n_owned_ = pattern.n_owned();
      Mat whole = pattern.mat();
      check(MatAssemblyBegin(whole, MAT_FINAL_ASSEMBLY)), check(MatAssemblyEnd(whole, MAT_FINAL_ASSEMBLY));
      check(MatSetOption(whole, MAT_SYMMETRIC, PETSC_TRUE));
      check(MatConvert(whole, MATSBAIJ, MAT_INITIAL_MATRIX, &A_));
    }
    for (const auto g : in.map.global) global_.push_back(g < in.map.first_dense ? static_cast<PetscInt>(g) : -1);
    check(MatSetOption(A_, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
    check(MatSetOption(A_, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  }
  ~UpperBlocks() override { MatDestroy(&A_); }
  UpperBlocks(const UpperBlocks&) = delete;
  void zero() override { check(MatZeroEntries(A_)); }
  void add(int, std::span<const int> blocks, const double* K) override {
    index_.clear();
    for (const int b : blocks) index_.push_back(b < 0 ? -1 : global_[b]);
    const auto n = static_cast<PetscInt>(blocks.size());
    check(MatSetValuesBlocked(A_, n, index_.data(), n, index_.data(), K, ADD_VALUES));
  }
  void add_diagonal(int block, const double d[3]) override {
    const double D[9] = {d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]};
    check(MatSetValuesBlocked(A_, 1, &global_[block], 1, &global_[block], D, ADD_VALUES));
  }
  void assemble() override {
    check(MatAssemblyBegin(A_, MAT_FINAL_ASSEMBLY)), check(MatAssemblyEnd(A_, MAT_FINAL_ASSEMBLY));
    check(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
  }
  Mat mat() const override { return A_; }
  void for_each_row(const Row&) const override { throw Error("", "rows of an upper triangle are not whole", "", Exit::fault); }
  PetscInt n_owned() const override { return n_owned_; }
  double bytes() const override {
    MatInfo info;
    return MatGetInfo(A_, MAT_LOCAL, &info) ? 0 : info.memory;
  }

 private:
  PetscInt n_owned_;
  std::vector<PetscInt> global_, index_;
  Mat A_ = nullptr;
};

/// Any PC of PETSc on the matrix that `operand` makes of the flexible one; columns go through it one after the other.
class PetscInverse : public FlexibleInverse {
 public:
  PetscInverse(std::string name, Options options, std::vector<double> positions)
      : name_(std::move(name)), options_(std::move(options)), positions_(std::move(positions)) {}
  ~PetscInverse() override { PCDestroy(&pc_), MatDestroy(&operand_); }

  bool set_up() override {
    const bool fresh = !pc_;
    make_operand(operand_);
    if (fresh) {
      check(PCCreate(PETSC_COMM_WORLD, &pc_));
      check(PCSetOptionsPrefix(pc_, "peer_"));
      check(PCSetErrorIfFailure(pc_, PETSC_FALSE));
      set_options("peer_", options_);
      if (!positions_.empty() || size() > 1) set_near_null_space(operand_, positions_);
    }
    check(PCSetOperators(pc_, operand_, operand_));
    if (fresh) check(PCSetFromOptions(pc_));
    check(PCSetUp(pc_));
    PCFailedReason reason;
    check(PCGetFailedReason(pc_, &reason));
    return comm().max(reason == PC_NOERROR ? 0 : 1) == 0;
  }
  void apply(Eigen::Ref<Eigen::MatrixXd> X) override {
    if (!b_.exists()) b_ = Vector(static_cast<PetscInt>(X.rows())), x_ = Vector(static_cast<PetscInt>(X.rows()));
    for (Eigen::Index k = 0; k < X.cols(); ++k) {
      check(VecPlaceArray(b_, X.col(k).data()));
      solve(b_, x_);
      check(VecResetArray(b_));
      const Values x(x_);
      std::copy_n(x.data(), X.rows(), X.col(k).data());
    }
  }
  bool strengthen(int, bool) override { return false; }
  std::string name() const override { return name_; }
  double bytes() const override { return 0; }

 protected:
  virtual void make_operand(Mat& operand) = 0;
  virtual void solve(Vec b, Vec x) { check(PCApply(pc_, b, x)); }
  std::string name_;
  Options options_;
  std::vector<double> positions_;
  PC pc_ = nullptr;

 private:
  Mat operand_ = nullptr;
  Vector b_, x_;
};

/// On the assembled matrix, as it stands or as one of another type.
class OfAssembled final : public PetscInverse {
 public:
  OfAssembled(const FlexibleMatrix& F, MatType type, std::string name, Options options, std::vector<double> positions)
      : PetscInverse(std::move(name), std::move(options), std::move(positions)), F_(F), type_(type) {}

 private:
  void make_operand(Mat& operand) override {
    if (type_) {
      check(MatConvert(F_.mat(), type_, operand ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &operand));
      check(MatSetBlockSize(operand, 3));
      check(MatSetOption(operand, MAT_SPD, PETSC_TRUE));
    } else if (!operand) {
      operand = F_.mat();
      check(PetscObjectReference(reinterpret_cast<PetscObject>(operand)));
    }
  }
  const FlexibleMatrix& F_;
  MatType type_;
};

/// On the sum of subdomains' matrices, one a rank: PCBDDC, and KSPFETIDP with it inside.
class OfSubdomains final : public PetscInverse {
 public:
  OfSubdomains(const SubdomainMatrix& F, std::string name, Options options, std::vector<double> positions, bool is_feti)
      : PetscInverse(std::move(name), std::move(options), std::move(positions)), F_(F), is_feti_(is_feti) {}
  ~OfSubdomains() override { KSPDestroy(&ksp_); }
  bool varies() const override { return is_feti_; }
  Within take_iterations() override { return std::exchange(taken_, {}); }

  bool set_up() override {
    if (!is_feti_) return PetscInverse::set_up();
    const bool fresh = !ksp_;
    make_operand(A_);
    if (fresh) {
      check(KSPCreate(PETSC_COMM_WORLD, &ksp_));
      check(KSPSetOptionsPrefix(ksp_, "peer_"));
      set_options("peer_fetidp_bddc_", options_);
      set_options("peer_", {{"ksp_type", "fetidp"}, {"fetidp_ksp_rtol", "1e-8"}, {"fetidp_ksp_max_it", "300"}});
      set_near_null_space(A_, positions_);
    }
    check(KSPSetOperators(ksp_, A_, A_));
    if (fresh) check(KSPSetFromOptions(ksp_));
    check(KSPSetUp(ksp_));
    return true;
  }

 private:
  void make_operand(Mat& A) override {
    if (!A) create(A);
    Mat local;
    check(MatISGetLocalMat(A, &local));
    check(MatZeroEntries(local));
    const auto place = [&](PetscInt g) {
      return static_cast<PetscInt>(std::lower_bound(sorted_.begin(), sorted_.end(), g) - sorted_.begin());
    };
    std::vector<PetscInt> index;
    F_.for_each_row([&](PetscInt row, std::span<const PetscInt> columns, const double* values) {
      index.clear();
      for (const PetscInt c : columns) index.push_back(place(c));
      const PetscInt i = place(row);
      check(MatSetValuesBlocked(local, 1, &i, static_cast<PetscInt>(index.size()), index.data(), values, INSERT_VALUES));
    });
    check(MatAssemblyBegin(local, MAT_FINAL_ASSEMBLY)), check(MatAssemblyEnd(local, MAT_FINAL_ASSEMBLY));
    check(MatSetOption(local, MAT_SPD, PETSC_TRUE));
    check(MatISRestoreLocalMat(A, &local));
    check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY)), check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
    check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  }
  void create(Mat& A) {
    std::vector<PetscInt> width;
    for (PetscInt i = 0; i < F_.n_blocks(); ++i) sorted_.push_back(F_.global(i));
    std::sort(sorted_.begin(), sorted_.end());
    width.resize(3 * sorted_.size());
    for (PetscInt i = 0; i < F_.n_blocks(); ++i) {
      const auto k = std::lower_bound(sorted_.begin(), sorted_.end(), F_.global(i)) - sorted_.begin();
      for (int c = 0; c < 3; ++c) width[3 * static_cast<size_t>(k) + c] = static_cast<PetscInt>(3 * F_.neighbours(i).size());
    }
    ISLocalToGlobalMapping map;
    const auto n = static_cast<PetscInt>(sorted_.size());
    check(ISLocalToGlobalMappingCreate(PETSC_COMM_WORLD, 3, n, sorted_.data(), PETSC_COPY_VALUES, &map));
    check(MatCreateIS(PETSC_COMM_WORLD, 3, 3 * F_.n_owned(), 3 * F_.n_owned(), PETSC_DETERMINE, PETSC_DETERMINE, map, map, &A));
    check(ISLocalToGlobalMappingDestroy(&map));
    Mat local;
    check(MatCreateSeqAIJ(PETSC_COMM_SELF, 3 * n, 3 * n, 0, width.data(), &local));
    check(MatSetBlockSize(local, 3));
    check(MatISSetLocalMat(A, local));
    check(MatDestroy(&local));
  }
  void solve(Vec b, Vec x) override {
    if (!is_feti_) return PetscInverse::solve(b, x);
    check(KSPSolve(ksp_, b, x));
    KSP inner;
    PetscInt n;
    check(KSPFETIDPGetInnerKSP(ksp_, &inner));
    check(KSPGetIterationNumber(inner, &n));
    taken_.all += n, taken_.most = std::max<int>(taken_.most, n);
  }

  const SubdomainMatrix& F_;
  bool is_feti_;
  std::vector<PetscInt> sorted_;  // global numbers of the subdomain's blocks
  Mat A_ = nullptr;               // of FETI-DP; lives as long as the process
  KSP ksp_ = nullptr;
  Within taken_;
};

const Options gamg{{"pc_type", "gamg"}, {"pc_gamg_agg_nsmooths", "1"}, {"pc_gamg_reuse_interpolation", "true"}};
const Options hypre{{"pc_type", "hypre"},
                    {"pc_hypre_type", "boomeramg"},
                    {"pc_hypre_boomeramg_strong_threshold", "0.5"},
                    {"pc_hypre_boomeramg_nodal_coarsen", "6"},
                    {"pc_hypre_boomeramg_vec_interp_variant", "3"},
                    {"pc_hypre_boomeramg_agg_nl", "1"}};
const Options incomplete_cholesky{{"pc_type", "bjacobi"}, {"sub_pc_type", "icc"}, {"sub_pc_factor_shift_type", "positive_definite"}};
const Options incomplete_lu{{"pc_type", "bjacobi"}, {"sub_pc_type", "ilu"}, {"sub_pc_factor_mat_ordering_type", "rcm"}};
const Options cholmod{{"pc_type", "cholesky"}, {"pc_factor_mat_solver_type", "cholmod"}};
const Options bddc{{"pc_type", "bddc"},
                   {"pc_bddc_use_faces", "1"},
                   {"pc_bddc_corner_selection", "1"},
                   {"pc_bddc_dirichlet_pc_type", "cholesky"},
                   {"pc_bddc_dirichlet_pc_factor_mat_solver_type", "cholmod"},
                   {"pc_bddc_neumann_pc_type", "cholesky"},
                   {"pc_bddc_neumann_pc_factor_mat_solver_type", "cholmod"},
                   {"pc_bddc_coarse_redundant_pc_type", "cholesky"}};
Options with(Options all, const Options& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}
const Options deluxe = with(bddc, {{"pc_bddc_use_deluxe_scaling", "1"}, {"sub_schurs_mat_solver_type", "mumps"}});
const Options adaptive = with(deluxe, {{"pc_bddc_adaptive_threshold", "2"}});

Flexible on_blocks(const FlexibleInput& in, MatType type, const char* name, const Options& options) {
  auto F = std::make_unique<BlockMatrix>(in.cliques, in.map, in.shared, in.map.first_dense);
  auto inverse = std::make_unique<OfAssembled>(*F, type, name, options, in.positions);
  return {std::move(F), std::move(inverse)};
}
Flexible on_upper(const FlexibleInput& in, const char* name, const Options& options) {
  auto F = std::make_unique<UpperBlocks>(in);
  auto inverse = std::make_unique<OfAssembled>(*F, nullptr, name, options, std::vector<double>{});
  return {std::move(F), std::move(inverse)};
}
Flexible on_subdomains(const FlexibleInput& in, const char* name, const Options& options, bool is_feti = false) {
  auto F = std::make_unique<SubdomainMatrix>(in.cliques, in.map, in.shared, 1);
  std::unique_ptr<FlexibleInverse> inverse = std::make_unique<OfSubdomains>(*F, name, options, in.positions, is_feti);
  inverse = make_deflated(std::move(inverse), *F, in.positions);
  return {std::move(F), std::move(inverse)};
}

}  // namespace

const PetscKind* find_peer(const std::string& word) {
  static const std::vector<PetscKind> peers{
      {.name = "petsc-icc",
       .title = "PETSc",
       .make = [](const auto& in) { return on_upper(in, "PETSc ICC", incomplete_cholesky); },
       .is_symmetric = true},
      {.name = "petsc-gamg",
       .title = "PETSc",
       .make = [](const auto& in) { return on_blocks(in, MATAIJ, "GAMG", gamg); },
       .is_symmetric = true},
      {.name = "petsc-hypre",
       .title = "PETSc",
       .make = [](const auto& in) { return on_blocks(in, MATAIJ, "BoomerAMG", hypre); },
       .is_symmetric = true},
      {.name = "petsc-ilu", .title = "PETSc", .make = [](const auto& in) { return on_blocks(in, nullptr, "PETSc ILU", incomplete_lu); }},
      {.name = "petsc-cholmod", .title = "PETSc", .make = [](const auto& in) { return on_blocks(in, MATAIJ, "CHOLMOD", cholmod); }},
      {.name = "petsc-bddc", .title = "PETSc", .make = [](const auto& in) { return on_subdomains(in, "PCBDDC", bddc); }},
      {.name = "petsc-bddc-deluxe", .title = "PETSc", .make = [](const auto& in) { return on_subdomains(in, "PCBDDC deluxe", deluxe); }},
      {.name = "petsc-bddc-adaptive",
       .title = "PETSc",
       .make = [](const auto& in) { return on_subdomains(in, "PCBDDC adaptive", adaptive); }},
      {.name = "petsc-fetidp", .title = "PETSc", .make = [](const auto& in) { return on_subdomains(in, "KSPFETIDP", bddc, true); }},
  };
  const auto found = std::find_if(peers.begin(), peers.end(), [&](const PetscKind& k) { return k.name == word; });
  return found == peers.end() ? nullptr : &*found;
}

}  // namespace hilo::bench
