// SPDX-License-Identifier: GPL-3.0-or-later
// The Cholesky factor of a rank's subdomains with their interfaces last [davis-2006]:
//
//     [ A_II  A_IG ]   [ L_II      ] [ L_II^T  L_GI^T ]
//     [ A_GI  A_GG ] = [ L_GI  L_S ] [         L_S^T  ]
//
// One factor so serves the interior (L_II), the interface alone (L_S L_S^T is the Schur complement), and what goes between them.
#pragma once
#include <suitesparse/cholmod.h>

#include <vector>

#include "linear/petsc/interface.hpp"
#include "linear/supernodal.hpp"

namespace hilo::petsc {

class SubdomainFactor {
 public:
  /// The pattern is that of F and of dense classes.
  SubdomainFactor(const SubdomainMatrix& F, const Interface& interface);
  ~SubdomainFactor();
  SubdomainFactor(const SubdomainFactor&) = delete;

  /// Factor the symmetric part of F with sum_k weight_k q_k q_k^T of the classes added.  False when it is not positive definite.
  bool factor(const SubdomainMatrix& F, const Interface& interface, const std::vector<double>& weight);

  int n() const { return 3 * static_cast<int>(place_.size()); }
  int n_interior() const { return n_interior_; }
  int place(PetscInt block) const { return place_[block]; }  // of a block in the factor's order
  PetscInt block(int place) const { return block_[place]; }
  /// From here to the next factor() forward and backward are in single precision, in half the time; of L itself nothing
  /// can be had any more.
  void narrow();
  /// x := L^-1 x, columns [from, to) of L only: the rows below them are changed too.  x: (n x columns).
  void forward(int from, int to, double* x, int columns = 1) const;
  /// x := L^-T x, columns [from, to) of L only, from the rows below as they are.
  void backward(int from, int to, double* x, int columns = 1) const;
  /// x := L_S L_S^T x of all interfaces; x of all unknowns.
  void multiply_schur(double* x, int columns = 1) const;
  /// The interface of a piece: unknowns [begin(p), begin(p + 1)).
  int begin(int piece) const { return begin_[piece]; }
  /// Rows of a piece's L_S, dense (unknowns x its interface): of the given ones of its interface.
  Eigen::MatrixXd schur_rows(int piece, const std::vector<int>& unknowns) const;
  /// Inverse of a piece's L_S, dense; empty where it has more than `most` unknowns.
  Eigen::MatrixXd inverse_root(int piece, int most) const;
  double bytes() const;

 private:
  template <class Solve>
  void in_single(int from, int to, double* x, int columns, const Solve& solve) const;
  void order(const SubdomainMatrix& F, const Interface& interface, const std::vector<char>& shared);

  cholmod_common common_{};
  cholmod_factor* L_ = nullptr;
  std::vector<int> place_;
  std::vector<PetscInt> block_;
  int n_interior_ = 0;
  std::vector<int> begin_;           // of each piece's interface (n_pieces + 1)
  std::vector<int> start_, rows_;    // of the lower triangle in blocks, by columns
  supernodal::SingleValues single_;  // of L, once narrowed
  mutable std::vector<double> below_;
  mutable std::vector<float> x_, below_single_;
};

}  // namespace hilo::petsc
