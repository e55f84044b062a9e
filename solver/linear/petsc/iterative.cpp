// SPDX-License-Identifier: GPL-3.0-or-later
// A Krylov method on the whole system - GMRES, or CG on its symmetric part - with the preconditioner of saddle.hpp: when that is made anew,
// what is tried where it does not do, and when another solver goes on.
#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "linear/petsc/hand_over.hpp"
#include "linear/petsc/kinds.hpp"
#include "linear/petsc/krylov.hpp"
#include "linear/petsc/saddle.hpp"

namespace hilo::petsc {
namespace {

/// CG solves with the symmetric part, in single precision: digits beyond these are not the tangent's.
constexpr double worth_wanting = 1e-4;
/// Part of an element's tangent that is not symmetric beyond which Newton with the symmetric part takes thrice the iterations.
constexpr double too_unsymmetric = 0.01;
/// Unknowns whose factors find room; beyond, a run would rather have shorter steps.
constexpr std::int64_t most_factored = 300000;

class IterativeSolver final : public KktSolver {
 public:
  IterativeSolver(const PetscKind& kind, double tolerance, int subdomains) : kind_(&kind), tolerance_(tolerance), subdomains_(subdomains) {}

  void structure(const Cliques& cliques, const BlockMap& map) override {
    cliques_ = &cliques, map_ = &map;
    direct_.reset(), krylov_.reset(), system_.reset();
    shared_.emplace(map);
    FlexibleInput in{cliques, map, *shared_, {}, subdomains_};
    if (!map.X.empty())
      for (std::int64_t k = 0; k < shared_->n_owned() && map.first + k < map.first_dense; ++k)
        in.positions.insert(in.positions.end(), map.X.begin() + 3 * shared_->owned(k), map.X.begin() + 3 * shared_->owned(k) + 3);
    system_.emplace(cliques, map, *shared_, kind_->make(in));
    ready_ = false;
    const auto n = static_cast<PetscInt>(system_->n_all());
    x_ = Vector(n), b_ = Vector(n), r_ = Vector(n);
    if (kind_->is_symmetric) dx_ = Vector(n);
    krylov_.emplace(
        n, 3 * map.n_global, kind_->is_symmetric ? Method::cg : gmres(), [this](Vec x, Vec y) { system_->multiply(x, y); },
        [this](Vec x, Vec y) { system_->precondition(x, y); });
  }
  void zero() override {
    if (direct_) return direct_->zero();
    if (turns_) take_whole_tangent();
    system_->zero();
  }
  void add(int clique, const double* K) override { direct_ ? direct_->add(clique, K) : system_->add(clique, K); }
  void add_diagonal(int block, const double d[3]) override { direct_ ? direct_->add_diagonal(block, d) : system_->add_diagonal(block, d); }
  void sum_shared(std::span<double> local) override { shared_->sum(local); }

  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override {
    if (direct_) return direct_->solve(b, x, tolerance);
    wanted_ = std::max({tolerance, tolerance_, kind_->is_symmetric ? worth_wanting : 0.});
    system_->assemble();
    if (kind_->is_symmetric) {
      system_->coupling().symmetrise();
      turns_ = comm().max(system_->matrix().asymmetry()) > too_unsymmetric;
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
      while ((stronger = system_->inverse().strengthen(report.iterations, !report.ok)) && !report.ok) {
        before += report.iterations;
        check(VecSet(x_, 0));
        report = set_up_and_attempt();
      }
      if (stronger) ready_ = false;  // at the next solve
      rate_ = report.iterations / decades;
      report.iterations += before;
    }
    if (gives_up(report)) {
      if (rank() == 0) warn("", fmt::format("{} fails ({}); direct from here on", name(), report.message));
      auto direct = hand_over(system_->matrix(), system_->coupling(), *cliques_, *map_, tolerance_);
      krylov_.reset(), system_.reset();
      direct_ = std::move(direct);
      before = report.iterations;
      report = direct_->solve(b, x, tolerance);
      report.iterations += before;
      return report;
    }
    if (!report.ok) report.message += "; solver.kind = \"direct\" does where its factors find room";
    if (within_.all > 0) report.iterations = within_.all, report.most_within = within_.most;
    to_local(*shared_, x_, x);
    return report;
  }

