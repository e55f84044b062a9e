// SPDX-License-Identifier: GPL-3.0-or-later
// The outside of a mesh as VTK draws it: built once, then only its points, normals and values move.
#pragma once
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <span>
#include <vector>

#include "model/mesh.hpp"
#include "post/surface/cut.hpp"

namespace hilo {

/// Facets of the shown cells that no other shown cell shares.  `shown` is per region.
std::vector<Facet> boundary_facets(const Mesh& mesh, const std::vector<bool>& shown);

/// Drawn faces of a set of facets and of bars.  Facets with mid-side nodes are divided four by four with their own shape functions.  A
/// point is drawn once for each smooth patch around it, so that edges sharper than 40 degrees stay sharp and the rest is shaded smoothly.
class Skin {
 public:
  /// What `cut` takes away is left out, and the section through `cells` closes the rest.
  Skin(const Mesh& mesh, std::span<const Facet> facets, std::span<const std::int64_t> bars = {}, const Plane* cut = nullptr,
       std::span<const std::int64_t> cells = {});

  /// Move to nodal positions x.
  void move(const std::vector<Vec3>& x);
  /// Nodal values, interpolated with the shape functions.
  void set_values(const std::vector<double>& value);
  /// Colours of cells, for names (region, fidelity, rank); (n_cells) of the mesh.
  void set_cell_colours(const std::vector<std::array<std::uint8_t, 3>>& colour);

  vtkPolyData* faces() const { return faces_; }
  vtkPolyData* bars() const { return bars_; }
  vtkPolyData* feature_edges() const { return feature_; }  // sharp edges, borders, and edges between regions
  vtkPolyData* cell_edges() const { return grid_; }        // borders of all facets
  double mean_edge() const { return mean_edge_; }          // mean length of those at the start  [m]
  bool empty() const { return face_cell_.empty() && bar_cell_.empty(); }

 private:
  // A drawn point is a fixed combination of nodes.
  std::vector<std::int64_t> first_;  // first entry in node_, weight_   (n_points + 1)
  std::vector<std::int64_t> node_;
  std::vector<double> weight_;
  std::vector<std::int64_t> point_;                 // point of each drawn vertex      (n_vertices)
  std::vector<std::int64_t> corner_, polygon_{0};   // vertices of the polygons and where each begins
  std::vector<std::int64_t> face_cell_, bar_cell_;  // cell of each polygon and bar
  double mean_edge_ = 0;
  vtkSmartPointer<vtkPolyData> faces_, bars_, feature_, grid_;
};

}  // namespace hilo
