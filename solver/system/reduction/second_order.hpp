// SPDX-License-Identifier: GPL-3.0-or-later
// What a linear region leaves out: the work of stresses on strains of the second degree, u_k,i u_k,j /2, of displacements from its mean
// axes.  With gradients H_i of three turns and of the softest shapes,
//
//   forces(k, (i, j)) = int sigma_k : H_i^T H_j,      sigma_k the stress of mode k; last row: sigma = 1/volume
//
// The stress of amplitudes eta_k is the initial stress of the softest shapes, K_sigma = sum_k eta_k forces(k, .), and displacements
// sum_i s_i H_i push the modes with f_k = forces(k, .) s s/2, as strains of the second degree would (system/region_measures.hpp).
#pragma once
#include "system/reduction/reduction.hpp"

namespace hilo {

struct SecondOrder {
  Eigen::MatrixXd soft;    // the softest shapes in modes, orthonormal in mass   (m x S)
  Eigen::MatrixXd forces;  // i <= j as QuadraticStrain::pair numbers them, turns first   (m + 1 x (3 + S)(4 + S)/2)
};

/// Of modes (3 n_nodes x m) of these squared frequencies.  `interfaces`: M times what the interfaces move the region by (3 n_nodes x k).
SecondOrder second_order(const ReductionInput& in, const Eigen::MatrixXd& modes, const Eigen::VectorXd& omega2,
                         const Eigen::MatrixXd& interfaces);

}  // namespace hilo
