// SPDX-License-Identifier: GPL-3.0-or-later
// The [[contact]] entries of a scene, those of a = "all" or b = "all" as one for each pair that they stand for.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "model/local_mesh.hpp"
#include "model/scene.hpp"

namespace hilo {

struct ContactEntry {
  Entry entry;
  bool of_all = false;               // one of the pairs of an "all"
  std::vector<std::string> balls{};  // not one pair, but all of these obstacles that come near each other (system/ball_heap)
  std::vector<std::pair<std::string, std::string>> never{};  // of these, pairs that another entry names
};
/// What is to be said of an entry, and where it stands.
struct ContactNote {
  std::string where, what;
};
/// An "all" that stands for more pairs of balls than this has them as one.
constexpr size_t most_pairs_of_balls = 1000;
/// In the order of the scene.  "all" is every obstacle and every region with cells of three dimensions, unless something has that name.
/// Left out: what hangs together by nodes, is on the same body, or another [[contact]] or [[tie]] names, also by sets of its
/// facets.  Error where nothing is left, or where two have facets of both sides in common; `told`: what is to be said.  Collective.
std::vector<ContactEntry> contact_entries(const Scene& scene, const LocalMesh* mesh, const Comm& comm,
                                          std::vector<ContactNote>* told = nullptr);
/// Whether a [[contact]] says "all".
bool meets_all(const Scene& scene);
/// Which pairs the "all" of the scene stand for, a line for each: "contact.NAME stands for NAME_A_B: A, B".  Collective.
std::string told_pairs(const Scene& scene, const LocalMesh* mesh, const Comm& comm);

}  // namespace hilo
