// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dampers of an .inp deck whose force is a table, or acts along one component of nodes that are not in a line along it.
#pragma once
#include <string>
#include <vector>

#include "import/inp/deck.hpp"

namespace hilo {

/// An end of a spring: its name in the scene and its place, in units of the deck.
struct InpSpringEnd {
  std::string name;
  Vec3 X;
  bool turns = false;  // a body, not a node
};

/// The element, its value and its ends: one for SPRING1 and DASHPOT1.
struct InpPointSpring {
  const InpPoint& element;
  const InpPointValue& value;
  std::vector<InpSpringEnd> ends;
};

/// Why no line of a scene says it; "" where one does.
std::string why_no_spring(const InpPointSpring& spring);
/// `size` of the model, in units of the deck.
void write_point_spring(const InpDeck& deck, double size, const InpPointSpring& spring, const ImportOptions& options, SceneWriter& scene);

}  // namespace hilo
