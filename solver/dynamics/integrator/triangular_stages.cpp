// SPDX-License-Identifier: GPL-3.0-or-later
// Newton for coupled stages with one matrix of the size of a stage.
//
// With matrices K of positions, C of velocities and M of accelerations that are those of one configuration for all stages, an iteration is
//   M W^2 z/h^2 + C W z/h + K z + G^T l = -f,   G W z = -g      (z, l, f, g of all stages; W = A^-1)
//   M z/h^2 + C A z/h + K A^2 z + G^T A^2 l = -A^2 f,   G z = -A g
// in which a lower triangular T, of which all stages have the same diagonal d, takes the place of A: the stages follow one another with the
// one matrix M/(d h)^2 + C/(d h) + K, and K z_j of those before goes to the right-hand side [van-der-houwen-de-swart-1997].  C z_j does
// not: where it counts, what is left of the corrections falls more slowly.
#include <algorithm>
#include <cmath>

#include "dynamics/integrator/coupled_stages.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/profile.hpp"

namespace hilo {

/// The matrix of the middle stage.
void CoupledStages::build_triangular(const System& system, KktSolver& solver) {
  OneMatrix& o = one_;
  o.q = *stages_[1].left, o.a = *stages_[1].a, o.v = *stages_[1].v;
  combine(o.before, {{1, &o.q}, {-h_ / 2, &o.v}}), combine(o.after, {{1, &o.q}, {h_ / 2, &o.v}});
  o.stage = stage_at(o.q, stages_[1].t1);
  o.stage.a = &o.a, o.stage.v = &o.v, o.stage.w0 = &o.before, o.stage.w1 = &o.after, o.stage.h = h_;
  const double f = 1 / (o.d * h_);
  o.stage.mass_slope = f * f, o.stage.alpha_slope = f;
  system.evaluate(o.stage, lambda_[1], o.r, &solver);
  combine(o.zero, {{0, &o.a}});
  o.none.assign(lambda_[1].size(), 0.0);
  Stage still = o.stage;
  still.a = &o.zero;
  system.evaluate(still, o.none, o.still, nullptr);
  complete(system, solver, o.still.r);
  phases().evaluations += 2, ++phases().tangents;
  o.kept = o.pulls = true, o.weighed = false, o.h = h_;
}

/// One iteration: increments z_ of all stages, with those of their multipliers, from the residuals r_.
SolveReport CoupledStages::solve_triangular(const System& system, KktSolver& solver, const Eigen::Matrix3d& T) {
  OneMatrix& o = one_;
  const Eigen::Matrix3d A2 = A_ * A_ / (o.d * o.d), T2 = T * T / (o.d * o.d), W2 = W_ * W_ * (o.d * o.d);
  const int n = 3 * system.n_blocks(), first = 3 * system.first_joint_block();
  const double sigma = o.r.sigma;
  SolveReport solved;
  for (int i = 0; i < n_stages; ++i) {
    o.b.assign(n, 0.0);
    for (int j = 0; j < n_stages; ++j) {
      const double g = A_(i, j) * sigma / r_[j].sigma;
      for (int k = 0; k < first; ++k) o.b[k] -= A2(i, j) * r_[j].r[k];
      for (int k = first; k < n; ++k) o.b[k] -= g * r_[j].r[k];
    }
    for (int j = 0; j < i && o.pulls; ++j)
      for (int k = 0; k < first; ++k) o.b[k] -= T2(i, j) * o.pull[j][k];
    const std::span<double> z(z_.data() + static_cast<size_t>(i) * n, n);
    std::fill(z.begin(), z.end(), 0.0);
    ++phases().solves;
    if (!(solved = solver.solve(o.b, z)).ok) return solved;
    if (i + 1 == n_stages || !o.pulls) continue;
    // K z = b - G^T l - M z/(d h)^2
    combine(o.trial_a, {{0, &o.a}});
    system.add_rates(o.trial_a, o.q, z);
    combine(o.trial_a, {{o.stage.mass_slope, &o.trial_a}});
    o.trial.resize(o.none.size());
    for (size_t k = 0; k < o.trial.size(); ++k) o.trial[k] = sigma * z[first + k];
    Stage trial = o.stage;
    trial.a = &o.trial_a;
    system.evaluate(trial, o.trial, o.by_trial, nullptr);
    complete(system, solver, o.by_trial.r);
    ++phases().evaluations;
    o.pull[i].resize(first);
    for (int k = 0; k < first; ++k) o.pull[i][k] = o.b[k] - (o.by_trial.r[k] - o.still.r[k]);
    system.mask_fixed(o.pull[i]);
    if (o.weighed) continue;
    // where K z is nothing beside the inertia of z, as where bodies alone resolve their motion, it costs more than it gains
    system.evaluate(trial, o.none, o.by_trial, nullptr);
    complete(system, solver, o.by_trial.r);
    ++phases().evaluations;
    double pull = 0, inertia = 0;
    for (int k = 0; k < first; ++k)
      pull = std::max(pull, std::abs(o.pull[i][k])), inertia = std::max(inertia, std::abs(o.by_trial.r[k] - o.still.r[k]));
    o.pulls = !(system.comm->max(pull) < 2e-3 * system.comm->max(inertia)), o.weighed = true;
  }
  for (int k = first; k < n; ++k) {  // A^2 l/d^2 was found
    const double y[3] = {z_[k], z_[n + k], z_[2 * n + k]};
    for (int i = 0; i < n_stages; ++i) z_[i * n + k] = sigma * (W2(i, 0) * y[0] + W2(i, 1) * y[1] + W2(i, 2) * y[2]);
  }
  return solved;
}

NewtonReport CoupledStages::iterate_triangular(const System& system, KktSolver& solver, const Eigen::Matrix3d& T,
                                               const NewtonOptions& options) {
  NewtonReport report;
  const int n = 3 * system.n_blocks(), first = 3 * system.first_joint_block();
  z_.resize(n_stages * static_cast<size_t>(n));
  one_.d = T(0, 0);
  if (h_ > 1.5 * one_.h || one_.h > 1.5 * h_) one_.kept = false;
  bool built = false;
  int with_it = 0;                     // iterations with the matrix at hand
  double last = 0, last_residual = 0;  // of the iteration before with it: correction, residual
  for (int it = 0; it < options.max_iterations; ++it) {
    {
      const Timed timed(phases().assembly);
      place(system);
      evaluate(system, nullptr);
      judge(system, solver, report);
      if (!std::isfinite(report.residual)) return report.reason = "the residual is not finite", report;
      if (!one_.kept) build_triangular(system, solver), built = true, with_it = 0, last = 0;
    }
    const Timed timed(phases().solve);
    const SolveReport solved = solve_triangular(system, solver, T);
    ++report.iterations, ++with_it;
    const double correction = solved.ok ? largest_correction(system) : 1e300;
    const double rate = last > 0 ? correction / last : 0.25;
    // it leads astray; a first correction of multipliers alone moves positions by what an old matrix has of other rows, and the next one
    // moves them back
    if (!(correction < 0.3) || (correction > 1e-14 && rate > 0.7 && !(report.residual < 0.3 * last_residual))) {
      if (built) return report.reason = "the stages do not follow one another", report;
      one_.kept = false;
      continue;
    }
    move(system, z_);
    for (int i = 0; i < n_stages; ++i)
      for (size_t k = 0; k < lambda_[i].size(); ++k) lambda_[i][k] += z_[i * n + first + k];
    report.correction = correction;
    const double left = rate < 1 ? rate / (1 - rate) : 1e300, enough = sufficient(system, options.tolerance);
    const bool falls = last > 0 && left * correction <= enough, rounds = correction < 1e-14 && rate > 0.3;
    if ((falls && left * report.residual <= 1e-2 * options.tolerance) ||
        (rounds && report.residual <= 1e-2 * options.tolerance + rounding(system))) {
      // a new matrix costs about one iteration
      if (built) one_.iterations = with_it;
      if (with_it > one_.iterations) one_.kept = false;
      report.converged = true;
      return report;
    }
    if (!built && last > 0 && std::log(left * correction / enough) > -5 * std::log(rate)) one_.kept = false;
    last = one_.kept ? correction : 0, last_residual = report.residual;
  }
  return report.reason = "no convergence within the iterations allowed", report;
}

}  // namespace hilo
