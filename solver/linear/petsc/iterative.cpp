// GMRES on the whole system, preconditioned from the right by a block factorisation in which only F is approximated:
//
//     P = [ F~  B ]     with  S = D - C F~^-1 B  dense and exact for F~:   p = S^-1 (g - C F~^-1 f),   u = F~^-1 f - Z p,   Z = F~^-1 B.
//         [ C   D ]
//
// P^-1 A - 1 then vanishes outside the flexible block, so bodies and multipliers cost no iterations beyond those of F~ on F (for
// C = B^T, D = 0: the constraint preconditioner [keller-gould-wathen-2000]).  Cost: one application of F~ per dense unknown that touches a
// flexible node (6 per attached body, 3 per multiplier block) and solve, and one per iteration.
#define OMPI_SKIP_MPICXX 1
#include <fmt/format.h>
#include <petscksp.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/error.hpp"
#include "linear/petsc/coupling.hpp"
#include "linear/petsc/flexible.hpp"
#include "linear/petsc/solver.hpp"

namespace hilo::petsc {
namespace {

/// Z is kept (in single precision: it only preconditions) up to so many columns; beyond, F~ is applied a second time per iteration.
constexpr size_t columns_kept = 100;
constexpr int many_iterations = 200;  // then multigrid takes over

class IterativeSolver final : public KktSolver {
 public:
  explicit IterativeSolver(double tolerance) : tolerance_(tolerance) {}
  ~IterativeSolver() override { release(); }

  void structure(const Cliques& cliques, const BlockMap& map) override {
    release();
    cliques_ = &cliques;
    shared_.emplace(map);
    inverse_.reset(), matrix_.reset(), coupling_.reset();
    matrix_.emplace(cliques, map, *shared_, map.first_dense);
    coupling_.emplace(cliques, map, *shared_);
    std::vector<double> positions;
    if (!map.X.empty())
      for (PetscInt k = 0; k < matrix_->n_owned(); ++k)
        positions.insert(positions.end(), map.X.begin() + 3 * shared_->owned(k), map.X.begin() + 3 * shared_->owned(k) + 3);
    inverse_.emplace(*matrix_, std::move(positions));
    touches_dense_.clear();
    for (int e = 0; e < cliques.size(); ++e) touches_dense_.push_back(coupling_->couples(cliques[e]));
    n_flexible_ = 3 * static_cast<size_t>(matrix_->n_owned());
    n_all_ = 3 * static_cast<size_t>(shared_->n_owned());
    m_ = coupling_->m();
    const auto nf = static_cast<PetscInt>(n_flexible_), na = static_cast<PetscInt>(n_all_);
    x_ = Vector(na), b_ = Vector(na), r_ = Vector(na);
    f_ = Vector(nf), u_ = Vector(nf), w_ = Vector(nf);
    p_.assign(m_, 0.0), q_.assign(m_, 0.0);
    make_krylov(3 * map.n_global);
  }
  void zero() override { matrix_->zero(), coupling_->zero(); }
  void add(int clique, const double* K) override {
    matrix_->add((*cliques_)[clique], K);
    if (touches_dense_[clique]) coupling_->add((*cliques_)[clique], K);
  }
  void add_diagonal(int block, const double d[3]) override {
    if (coupling_->is_dense(block))
      coupling_->add_diagonal(block, d);
    else
      matrix_->add_diagonal(block, d);
  }
  void sum_shared(std::span<double> local) override { shared_->sum(local); }

  SolveReport solve(std::span<const double> b, std::span<double> x) override {
    matrix_->assemble(), coupling_->assemble();
    to_owned(*shared_, b, b_);
    SolveReport report = attempt();
    if (!report.ok && inverse_->kind() == FlexibleInverse::Kind::incomplete) {
      inverse_->use(FlexibleInverse::Kind::multigrid);
      const int before = report.iterations;
      report = attempt();
      report.iterations += before;
    } else if (report.iterations > many_iterations) {
      inverse_->use(FlexibleInverse::Kind::multigrid);
    }
    to_local(*shared_, x_, x);
    return report;
  }

  double bytes() const override {
    return matrix_->bytes() + coupling_->bytes() + inverse_->bytes() + 4. * n_flexible_ * Z_.size() + 8. * restart_ * n_all_;
  }
  std::string name() const override {
    const bool multigrid = inverse_ && inverse_->kind() == FlexibleInverse::Kind::multigrid;
    return fmt::format("iterative (GMRES, {}{})", multigrid ? "multigrid" : "ILU", size() > 1 ? fmt::format(", {} ranks", size()) : "");
  }

 private:
  void release() {
    KSPDestroy(&ksp_);
    MatDestroy(&A_);
  }

