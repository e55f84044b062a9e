// SPDX-License-Identifier: GPL-3.0-or-later
// What a CAD file says beside its shapes: the unit of its lengths, colours, and which solids touch.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "import/gmsh/mesh.hpp"

namespace hilo {

/// A length unit that a file states.
struct LengthUnit {
  std::string name;  // "mm"
  double metre = 0;  // [m]
};
/// Of a STEP file the length unit of its contexts, of an IGES file that of its global section; nothing where the text states none.  A file
/// with several has "" for a name and its first unit's length.
std::optional<LengthUnit> step_unit(const std::string& text);
std::optional<LengthUnit> iges_unit(const std::string& text);

/// Solids that touch share their faces (boolean fragments) in the model of gmsh; names stay with the solids.  Colours that single faces
/// have become surface groups "colour_rrggbb"; `solids` gets those of the solids, by tag.  Says which solids share faces now, which
/// overlap, and which coloured faces were cut.
void join_touching(bool keep_apart, std::map<std::string, std::vector<int>>& solids, std::vector<std::string>& notes);

}  // namespace hilo
