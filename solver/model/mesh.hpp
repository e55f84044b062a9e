// SPDX-License-Identifier: GPL-3.0-or-later
// A finite-element mesh: nodes, cells of several shapes, the regions that partition the cells, and named sets that may overlap.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.hpp"
#include "base/shape.hpp"

namespace hilo {

/// What a shape is: name, nodes, dimension, VTK cell type, XDMF topology number, the local nodes of its facets
/// (outward, corner nodes first, then mid-side nodes), and the corners at the far ends of the edges from node 0 (right-handed).
struct ShapeInfo {
  std::string_view name;
  int n_nodes, n_corners, dimension, vtk_type, xdmf_type;
  std::vector<std::vector<int>> facets;
  std::vector<int> edges;
};
const ShapeInfo& info(Shape shape);
inline const ShapeInfo& info(std::uint8_t shape) { return info(static_cast<Shape>(shape)); }

/// What the deck said of a region's material; NaN where it said nothing.  SI units.
struct RegionData {
  double density = std::numeric_limits<double>::quiet_NaN();  // [kg/m^3]
  double E = std::numeric_limits<double>::quiet_NaN();        // [Pa]
  double nu = std::numeric_limits<double>::quiet_NaN();       // [1]
};

/// A facet: a cell and the local number of one of its facets (see ShapeInfo::facets).
struct Facet {
  std::int64_t cell;
  std::int64_t facet;
};

struct Mesh {
  std::vector<Vec3> X;                                         // reference positions           (n_nodes x 3)  [m]
  std::vector<std::int64_t> node_id;                           // number of the node in the deck (n_nodes)
  std::vector<std::uint8_t> shape;                             // Shape of each cell            (n_cells)
  std::vector<std::int64_t> offset{0};                         // first entry in `nodes`        (n_cells + 1)
  std::vector<std::int64_t> nodes;                             // nodes of the cells            (offset.back())
  std::vector<std::int32_t> region;                            // region of each cell           (n_cells)
  std::vector<std::int64_t> cell_id;                           // number of the cell in the deck (n_cells)
  std::vector<std::string> region_name;                        // (n_regions)
  std::vector<RegionData> region_data;                         // (n_regions)
  std::map<std::string, std::vector<std::int64_t>> node_sets;  // named sets of nodes
  std::map<std::string, std::vector<Facet>> facet_sets;        // named sets of facets (boundary faces)
  std::map<std::string, std::vector<std::int64_t>> cell_sets;  // named sets of cells
  std::vector<std::int64_t> block;                             // of nodes that move as one body: its number, or -1 (n_nodes; empty: none)
  std::vector<std::string> block_name;                         // (n_blocks)
  std::vector<Vec3> block_at;                                  // the point that is the body's own  (n_blocks x 3)  [m]
  std::string deck_scene;                                      // scene lines that the deck's loads and supports became ("" if none)

  std::int64_t n_nodes() const { return static_cast<std::int64_t>(X.size()); }
  std::int64_t n_cells() const { return static_cast<std::int64_t>(shape.size()); }
  std::span<const std::int64_t> cell(std::int64_t c) const {
    return {nodes.data() + offset[c], static_cast<size_t>(offset[c + 1] - offset[c])};
  }
  void add_cell(Shape s, std::span<const std::int64_t> cell_nodes, std::int32_t cell_region, std::int64_t id);
  std::vector<std::int64_t> facet_nodes(const Facet& f) const;
  /// The nodes of a region, node set, facet set or cell set of that name, sorted and unique; throws Error with a suggestion.
  /// `where` is what an error is reported at.
  std::vector<std::int64_t> nodes_of(const std::string& name, const std::string& where) const;
  int find_region(std::string_view name) const;  // -1 when there is none
  std::vector<std::string> all_names() const;    // regions and sets, for suggestions
};

/// Fidelity of a region, stored as this word in tags.h5.
enum class Fidelity : std::uint8_t { nonlinear = 0, rigid = 1, linear = 2 };
std::string_view word(Fidelity f);
/// Inverse of word(); throws Error at `where`.
Fidelity fidelity_of(std::string_view word, const std::string& where);

/// Mesh, tags and partition as one of mesh.h5, tags.h5, parts-N.h5 tells (each links to the one before).
struct MeshFile {
  Mesh mesh;
  std::vector<Fidelity> fidelity;  // per region; all nonlinear and `tagged` false for a bare mesh
  bool tagged = false;
  std::vector<std::int32_t> rank;  // part of each cell, empty for an unpartitioned mesh
  int n_parts = 1;
  std::vector<std::string> provenance;  // command lines so far
};
MeshFile read_mesh_file(const std::string& path);
void write_mesh(const std::string& path, const Mesh& mesh, const std::vector<std::string>& provenance);
/// `from` is the file read (mesh.h5), linked relatively, with its digest.
void write_tags(const std::string& path, const std::string& from, const std::vector<Fidelity>& fidelity,
                const std::vector<std::string>& provenance);
void write_parts(const std::string& path, const std::string& from, int n_parts, const std::vector<std::int32_t>& rank,
                 const std::vector<std::string>& provenance);

/// Volume (length for bars) of a cell by the isoparametric map, exact for straight-sided cells, and the smallest
/// Jacobian determinant over its corners divided by the largest (1 for a box, <= 0 inverted).
struct CellQuality {
  double volume;           // [m^3]
  double scaled_jacobian;  // [1]
};
CellQuality quality(const Mesh& mesh, std::int64_t cell);
/// Area vector of a facet, outward [m^2]; zero for the ends of a bar.
Vec3 facet_area(const Mesh& mesh, const Facet& f);

}  // namespace hilo