  void make_krylov(std::int64_t n_global) {
    const auto n = static_cast<PetscInt>(n_all_);
    check(MatCreateShell(PETSC_COMM_WORLD, n, n, PETSC_DETERMINE, PETSC_DETERMINE, this, &A_));
    check(MatShellSetOperation(A_, MATOP_MULT, reinterpret_cast<void (*)(void)>(+[](Mat A, Vec x, Vec y) -> PetscErrorCode {
                                 void* self;
                                 PetscErrorCode code = MatShellGetContext(A, &self);
                                 if (!code) static_cast<IterativeSolver*>(self)->multiply(x, y);
                                 return code;
                               })));
    check(KSPCreate(PETSC_COMM_WORLD, &ksp_));
    check(KSPSetOptionsPrefix(ksp_, "hilo_"));
    check(KSPSetOperators(ksp_, A_, A_));
    check(KSPSetType(ksp_, KSPGMRES));
    restart_ = n_global > 1000000 ? 50 : 100;  // at 3 million unknowns 50 vectors are 1.2 GB
    check(KSPGMRESSetRestart(ksp_, restart_));
    check(KSPSetPCSide(ksp_, PC_RIGHT));
    check(KSPSetTolerances(ksp_, tolerance_, 1e-300, PETSC_DEFAULT, 600));
    PC pc;
    check(KSPGetPC(ksp_, &pc));
    check(PCSetType(pc, PCSHELL));
    check(PCShellSetContext(pc, this));
    check(PCShellSetApply(pc, [](PC pc, Vec x, Vec y) -> PetscErrorCode {
      void* self;
      PetscErrorCode code = PCShellGetContext(pc, &self);
      if (!code) static_cast<IterativeSolver*>(self)->precondition(x, y);
      return code;
    }));
    check(KSPSetFromOptions(ksp_));
  }

  SolveReport attempt() {
    SolveReport report;
    check(VecSet(x_, 0));
    if (!inverse_->set_up()) return {false, 1, 0, "the flexible block is singular"};
    if (!factor_schur()) return {false, 1, 0, "the matrix is singular (bodies and joints)"};
    check(KSPSolve(ksp_, b_, x_));
    KSPConvergedReason reason;
    PetscInt iterations;
    check(KSPGetConvergedReason(ksp_, &reason));
    check(KSPGetIterationNumber(ksp_, &iterations));
    report.iterations = static_cast<int>(iterations);
    multiply(x_, r_);
    check(VecAYPX(r_, -1, b_));
    const double norm = max_norm(b_);
    report.residual = norm > 0 ? max_norm(r_) / norm : max_norm(r_);
    report.ok = std::isfinite(report.residual) && (reason > 0 || report.residual <= tolerance_);
    if (!report.ok)
      report.message =
          fmt::format("no convergence in {} iterations, residual {:.1e} (wanted {:.0e})", iterations, report.residual, tolerance_);
    return report;
  }

  /// Z = F~^-1 B and S = D - C Z.  False when S is singular.
  bool factor_schur() {
    if (m_ == 0) return true;
    const auto& columns = coupling_->columns();
    keep_ = columns.size() <= columns_kept;
    Z_.resize(keep_ ? columns.size() : 0);
    Eigen::MatrixXd S(m_, m_), change = Eigen::MatrixXd::Zero(m_, static_cast<Eigen::Index>(columns.size()));
    for (int i = 0; i < m_; ++i)
      for (int j = 0; j < m_; ++j) S(i, j) = coupling_->D()[static_cast<size_t>(i) * m_ + j];
    for (size_t k = 0; k < columns.size(); ++k) {
      {
        const Values f(f_);
        coupling_->column(columns[k], f.data(), n_flexible_);
      }
      inverse_->apply(f_, u_);
      const Values u(u_);
      coupling_->add_C(-1, u.data(), change.col(static_cast<Eigen::Index>(k)).data());
      if (keep_) Z_[k].assign(u.data(), u.data() + n_flexible_);
    }
    sum(change.data(), static_cast<int>(change.size()));
    for (size_t k = 0; k < columns.size(); ++k) S.col(columns[k]) += change.col(static_cast<Eigen::Index>(k));
    // rows of bodies and of constraints differ by many orders
    row_scale_ = S.cwiseAbs().rowwise().maxCoeff();
    if (!(row_scale_.minCoeff() > 0) || !S.allFinite()) return false;
    row_scale_ = row_scale_.cwiseInverse();
    const Eigen::VectorXd column_scale = (row_scale_.asDiagonal() * S).cwiseAbs().colwise().maxCoeff().transpose();
    if (!(column_scale.minCoeff() > 0)) return false;
    column_scale_ = column_scale.cwiseInverse();
    schur_.compute(row_scale_.asDiagonal() * S * column_scale_.asDiagonal());
    return schur_.rcond() > 1e-14;
  }

