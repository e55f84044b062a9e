// SPDX-License-Identifier: GPL-3.0-or-later
// The light solve: serial, for scenes that need not start PETSc.  Factors of one matrix serve the next ones while that is cheaper.
#include <fmt/format.h>
#include <suitesparse/amd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/registry.hpp"
#include "base/stopwatch.hpp"
#include "linear/factors.hpp"
#include "linear/gmres.hpp"
#include "linear/inertia.hpp"

namespace hilo {
namespace {

constexpr int klu_below = 1500;         // unknowns, and
constexpr double klu_work = 4e5;        // multiplications of a factorisation, where there are cells: some hundred nodes of a block
constexpr int rigid_klu_below = 30000;  // unknowns where there are none; beyond, while factors stay thin
constexpr double thin = 60;             // multiplications a factor's entry
constexpr int net_from = 600;           // unknowns of a net of bodies, without multipliers, that UMFPACK does faster,
constexpr double thin_net = 25;         // unless its factors are thinner than this
constexpr int dense_at_most = 1200;     // unknowns of bodies and multipliers beside a Cholesky factor
constexpr int least_iterations = 10;    // that lagged factors are given
constexpr double many_more = 4;         // iterations than with fresh factors: what the factors can follow is more than round-off
constexpr double tiny = 1e-280;         // what is at rest but for numbers below the normal ones has no relative residual

/// What a factorisation by columns takes, by the pattern.
struct FactorWork {
  double multiplications, entries;
  /// Some tens for chains, trees and rows of loops, hundreds for nets, which a multifrontal one does faster.
  double per_entry() const { return multiplications / entries; }
};

FactorWork factor_work(const BlockCsr& A) {
  std::vector<int> start{0}, column;
  for (int i = 0; i < A.n_blocks(); ++i) {
    const auto list = A.neighbours(i);
    column.insert(column.end(), list.begin(), list.end());
    start.push_back(static_cast<int>(column.size()));
  }
  std::vector<int> order(A.n_blocks());
  double info[AMD_INFO];
  if (amd_order(A.n_blocks(), start.data(), column.data(), order.data(), nullptr, info) < 0) return {0, 1};
  return {27 * info[AMD_NMULTSUBS_LU], 9 * (2 * info[AMD_LNZ] + A.n_blocks())};
}

class LightSolver final : public SerialKktSolver {
 public:
  explicit LightSolver(std::string kind) : kind_(std::move(kind)) {}

  void structure(const Cliques& cliques, const BlockMap& map) override {
    A_.structure(cliques, static_cast<int>(map.global.size()));
    is_dense_.assign(map.global.size(), 0);
    for (size_t i = 0; i < map.global.size(); ++i) is_dense_[i] = map.global[i] >= map.first_dense + map.n_with_cells;
    const auto n_dense = 3 * std::count(is_dense_.begin(), is_dense_.end(), 1);
    std::string kind = kind_;
    if (kind == "light") {
      const bool serves = n_dense == A_.n() ? A_.n() < rigid_klu_below || factor_work(A_).per_entry() < thin
                                            : A_.n() < klu_below && factor_work(A_).multiplications < klu_work;
      kind = serves ? "klu" : n_dense <= dense_at_most && 2 * n_dense < A_.n() ? "cholesky" : "umfpack";
    }
    is_klu_ = kind == "klu";
    may_be_net_ = is_klu_ && kind_ == "light" && n_dense == A_.n() && A_.n() >= net_from && A_.n() < rigid_klu_below;
    factors_ = is_klu_ ? make_klu(n_dense == A_.n()) : kind == "umfpack" ? make_umfpack() : make_cholesky(is_dense_, joined(cliques));
    is_definite_ = kind == "cholesky";
    aside_.reset(), rest_ = 0;
    factored_ = ready_ = false, changed_ = true;
  }

  void zero() override { A_.zero(), factored_ = false, changed_ = true; }
  void add(int clique, const double* K) override { A_.add(clique, K); }
  void add_part(int clique, int row, int column, int n, const double* K) override { A_.add_part(clique, row, column, n, K); }
  void add_diagonal(int block, const double d[3]) override { A_.add_diagonal(block, d); }
  void sum_shared(std::span<double>) override {}

  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override {
    if (A_.n() == 0) return {};  // nothing is free to move
    if (std::exchange(may_be_net_, false) && has_whole_diagonal() && factor_work(A_).per_entry() >= thin_net)
      is_klu_ = false, factors_ = make_umfpack(), is_definite_ = false;
    return is_klu_ ? solve_refined(b, x) : solve_iterated(b, x, tolerance);
  }
  bool repeats_cheaply() const override { return is_klu_; }
  std::optional<int> eigenvalues_below_zero(int first_row) override {
    if (is_definite_ && factors_->are_of_definite() &&
        std::ranges::none_of(is_dense_, std::identity())) {  // their factors tell as well, and serve the next matrix
      const Stopwatch watch(set_up_);
      ready_ = factors_->factor(A_);
      if (ready_ && factors_->are_of_definite()) return excess_ = 0, 0;
    }
    return hilo::eigenvalues_below_zero(A_, first_row);
  }
  std::string name() const override { return fmt::format("light ({})", factors_->name()); }
  double bytes() const override { return A_.bytes() + factors_->bytes(); }
  double set_up_seconds() const override { return set_up_; }

