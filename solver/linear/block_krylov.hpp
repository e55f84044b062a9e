// SPDX-License-Identifier: GPL-3.0-or-later
// The lowest modes of K x = omega^2 M x on a subspace, by block Krylov sequences of the inverse (K + s M)^-1 M, all vectors kept
// orthonormal in M [parlett-1998, 13.10].  M may be singular (massless unknowns) and K too (free parts, by the shift s); the subspace may
// be as small as one direction.  A sequence that holds the wanted modes is doubted: it goes on from further random vectors, until these
// bring no mode that it has missed, as copies of a multiple one.
#pragma once
#include <Eigen/Dense>
#include <functional>

namespace hilo {

struct Pencil {
  Eigen::Index n;                                                       // unknowns
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&X)> mass, solve;  // M X, and (K + s M)^-1 X in the subspace   (n x columns)
  double shift;                                                         // s [1/s^2]
};

struct Eigenmodes {
  Eigen::VectorXd omega2;  // rising                              [1/s^2]
  Eigen::MatrixXd shapes;  // columns, orthonormal in M           (n x modes)
  double asymmetry = 0;    // of the inverse on what was found, 0 for a symmetric K
  bool converged = false;
};

/// As many modes as wanted, or all there are, those with the lowest |omega^2 + s|.  `tolerance`: of (K + s M)^-1 M x - nu x over nu.
/// Without `doubt` copies of multiple modes may be missing.  `tell` is called with the number of modes found so far.
Eigenmodes lowest_modes(const Pencil& pencil, int wanted, double tolerance, bool doubt = true, const std::function<void(int)>& tell = {});

}  // namespace hilo
