// SPDX-License-Identifier: GPL-3.0-or-later
// Several *STEPs of a deck as one run, where one run can say them.
#pragma once
#include "import/inp/deck.hpp"

namespace hilo {

/// What is left of a line without the components from `first` to `last`.
std::vector<InpNodal> without(const InpNodal& line, int first, int last);
/// Supports and loads of the first steps become those of one run, with amplitudes over its whole time, and `deck.plan` says what is run:
/// static steps one behind the other, or what follows from their equilibrium, dynamic steps or modes.  Steps that this cannot say are
/// named, with what is in them.
void join_steps(InpDeck& deck, Imported& in);
/// Before: *FREQUENCY and *MODAL DYNAMIC or *STEADY STATE DYNAMICS behind it become one step.
void take_modal(InpDeck& deck, Imported& in);
/// Then: velocities and accelerations of supports, and *BASE MOTION, become displacements.
void find_motions(InpDeck& deck, Imported& in);

}  // namespace hilo