  static void sum(double* values, int n) {
    if (size() > 1 && n > 0) MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  }

  /// The dense part of a vector, from the end of the last rank's unknowns to all.
  void get_dense(const double* x) {
    if (m_ == 0) return;
    if (n_all_ > n_flexible_) std::copy_n(x + n_flexible_, m_, p_.begin());
    if (size() > 1) MPI_Bcast(p_.data(), m_, MPI_DOUBLE, size() - 1, PETSC_COMM_WORLD);
  }

  /// y = A x.
  void multiply(Vec x, Vec y) {
    const double* in;
    check(VecGetArrayRead(x, &in));
    const Values out(y);
    get_dense(in);
    check(VecPlaceArray(f_, in)), check(VecPlaceArray(u_, out.data()));
    check(MatMult(matrix_->mat(), f_, u_));
    check(VecResetArray(f_)), check(VecResetArray(u_));
    if (m_ > 0) {
      coupling_->add_B(1, p_.data(), out.data());
      std::fill(q_.begin(), q_.end(), 0.0);
      coupling_->add_C(1, in, q_.data());
      sum(q_.data(), m_);
      if (n_all_ > n_flexible_) {
        const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> D(coupling_->D().data(), m_, m_);
        Eigen::Map<Eigen::VectorXd>(out.data() + n_flexible_, m_) =
            Eigen::Map<const Eigen::VectorXd>(q_.data(), m_) + D * Eigen::Map<const Eigen::VectorXd>(p_.data(), m_);
      }
    }
    check(VecRestoreArrayRead(x, &in));
  }

  /// y = P^-1 x.
  void precondition(Vec x, Vec y) {
    const double* in;
    check(VecGetArrayRead(x, &in));
    {
      const Values out(y);
      check(VecPlaceArray(f_, in)), check(VecPlaceArray(u_, out.data()));
      inverse_->apply(f_, u_);
      check(VecResetArray(f_)), check(VecResetArray(u_));
      if (m_ > 0) {
        get_dense(in);
        std::fill(q_.begin(), q_.end(), 0.0);
        coupling_->add_C(1, out.data(), q_.data());
        sum(q_.data(), m_);
        Eigen::Map<Eigen::VectorXd> g(p_.data(), m_);
        const Eigen::VectorXd t = row_scale_.cwiseProduct(g - Eigen::Map<const Eigen::VectorXd>(q_.data(), m_));
        g = column_scale_.cwiseProduct(schur_.solve(t));
        subtract_Z(out.data());
        if (n_all_ > n_flexible_) std::copy_n(p_.begin(), m_, out.data() + n_flexible_);
      }
    }
    check(VecRestoreArrayRead(x, &in));
  }

  /// u -= Z p.
  void subtract_Z(double* u) {
    const auto& columns = coupling_->columns();
    if (columns.empty()) return;
    if (keep_) {
      for (size_t k = 0; k < columns.size(); ++k) {
        const double factor = p_[columns[k]];
        const float* z = Z_[k].data();
        for (size_t i = 0; i < n_flexible_; ++i) u[i] -= factor * z[i];
      }
      return;
    }
    check(VecSet(f_, 0));
    {
      const Values f(f_);
      coupling_->add_B(1, p_.data(), f.data());
    }
    inverse_->apply(f_, w_);
    const Values w(w_);
    for (size_t i = 0; i < n_flexible_; ++i) u[i] -= w[i];
  }

  double tolerance_;
  int m_ = 0, restart_ = 100;
  size_t n_flexible_ = 0, n_all_ = 0;  // owned unknowns
  const Cliques* cliques_ = nullptr;
  std::vector<char> touches_dense_;  // (n_cliques)
  std::optional<SharedBlocks> shared_;
  std::optional<BlockMatrix> matrix_;
  std::optional<Coupling> coupling_;
  std::optional<FlexibleInverse> inverse_;
  Vector x_, b_, r_, f_, u_, w_;
  Mat A_ = nullptr;
  KSP ksp_ = nullptr;
  bool keep_ = true;
  std::vector<std::vector<float>> Z_;
  std::vector<double> p_, q_;  // dense part, on all ranks
  Eigen::VectorXd row_scale_, column_scale_;
  Eigen::PartialPivLU<Eigen::MatrixXd> schur_;
};

}  // namespace

std::unique_ptr<KktSolver> make_iterative(double tolerance) { return std::make_unique<IterativeSolver>(tolerance); }

}  // namespace hilo::petsc
