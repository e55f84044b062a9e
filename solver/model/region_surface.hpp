// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of the regions of a mesh that is spread over ranks: what a picture of any choice of regions can show.
#pragma once
#include "model/local_mesh.hpp"

namespace hilo {

/// Facets of the local cells that no other cell of their region shares, on this rank or elsewhere.  Collective.
std::vector<Facet> region_surface(const LocalMesh& local, const Comm& comm);
/// Those that no other cell at all shares.  Collective.
std::vector<Facet> outer_surface(const LocalMesh& local, const Comm& comm);

}  // namespace hilo
