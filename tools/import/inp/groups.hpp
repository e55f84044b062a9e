// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that a deck holds or pushes, in groups that each become one entry of the scene.
#pragma once
#include "import/inp/deck.hpp"

namespace hilo {

using Rows = std::vector<std::int64_t>;

/// A group of nodes held in the same components to the same values.
struct Held {
  std::string target, amplitude, place;
  std::array<bool, 3> on{};
  Vec3 value = Vec3::Zero();
  bool moved = false;
  Rows nodes = {};
};
/// A component of a node held along an axis that is none of the model's.
struct HeldAskew {
  std::int64_t node;
  Vec3 axis;
  std::string place;
};
/// *BOUNDARY by set, or equal supports of single nodes together; the last line that speaks of a component of a node holds it.
/// `askew`: those in axes of *TRANSFORM.
std::vector<Held> held_groups(const InpDeck& deck, const std::vector<int>& turned, Imported& in, std::vector<HeldAskew>& askew);

/// A vector on each node of a group.
struct Nodal {
  std::string target, amplitude, place;
  Vec3 value = Vec3::Zero();
  Rows nodes;
};
/// *CLOAD (values on the same node add up) or initial velocities (the last one holds): by set, or equal vectors of single nodes together.
std::vector<Nodal> nodal_groups(const InpDeck& deck, const std::vector<InpNodal>& lines, const char* what, bool add,
                                const std::vector<int>& turned, Imported& in);

/// Which *TRANSFORM each node has, or -1.
std::vector<int> turned_nodes(const InpDeck& deck, const Mesh& mesh);

}  // namespace hilo
