// SPDX-License-Identifier: GPL-3.0-or-later
// What BDDC and FETI-DP share [mandel-dohrmann-tezaur-2005]: functions on the interface of a rank's subdomains, and the Schur complement
// of the symmetric part of the flexible block on them.
//
//     W    each connected piece has values of its own;   W~  pieces that meet have common primal values C w;   W^  all values common
//     S    block by block;   S~ = S on W~,  with   S~^-1 = Psi K_c^-1 Psi^T  +  S^-1 restricted to C w = 0
//     E_D  averages with weights D, from W~ to W^;   P_D = 1 - E_D  the weighed jump
//
// C: the averages and moments of classes of shared nodes, and more where those do not do (class_matrices.hpp); Psi: the motions of least
// energy with C Psi = 1, K_c their stiffness; D: by stiffness, of whole classes ("deluxe" [dohrmann-widlund-2016]) where they are not too
// large.  Floating pieces are made regular by C^T r C, which changes nothing on C w = 0.
#pragma once
#include <Eigen/Dense>

#include "linear/petsc/class_matrices.hpp"
#include "linear/petsc/coarse_problem.hpp"
#include "linear/petsc/interface.hpp"
#include "linear/petsc/solver.hpp"
#include "linear/petsc/subdomain_factor.hpp"

namespace hilo::petsc {

/// Iterations beyond which further constraints are looked for: rigid motions of classes serve where stiffness is smooth.
constexpr int too_many_iterations = 20;

/// Vectors of W and of forces on it: the unknowns of the interfaces of this rank's pieces (n_edge), piece after piece; several of them
/// side by side are the columns of a matrix.
class DualPrimal {
 public:
  using VectorXd = Eigen::VectorXd;
  using MatrixXd = Eigen::MatrixXd;
  using Columns = Eigen::Ref<const Eigen::MatrixXd>;

  explicit DualPrimal(const SubdomainMatrix& F);
  ~DualPrimal();
  DualPrimal(const DualPrimal&) = delete;

  /// Factors of the matrix as it is now, with more than rigid motions as constraints or not.  False when it is not positive definite.
  bool set_up(bool more_constraints);
  /// Until the next set-up, S~^-1 in single precision; S w cannot be had any more.
  void narrow() { factor_.narrow(); }
  /// Eliminate the inside: the forces that b leaves on the interface, shared out by D^T.
  MatrixXd condense(const Columns& b);
  /// x := E_D w on the interface and, for the b condensed last, the equilibrium inside.
  void expand(const Columns& w, Eigen::Ref<MatrixXd> x);
  /// S~^-1 f
  MatrixXd solve(const Columns& f);
  /// S w
  MatrixXd multiply(const Columns& w);
  MatrixXd average(const Columns& w) { return sum(weigh(w, false)); }            // E_D w
  MatrixXd average_transposed(const Columns& f) { return weigh(sum(f), true); }  // E_D^T f

  double coarse_seconds() const { return coarse_.seconds(); }
  double bytes() const;

 private:
  /// The interface of a connected part of a subdomain: unknowns [from, from + n) of this rank's interface.
  struct Piece {
    Eigen::Index from = 0, n = 0;
    std::vector<int> number;  // of its constraints among all
    VectorXd regular;         // r of each of its constraints
    MatrixXd C, Psi, coarse;  // (n x constraints), the same, (constraints x constraints)
    MatrixXd own(const MatrixXd& primal) const;
  };

  void make_scatters();
  void find_weights();
  void list_constraints(const std::vector<double>& regular);
  bool form_coarse_basis();
  bool factor_coarse();
  MatrixXd solve_coarse(const Columns& f);
  MatrixXd weigh(const Columns& x, bool transposed) const;
  MatrixXd add(const Columns& x, const double* g);
  MatrixXd sum(const Columns& x) { return add(x, nullptr); }

  const SubdomainMatrix& F_;
  Interface interface_;
  SubdomainFactor factor_;
  std::vector<Piece> pieces_;
  int n_ = 0, n_interior_ = 0;  // unknowns of this rank's subdomains
  Eigen::Index n_edge_ = 0;
  VectorXd diagonal_, weight_;  // of all unknowns; of the interface
  ClassMatrices of_class_;
  int n_constraints_ = 0;  // of all ranks
  CoarseProblem coarse_;
  VecScatter all_ = nullptr, edge_ = nullptr;
  Vec local_ = nullptr, edge_local_ = nullptr;
  Vector g_;
  MatrixXd work_;  // (n x columns) the inside, as condense leaves it for expand; the interface at work
};

}  // namespace hilo::petsc
