// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvectors and eigenvalues of a symmetric 3 x 3 matrix.
#pragma once
#include "base/math.hpp"

namespace hilo {

/// A = V diag(e) V^T by Jacobi's rotations: small entries keep their digits.
void principal_axes(Mat3 A, Mat3& V, Vec3& e);

}  // namespace hilo
