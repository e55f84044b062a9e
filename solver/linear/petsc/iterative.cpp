// A Krylov method on the whole system - GMRES, or CG on its symmetric part - preconditioned by a block factorisation in which only F is
// approximated:
//
//     P = [ F~  B ]     with  S = D - C F~^-1 B  sparse and exact for F~:  p = S^-1 (g - C F~^-1 f),   u = F~^-1 f - Z p,   Z = F~^-1 B.
//         [ C   D ]
//
// P^-1 A - 1 then vanishes outside the flexible block, so bodies and multipliers cost no iterations beyond those of F~ on F (for
// C = B^T, D = 0: the constraint preconditioner [keller-gould-wathen-2000]).  Cost: one application of F~ per dense unknown that touches a
// flexible node (6 per attached body, 3 per multiplier block) and solve, and one per iteration.
#define OMPI_SKIP_MPICXX 1
#include <fmt/format.h>
#include <petscksp.h>

#include <Eigen/Core>
#include <cmath>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "linear/petsc/coupling.hpp"
#include "linear/petsc/direct.hpp"
#include "linear/petsc/schur_factor.hpp"
#include "linear/petsc/solver.hpp"
#include "linear/petsc/subdomain_matrix.hpp"
#include "linear/petsc/symmetric_matrix.hpp"

namespace hilo::petsc {
namespace {

/// Z is kept up to so many values per rank (320 MB); beyond, F~ is applied a second time per iteration.  In double precision: where a body
/// hangs on stiff parts and little else, the forces of its motions cancel.
constexpr double values_kept = 4e7;
/// Columns of Z that go through F~ together, which reads its factors once for them.
constexpr Eigen::Index columns_at_once = 24;

/// CG solves with the symmetric part, in single precision: digits beyond these are not the tangent's.
constexpr double worth_wanting = 1e-4;
/// Part of an element's tangent that is not symmetric beyond which Newton with the symmetric part takes thrice the iterations.
constexpr double too_unsymmetric = 0.01;

class IterativeSolver final : public KktSolver {
 public:
  IterativeSolver(Kind kind, double tolerance, int subdomains) : kind_(kind), tolerance_(tolerance), subdomains_(subdomains) {}
  ~IterativeSolver() override { release(); }

