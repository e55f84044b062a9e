// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh of a section's face from a text file of gmsh (.msh 2.2 or 4.1): triangles and quadrangles in a plane z = const, linear ones
// with their mid-nodes added.
#pragma once
#include <string>

#include "physics/section_mesh.hpp"

namespace hilo {

/// Of the file's text, x along axis 1 and y along axis 2, in the numbers of the file.  Error with the line where the face is none: no cell,
/// not plane, turned inside out, overlapping, of parts that do not hang together by their nodes.
SectionMesh section_mesh_of(const std::string& text, const std::string& path);

}  // namespace hilo
