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
  /// From the first guesses of unknowns and multipliers to the solution.
  NewtonReport iterate(const System& system, const NewtonOptions& options);
  /// The step is accepted; nothing of the matrix is to be kept; the run begins anew.
  void accepted() { tried_ = false; }
  void drop_matrix() { kept_ = false; }
  void forget_structure() { kept_ = tried_ = false, map_ = {}, cliques_ = {}; }

  Eigen::Matrix3d A_, W_;  // W = A^-1
  double c_[n_stages], t_ = 0, h_ = 0;
  std::vector<double> lambda_[n_stages];
  Stage stages_[n_stages];
  Residual r_[n_stages];

 private:
  void couple(const System& system);
  void look_at(const System& system, NewtonReport& report);
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
};

}  // namespace hilo
