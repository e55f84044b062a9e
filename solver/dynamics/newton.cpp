// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/linear_step.hpp"
#include "dynamics/redundancy/free_part.hpp"
#include "system/revising.hpp"

namespace hilo {

double relative_residual(const System& s, const Residual& r) {
  const double force = r.force_scale > 0 ? r.force_scale : 1;
  double worst = 0;
  const auto visit = [&](int block, double scale) {
    for (int k = 0; k < 3; ++k) {
      const double x = std::abs(r.r[3 * block + k]) / scale;
      if (!(x <= worst)) worst = x;  // keeps a NaN
    }
  };
  for (const UnknownField& f : s.unknowns)
    for (size_t k = 0; k < f.size(); ++k) visit(f.block(k), force * (f.turns() ? std::max(f.scale(k), 1e-3 * s.length) : f.scale(k)));
  for (int j = s.first_joint_block(); j < s.n_blocks(); ++j) visit(j, r.sigma * s.length);
  return worst;
}

double relative_correction(const System& s, std::span<const double> z) {
  double worst = 0;
  const auto visit = [&](int block, double scale) {
    for (int k = 0; k < 3; ++k) {
      const double x = std::abs(z[3 * block + k]) * scale;
      if (!(x <= worst)) worst = x;
    }
  };
  for (const UnknownField& f : s.unknowns)
    for (size_t k = 0; k < f.size(); ++k) visit(f.block(k), f.scale(k) / s.length);
  return worst;
}

double size_of(const System& s, std::span<const double> z) {
  double sum = 0;
  for (const UnknownField& f : s.unknowns)
    for (size_t k = 0; k < f.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const double x = z[3 * f.block(k) + i] * f.scale(k);
        sum += x * x;
      }
  return std::sqrt(s.comm->sum(sum));
}

double work_of(const System& s, const Residual& r, std::span<const double> step) {
  double work = 0;
  for (size_t k = 0; k < step.size() / 3; ++k) {
    const std::int64_t owned = s.layout.map.global[k] - s.layout.map.first;  // of the ranks that hold the block one counts it
    if (owned < 0 || owned >= s.layout.map.n_owned) continue;
    for (size_t i = 3 * k; i < 3 * k + 3; ++i) work += r.r[i] * step[i];
  }
  return s.comm->sum(work);
}

namespace {

/// What the residual left works over the step, and how far it leaves the rows open.
void tell_what_is_left(const System& s, const Residual& r, const Unknown& u, NewtonReport& report) {
  report.left = work_of(s, r, u.increments(s));
  report.gaps.assign(r.r.begin() + 3 * static_cast<std::ptrdiff_t>(s.first_joint_block()), r.r.end());
  for (double& g : report.gaps) g /= r.sigma;
}

/// One solution on its way.
class Newton {
 public:
  Newton(const System& system, KktSolver& solver, const std::function<Stage(const Unknown&)>& stage, Unknown& u,
         std::vector<double>& lambda, const NewtonOptions& options, std::optional<Correction> guess)
      : system_(system),
        solver_(solver),
        stage_(stage),
        u_(u),
        lambda_(lambda),
        options_(options),
        guessed_(guess ? system.largest_difference(u.q, guess->before) / system.length : 0),
        foresees_(system.traits().deforms && options.foresees && !options.searches),
        last_(std::move(guess)) {
    if (!foresees_) last_.reset();
    if (foresees_ && system.traits().is_thin) growth_ = 10;  // thin parts settle with their stress foreseen, and damped they creep
  }
  NewtonReport take();

 private:
  void evaluate(bool tangent);
  SolveReport solve(bool old_factors);
  double forcing(bool old_factors) const;
  double correction() const { return system_.comm->max(relative_correction(system_, z_)); }
  void move();
  void move_along(double share);
  void go_as_far_as_allowed();
  bool go_damped();
  bool search_along();
  void repeat_with_old_factors();
  void polish();
  void accept();
  NewtonReport fail(const std::string& reason) { return report_.reason = reason, report_; }
  bool is_sound() const { return report_.least_det.det > 0 && std::isfinite(report_.residual); }
  bool is_time_to_choose() const;
  bool is_revised();
  bool is_small_enough() const { return report_.residual <= options_.tolerance; }
  bool is_rounding() const;

