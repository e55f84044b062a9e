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

/// A face (2) or an edge (1) of the model of gmsh, by the name that the file gives it.
struct NamedEntity {
  int dim, tag;
  std::string name;
};
/// Those of a STEP file that is open, whose numbers have the unit of length `unit` [mm]; notes say which are not found.
std::vector<NamedEntity> step_names(const std::string& text, double unit, std::vector<std::string>& notes);

/// Solids that touch share their faces (boolean fragments) in the model of gmsh; names stay with the solids.  Colours that single faces
/// have become surface groups "colour_rrggbb", and what is `named` becomes a group of that name; `solids` gets the colours of the solids,
/// by tag.  Says which solids share faces now, which overlap, and which coloured or named faces were cut.
void join_touching(bool keep_apart, const std::vector<NamedEntity>& named, std::map<std::string, std::vector<int>>& solids,
                   std::vector<std::string>& notes);

/// A volume by its name, that of a physical group it is in, or its number.
std::string name_of_volume(int tag);
/// Facets of the surface mesh that cut each other: of which volumes, and where in lengths of `unit`; "" where none do.
std::string where_facets_cut(double unit);

}  // namespace hilo
