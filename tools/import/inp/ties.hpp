// SPDX-License-Identifier: GPL-3.0-or-later
// Reference nodes, springs and masses of an .inp deck: what they become in a scene.
#pragma once
#include <functional>

#include "import/inp/deck.hpp"

namespace hilo {

/// Which nodes of no cell become bodies or means; what no scene can say is told.
void find_ties(InpDeck& deck, Imported& in, const std::map<std::string, std::string>& surface);
/// Whether a node of no cell is a body or a mean.
bool is_tied(const InpDeck& deck, std::int64_t id);
/// Calls `use(node, first, last)` for the tied nodes that a line speaks of, with degrees of freedom from 1 to 6.
void tied_lines(const InpDeck& deck, const InpNodal& line, const std::function<void(std::int64_t, int, int)>& use);
/// Of the model, 1 where it has none: for points beside others.
double size_of(const InpDeck& deck, const Mesh& mesh);
std::string body_name(const InpDeck& d, std::int64_t id);
/// [[body]], [[point_mass]], [[joint]] and [[spring]].
void write_ties(const InpDeck& deck, Imported& in, SetNames& names, const ImportOptions& options, SceneWriter& scene);

}  // namespace hilo
