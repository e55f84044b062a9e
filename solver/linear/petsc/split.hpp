// SPDX-License-Identifier: GPL-3.0-or-later
// The cliques of a rank in several subdomains, by METIS: small factors where one large one would fill in.
#pragma once
#include <vector>

#include "linear/kkt.hpp"

namespace hilo::petsc {

/// Subdomain (0 .. n - 1) of each clique; those without a flexible block get 0.  `map.first_dense` says which blocks are flexible.
std::vector<int> split_cliques(const Cliques& cliques, const BlockMap& map, int n);

}  // namespace hilo::petsc
