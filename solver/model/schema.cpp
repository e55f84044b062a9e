// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/schema.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "base/error.hpp"

namespace hilo {

namespace {

std::vector<ArraySchema>& arrays() {
  static std::vector<ArraySchema> table = {
      {"mesh.h5", "/", "", "", "", "attributes: format = \"hilo mesh|tags|parts|reduced|run|checkpoint\", version, complete (0|1)"},
      {"mesh.h5", "/provenance", "string", "(n)", "", "command lines that led to this file, oldest first"},
      {"mesh.h5", "/mesh/nodes/X", "f8", "(n_nodes, 3)", "m", "reference positions"},
      {"mesh.h5", "/mesh/nodes/id", "i8", "(n_nodes)", "", "number of the node in the deck"},
      {"mesh.h5", "/mesh/nodes/block", "i8", "(n_nodes)", "",
       "number of the block that a node moves with, -1: none; absent without blocks"},
      {"mesh.h5", "/mesh/blocks/name", "string", "(n_blocks)", "", "names of the blocks: nodes that move as one rigid body"},
      {"mesh.h5", "/mesh/blocks/X", "f8", "(n_blocks, 3)", "m", "the point of a block that its body is at"},
      {"mesh.h5", "/mesh/cells/shape", "u1", "(n_cells)", "",
       "0 bar2, 1 tet4, 2 tet10, 3 wedge6, 4 wedge15, 5 hex8, 6 hex20, 7 hex20r, 8 tri3, 9 tri6, 10 quad4, 11 quad8, 12 shell8"},
      {"mesh.h5", "/mesh/cells/offset", "i8", "(n_cells + 1)", "", "first entry of each cell in /mesh/cells/nodes"},
      {"mesh.h5", "/mesh/cells/nodes", "i8", "(n)", "", "nodes of the cells, VTK order"},
      {"mesh.h5", "/mesh/cells/region", "i4", "(n_cells)", "", "region of each cell"},
      {"mesh.h5", "/mesh/cells/id", "i8", "(n_cells)", "", "number of the cell in the deck"},
      {"mesh.h5", "/mesh/regions/name", "string", "(n_regions)", "", "names of the regions"},
      {"mesh.h5", "/mesh/regions/density", "f8", "(n_regions)", "kg/m^3", "from the deck, NaN where absent"},
      {"mesh.h5", "/mesh/regions/E", "f8", "(n_regions)", "Pa", "from the deck, NaN where absent"},
      {"mesh.h5", "/mesh/regions/nu", "f8", "(n_regions)", "1", "from the deck, NaN where absent"},
      {"mesh.h5", "/mesh/regions/thin", "f8", "(n_regions, 10)", "m^3, m^4, m^5",
       "of shells and beams, where there are any: volume, its first moments x y z, its second moments xx yy zz yz xz xy, about the origin"},
      {"mesh.h5", "/mesh/regions/thickness", "f8", "(n_regions)", "m", "of shells, NaN where absent"},
      {"mesh.h5", "/mesh/regions/area", "f8", "(n_regions)", "m^2", "cross-section of beams, NaN where absent"},
      {"mesh.h5", "/mesh/sets/nodes/<name>", "i8", "(n)", "", "a set of nodes"},
      {"mesh.h5", "/mesh/sets/facets/<name>", "i8", "(n, 2)", "", "a set of facets: cell, local facet"},
      {"mesh.h5", "/mesh/sets/cells/<name>", "i8", "(n)", "", "a set of cells"},
      {"mesh.h5", "/mesh/deck_scene", "string", "()", "", "scene lines that the deck's supports and loads became"},
      {"tags.h5", "/mesh", "link", "", "", "external link to mesh.h5:/mesh; attributes of /: mesh_file, mesh_digest"},
      {"tags.h5", "/tags/region", "string", "(n_regions)", "", "names of the regions that the tags are of"},
      {"tags.h5", "/tags/fidelity", "string", "(n_regions)", "", "rigid, linear or nonlinear"},
      {"parts.h5", "/mesh", "link", "", "", "external link to mesh.h5:/mesh; attributes of /: mesh_file, mesh_digest"},
      {"parts.h5", "/tags", "link", "", "",
       "external link to tags.h5:/tags (absent for an untagged mesh); attributes of /: tags_file, tags_digest"},
      {"parts.h5", "/parts/rank", "i4", "(n_cells)", "", "part of each cell; attribute n_parts"},
      {"reduced.h5", "/provenance", "string", "(n)", "", "command lines that led to this file, oldest first"},
      {"reduced.h5", "/reduced/<name>/omega2", "f8", "(n_modes)", "1/s^2",
       "squared circular frequencies of the free region's modes; attributes of the group: digests of mesh, material, loads and basis, "
       "held_frequency [Hz] of the first vibration left out"},
      {"reduced.h5", "/reduced/<name>/shapes", "f8", "(3 n_nodes, n_modes)", "kg^-0.5",
       "the modes, orthonormal in mass, at the region's nodes in the order of the mesh"},
      {"reduced.h5", "/reduced/<name>/held", "f8", "(n, 4)", "Hz, 1",
       "vibrations with the interfaces held: frequency, share of the region's mass along x, y, z"},
      {"reduced.h5", "/reduced/<name>/A", "f8", "(4 + 3 n_modes, 4 + 3 n_modes)", "kg, kg m, kg m^2",
       "int rho b b^T of b = (1, X - Xc, shapes by component)"},
      {"reduced.h5", "/reduced/<name>/A_damped", "f8", "(4 + 3 n_modes, 4 + 3 n_modes)", "kg/s", "the same of mass-proportional damping"},
      {"reduced.h5", "/reduced/<name>/viscous", "f8", "(n_modes, n_modes)", "1/s",
       "stiffness-proportional damping on the modes; as strain where they stiffen"},
      {"reduced.h5", "/reduced/<name>/strain", "f8", "(n, n)", "J",
       "of a region that stiffens: energy e^T KK e/2 of e = (eta_i, eta_i eta_j)"},
      {"reduced.h5", "/reduced/<name>/left_out", "f8", "(n_modes, n_modes)", "s^2",
       "L: modes left out would hold the strain energy a.L a/2, where the modes are accelerated by a"},
      {"reduced.h5", "/reduced/<name>/soft", "f8", "(n_modes, n_soft)", "1",
       "the softest shapes, orthonormal in mass, as sums of the modes"},
      {"reduced.h5", "/reduced/<name>/second_order", "f8", "(n_modes + 1, (3 + n_soft)(4 + n_soft)/2)", "J m^-1 kg^-0.5",
       "work of the stress of each mode on products of displacement gradients of pairs (i, j), i <= j, at j (j + 1)/2 + i: three turns, "
       "then "
       "the softest shapes; last row: of the unit tensor over the volume"},
      {"reduced.h5", "/reduced/<name>/sites", "f8", "(n, n_modes)", "m^-1 kg^-0.5",
       "displacements of nodes far out, divided by the distance between them"},
      {"reduced.h5", "/reduced/<name>/interfaces", "string", "(n)", "", "what the region is held or moved by"},
      {"reduced.h5", "/reduced/<name>/interface_digests", "string", "(n)", "", "digests of their nodes"},
      {"checkpoint.h5", "/", "", "", "", "attributes: format = \"hilo checkpoint\", version, t [s] and steps of the run when it was kept"},
      {"checkpoint.h5", "/kept/alike", "u1", "(n)", "", "what the run remembers and all ranks hold alike, as bits"},
      {"checkpoint.h5", "/kept/spread/<k>", "f8", "(n)", "",
       "values of nodes or cells by their number: the k-th list that ranks have parts of"},
      {"checkpoint.h5", "/scene", "string", "()", "", "the scene as run, overrides applied"},
      {"checkpoint.h5", "/values", "string", "(n)", "", "every value in force, key = value, of tables and files their digests"},
      {"checkpoint.h5", "/digests", "string", "(n)", "", "of mesh.h5 and tags.h5"},
      {"checkpoint.h5", "/command/scene", "string", "()", "", "paths of the scene"},
      {"checkpoint.h5", "/command/mesh", "string", "()", "", "of the mesh, tags or parts"},
      {"checkpoint.h5", "/command/modes", "string", "()", "", "and of the reduced file"},
      {"checkpoint.h5", "/command/checkpoint", "string", "()", "", "--checkpoint as given, or nothing"},
      {"checkpoint.h5", "/command/overrides", "string", "(n)", "", "what --set was given"},
      {"checkpoint.h5", "/provenance", "string", "(n)", "", "command lines that led to the run"},
      {"run.h5", "/provenance", "string", "(n)", "", "command lines that led to this file, oldest first"},
      {"run.h5", "/mesh", "link", "", "",
       "external link to mesh.h5:/mesh (absent for a scene of bodies alone); attributes of /: mesh_file, mesh_digest"},
      {"run.h5", "/tags/fidelity", "string", "(n_regions)", "", "the fidelity each region was run at"},
      {"run.h5", "/parts/rank", "i4", "(n_cells)", "", "part of each cell in a parallel run"},
      {"run.h5", "/scene", "string", "()", "", "the scene as run, overrides applied"},
      {"run.h5", "/body/name", "string", "(n_bodies)", "", "rigid bodies and patches: regions joined by +"},
      {"run.h5", "/body/points", "f8", "(n_bodies, 4, 3)", "m",
       "reference positions of the points of each body: centre of mass and three along the principal axes"},
      {"run.h5", "/resolved", "f8", "(n_regions)", "Hz",
       "highest frequency whose shear waves the cells of a region run to 1 % and its modes hold; infinite for a rigid one"},
      {"run.h5", "/body/mass", "f8", "(n_bodies)", "kg", "mass (0 for a patch)"},
      {"run.h5", "/body/inertia", "f8", "(n_bodies, 3)", "kg m^2", "principal moments, rising, about the axes of its points"},
      {"run.h5", "/section/<name>/points", "f8", "(n_section_nodes, 2)", "m",
       "nodes of a meshed section of beams, along axes 1 and 2 of the section; its origin is the centre of area"},
      {"run.h5", "/section/<name>/cells", "i4", "(n_section_cells, 9)", "",
       "its quadratic cells: corners, mid-nodes between them, centre; triangles have -1 in the last three"},
      {"run.h5", "/body/follower_node", "i8", "(n_followers)", "", "dependent nodes: their positions follow from a body"},
      {"run.h5", "/body/follower_body", "i4", "(n_followers)", "",
       "the body each depends on; its position is sum N_a(X) q_a over the four points"},
      {"run.h5", "/skin/node", "i8", "(n_skin)", "",
       "nodes on the surface of a region: with output.nodes = \"skin\" the nodal fields below, and /xdmf, have a row for each of these "
       "alone"},
      {"run.h5", "/field/<step>/displacement", "f8", "(n_nodes, 3)", "m",
       "x - X; attribute t [s] of the group; f4, like all fields, with output.precision = \"single\""},
      {"run.h5", "/field/<step>/velocity", "f8", "(n_nodes, 3)", "m/s", "velocity at t"},
      {"run.h5", "/field/<step>/acceleration", "f8", "(n_nodes, 3)", "m/s^2",
       "acceleration at t, second order (mean of the mid-step values around it); of first order by V0 and, where joints or ties hold, "
       "bathe"},
      {"run.h5", "/field/<step>/stress", "f8", "(n_nodes, 6)", "Pa",
       "Cauchy stress xx yy zz yz xz xy, recovered from the cells of the node's first flexible region alone, of others in /border; 0 on "
       "rigid regions"},
      {"run.h5", "/field/<step>/von_mises", "f8", "(n_nodes)", "Pa", "von Mises stress of it; of a node of bars alone the mean of theirs"},
      {"run.h5", "/field/<step>/stress_error", "f8", "(n_nodes)", "Pa",
       "von Mises stress of recovered minus raw stress, root mean square over the cells at the node: what the mesh leaves open"},
      {"run.h5", "/field/<step>/cell_von_mises", "f8", "(n_cells)", "Pa",
       "von Mises stress of each cell, mean over its integration points (hex8: 2 x 2 x 2 of its assumed strains), not recovered; 0 on "
       "rigid "
       "cells"},
      {"run.h5", "/field/<step>/contact_pressure", "f8", "(n_nodes)", "Pa",
       "of [[contact]]: of planes through the pressures of the points of its pressed facets, their mean; only where facets may meet "
       "something"},
      {"run.h5", "/field/<step>/plastic_strain", "f8", "(n_nodes)", "1",
       "equivalent plastic strain: that of the integration points extrapolated in each cell of the node's first flexible region, their "
       "mean; "
       "only where a material has one"},
      {"run.h5", "/field/<step>/cell_plastic_strain", "f8", "(n_cells)", "1",
       "equivalent plastic strain of each cell, mean over its integration points; only where a material has one"},
      {"run.h5", "/field/<step>/shell_force", "f8", "(n_nodes, 5)", "N/m",
       "with output.fields = [\"shell\"]: n11 n22 n12 q1 q2 of the shell at the node, per length; in the axes of shell_axis; 0 elsewhere"},
      {"run.h5", "/field/<step>/shell_moment", "f8", "(n_nodes, 3)", "N",
       "m11 m22 m12 per length: positive where the upper face is pulled"},
      {"run.h5", "/field/<step>/shell_stress", "f8", "(n_nodes, 6)", "Pa", "s11 s22 s12 at the node's own face, then their means across"},
      {"run.h5", "/field/<step>/shell_axis", "f8", "(n_nodes, 3)", "1",
       "axis 1 of the shell, which moves with it; 3 is the normal out of the upper face, that of the nodes 4 to 7"},
      {"run.h5", "/border/row", "i8", "(n_borders)", "",
       "rows of the fields of nodes that flexible regions share, once for each region but the first"},
      {"run.h5", "/border/region", "i8", "(n_borders)", "", "and that region, by number"},
      {"run.h5", "/border/<step>/stress", "f8", "(n_borders, 6)", "Pa", "stress of these nodes as that region has it"},
      {"run.h5", "/border/<step>/von_mises", "f8", "(n_borders)", "Pa", "likewise"},
      {"run.h5", "/border/<step>/stress_error", "f8", "(n_borders)", "Pa", "likewise"},
      {"run.h5", "/border/<step>/plastic_strain", "f8", "(n_borders)", "1", "likewise"},
      {"run.h5", "/border/<step>/shell_force", "f8", "(n_borders, 5)", "N/m", "likewise"},
      {"run.h5", "/border/<step>/shell_moment", "f8", "(n_borders, 3)", "N", "likewise"},
      {"run.h5", "/border/<step>/shell_stress", "f8", "(n_borders, 6)", "Pa", "likewise"},
      {"run.h5", "/border/<step>/shell_axis", "f8", "(n_borders, 3)", "1", "likewise"},
      {"run.h5", "/envelope/displacement", "f8", "(n_nodes)", "m",
       "with output.envelope: largest size over all steps of the run, not only those with fields; written at its end"},
      {"run.h5", "/envelope/displacement_time", "f8", "(n_nodes)", "s", "when it was, the first time"},
      {"run.h5", "/envelope/acceleration", "f8", "(n_nodes)", "m/s^2", "largest size over all steps"},
      {"run.h5", "/envelope/acceleration_time", "f8", "(n_nodes)", "s", "when it was, the first time"},
      {"run.h5", "/envelope/von_mises", "f8", "(n_nodes)", "Pa", "largest von Mises stress of a node over all steps"},
      {"run.h5", "/envelope/von_mises_time", "f8", "(n_nodes)", "s", "when it was, the first time"},
      {"run.h5", "/history/t", "f8", "(n_t)", "s", "times of all histories below; first row is the start"},
      {"run.h5", "/history/energy", "f8", "(n_t, 6)", "J",
       "columns: kinetic, elastic (with what time.dissipation stores), gravity potential, external work, dissipated, balance E - E0 - W + "
       "D"},
      {"run.h5", "/history/momentum", "f8", "(n_t, 6)", "kg m/s, kg m^2/s", "linear, and angular about the origin"},
      {"run.h5", "/history/constraint", "f8", "(n_t)", "m", "largest violation of a joint row"},
      {"run.h5", "/history/mode", "f8", "(n_t, 10)", "Hz, 1, kg, kg m^2, 1, m kg^0.5",
       "of an analysis of modes, in which t is the number of the mode and the first row the state of rest: frequency (below zero: the "
       "state "
       "is not stable, and this the rate of growth divided by 2 pi), damping ratio, effective mass along x, y, z and about axes through "
       "the "
       "centre "
       "of mass, error of the shape, amplitude of the mode of unit mass in the other arrays (0: a whirl); all other arrays are of that "
       "state with the shape added, a hundred thousandth of the scene at most"},
      {"run.h5", "/history/participation", "f8", "(n_t, 6)", "kg^0.5, kg^0.5 m",
       "of an analysis of modes: share of each mode of unit mass in a motion of the whole scene along x, y, z and about axes through the "
       "centre "
       "of mass; its square is the effective mass (0: a whirl)"},
      {"run.h5", "/history/mode_stiffness", "f8", "(n_t, 1)", "1/s^2",
       "of an analysis of modes: squared circular frequency of each mode without damping, of which the shapes are (0: a whirl)"},
      {"run.h5", "/history/mode_damping", "f8", "(n_t, n_modes)", "1/s",
       "of an analysis of modes: damping matrix on the modes of unit mass, a row for each"},
      {"run.h5", "/history/mode_drag", "f8", "(n_t, 6)", "kg^0.5/s",
       "of an analysis of modes: forces of damping on each mode where everything moves along x, y, z, what stands still too (of "
       "mass-proportional damping alone), and where that stands still"},
      {"run.h5", "/history/mode_load", "f8", "(n_t, 1)", "N kg^-0.5",
       "of an analysis of modes: share of each mode of unit mass in the loads and gravity of the scene at t = 0 (0: a whirl)"},
      {"run.h5", "/history/buckling", "f8", "(n_t, 2)", "1",
       "of an analysis of buckling, in which t is the number of the shape and the first row the drawn state: factor of the loads (below "
       "zero: "
       "reversed), error of the shape; all other arrays are of the drawn state with the shape added"},
      {"run.h5", "/history/path", "f8", "(n_t, 3)", "1",
       "of an analysis of a path, in which t is the number of the state: share of the loads; its rise along the path, 1 where all of a "
       "step is "
       "load, 0 at limits of the load, below zero where it falls; eigenvalues of the tangent below zero (0: stable; NaN: not counted)"},
      {"run.h5", "/history/newton", "i4", "(n_t)", "", "Newton iterations of the step"},
      {"run.h5", "/history/body/<name>", "f8", "(n_t, 12)", "m", "positions of the four points of a body"},
      {"run.h5", "/history/beam/<name>", "f8", "(n_t, n_resultants)", "N, N m",
       "of each cell of a beam, at its first and at its last section: forces along 1 (shear), 2 (shear) and 3 (stretch) and moments about "
       "1, "
       "2 (bending) and 3 (twist), in the axes of the section, of the side of rising numbers on the other"},
      {"run.h5", "/history/modes/<name>", "f8", "(n_t, n_modes)", "m kg^0.5",
       "amplitudes of the modes of a linear region, orthonormal in mass"},
      {"run.h5", "/history/left_out/<name>", "f8", "(n_t, 2)", "J",
       "of a linear region: strain energy at the inside of the step, and what modes left out would hold of the answer to its vibration"},
      {"run.h5", "/history/second_order/<name>", "f8", "(n_t, 3)", "J, 1, 1",
       "of a linear region: strain energy of strains of the second degree that its supports let nothing take back; its load over that at "
       "which it would buckle; how many times as far it would give way under that load (1000: without end)"},
      {"run.h5", "/history/joint/<name>", "f8", "(n_t, 6)", "N, N m",
       "force and moment on b at the joint point, joint frame carried by a, or in the axes that `reactions` names; of redundant joints the "
       "minimum-norm share"},
      {"run.h5", "/history/coordinate/<name>", "f8", "(n_t, 2)", "m, rad",
       "of a joint with a free slide or angle: displacement of b along the axis and angle of b about it, whole turns included; zero at the "
       "start, and where the joint leaves none free"},
      {"run.h5", "/history/spring/<name>", "f8", "(n_t, 6)", "N, N m", "force and moment on b at the point, inertial axes"},
      {"run.h5", "/history/contact/<name>", "f8", "(n_t, 8)", "N, m, 1, m, J, N",
       "force on b, inertial axes, zero where a surface meets itself; largest depth, and that as a share of the cell (of a ball, of a "
       "tenth of its radius); slip so far; work that friction took so far; sum of the sizes of the normal forces of all points"},
      {"run.h5", "/history/heap/<name>", "f8", "(n_t, 6)", "1, m, 1, m, J, N",
       "of a [[contact]] of all balls, more than 1000 pairs: pairs that are pressed; largest depth, and that as a share of a tenth of the "
       "radius; slip so far, the mean by pressure; work that friction took so far; largest force of a pair"},
      {"run.h5", "/history/stop/<name>", "f8", "(n_t, 6)", "N, N m", "force and moment on b at the joint point, joint frame carried by a"},
      {"run.h5", "/history/motor/<name>", "f8", "(n_t, 6)", "N, N m", "force and moment on b at the joint point, joint frame carried by a"},
      {"run.h5", "/history/friction/<name>", "f8", "(n_t, 6)", "N, N m",
       "force and moment on b at the joint point, joint frame carried by a"},
      {"run.h5", "/history/motion/<name>", "f8", "(n_t, 6)", "N, N m",
       "force and moment on what is held, about the mean of its nodes or the body's centre, inertial axes"},
      {"run.h5", "/history/tie/<name>", "f8", "(n_t, 6)", "N, N m",
       "force and moment on b, about the mean of its nodes that are tied, inertial axes"},
      {"run.h5", "/history/sensor/<name>", "f8", "(n_t, 3)", "1", "proper acceleration R^T (a - g)/g0 in sensor axes: +1 upward at rest"},
      {"run.h5", "/history/probe/<name>", "f8", "(n_t, 9)", "m, m/s, m/s^2", "position, velocity, acceleration"},
      {"run.h5", "/history/<name>/%table", "f8", "(n_t, n, n_columns)", "",
       "of a group of more than 256 histories, in place of an array for each: all of them, in the order of their names"},
      {"run.h5", "/history/<name>/%names", "string", "(n)", "", "names of the histories in that table"},
      {"run.h5", "/xdmf/topology", "i8", "(n)", "", "cells as XDMF's mixed list, for ParaView"},
      {"run.h5", "/xdmf/X", "f8", "(n_nodes, 3)", "m", "reference positions, repeated for ParaView"},
      {"run.h5", "/xdmf/region", "i4", "(n_cells)", "", "region of each cell"},
      {"run.h5", "/VTKHDF", "group", "", "",
       "the same fields, by the names above, as VTK's file format VTKHDF 2.0 has them: views of these arrays, written when the run ends"},
      {"run.h5", "/checkpoint", "group", "", "", "reserved"},
      {"run.h5", "/cell/state", "group", "", "", "reserved: history variables and element modes, global numbering"},
  };
  return table;
}

/// Part by part; <name> is any name, <step> six digits.
bool is_path(std::string_view pattern, std::string_view path) {
  const auto cut = [](std::string_view& rest) {
    const auto at = std::min(rest.find('/'), rest.size());
    const std::string_view part = rest.substr(0, at);
    rest.remove_prefix(std::min(at + 1, rest.size()));
    return part;
  };
  while (!pattern.empty() && !path.empty()) {
    const std::string_view wanted = cut(pattern), part = cut(path);
    const bool digits = part.size() == 6 && part.find_first_not_of("0123456789") == part.npos;
    if (wanted == "<name>" ? part.empty() : wanted == "<step>" ? !digits : wanted != part) return false;
  }
  return pattern.empty() && path.empty();
}

}  // namespace

const std::vector<ArraySchema>& file_schema() { return arrays(); }

void add_array(const ArraySchema& array) {
  if (find_array(array.file, array.path))
    throw Error("", "the schema has an array " + std::string(array.path) + " already", "", Exit::fault);
  arrays().push_back(array);
}

const ArraySchema* find_array(std::string_view file, std::string_view path) {
  const auto& table = file_schema();
  const auto at = std::find_if(table.begin(), table.end(), [&](const ArraySchema& a) { return a.file == file && is_path(a.path, path); });
  return at == table.end() ? nullptr : &*at;
}

const ArraySchema& run_array(std::string_view path) {
  if (const ArraySchema* found = find_array("run.h5", path)) return *found;
  throw Error("", "the schema has no array " + std::string(path), "", Exit::fault);
}

std::vector<std::int64_t> row_shape(const ArraySchema& array) {
  std::vector<std::int64_t> shape;
  for (auto at = array.shape.find(','); at != array.shape.npos; at = array.shape.find(',', at + 1)) {
    const char* digits = array.shape.data() + array.shape.find_first_not_of(", ", at);
    std::int64_t n = 0;
    std::from_chars(digits, array.shape.data() + array.shape.size(), n);
    shape.push_back(n);
  }
  return shape;
}

}  // namespace hilo
