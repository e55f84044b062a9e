// SPDX-License-Identifier: GPL-3.0-or-later
// Integrals over facets of cells, and over shells.
#pragma once
#include <functional>

#include "model/mesh.hpp"

namespace hilo {

/// Calls f(x, n dA) at the points of a rule over a facet, with the outward normal: exact for polynomials of degree 2 of x on flat facets
/// with straight edges.
void over_facet(const Mesh& mesh, const Facet& facet, const std::function<void(const Vec3& x, const Vec3& dA)>& f);

}  // namespace hilo
