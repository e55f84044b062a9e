// SPDX-License-Identifier: GPL-3.0-or-later
// What the modes of a linear region need to stiffen: strains of the second degree, and shapes that let a bent part shorten.
//
// Bending turns sections, and a linear map stretches what it turns: without shapes that take these stretches back, the quadratic strain
// would lock.  They are the static modal derivatives u_ij = -K^-1 (d K/d eta_i) phi_j, interfaces held [idelsohn-cardona-1985]; what the
// interfaces themselves are stretched by are modes of their own, which the welds hold to what their turn demands (system/welds.hpp).
#pragma once
#include <functional>

#include "system/quadratic_strain.hpp"
#include "system/reduction/region_cells.hpp"

namespace hilo {

/// The derivatives of modes (3 n_nodes x n) of these squared frequencies, as many as matter where each mode has the same energy.
/// `solve`: answers of the region to loads, its interfaces held.
Eigen::MatrixXd modal_derivatives(const RegionCells& cells, const Eigen::MatrixXd& modes, const Eigen::VectorXd& omega2, double length,
                                  const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& solve);

/// Of all modes; `length` of the region [m].
QuadraticStrain quadratic_strain(const RegionCells& cells, const Eigen::MatrixXd& modes, const Eigen::VectorXd& omega2, double length,
                                 const std::function<void(const std::string&)>& tell);
/// Of damping by stiffness: beta C of the cells in the place of C.
Eigen::MatrixXd viscous_strain(const RegionCells& cells, const Eigen::MatrixXd& modes, double length,
                               const std::function<void(const std::string&)>& tell);

}  // namespace hilo
