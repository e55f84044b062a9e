// SPDX-License-Identifier: GPL-3.0-or-later
// Sets that a scene makes of a mesh by place: [set.NAME].
#pragma once
#include "model/local_mesh.hpp"
#include "model/scene.hpp"

namespace hilo {

/// Adds the sets of the scene to the mesh: the nodes of each, and under the same name the outer facets all whose nodes are among them.
/// Errors: a name that is taken, no node at the place, one node alone on several ranks (a joint there could not reach it).  Collective.
void add_scene_sets(const Scene& scene, LocalMesh& mesh, const Comm& comm);
/// The same for a whole mesh.
void add_scene_sets(const Scene& scene, Mesh& mesh);

}  // namespace hilo
