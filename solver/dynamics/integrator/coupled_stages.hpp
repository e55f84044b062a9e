// SPDX-License-Identifier: GPL-3.0-or-later
// Methods whose stages are solved together, in one system of three times the unknowns.
//
// Simplified Newton [hairer-wanner-1996, IV.8]: matrix and factors stay, over steps too, while corrections with them fall fast.
#pragma once
#include <Eigen/Core>

#include "dynamics/integrator.hpp"

namespace hilo {

class CoupledStages : public Integrator {
 protected:
  static constexpr int n_stages = 3;
  /// `solver`: of the matrix of all stages; A: the tableau.
  CoupledStages(std::unique_ptr<SerialKktSolver> solver, Eigen::Matrix3d A);

  /// Error where a scene is not for the method.
  virtual void check(const System& /*system*/) const {}
  /// Add the increments z_i of stage i (each 3 x n_blocks, one behind the other) to the unknowns.
  virtual void move(const System& system, std::span<const double> z) = 0;
  /// stages_ of the unknowns.
  virtual void place(const System& system) = 0;
  /// Residuals r_ of the stages and, into the zero matrix `whole` where there is one, what they are by the unknowns.
  virtual void evaluate(const System& system, SerialKktSolver* whole) = 0;

  /// Before the first guess of a step of length h.  Error where a scene is not for it.
  void begin(const System& system, double t, double h);
  /// From the first guesses of unknowns and multipliers to the solution, with the matrix of all stages.
  NewtonReport iterate(const System& system, const NewtonOptions& options);
  /// The same with a matrix of the size of a stage, in `solver`, where `triangular` stands for A: lower triangular, of one diagonal
  /// (triangular_stages.cpp).
  NewtonReport iterate_triangular(const System& system, KktSolver& solver, const Eigen::Matrix3d& triangular, const NewtonOptions& options);
  /// The step is accepted; nothing of the matrices is to be kept; the run begins anew.
  void accepted() { tried_ = false; }
  void drop_matrix() { kept_ = one_.kept = false; }
  void forget_structure() { drop_matrix(), tried_ = false, map_ = {}, cliques_ = {}; }

  Eigen::Matrix3d A_, W_;  // W = A^-1
  double c_[n_stages], t_ = 0, h_ = 0;
  std::vector<double> lambda_[n_stages];
  Stage stages_[n_stages];
  Residual r_[n_stages];

 private:
  void couple(const System& system);
  void judge(const System& system, KktSolver& solver, NewtonReport& report);
  void build_triangular(const System& system, KktSolver& solver);
  SolveReport solve_triangular(const System& system, KktSolver& solver, const Eigen::Matrix3d& T);
  double largest_correction(const System& system) const;
  std::pair<double, double> scales(const System& system) const;
  double sufficient(const System& system, double tolerance) const;
  double rounding(const System& system) const;

  std::unique_ptr<SerialKktSolver> whole_;
  Cliques cliques_;
  BlockMap map_;
  bool tried_ = false;                                     // the step solved last is not accepted yet
  bool kept_ = false;                                      // the matrix at hand serves,
  double kept_h_ = 0, kept_sigma_[n_stages]{}, rate_ = 1;  // built for this step length and these scales; how it contracted last
  int excess_ = 0;                                         // iterations that its age has cost
  std::vector<double> b_, z_;
  struct OneMatrix {  // of the size of a stage
    bool kept = false;
    double h = 0, d = 0;                 // of the step it was built for; diagonal of T
    int iterations = 0;                  // of that step with it
    bool pulls = true, weighed = false;  // K z of a stage counts for the next ones; that has been found out
    Stage stage;                         // that it is the tangent of, at the middle one,
    Config q, v, a, before, after;
    Residual r, still;                   // its residual, and without accelerations and multipliers
    std::vector<double> none, b;         // multipliers; right-hand side
    Config zero, trial_a;                // accelerations
    std::vector<double> trial;           // multipliers
    Residual by_trial;                   //
    std::vector<double> pull[n_stages];  // K z of a stage
  } one_;
};

}  // namespace hilo
