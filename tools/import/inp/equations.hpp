// SPDX-License-Identifier: GPL-3.0-or-later
// *EQUATION: displacements that are equal, as a body of no mass that slides and takes the nodes along.
#pragma once
#include "import/inp/deck.hpp"

namespace hilo {

/// Numbers of the nodes that a term names.
std::vector<std::int64_t> numbers_of(const InpDeck& deck, const InpTarget& target);
/// Terms of one node become supports, those of two equal displacements `deck.slides`; others are named.
void find_equations(InpDeck& deck, Imported& in);
/// The slide of a displacement (1 to 3) of a node, or -1.
int slide_of(const InpDeck& deck, std::int64_t node, int component);
/// A node of no cell whose displacement an equation speaks of.
bool is_slide(const InpDeck& deck, std::int64_t node);
std::string slide_name(const InpDeck& deck, int slide);

}  // namespace hilo
