// SPDX-License-Identifier: GPL-3.0-or-later
// Full Newton on the equations of a step, with tolerances that mean forces and lengths.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "dynamics/unknown.hpp"
#include "linear/kkt.hpp"
#include "system/system.hpp"

namespace hilo {

struct NewtonOptions {
  double tolerance = 1e-10;  // residual over the largest force it sums; correction over the scene's length
  int max_iterations = 25;
  bool patient = false;       // do not give up on slow contraction
  double reach = 1e3;         // largest correction, in lengths of the scene; a guess farther off may lead to another root
  bool foresees = false;      // tangents have the stresses that the last correction foresaw, while corrections halve
  bool searches = false;      // goes along each correction until forces work no further: for what slides in part
  double least_share = 1e-3;  // of a damped correction; below it the guess is given up
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0;     // linear solves
  double correction = 0;  // last one, over the scene's length
  double residual = 0;    // last one, over the force scale
  LeastDet least_det;
  int linear_iterations = 0;
  double left = 0;            // work of the residual over the increments of the unknown from where it began [J]
  std::vector<double> gaps;   // of the constraint rows, laid out like lambda; none: closed to rounding
  std::string reason;         // why it failed
  bool is_round_off = false;  // and that round-off of positions alone is left
};

/// Solve for the unknown and lambda from the guesses given.  `stage` makes the stage of an unknown; `guess`: where the first guess is a
/// linear answer, how it was found.
NewtonReport newton(const System& system, KktSolver& solver, const std::function<Stage(const Unknown&)>& stage, Unknown& u,
                    std::vector<double>& lambda, const NewtonOptions& options, std::optional<Correction> guess = {});

/// Residual over its scales: forces by the largest force, moments by force times the body's size, constraints by the scene's length.
double relative_residual(const System& system, const Residual& r);
/// The increments z as lengths [m], without multipliers: root of the sum of squares.
double size_of(const System& system, std::span<const double> z);
/// Work of a residual over increments, which may end before the rows [J].  Collective.
double work_of(const System& system, const Residual& r, std::span<const double> step);
/// Largest move of a point by the increments z, over the scene's length.
double relative_correction(const System& system, std::span<const double> z);

}  // namespace hilo
