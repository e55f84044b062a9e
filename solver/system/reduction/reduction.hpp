// SPDX-License-Identifier: GPL-3.0-or-later
// The modes of a linear region: what its cells can do in small strain, reduced to what its interfaces, the forces of inertia and the lowest
// frequencies ask for.
//
//   constraint modes   a rigid motion of one interface, or a motion of its nodes (where they are many, by smooth functions of place),
//                      the others held   [craig-bampton-1968]; where the region stiffens, stretches of a rigid interface too
//   static modes       the answer to the loads rho e_i and rho (X - Xc)_j e_i, interfaces held: gravity, any rigid acceleration and
//                      centrifugal force are exact with these twelve
//   load modes         the answer to each load of the scene on its nodes, in every direction that it may take as the region turns
//   vibration modes    the lowest of the region with its interfaces held, or free where it has none
//   derivatives        of the lowest modes, where the region stiffens (system/reduction/stiffening.hpp)
//
// The span of all of them, without rigid motions (mean axes: orthogonal in mass to the six), is turned into modes orthonormal in mass.
#pragma once
#include <Eigen/Dense>
#include <functional>

#include "system/quadratic_strain.hpp"
#include "system/reduction/point_cell.hpp"
#include "system/solids.hpp"

namespace hilo {

/// Nodes of an interface whose every motion is a mode, at most; more move by polynomials of the fifth degree [docs/fidelity.md].
inline constexpr size_t most_free = 66;

/// Smooth functions of many points: orthonormal combinations of the polynomials of degree up to five   (n x k, k <= 56).
Eigen::MatrixXd smooth_functions(const std::vector<Vec3>& at);

struct ReductionInput {
  std::vector<Vec3> X;                                   // nodes of the region
  std::vector<SolidBatch> cells;                         // over these nodes
  std::vector<std::string> made_of;                      // what each of them is made of, in words
  std::vector<PointCell> points;                         // cells given by their matrices
  std::vector<std::vector<int>> rigid;                   // interfaces that move as rigid bodies,
  std::vector<std::string> rigid_names;                  // and their names
  std::vector<int> free;                                 // nodes of an interface that move freely
  std::vector<std::vector<int>> tied;                    // nodes that ties hold, each list like `free`,
  std::vector<std::string> tied_names;                   // and their names
  std::vector<std::vector<int>> blocks;                  // nodes that move as one
  Vec3 centre = Vec3::Zero();                            // of mass
  std::vector<std::vector<std::pair<int, Vec3>>> loads;  // on nodes
  int n_vibrations = 0;                                  // vibration modes, at most
  bool may_be_fewer = false;                             // of them, where no more modes can stiffen
  double up_to = 0;                                      // and up to this frequency, but at least four; 0: all of n_vibrations  [Hz]
  Eigen::MatrixXd given;                                 // modes that take the place of all others (3 n_nodes x k), or empty [m]
  bool stiffening = false;                               // strains of the second degree in the amplitudes
  double length = 1;                                     // of the region [m]
  double memory = -1;                                    // that the factor may take; negative: what is free   [byte]
  std::string scratch;                                   // folder of a file for a factor that does not fit
  std::function<void(const std::string&)> progress;
};

struct Reduction {
  Eigen::MatrixXd shapes;    // (3 n_nodes x m) [m per unit of amplitude]
  Eigen::VectorXd omega2;    // of the modes, squared circular frequencies (m) [1/s^2]
  Eigen::MatrixXd A;         // int rho b b^T, b = (1, X - Xc, shapes by component)   (4 + 3m x 4 + 3m)
  Eigen::MatrixXd A_damped;  // the same of mass-proportional damping alpha rho, or empty
  Eigen::MatrixXd viscous;   // of damping beta C on the modes (m x m), on the measures of strain where it stiffens, or empty [1/s]
  QuadraticStrain strain;    // where it stiffens
  Eigen::MatrixXd sites;     // displacements of nodes far out, over the distance between them   (3 n_sites x m) [1 per unit of amplitude]
  Eigen::MatrixXd held;      // vibrations with the interfaces held: frequency [Hz], shares of the mass along x, y, z   (n x 4)
  Eigen::MatrixXd left_out;  // L: modes left out would hold the strain energy a.L a/2, where the modes are accelerated by a   (m x m) [s^2]
  Eigen::MatrixXd soft, second_order;  // as SecondOrder has them (system/reduction/second_order.hpp): soft, forces
  double held_frequency = 0;           // of the first vibration mode left out, or 0 where all that were found are in  [Hz]
};

class SharedCholesky;
/// On rank 0, with the others in the factor's serve().
/// Errors: a region that is not held together, or cells turned inside out; no memory.
Reduction reduced(const ReductionInput& in, SharedCholesky& factor);
/// Of a region that is rigid: no modes.
Reduction rigid_one(const ReductionInput& in);

}  // namespace hilo
