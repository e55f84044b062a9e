// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth faces of a mesh under numbers: a list to look up what a set or a joint needs of them, and where the numbers stand in a picture.
#pragma once
#include <optional>
#include <vector>

#include "base/table.hpp"
#include "model/smooth_faces.hpp"
#include "post/picture/picture.hpp"

class vtkCamera;

namespace hilo {

struct NumberedFace {
  std::int32_t region;
  std::vector<SurfaceFacet> facets;
  FaceShape shape;
};

/// Faces of the facets `outside`, region by region; those turn by less than `angle` [rad] from facet to facet.
std::vector<NumberedFace> numbered_faces(const Mesh& mesh, const std::vector<Facet>& outside, double angle);

/// Number, region, shape, area, a point for [set.NAME] kind = "near"; middle, axis, radius and length for a joint there.
Table table_of_faces(const Mesh& mesh, const std::vector<NumberedFace>& faces);

/// Where the number of each face stands: the middle of a facet that the camera sees; nothing where it sees none.
std::vector<std::optional<Vec3>> places_of_numbers(const std::vector<NumberedFace>& faces, vtkCamera* camera);

/// Places of labels in a picture, moved until each pair is `apart` [pixels], and within the box.  Labels that
/// collide with none stay.  Where there is no room for all some overlap still.
std::vector<Vec2> spread_labels(std::vector<Vec2> at, double apart, const Box& within);

}  // namespace hilo