  std::optional<int> eigenvalues_below_zero(int first_row) override {
    return direct_ ? direct_->eigenvalues_below_zero(first_row) : std::nullopt;
  }
  double bytes() const override {
    return direct_ ? direct_->bytes() : system_->bytes() + 8. * static_cast<double>(krylov_->vectors() * system_->n_all());
  }
  double set_up_seconds() const override { return set_up_seconds_ + (direct_ ? direct_->set_up_seconds() : 0); }
  double undivided_seconds() const override { return system_ ? system_->inverse().undivided_seconds() : 0; }
  std::string name() const override {
    if (direct_) return direct_->name();
    if (!system_) return kind_->title;
    const std::string ranks = size() > 1 ? fmt::format(", {} ranks", size()) : "";
    const char* method = krylov_->method() == Method::cg ? "CG" : "GMRES";
    return kind_->goes_direct ? fmt::format("{} ({}{})", system_->inverse().name(), method, ranks)
                              : fmt::format("iterative ({}, {}{})", method, system_->inverse().name(), ranks);
  }

 private:
  Method gmres() const { return system_->inverse().varies() ? Method::flexible_gmres : Method::gmres; }

  /// Whether factors go on from here.
  bool gives_up(const SolveReport& report) const {
    return !report.ok && (kind_->goes_direct || (std::isfinite(report.residual) && 3 * map_->n_global <= most_factored));
  }
  /// From the next matrix on; this one is at hand as its symmetric part alone.
  void take_whole_tangent() {
    if (rank() == 0) warn("", "CG: parts turn too far in a step for a symmetric tangent; GMRES with the whole one from here on");
    turns_ = false, kind_ = &solver_kinds().at("iterative");
    structure(*cliques_, *map_);
  }

  /// From x to where the rows of the dense part hold exactly.
  void step_to_dense_rows() {
    find_residual();
    system_->precondition(r_, dx_);
    check(VecAXPY(x_, 1, dx_));
  }
  void find_residual() {
    system_->multiply(x_, r_);
    check(VecAYPX(r_, -1, b_));
  }

  SolveReport set_up_and_attempt() {
    ready_ = false;
    if (const SolveReport made = set_up(); !made.ok) return made;
    system_->inverse().take_iterations();  // those of the set-up
    const SolveReport report = attempt(system_->inverse().most_iterations());
    ready_ = report.ok;
    return report;
  }
  SolveReport set_up() {
    const Stopwatch watch(set_up_seconds_);
    return system_->set_up();
  }

  /// From x_ as it is.
  SolveReport attempt(int iterations_allowed) {
    SolveReport report;
    PetscReal size = 0, left = 0;
    check(VecNorm(b_, NORM_2, &size));
    bool converged = true;
    // a preconditioner in single precision lets the recurrence run ahead of the residual: go on from where that is
    const int cycles = kind_->goes_direct ? 1 : 4;
    for (int cycle = 0; cycle < cycles && report.iterations < iterations_allowed; ++cycle) {
      if (krylov_->method() == Method::cg) step_to_dense_rows();
      const Krylov::Result result = krylov_->solve(b_, x_, wanted_, iterations_allowed - report.iterations);
      report.iterations += result.iterations;
      converged = result.converged;
      if (result.indefinite && krylov_->method() == Method::cg) {
        if (rank() == 0) warn("", "CG: the tangent is indefinite; GMRES from here on");
        krylov_->use(gmres());
        check(VecSet(x_, 0)), check(VecCopy(b_, r_));
        continue;
      }
      find_residual();
      check(VecNorm(r_, NORM_2, &left));
      if (!converged || result.iterations == 0 || !(left > 2 * wanted_ * size)) break;
    }
    const auto [all, most] = system_->inverse().take_iterations();
    within_.all += all, within_.most = std::max(within_.most, most);
    const double norm = max_norm(b_);
    report.residual = norm > 0 ? max_norm(r_) / norm : max_norm(r_);
    report.ok = std::isfinite(report.residual) && (converged || report.residual <= wanted_);
    if (!report.ok)
      report.message =
          fmt::format("no convergence in {} iterations, residual {:.1e} (wanted {:.0e})", report.iterations, report.residual, wanted_);
    return report;
  }

  const PetscKind* kind_;
  double tolerance_, wanted_ = 0;  // the tightest; that of the solve at hand
  int subdomains_ = 1;             // of this rank
  double set_up_seconds_ = 0;
  bool ready_ = false;  // the preconditioner is of a matrix that it solved
  double rate_ = 0;     // iterations a decade, when it was fresh
  bool turns_ = false;  // too far for the symmetric part alone
  FlexibleInverse::Within within_;
  const Cliques* cliques_ = nullptr;
  const BlockMap* map_ = nullptr;
  std::optional<SharedBlocks> shared_;
  std::optional<Saddle> system_;
  std::optional<Krylov> krylov_;
  std::unique_ptr<DirectSolver> direct_;  // once what is iterative has failed
  Vector x_, b_, r_, dx_;
};

}  // namespace

std::unique_ptr<KktSolver> make_iterative(const PetscKind& kind, double tolerance, int subdomains) {
  return std::make_unique<IterativeSolver>(kind, tolerance, subdomains);
}

}  // namespace hilo::petsc