 private:
  /// Blocks that joints, contacts and the like couple, beside cells.
  std::vector<char> joined(const Cliques& cliques) const {
    std::vector<char> out(is_dense_.size(), 0);
    for (int i = 0; i < cliques.size(); ++i)
      for (const int b : cliques[i])
        if (b >= 0 && !cliques.own[i] && !is_dense_[b]) out[b] = 1;
    return out;
  }

  SolveReport solve_refined(std::span<const double> b, std::span<double> x) {
    if (factored_) return factors_->solve(b.data(), x.data()), SolveReport{};
    factored_ = true;
    // pivots of the factorisation before serve again while the residual says that they are good ones
    if (refactor())
      if (const SolveReport report = refine(b, x, 1); report.ok) return report;
    if (!factor()) return factored_ = false, SolveReport::singular();
    return refine(b, x, 3);
  }

  /// x from the factors, refined until the residual is at round-off.
  SolveReport refine(std::span<const double> b, std::span<double> x, int passes) {
    factors_->solve(b.data(), x.data());
    SolveReport report;
    for (int pass = 0;; ++pass) {
      report.residual = find_residual(b, x);
      if (!std::isfinite(report.residual)) return SolveReport::singular(" to working precision", report.residual);
      if (report.residual > 1e-6 && backward_error(b, x) > 1e-12)
        report.ok = false, report.message = fmt::format("linear residual {:.1e}", report.residual);
      if (!report.ok || report.residual < 1e-11 || pass == passes) return report;
      correction_.resize(b.size());
      factors_->solve(residual_.data(), correction_.data());
      for (size_t i = 0; i < b.size(); ++i) x[i] += correction_[i];
    }
  }

  /// GMRES on the matrix, with the factors of this one or an earlier one.
  SolveReport solve_iterated(std::span<const double> b, std::span<double> x, double tolerance) {
    tolerance = std::max(tolerance, 1e-10);  // about what round-off leaves of stiff scenes
    int before = 0;
    if (std::exchange(changed_, false)) {
      find_weights();  // those of another matrix may leave out rows: of a mass that was added, of a contact that has opened
      if (ready_ && lags_) ready_ = factors_->follow(A_);
    }
    if (ready_) {
      const int allowed = least_iterations + static_cast<int>(factors_->cost());
      SolveReport report = iterate(b, x, tolerance, allowed);
      // new factors once what lagging has cost is what they cost
      const double decades = -std::log10(std::clamp(report.residual, 1e-12, 0.5));
      const double excess = std::max(0.0, report.iterations - rate_ * decades);
      excess_ += excess;
      if (excess > many_more) lags_ = true;
      ready_ = report.ok && excess_ < factors_->cost();
      if (report.ok) return report;
      before = report.iterations;
    }
    SolveReport report = factor_and_iterate(b, x, tolerance);
    if ((!report.ok || rate_ > 1) && factors_->sharpen()) before += report.iterations, report = factor_and_iterate(b, x, tolerance);
    if (!report.ok && is_definite_) {
      if (!indefinite_ || (!told_ && has_whole_diagonal()))  // rows may hold what the rest leaves free
        warn("", fmt::format("{}: {}; unsymmetric factors {}", name(), report.message, indefinite_ ? "instead" : "from here on"));
      told_ = true;
      if (indefinite_) aside_ = std::move(factors_), waits_ = rest_ = std::min(2 * rest_ + 1, 15);
      factors_ = make_umfpack(), is_definite_ = false;
      before += report.iterations;
      report = factor_and_iterate(b, x, tolerance);
    }
    report.iterations += before;
    return report;
  }

  /// Where an earlier matrix was not definite, this one may be.
  bool factor() {
    const Stopwatch watch(set_up_);
    if (aside_ && waits_-- == 0) {
      if (aside_->factor(A_)) return factors_ = std::move(aside_), is_definite_ = true;
      waits_ = rest_ = std::min(2 * rest_ + 1, 15);
    }
    const bool done = factors_->factor(A_);
    indefinite_ = is_definite_ && !done;
    return done;
  }
  bool refactor() {
    const Stopwatch watch(set_up_);
    return factors_->refactor(A_);
  }

  SolveReport factor_and_iterate(std::span<const double> b, std::span<double> x, double tolerance) {
    ready_ = false;
    if (!factor()) return is_definite_ ? SolveReport::failed("the matrix is not positive definite") : SolveReport::singular();
    const SolveReport report = iterate(b, x, tolerance, 60);
    rate_ = report.iterations / -std::log10(std::clamp(report.residual, 1e-12, 0.5));
    excess_ = 0;
    ready_ = report.ok;
    return report;
  }

