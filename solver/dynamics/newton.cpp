// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/newton.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/free_part.hpp"
#include "dynamics/profile.hpp"

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

namespace {

/// What the residual left works over the step, and how far it leaves the rows open.
void tell_what_is_left(const System& s, const Residual& r, const Unknown& u, NewtonReport& report) {
  const std::vector<double> step = u.increments(s);
  double work = 0;
  for (size_t k = 0; k < step.size() / 3; ++k) {
    const std::int64_t owned = s.layout.map.global[k] - s.layout.map.first;  // of the ranks that hold the block one counts it
    if (owned < 0 || owned >= s.layout.map.n_owned) continue;
    for (size_t i = 3 * k; i < 3 * k + 3; ++i) work += r.r[i] * step[i];
  }
  report.left = s.comm->sum(work);
  report.gaps.assign(r.r.begin() + 3 * static_cast<std::ptrdiff_t>(s.first_joint_block()), r.r.end());
  for (double& g : report.gaps) g /= r.sigma;
}

}  // namespace

NewtonReport newton(const System& system, KktSolver& solver, const std::function<Stage(const Unknown&)>& stage, Unknown& u,
                    std::vector<double>& lambda, const NewtonOptions& options, std::optional<Correction> last) {
  NewtonReport report;
  Residual r;
  std::vector<double> b, z;
  // The last correction, to first order: a tangent takes the stresses of cells from it (physics/solid, `foresee`).
  bool foresees = system.traits().deforms && options.foresees;
  if (!foresees) last.reset();
  bool foreseen = false;   // in the last tangent
  std::vector<double> by;  // the last correction, where `last->along` is not known yet
  const auto evaluate = [&](bool tangent) {
    const Timed timed(phases().assembly);
    Stage s = stage(u);
    if (tangent) foreseen = last && s.e1 == s.end && s.chain == 1;
    if (tangent && foreseen) {
      if (!by.empty()) {
        combine(last->along, {{0, &last->before}});
        system.add_rates(last->along, last->before, by);
      }
      s.before = &last->before, s.along = &last->along;
    }
    system.evaluate(s, lambda, r, tangent ? &solver : nullptr);
    solver.sum_shared(r.r);
    system.mask_fixed(r.r);
    r.force_scale = report.force = system.comm->max(r.force_scale);
    report.least_det = r.least_det;
    if (system.comm->size > 1) {
      report.least_det.det = -system.comm->max(-r.least_det.det);
      report.least_det.region = static_cast<int>(system.comm->max(r.least_det.det == report.least_det.det ? r.least_det.region : -1));
    }
    report.residual = system.comm->max(relative_residual(system, r));
    ++phases().evaluations, phases().tangents += tangent;
  };
  // What a solve may leave of the residual: a tenth of what is left to the tolerance, and no less than Newton's own error, about the square
  // of how far the last iteration came [eisenstat-walker-1996], or that of an iteration with old factors, which comes as far as the last
  // one.
  double last_residual = 0;
  const auto forcing = [&](bool old_factors) {
    const double enough = 0.1 * options.tolerance / std::max(report.residual, 1e-300);
    const double contraction = last_residual > 0 ? report.residual / last_residual : 1e-2;
    return std::clamp(std::max(std::min(enough, 0.1), std::min(0.1 * contraction * (old_factors ? 1 : contraction), 1e-3)), 1e-10, 0.1);
  };
  const auto solve = [&](bool old_factors) {
    b.resize(r.r.size()), z.assign(r.r.size(), 0.0);
    for (size_t i = 0; i < b.size(); ++i) b[i] = -r.r[i];
    const Timed timed(phases().solve);
    const SolveReport solved = solver.solve(b, z, forcing(old_factors));
    ++phases().solves, phases().linear_iterations += solved.iterations;
    report.linear_iterations += solved.iterations;
    return solved;
  };
  const auto move = [&] {
    if (foresees) {
      if (!last) last.emplace();
      last->before = u.q, by = z;
    }
    u.move(system, z);
    const int first = 3 * system.first_joint_block();
    for (size_t i = 0; i < lambda.size(); ++i) lambda[i] += r.sigma * z[first + i];
  };
  std::vector<double> direction;
  const auto move_along = [&](double share) {
    z.resize(direction.size());
    for (size_t i = 0; i < z.size(); ++i) z[i] = share * direction[i];
    move();
  };
  /// Back along the direction, of which `left` remains.
  const auto move_back = [&](double share, double left) {
    const std::optional<Correction> from = last;
    move_along(-share);
    last = from;
    for (size_t i = 0; i < by.size(); ++i) by[i] = left * direction[i];
  };
  const auto is_sound = [&] { return report.least_det.det > 0 && std::isfinite(report.residual); };
  // Damped Newton: a share s of the correction z = -K^-1 r, such that the next one by the same matrix, -K^-1 r(u + s z), is smaller by at
  // least s/4 [deuflhard-2004, the natural monotonicity test].  K weighs forces, moments and constraints against each other.
  double share = 1;
  bool damped = false;
  const auto damped_move = [&] {
    direction = z;
    const double size = size_of(system, direction);
    for (share = std::min(1.0, 4 * share); share > options.least_share; share /= 2) {
      move_along(share);
      evaluate(false);
      if (is_sound() && solve(true).ok) {
        const double ratio = size_of(system, z) / size;
        if (ratio <= 1 - share / 4) {
          damped = share < 1 || ratio > 0.1;
          return true;
        }
      }
      move_along(-share);
    }
    return false;
  };
  const auto accept = [&] {  // the unknown evaluated last
    tell_what_is_left(system, r, u, report);
    report.converged = true;
  };
  // where the last factors serve once more for little, one more correction takes constraints and forces to round-off (or, where the
  // tolerance asked for is a loose one, to five digits beyond)
  const auto polish = [&] {
    for (int k = 0; k < 4 && report.residual > 1e-5 * options.tolerance && solver.repeats_cheaply() && solve(true).ok; ++k) {
      const double correction = system.comm->max(relative_correction(system, z));
      if (!(correction < 1e-6)) break;
      move();
      if (correction < 1e-12) {  // what the old factors leave of it is round-off
        report.converged = true;
        return;
      }
      evaluate(false);
    }
    accept();
  };
  // A correction far below the tolerance, one to come that is nothing to the scene, and a residual within ten of the tolerance: what is
  // left is the round-off of positions amplified by stiffness; another solve would only draw other digits of it.
  const auto is_rounding = [&] {
    return report.correction <= 1e-2 * options.tolerance && report.correction * report.residual <= 1e-13 * last_residual &&
           report.residual <= 10 * options.tolerance;
  };
  double previous = last ? system.largest_difference(u.q, last->before) / system.length : 1e300;
  bool near = false;   // the next residual is likely to be small enough: look at it before building a tangent
  bool moved = false;  // by the last iteration
  for (int it = 0;; ++it) {
    if (near) {
      evaluate(false);
      // modified Newton: iterations with the factors of the last tangent.  They pay where solves are cheap, where the residual is within
      // 1000 of the tolerance, or where an iteration that gains as much as the last one ends within 10 of it
      const auto worth = [&] {
        return solver.repeats_cheaply()
                   ? report.residual > 1e-2 * options.tolerance
                   : report.residual > options.tolerance && !is_rounding() &&
                         report.residual < std::max(1e3 * options.tolerance, std::sqrt(10 * options.tolerance * last_residual));
      };
      for (int reuse = 0; reuse < 4 && worth(); ++reuse) {
        const double residual = report.residual;
        if (!solve(true).ok) break;
        const double correction = system.comm->max(relative_correction(system, z));
        if (!(correction < 0.1 * report.correction)) break;
        report.correction = correction;
        move();
        evaluate(false);
        last_residual = residual;
        if (!(report.residual < 0.1 * residual)) break;
      }
      if (report.residual <= options.tolerance || is_rounding()) {
        polish();
        return report;
      }
    }
    if (it == options.max_iterations) {
      report.reason = "no convergence within the iterations allowed";
      return report;
    }
    evaluate(true);
    if (moved && !damped && !is_sound()) {  // the last correction went too far: back along it to where cells are whole
      direction = z, damped = true;
      for (share = 1; !is_sound() && share > options.least_share;) share /= 2, move_back(share, share), evaluate(false);
      evaluate(true);
    }
    if (!std::isfinite(report.residual)) {
      report.reason = "the residual is not finite";
      return report;
    }
    if (report.residual <= options.tolerance && it > 0) {
      accept();
      return report;
    }
    const SolveReport solved = solve(false);
    last_residual = report.residual;
    ++report.iterations;
    report.correction = solved.ok ? system.comm->max(relative_correction(system, z)) : 1e300;
    if (foreseen && !(report.correction <= std::max(0.5 * previous, 1e-6))) {  // the stresses foreseen are too large: without them
      foresees = near = false, last.reset();
      if (!moved) previous = 1e300;
      moved = false;
      continue;
    }
    if (!solved.ok) {
      report.reason = solver.name() + ": " + solved.message;
      if (solved.message.find("singular") != std::string::npos) report.reason += free_part(system, solver, r.sigma);
      return report;
    }
    if (!(report.correction <= options.reach)) {
      report.reason = "the correction is not finite or leaves the scene";
      return report;
    }
    if (!options.patient && it > 0 && report.correction > 0.5 * previous && report.correction > 1e-6) damped = true;
    if (!damped) {
      move();
    } else if (!damped_move()) {
      report.reason = "no share of a correction makes the next one smaller";
      return report;
    }
    if (!damped && report.correction <= options.tolerance * 1e-2) {  // far below what the next one could change
      evaluate(false);
      accept();
      return report;
    }
    near = report.correction < 1e-3, moved = true;
    previous = report.correction;
  }
}

}  // namespace hilo