  void structure(const Cliques& cliques, const BlockMap& map) override {
    release();
    cliques_ = &cliques, map_ = &map;
    direct_.reset(), inverse_.reset(), matrix_.reset(), coupling_.reset();
    shared_.emplace(map);
    coupling_.emplace(cliques, map, *shared_);
    std::vector<double> positions;
    if (!map.X.empty())
      for (std::int64_t k = 0; k < shared_->n_owned() && map.first + k < map.first_dense; ++k)
        positions.insert(positions.end(), map.X.begin() + 3 * shared_->owned(k), map.X.begin() + 3 * shared_->owned(k) + 3);
    make_flexible(std::move(positions));
    ready_ = false;
    touches_dense_.clear();
    for (int e = 0; e < cliques.size(); ++e) touches_dense_.push_back(coupling_->couples(cliques[e]));
    n_flexible_ = 3 * static_cast<size_t>(matrix_->n_owned());
    n_all_ = 3 * static_cast<size_t>(shared_->n_owned());
    m_ = coupling_->m();
    const auto nf = static_cast<PetscInt>(n_flexible_), na = static_cast<PetscInt>(n_all_);
    x_ = Vector(na), b_ = Vector(na), r_ = Vector(na);
    if (kind_ == Kind::cg) dx_ = Vector(na);
    f_ = Vector(nf), u_ = Vector(nf);
    p_.assign(m_, 0.0), q_.assign(m_, 0.0);
    make_krylov(3 * map.n_global);
  }
  void zero() override {
    if (direct_) return direct_->zero();
    if (turns_) take_whole_tangent();
    matrix_->zero(), coupling_->zero();
  }
  void add(int clique, const double* K) override {
    if (direct_) return direct_->add(clique, K);
    matrix_->add(clique, (*cliques_)[clique], K);
    if (touches_dense_[clique]) coupling_->add((*cliques_)[clique], K);
  }
  void add_diagonal(int block, const double d[3]) override {
    if (direct_) return direct_->add_diagonal(block, d);
    if (coupling_->is_dense(block))
      coupling_->add_diagonal(block, d);
    else
      matrix_->add_diagonal(block, d);
  }
  void sum_shared(std::span<double> local) override { shared_->sum(local); }

  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override {
    if (direct_) return direct_->solve(b, x, tolerance);
    wanted_ = std::max({tolerance, tolerance_, kind_ == Kind::cg ? worth_wanting : 0.});
    matrix_->assemble(), coupling_->assemble();
    if (kind_ == Kind::cg) {
      coupling_->symmetrise();
      turns_ = largest(static_cast<SymmetricMatrix&>(*matrix_).asymmetry()) > too_unsymmetric;
    }
    to_owned(*shared_, b, b_);
    check(VecSet(x_, 0));
    SolveReport report;
    within_ = {};
    int before = 0;
    const double decades = -std::log10(wanted_);
    const bool lagged = ready_;
    if (lagged) {  // the preconditioner of a matrix before serves while it is not much worse than it was for its own
      report = attempt(static_cast<int>(2 * rate_ * decades) + 10);
      ready_ = report.ok && report.iterations <= 1.5 * rate_ * decades + 5;
      before = report.iterations;
    }
    if (!lagged || !report.ok) {
      if (!(report.residual < 1)) check(VecSet(x_, 0));
      report = set_up_and_attempt();
      bool stronger;
      while ((stronger = inverse_->strengthen(report.iterations, !report.ok)) && !report.ok) {
        before += report.iterations;
        check(VecSet(x_, 0));
        report = set_up_and_attempt();
      }
      if (stronger) ready_ = false;  // at the next solve
      rate_ = report.iterations / decades;
      report.iterations += before;
    }
    if (!report.ok && is_substructured()) {
      if (rank() == 0) warn("", fmt::format("{} fails ({}); direct from here on", name(), report.message));
      hand_over();
      before = report.iterations;
      report = direct_->solve(b, x, tolerance);
      report.iterations += before;
      return report;
    }
    if (within_.all > 0) report.iterations = within_.all, report.most_within = within_.most;
    to_local(*shared_, x_, x);
    return report;
  }

  double bytes() const override {
    if (direct_) return direct_->bytes();
    return matrix_->bytes() + coupling_->bytes() + inverse_->bytes() + 8. * static_cast<double>(Z_.size()) +
           8. *
               (is_cg_               ? 3
                : inverse_->varies() ? 2 * restart_
                                     : restart_) *
               n_all_;
  }
  double set_up_seconds() const override { return set_up_seconds_ + (direct_ ? direct_->set_up_seconds() : 0); }
  double undivided_seconds() const override { return inverse_ ? inverse_->undivided_seconds() : 0; }
  std::string name() const override {
    if (direct_) return direct_->name();
    if (!inverse_) return kind_ == Kind::bddc ? "BDDC" : kind_ == Kind::feti_dp ? "FETI-DP" : "iterative";
    const std::string ranks = size() > 1 ? fmt::format(", {} ranks", size()) : "";
    const char* method = is_cg_ ? "CG" : "GMRES";
    return is_substructured() ? fmt::format("{} ({}{})", inverse_->name(), method, ranks)
                              : fmt::format("iterative ({}, {}{})", method, inverse_->name(), ranks);
  }

 private:
  void release() {
    KSPDestroy(&ksp_);
    MatDestroy(&A_);
  }

  bool is_substructured() const { return kind_ == Kind::bddc || kind_ == Kind::feti_dp; }