  /// To the tolerance in rows weighted alike, or to round-off of what they sum.
  SolveReport iterate(std::span<const double> b, std::span<double> x, double tolerance, int most) {
    const auto multiply = [&](const double* in, double* out) { A_.multiply(in, out); };
    const auto precondition = [&](const double* in, double* out) { factors_->solve(in, out); };
    const auto weighted = [&](std::span<const double> r) {
      double sum = 0;
      for (size_t i = 0; i < r.size(); ++i) sum += weight_[i] * r[i] * weight_[i] * r[i];
      return std::sqrt(sum);
    };
    const double norm = weighted(b);
    SolveReport report;
    int iterations = gmres_.solve(multiply, precondition, weight_, b, x, tolerance, most).iterations;
    for (bool again = true;; again = false) {
      const double residual = find_residual(b, x), left = norm > 0 ? weighted(residual_) / norm : 0;
      const bool finite = std::isfinite(left),
                 done = finite && (left <= 2 * tolerance || residual <= 1e-12 || backward_error(b, x) <= 1e-15);
      if (!finite || done || !again || iterations >= most) {  // the recurrence may flatter: once more from what is left
        if (!done) report.message = fmt::format("no convergence in {} iterations, residual {:.1e}", iterations, left);
        report.ok = done, report.residual = left, report.iterations = iterations;
        return report;
      }
      correction_.resize(b.size());
      iterations += gmres_.solve(multiply, precondition, weight_, residual_, correction_, tolerance / left, most - iterations).iterations;
      for (size_t i = 0; i < b.size(); ++i) x[i] += correction_[i];
    }
  }

  /// residual_ := b - A x by multiplication; its largest number over that of b.
  double find_residual(std::span<const double> b, std::span<const double> x) {
    residual_.resize(b.size());
    A_.multiply(x.data(), residual_.data());
    double worst = 0, norm = 0;
    for (size_t i = 0; i < b.size(); ++i) {
      const double s = residual_[i] = b[i] - residual_[i];
      norm = std::max(norm, std::abs(b[i]));
      if (!(std::abs(s) <= worst)) worst = std::abs(s);
    }
    return norm > tiny ? worst / norm : worst;
  }

  /// The largest residual of x over the largest sum of terms' sizes in a row: an ill-conditioned matrix leaves round-off of these.
  double backward_error(std::span<const double> b, std::span<const double> x) {
    residual_.resize(b.size()), sums_.resize(b.size());
    A_.multiply(x.data(), residual_.data(), sums_.data());
    double worst = 0, terms = 0;
    for (size_t i = 0; i < b.size(); ++i) {
      residual_[i] = b[i] - residual_[i];
      worst = std::max(worst, std::abs(residual_[i])), terms = std::max(terms, sums_[i] + std::abs(b[i]));
    }
    return terms > tiny ? worst / terms : 0;
  }

  /// Whether no row is of a multiplier.
  bool has_whole_diagonal() const {
    const auto &start = A_.row_start(), &column = A_.column();
    for (int i = 0; i < A_.n(); ++i) {
      const auto at = std::lower_bound(column.begin() + start[i], column.begin() + start[i + 1], i);
      if (at == column.begin() + start[i + 1] || *at != i || A_.values()[static_cast<size_t>(at - column.begin())] == 0) return false;
    }
    return true;
  }

  /// One over the largest entry of each row.
  void find_weights() {
    weight_.resize(A_.n());
    const auto& start = A_.row_start();
    for (int i = 0; i < A_.n(); ++i) {
      double largest = 0;
      for (int k = start[i]; k < start[i + 1]; ++k) largest = std::max(largest, std::abs(A_.values()[k]));
      weight_[i] = largest > 0 ? 1 / largest : 1;
    }
  }

  std::string kind_;
  BlockCsr A_;
  std::vector<char> is_dense_;
  std::unique_ptr<Factors> factors_;
  double set_up_ = 0;
  bool is_klu_ = true, is_definite_ = false;
  bool may_be_net_ = false;         // rigid bodies that contacts and springs alone hold: the matrix tells
  std::unique_ptr<Factors> aside_;  // Cholesky factors that failed as the matrix was not definite; matrices until they try again
  int waits_ = 0, rest_ = 0;
  bool indefinite_ = false, told_ = false;
  bool factored_ = false;         // the factors at hand are those of the matrix
  bool changed_ = false;          // the matrix, since the last solve
  bool ready_ = false;            // the factors at hand serve it preconditioning
  bool lags_ = false;             // factors of earlier matrices, of whatever structure, have been far from these: they are to follow
  double rate_ = 0, excess_ = 0;  // iterations per decade with fresh factors; those lagging has cost since
  std::vector<double> residual_, sums_, correction_, weight_;
  Gmres gmres_;
};

}  // namespace

std::unique_ptr<SerialKktSolver> make_light_solver(const std::string& kind) {
  const std::vector<std::string> kinds{"light", "klu", "cholesky", "umfpack"};
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) registry::refuse("light solver", kind, kinds, "solver.kind");
  return std::make_unique<LightSolver>(kind);
}

}  // namespace hilo
