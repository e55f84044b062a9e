// SPDX-License-Identifier: GPL-3.0-or-later
// The [[contact]] entries of a scene, those of a = "all" or b = "all" as one for each pair that they stand for.
#pragma once
#include <vector>

#include "model/local_mesh.hpp"
#include "model/scene.hpp"

namespace hilo {

struct ContactEntry {
  Entry entry;
  bool of_all = false;  // one of the pairs of an "all"
};
/// In the order of the scene.  "all" is every obstacle and every region with cells of three dimensions, unless something has that name.
/// Left out: what hangs together by nodes, is on the same body, or another [[contact]] or [[tie]] names.  Error where nothing is left.
/// Collective.
std::vector<ContactEntry> contact_entries(const Scene& scene, const LocalMesh* mesh, const Comm& comm);
/// Whether a [[contact]] says "all".
bool meets_all(const Scene& scene);
/// Which pairs the "all" of the scene stand for, a line for each: "contact.NAME stands for NAME_A_B: A, B".  Collective.
std::string told_pairs(const Scene& scene, const LocalMesh* mesh, const Comm& comm);

}  // namespace hilo
