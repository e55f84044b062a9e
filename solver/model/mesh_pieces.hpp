// SPDX-License-Identifier: GPL-3.0-or-later
// What of a mesh hangs together.
#pragma once
#include "model/mesh.hpp"

namespace hilo {

/// Cells that share nodes are one piece, and so are those on a block of nodes: the piece of each node, by the number of one of its nodes.
std::vector<std::int64_t> pieces_of(const Mesh& mesh);

}  // namespace hilo