  /// From the next matrix on; this one is at hand as its symmetric part alone.
  void take_whole_tangent() {
    if (rank() == 0) warn("", "CG: parts turn too far in a step for a symmetric tangent; GMRES with the whole one from here on");
    turns_ = false, kind_ = Kind::algebraic;
    structure(*cliques_, *map_);
  }

  void make_flexible(std::vector<double> positions) {
    if (kind_ == Kind::algebraic) {
      auto F = std::make_unique<BlockMatrix>(*cliques_, *map_, *shared_, map_->first_dense);
      inverse_ = make_algebraic_inverse(*F, std::move(positions));
      matrix_ = std::move(F);
      return;
    }
    if (kind_ == Kind::cg) {
      auto F = std::make_unique<SymmetricMatrix>(*cliques_, *map_, *shared_);
      const auto make_whole = [this] { return std::make_unique<BlockMatrix>(*cliques_, *map_, *shared_, map_->first_dense); };
      inverse_ = make_algebraic_inverse(*F, make_whole, std::move(positions));
      matrix_ = std::move(F);
      return;
    }
    auto F = std::make_unique<SubdomainMatrix>(*cliques_, *map_, *shared_, subdomains_);
    const bool placed = largest(positions.empty() ? 0 : 1) > 0;
    inverse_ = kind_ == Kind::feti_dp ? make_feti_dp(*F) : make_bddc(*F);
    if (placed) inverse_ = make_deflated(std::move(inverse_), *F, std::move(positions));
    matrix_ = std::move(F);
  }

