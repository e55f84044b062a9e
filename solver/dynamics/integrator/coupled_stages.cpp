// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator/coupled_stages.hpp"

#include <Eigen/LU>
#include <cmath>

#include "base/error.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/profile.hpp"

namespace hilo {

CoupledStages::CoupledStages(std::unique_ptr<SerialKktSolver> solver, Eigen::Matrix3d A)
    : A_(std::move(A)), W_(A_.inverse()), whole_(std::move(solver)) {
  for (int i = 0; i < n_stages; ++i) c_[i] = A_.row(i).sum();
}

void CoupledStages::begin(const System& system, double t, double h) {
  if (system.traits().lumps_masses) throw Error("", name() + " has no point masses on flexible parts", "use [[body]] entries");
  check(system);
  if (tried_) drop_matrix();  // the step before was refused: joint rows may have been chosen anew
  tried_ = true, t_ = t, h_ = h;
}

/// One system of three times the unknowns, each clique covering its blocks of all stages.
void CoupledStages::couple(const System& system) {
  const int n = system.n_blocks();
  std::vector<int> list;
  for (int e = 0; e < system.layout.cliques.size(); ++e) {
    list.clear();
    for (int i = 0; i < n_stages; ++i)
      for (int block : system.layout.cliques[e]) list.push_back(block < 0 ? -1 : block + i * n);
    cliques_.add(list);
  }
  for (int i = 0; i < n_stages * n; ++i) map_.global.push_back(i);
  map_.n_owned = map_.n_global = n_stages * n;
  whole_->structure(cliques_, map_);
  b_.resize(9 * static_cast<size_t>(n)), z_.assign(b_.size(), 0.0);
}

NewtonReport CoupledStages::iterate(const System& system, const NewtonOptions& options) {
  NewtonReport report;
  if (map_.global.empty()) couple(system);
  const int n = 3 * system.n_blocks();
  if (h_ > 2 * kept_h_ || kept_h_ > 2 * h_) kept_ = false;
  const bool lagged = kept_;
  int built = 0;                                           // matrices in this step, iterations of Newton; those between are modified Newton
  bool full = false;                                       // Newton alone: the step is too far from linear for less
  double last = 0, last_residual = 0, now = wall_clock();  // of the iteration before with the same matrix
  const auto lap = [&](Phase& phase) {
    const double then = now;
    phase.seconds += (now = wall_clock()) - then;
  };
  for (;;) {
    const bool fresh = !kept_;
    place(system);
    if (!kept_) whole_->zero();
    evaluate(system, kept_ ? nullptr : whole_.get());
    judge(system, *whole_, report);
    if (!kept_)
      for (int i = 0; i < n_stages; ++i) kept_sigma_[i] = r_[i].sigma;
    if (!std::isfinite(report.residual)) return report.reason = "the residual is not finite", report;
    if (fresh && ++built > options.max_iterations) {
      if (report.residual <= options.tolerance) break;
      return report.reason = "no convergence within the iterations allowed", report;
    }
    if (fresh) kept_ = true, kept_h_ = h_, rate_ = 1, excess_ = 0;
    // inertia and constraint rows are to the scale sigma, so that the matrix of another step length serves
    for (int i = 0; i < n_stages; ++i)
      for (int k = 0; k < n; ++k) b_[i * n + k] = -r_[i].r[k] * (kept_sigma_[i] / r_[i].sigma);
    lap(phases().assembly);
    const SolveReport solved = whole_->solve(b_, z_);
    lap(phases().solve), ++phases().solves;
    ++report.iterations;
    if (!solved.ok && fresh) return report.reason = whole_->name() + ": " + solved.message, report;
    const double correction = solved.ok ? largest_correction(system) : 1e300;
    // contraction: seen from the second iteration on, in residuals where corrections are at round-off
    double rate = fresh ? 1e-3 : std::clamp(2 * rate_, 0.1, 1.0);
    if (last > 0) rate = correction > 2e-15 ? correction / last : report.residual / last_residual;
    const bool settled = correction <= 1e-2 * options.tolerance;
    if (!fresh && !settled && !(correction < 1e-3 && (last == 0 || rate < 1))) {
      kept_ = false, full = built > 0, last = 0;  // it leads astray
      continue;
    }
    report.correction = correction;
    if (!(correction <= options.reach)) return report.reason = "the correction is not finite or leaves the scene", report;
    move(system, z_);
    for (int i = 0; i < n_stages; ++i)
      add_multipliers(system, r_[i].sigma, std::span(z_).subspan(static_cast<size_t>(i) * n, n), lambda_[i]);
    if (!fresh && last > 0) rate_ = rate;
    const double left = rate < 1 ? rate / (1 - rate) : 1e300, enough = sufficient(system, options.tolerance);
    if (left * correction <= enough && left * report.residual <= 1e-2 * options.tolerance) break;
    if (full ? settled : built && rate > 0.3 && (settled || report.residual <= options.tolerance)) {  // round-off
      if (!(report.residual <= 1e7 * options.tolerance + rounding(system)))
        return report.reason = "the residual does not fall with the corrections", report;
      break;
    }
    // a new matrix costs about five iterations
    if (last > 0 && (rate > 0.3 || std::log(left * correction / enough) > -5 * std::log(rate))) kept_ = false;
    if (built && last > 0 && rate > 0.3) full = true;
    if (full || correction > 1e-3) kept_ = false;
    last = kept_ ? correction : 0, last_residual = report.residual;
  }
  if (lagged && kept_ && (excess_ += std::max(0, report.iterations - 2)) >= 2) kept_ = false;
  report.converged = true;
  return report;
}

/// The largest residual, over the largest force of all stages: in one of them alone nothing may press.
void CoupledStages::judge(const System& system, KktSolver& solver, NewtonReport& report) {
  report.residual = 0;
  for (Residual& r : r_) complete(system, solver, r);
  const double force = scales(system).first;
  for (Residual& r : r_) {
    r.force_scale = force;
    const double x = relative_residual(system, r);
    if (!(x <= report.residual)) report.residual = x;  // keeps a NaN
    report.least_det.take(r.least_det);
  }
  report.residual = system.comm->max(report.residual);
}

double CoupledStages::largest_correction(const System& system) const {
  const size_t n = z_.size() / 3;
  double worst = 0;
  for (int i = 0; i < n_stages; ++i)
    if (const double x = relative_correction(system, {z_.data() + i * n, n}); !(x <= worst)) worst = x;
  return system.comm->max(worst);
}

/// Largest force, and inertia over the square of time [N/m].
std::pair<double, double> CoupledStages::scales(const System& system) const {
  double force = 0, inertia = 0;
  for (const Residual& r : r_)
    force = std::max(force, r.force_scale), inertia = std::max(inertia, r.sigma * static_cast<double>(system.layout.map.n_global));
  return {force, inertia};
}

/// What may be left of positions, over the scene's length: round-off, unless the tolerance is loose; less where it would be seen in the
/// accelerations, (W^2)_ii/h^2 times as large.
double CoupledStages::sufficient(const System& system, double tolerance) const {
  const auto [force, inertia] = scales(system);
  return std::max(2e-16, tolerance * std::min(1e-5, 10 * force / (inertia * system.length)));
}

/// The residual that round-off of positions makes.
double CoupledStages::rounding(const System& system) const {
  const auto [force, inertia] = scales(system);
  return 1e-12 * (inertia + system.stiffness) * system.length / std::max(force, 1e-300);
}

}  // namespace hilo
