// SPDX-License-Identifier: GPL-3.0-or-later
// Shells and beams of a mesh: cells that there is no element of, in regions that can be rigid alone.  What a rigid region needs of them is
// their mass, which the mesh file has as moments of each region.
#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "base/math.hpp"
#include "base/shape.hpp"
#include "model/store.hpp"

namespace hilo {

/// Shapes of shells, numbered behind those of base/shape.hpp.
inline constexpr auto tri3 = static_cast<Shape>(8), tri6 = static_cast<Shape>(9), quad4 = static_cast<Shape>(10),
                      quad8 = static_cast<Shape>(11);

struct ThinRegion {
  std::array<double, 10> moments{};                             // V, int x y z, int xx yy zz yz xz xy, about the origin  [m^3, m^4, m^5]
  double thickness = std::numeric_limits<double>::quiet_NaN();  // of its shells  [m]
  double area = std::numeric_limits<double>::quiet_NaN();       // of its beams  [m^2]
  bool any() const { return moments[0] > 0; }                   // has shells or beams
  double volume() const { return moments[0]; }
  Vec3 first() const { return {moments[1], moments[2], moments[3]}; }
  Mat3 second() const;  // int x x^T
};

/// Those of the regions of a mesh file, or of the mesh that a tags or parts file links to; none where it has no shells and no beams.
std::vector<ThinRegion> read_thin_regions(const std::string& path);
void write_thin_regions(Store& mesh, const std::vector<ThinRegion>& regions);

}  // namespace hilo
