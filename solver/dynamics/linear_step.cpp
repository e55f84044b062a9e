// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/linear_step.hpp"

#include "dynamics/profile.hpp"

namespace hilo {

void complete(const System& system, KktSolver& solver, std::vector<double>& r) {
  solver.sum_shared(r);
  system.mask_fixed(r);
}

void complete(const System& system, KktSolver& solver, Residual& r) {
  complete(system, solver, r.r);
  r.force_scale = system.comm->max(r.force_scale);
  if (system.comm->size > 1) {
    const double own = r.least_det.det;
    r.least_det.det = -system.comm->max(-own);
    r.least_det.region = static_cast<int>(system.comm->max(own == r.least_det.det ? r.least_det.region : -1));
  }
}

void assemble(const System& system, KktSolver& solver, const Stage& stage, std::span<const double> lambda, Residual& r, bool tangent) {
  const Timed timed(phases().assembly);
  system.evaluate(stage, lambda, r, tangent ? &solver : nullptr);
  complete(system, solver, r);
  ++phases().evaluations, phases().tangents += tangent;
}

SolveReport correct(KktSolver& solver, const std::vector<double>& r, std::vector<double>& z, double tolerance) {
  std::vector<double> b(r.size());
  for (size_t i = 0; i < b.size(); ++i) b[i] = -r[i];
  z.assign(r.size(), 0.0);
  const Timed timed(phases().solve);
  SolveReport solved = solver.solve(b, z, tolerance);
  ++phases().solves, phases().linear_iterations += solved.iterations;
  return solved;
}

void add_multipliers(const System& system, double sigma, std::span<const double> z, std::vector<double>& lambda, double share) {
  const size_t first = 3 * static_cast<size_t>(system.first_joint_block());
  for (size_t i = 0; i < lambda.size(); ++i) lambda[i] += share * sigma * z[first + i];
}

}  // namespace hilo