  /// What is assembled goes to the direct solver, which does the rest of the run.
  void hand_over() {
    auto direct = std::make_unique<DirectSolver>(tolerance_);
    direct->structure(*cliques_, *map_);
    direct->zero();
    BlockMatrix& A = direct->matrix();
    const auto first_dense = static_cast<PetscInt>(map_->first_dense);
    static_cast<SubdomainMatrix&>(*matrix_).for_each_row(
        [&](PetscInt row, std::span<const PetscInt> columns, const double* values) { A.add_row(row, columns, values); });
    coupling_->for_each_couple([&](int local, int dense, const double* B, const double* C) {
      const PetscInt u = static_cast<PetscInt>(map_->global[local]), p = first_dense + dense;
      A.add_row(u, {&p, 1}, B), A.add_row(p, {&u, 1}, C);
    });
    if (n_all_ > n_flexible_)
      coupling_->for_each_D([&](int i, int j, const double* D) {
        const PetscInt column = first_dense + j;
        A.add_row(first_dense + i, {&column, 1}, D);
      });
    release();
    Z_.resize(0, 0);
    inverse_.reset(), matrix_.reset(), coupling_.reset();
    direct_ = std::move(direct);
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
    check(KSPSetOptionsPrefix(ksp_, "hilo_outer_"));
    check(KSPSetOperators(ksp_, A_, A_));
    is_cg_ = kind_ == Kind::cg;
    restart_ = n_global > 1000000 ? 50 : 100;  // at 3 million unknowns 50 vectors are 1.2 GB
    choose_method();
    check(KSPSetInitialGuessNonzero(ksp_, PETSC_TRUE));
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

  void choose_method() {
    check(KSPSetType(ksp_, is_cg_ ? KSPCG : inverse_->varies() ? KSPFGMRES : KSPGMRES));
    check(KSPSetPCSide(ksp_, is_cg_ ? PC_LEFT : PC_RIGHT));
    check(KSPSetNormType(ksp_, KSP_NORM_UNPRECONDITIONED));
    if (!is_cg_) check(KSPGMRESSetRestart(ksp_, restart_));
  }

  /// From x to where the rows of the dense part hold exactly.
  void step_to_dense_rows() {
    multiply(x_, r_);
    check(VecAYPX(r_, -1, b_));
    precondition(r_, dx_);
    check(VecAXPY(x_, 1, dx_));
  }

  SolveReport set_up_and_attempt() {
    ready_ = false;
    if (const std::string problem = set_up(); !problem.empty()) return {false, 1, 0, problem};
    inverse_->take_iterations();  // those of the set-up
    const SolveReport report = attempt(inverse_->most_iterations());
    ready_ = report.ok;
    return report;
  }

  /// What is wrong, or nothing.
  std::string set_up() {
    const Stopwatch watch(set_up_seconds_);
    if (!inverse_->set_up()) return "the flexible block is singular";
    if (factor_schur()) return "";
    return inverse_->has_failed() ? inverse_->name() + " does not converge" : "the matrix is singular (bodies and joints)";
  }

  /// From x_ as it is.
  SolveReport attempt(int iterations_allowed) {
    SolveReport report;
    PetscReal size = 0, left = 0;
    check(VecNorm(b_, NORM_2, &size));
    KSPConvergedReason reason = KSP_CONVERGED_RTOL;
    PetscInt iterations = 0;
    // a preconditioner in single precision lets the recurrence run ahead of the residual: go on from where that is
    const int cycles = is_substructured() ? 1 : 4;
    for (int cycle = 0; cycle < cycles && iterations < iterations_allowed; ++cycle) {
      PetscInt more = 0;
      if (is_cg_) step_to_dense_rows();
      check(KSPSetTolerances(ksp_, wanted_, 1e-300, PETSC_DEFAULT, iterations_allowed - iterations));
      check(KSPSolve(ksp_, b_, x_));
      check(KSPGetConvergedReason(ksp_, &reason));
      check(KSPGetIterationNumber(ksp_, &more));
      iterations += more;
      if (is_cg_ && (reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC)) {
        if (rank() == 0) warn("", "CG: the tangent is indefinite; GMRES from here on");
        is_cg_ = false;
        choose_method();
        check(VecSet(x_, 0)), check(VecCopy(b_, r_));
        reason = KSP_DIVERGED_ITS;
        continue;
      }
      multiply(x_, r_);
      check(VecAYPX(r_, -1, b_));
      check(VecNorm(r_, NORM_2, &left));
      if (reason < 0 || more == 0 || !(left > 2 * wanted_ * size)) break;
    }
    report.iterations = static_cast<int>(iterations);
    const auto [all, most] = inverse_->take_iterations();
    within_.all += all, within_.most = std::max(within_.most, most);
    const double norm = max_norm(b_);
    report.residual = norm > 0 ? max_norm(r_) / norm : max_norm(r_);
    report.ok = std::isfinite(report.residual) && (reason > 0 || report.residual <= wanted_);
    if (!report.ok)
      report.message =
          fmt::format("no convergence in {} iterations, residual {:.1e} (wanted {:.0e})", iterations, report.residual, wanted_);
    return report;
  }

  /// Z = F~^-1 B and S = D - C Z.  False when S is singular.
  bool factor_schur() {
    if (m_ == 0) return true;
    const auto& columns = coupling_->columns();
    const auto n_columns = static_cast<Eigen::Index>(columns.size()), n = static_cast<Eigen::Index>(n_flexible_);
    keep_ = largest(static_cast<double>(n_columns) * static_cast<double>(n)) <= values_kept;
    Z_.resize(n, keep_ ? n_columns : std::min(n_columns, columns_at_once));
    if (n_columns > 6000)
      throw Error("", fmt::format("{} unknowns of bodies and joints touch flexible nodes: too many for this solver", n_columns),
                  "solver.kind = \"direct\"", Exit::resources);
    Eigen::MatrixXd of_touched(n_columns, n_columns);  // C touches no other rows
    std::vector<double> change(m_);
    for (Eigen::Index k = 0; k < n_columns; k += columns_at_once) {
      const auto some = std::min(columns_at_once, n_columns - k);
      auto Z = Z_.middleCols(keep_ ? k : 0, some);
      for (Eigen::Index j = 0; j < some; ++j) coupling_->column(columns[k + j], Z.col(j).data(), n_flexible_);
      inverse_->apply(Z);
      if (inverse_->has_failed()) return false;
      for (Eigen::Index j = 0; j < some; ++j) {
        std::fill(change.begin(), change.end(), 0.0);
        coupling_->add_C(-1, Z.col(j).data(), change.data());
        for (Eigen::Index i = 0; i < n_columns; ++i) of_touched(i, k + j) = change[columns[i]];
      }
    }
    if (!keep_) Z_.resize(0, 0);
    sum(of_touched.data(), static_cast<int>(of_touched.size()));
    return schur_.factor(*coupling_, columns, of_touched);
  }

  static double largest(double value) { return comm().max(value); }
  static void sum(double* values, int n) {
    if (n > 0) comm().sum({values, static_cast<size_t>(n)});
  }

  /// The dense part of a vector, from the end of the last rank's unknowns to all.
  void get_dense(const double* x) {
    if (m_ == 0) return;
    if (n_all_ > n_flexible_) std::copy_n(x + n_flexible_, m_, p_.begin());
    comm().copy(std::span(p_.data(), static_cast<size_t>(m_)), size() - 1);
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
        coupling_->add_D(p_.data(), q_.data());
        std::copy_n(q_.data(), m_, out.data() + n_flexible_);
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
      std::copy_n(in, n_flexible_, out.data());
      inverse_->apply(Eigen::Map<Eigen::MatrixXd>(out.data(), static_cast<Eigen::Index>(n_flexible_), 1));
      if (m_ > 0) {
        get_dense(in);
        std::fill(q_.begin(), q_.end(), 0.0);
        coupling_->add_C(1, out.data(), q_.data());
        sum(q_.data(), m_);
        for (int i = 0; i < m_; ++i) p_[i] -= q_[i];
        schur_.solve(p_.data());
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
    const auto n = static_cast<Eigen::Index>(n_flexible_);
    if (keep_) {
      Eigen::VectorXd p(Z_.cols());
      for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = p_[columns[k]];
      Eigen::Map<Eigen::VectorXd>(u, n).noalias() -= Z_ * p;
      return;
    }
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, 1);
    coupling_->add_B(1, p_.data(), w.data());
    inverse_->apply(w);
    Eigen::Map<Eigen::VectorXd>(u, n) -= w;
  }

  Kind kind_;
  double tolerance_, wanted_ = 0;  // the tightest; that of the solve at hand
  int subdomains_ = 1;             // of this rank
  double set_up_seconds_ = 0;
  bool ready_ = false;  // the preconditioner is of a matrix that it solved
  double rate_ = 0;     // iterations a decade, when it was fresh
  FlexibleInverse::Within within_;
  int m_ = 0, restart_ = 100;
  size_t n_flexible_ = 0, n_all_ = 0;  // owned unknowns
  const Cliques* cliques_ = nullptr;
  const BlockMap* map_ = nullptr;
  std::vector<char> touches_dense_;  // (n_cliques)
  std::optional<SharedBlocks> shared_;
  std::unique_ptr<FlexibleMatrix> matrix_;
  std::optional<Coupling> coupling_;
  std::unique_ptr<FlexibleInverse> inverse_;
  std::unique_ptr<DirectSolver> direct_;  // once substructuring has failed
  bool is_cg_ = false, turns_ = false;
  Vector x_, b_, r_, dx_, f_, u_;
  Mat A_ = nullptr;
  KSP ksp_ = nullptr;
  bool keep_ = true;
  Eigen::MatrixXd Z_;
  std::vector<double> p_, q_;  // dense part, on all ranks
  SchurFactor schur_;
};

}  // namespace

std::unique_ptr<KktSolver> make_iterative(Kind kind, double tolerance, int subdomains) {
  return std::make_unique<IterativeSolver>(kind, tolerance, subdomains);
}

}  // namespace hilo::petsc
