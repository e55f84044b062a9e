// SPDX-License-Identifier: GPL-3.0-or-later
// What a linear region is free to do between its supports: joints, welds, neighbours and the ground.
//
// Unknowns are translations and turns of the region and of the bodies that hang together with it, and the amplitudes s of its softest
// shapes; other linear regions count as rigid, nonlinear cells and springs hold nothing.  On the null space of all rows of positions, less
// what moves without strain (mechanisms and free flight, to which the rest is orthogonal in mass), the stiffness of the region has an
// inverse: what it gives way by.
#pragma once
#include "system/system.hpp"

namespace hilo {

struct LinearRegion;

struct RegionSupport {
  Eigen::MatrixXd free;        // turns of the region in its own axes and shapes s by motions of unit strain energy, 1/2   (3 + S x n)
  Eigen::MatrixXd compliance;  // of s   (S x S)
};

/// At a configuration of which the bodies and amplitudes are asked alone.
RegionSupport support_of(const System& system, const LinearRegion& region, const Config& q);

}  // namespace hilo