  const System& system_;
  KktSolver& solver_;
  const std::function<Stage(const Unknown&)>& stage_;
  Unknown& u_;
  std::vector<double>& lambda_;
  const NewtonOptions& options_;
  NewtonReport report_;
  Residual r_;
  std::vector<double> z_, direction_;  // correction; the whole of one of which shares are taken
  Config before_;                      // where that one began
  double share_ = 1;
  bool damped_ = false;
  int revisions_ = 0;
  double last_residual_ = 0;
  double guessed_;                  // way of the first guess over the scene's length, where it is a linear answer; 0: none
  double growth_ = 0.5;             // from one correction to the next, with the stress foreseen
  bool foresees_;                   // a tangent takes the stresses of cells from the last correction (physics/solid, `foresee`)
  bool foreseen_ = false;           // in the last tangent
  std::optional<Correction> last_;  // to first order
  std::vector<double> by_;          // it, where `last_->along` is not known yet
};

void Newton::evaluate(bool tangent) {
  Stage s = stage_(u_);
  if (tangent) foreseen_ = last_ && s.e1 == s.end && s.chain == 1;
  if (tangent && foreseen_) {
    if (!by_.empty()) {
      combine(last_->along, {{0, &last_->before}});
      system_.add_rates(last_->along, last_->before, by_);
    }
    s.last = &*last_;
  }
  assemble(system_, solver_, s, lambda_, r_, tangent);
  report_.least_det = r_.least_det;
  report_.residual = system_.comm->max(relative_residual(system_, r_));
}

/// What a solve may leave of the residual: a tenth of what is left to the tolerance, and no less than Newton's own error, about the square
/// of how far the last iteration came [eisenstat-walker-1996], or that of an iteration with old factors, which comes as far as the last
/// one.
double Newton::forcing(bool old_factors) const {
  const double enough = 0.1 * options_.tolerance / std::max(report_.residual, 1e-300);
  const double contraction = last_residual_ > 0 ? report_.residual / last_residual_ : 1e-2;
  return std::clamp(std::max(std::min(enough, 0.1), std::min(0.1 * contraction * (old_factors ? 1 : contraction), 1e-3)), 1e-10, 0.1);
}

SolveReport Newton::solve(bool old_factors) {
  SolveReport solved = correct(solver_, r_.r, z_, forcing(old_factors));
  report_.linear_iterations += solved.iterations;
  return solved;
}

void Newton::move() {
  if (foresees_) {
    if (!last_) last_.emplace();
    last_->before = u_.q, by_ = z_;
  }
  u_.move(system_, z_);
  add_multipliers(system_, r_.sigma, z_, lambda_);
}

void Newton::move_along(double share) {
  z_.resize(direction_.size());
  for (size_t i = 0; i < z_.size(); ++i) z_[i] = share * direction_[i];
  move();
}

/// The correction, or the share of it that cells and gaps allow.
void Newton::go_as_far_as_allowed() {
  before_ = u_.q, direction_ = z_;
  move();
  share_ = system_.longest_share(before_, u_.q);
  if (share_ == 1) return;
  damped_ = true;
  move_along(share_ - 1);
  if (!foresees_) return;
  last_->before = before_;
  for (size_t i = 0; i < by_.size(); ++i) by_[i] = share_ * direction_[i];
}

/// Damped Newton: a share s of the correction z = -K^-1 r, such that the next one by the same matrix, -K^-1 r(u + s z), is smaller by at
/// least s/4 [deuflhard-2004, the natural monotonicity test].  K weighs forces, moments and constraints against each other.
bool Newton::go_damped() {
  direction_ = z_, before_ = u_.q;
  const double size = size_of(system_, direction_);
  for (share_ = std::min(1.0, 4 * share_); share_ > options_.least_share; share_ /= 2) {
    move_along(share_);
    if (system_.longest_share(before_, u_.q) == 1) {
      evaluate(false);
      if (is_sound() && solve(true).ok) {
        const double ratio = size_of(system_, z_) / size;
        if (ratio <= 1 - share_ / 4) {
          damped_ = share_ < 1 || ratio > 0.1;
          return true;
        }
      }
    }
    move_along(-share_);
  }
  return false;
}

/// The share of a correction after which the residual does no more work along it, to a tenth.  A correction slides what sticks farther
/// than needed, as what slides has no stiffness; at given pressures friction has a convex potential, which is least there.
bool Newton::search_along() {
  constexpr int most = 10;
  constexpr double least = 1e-3;  // a correction that soon meets what resists it creeps
  direction_ = z_, before_ = u_.q;
  const std::span<const double> way(direction_.data(), 3 * static_cast<size_t>(system_.first_joint_block()));
  const double whole = std::abs(work_of(system_, r_, way));
  double low = 0, below = -whole, high = 0, above = 0, gone = 1;
  move_along(1);
  share_ = system_.longest_share(before_, u_.q);
  for (int k = 0; k < most; ++k) {
    if (share_ != gone) move_along(share_ - gone);
    gone = share_;
    evaluate(false);
    const double work = is_sound() ? work_of(system_, r_, way) : 1e3 * whole;
    if (is_sound() && (std::abs(work) <= 0.1 * whole || (work < 0 && high == 0))) return share_ > least;
    (work > 0 ? high : low) = share_, (work > 0 ? above : below) = work;
    share_ = low + (high - low) * std::clamp(below / (below - above), 0.1, 0.9);
  }
  return is_sound() && share_ > least;
}

void Newton::accept() {  // the unknown evaluated last
  tell_what_is_left(system_, r_, u_, report_);
  report_.converged = true;
}

/// Modified Newton: iterations with the factors of the last tangent.  They pay where solves are cheap, where the residual is within 1000 of
/// the tolerance, or where an iteration that gains as much as the last one ends within 10 of it.
void Newton::repeat_with_old_factors() {
  const double enough = options_.tolerance;
  const auto pays = [&] {
    return solver_.repeats_cheaply()
               ? report_.residual > 1e-2 * enough
               : !is_small_enough() && !is_rounding() && report_.residual < std::max(1e3 * enough, std::sqrt(10 * enough * last_residual_));
  };
  for (int reuse = 0; reuse < 4 && pays(); ++reuse) {
    const double residual = report_.residual;
    if (!solve(true).ok) return;
    const double by = correction();
    if (!(by < 0.1 * report_.correction)) return;
    report_.correction = by;
    move();
    evaluate(false);
    last_residual_ = residual;
    if (!(report_.residual < 0.1 * residual)) return;
  }
}

/// Where the last factors serve once more for little, one more correction takes constraints and forces to round-off (or, where the
/// tolerance asked for is a loose one, to five digits beyond).
void Newton::polish() {
  for (int k = 0; k < 4 && report_.residual > 1e-5 * options_.tolerance && solver_.repeats_cheaply() && solve(true).ok; ++k) {
    const double by = correction();
    if (!(by < 1e-6)) break;
    move();
    if (by < 1e-12) {  // what the old factors leave of it is round-off
      report_.converged = true;
      return;
    }
    evaluate(false);
  }
  accept();
}

/// A correction far below the tolerance, one to come that is nothing to the scene, and a residual within ten of the tolerance: what is left
/// is the round-off of positions amplified by stiffness; another solve would only draw other digits of it.
bool Newton::is_rounding() const {
  return report_.correction <= 1e-2 * options_.tolerance && report_.correction * report_.residual <= 1e-13 * last_residual_ &&
         report_.residual <= 10 * options_.tolerance;
}

/// Corrections by the factors of the choice before count where they are smaller than a tenth of this.
constexpr double first_after_revision = 1e-3;

/// Where the correction to come is next to nothing, what is chosen is what the answer itself would choose: chosen there, it costs no
/// iterations of its own.  Where old factors end soon, the end is soon enough.
bool Newton::is_time_to_choose() const {
  return revisions_ == 0 && report_.correction * report_.residual < 1e-9 * last_residual_ && report_.residual > 1e3 * options_.tolerance &&
         revises(system_);
}

/// Whether the answer makes other equations: what a point meets.  After six times they stay as they are; any choice keeps energy and
/// momenta.
bool Newton::is_revised() {
  constexpr int most = 6;
  if (revisions_ == most || !revise(system_, stage_(u_))) return false;
  ++revisions_, damped_ = false, last_.reset();
  report_.correction = first_after_revision, last_residual_ = 0;
  return true;
}

NewtonReport Newton::take() {
  double previous = guessed_ > 0 ? report_.correction = guessed_ : 1e300;
  bool near = previous < 1e-3;  // the next residual is likely to be small enough: look at it before building a tangent
  bool moved = false;           // by the last iteration
  for (int it = 0;; ++it) {
    if (near) {
      evaluate(false);
      if (is_time_to_choose() && is_revised()) {
        moved = false, previous = 1e300;
      } else {
        repeat_with_old_factors();
        if (is_small_enough() || is_rounding()) {
          if (!is_revised()) return polish(), report_;
          moved = false, previous = 1e300;
          continue;
        }
      }
    }
    if (it == options_.max_iterations * (1 + revisions_)) {
      report_.is_round_off = report_.correction < 1e-8 && report_.residual < 1e-6;
      return fail(report_.is_round_off
                      ? fmt::format("round-off of positions leaves a residual of {:.1e} of the forces, more than the tolerance of {:.0e}; "
                                    "loosen solver.tolerance, or move the scene nearer to the origin",
                                    report_.residual, options_.tolerance)
                      : "no convergence within the iterations allowed");
    }
    evaluate(true);
    if (moved && !damped_ && !is_sound()) {  // the last correction went farther than anyone foresaw: back, and damped from there
      move_along(-1);
      damped_ = true, near = moved = false, last_.reset();
      continue;
    }
    if (!std::isfinite(report_.residual)) return fail("the residual is not finite");
    if (is_small_enough() && it > 0) {
      if (!is_revised()) return accept(), report_;
      near = true, moved = false, previous = 1e300;
      continue;
    }
    const SolveReport solved = solve(false);
    last_residual_ = report_.residual;
    ++report_.iterations;
    report_.correction = solved.ok ? correction() : 1e300;
    if (foreseen_ && !(report_.correction <= std::max(growth_ * previous, 1e-6))) {  // the stresses foreseen are too large: without them
      foresees_ = near = false, last_.reset();
      if (!moved && it > 0) previous = 1e300;
      moved = false;
      continue;
    }
    if (!solved.ok) return fail(solver_.name() + ": " + solved.message + (solved.is_singular ? free_part(system_, solver_, r_.sigma) : ""));
    if (!(report_.correction <= options_.reach)) return fail("the correction is not finite or leaves the scene");
    if (!options_.patient && report_.correction > (foreseen_ ? growth_ : 0.5) * previous && report_.correction > 1e-6) damped_ = true;
    if (!damped_ && !options_.searches)
      go_as_far_as_allowed();
    else if (!(options_.searches ? search_along() : go_damped()))
      return fail("Newton does not converge, nor with damped corrections");
    if (!damped_ && report_.correction <= options_.tolerance * 1e-2) {  // far below what the next one could change
      evaluate(false);
      if (report_.correction == 0 && report_.residual > std::max(options_.tolerance, 0.5 * last_residual_))
        return fail(solver_.name() + ": forces are open, and the solve moves nothing");
      if (!is_revised()) return accept(), report_;
      near = true, moved = false, previous = 1e300;
      continue;
    }
    near = report_.correction < 1e-3, moved = true;
    previous = report_.correction;
  }
}

}  // namespace

NewtonReport newton(const System& system, KktSolver& solver, const std::function<Stage(const Unknown&)>& stage, Unknown& u,
                    std::vector<double>& lambda, const NewtonOptions& options, std::optional<Correction> guess) {
  return Newton(system, solver, stage, u, lambda, options, std::move(guess)).take();
}

}  // namespace hilo
