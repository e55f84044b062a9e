// SPDX-License-Identifier: GPL-3.0-or-later
// How many eigenvalues of a matrix lie below zero, without finding any: the signs of the pivots (Sylvester's law of inertia).
#pragma once
#include <optional>

#include "linear/block_csr.hpp"

namespace hilo {

/// Eigenvalues below zero of the symmetric part of K on the motions that the rows G allow, of the saddle-point matrix [K G^T; G 0], whose
/// rows begin with block `first_row`.  Rows are springs a thousand times as stiff as K: of
/// stiffer ones the round-off hides the soft motions that buckle.  Nothing where a pivot vanishes.
std::optional<int> eigenvalues_below_zero(const BlockCsr& A, int first_row);

}  // namespace hilo
