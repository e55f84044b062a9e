// SPDX-License-Identifier: GPL-3.0-or-later
// Flexible regions that do not hold together.
#pragma once
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace hilo {

/// A line for each flexible region whose cells hang together neither by their own nodes nor by those of other regions, nor by blocks.
std::vector<std::string> loose_pieces(const Mesh& mesh, const std::vector<Fidelity>& fidelity);

}  // namespace hilo
