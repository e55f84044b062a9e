// SPDX-License-Identifier: GPL-3.0-or-later
// [[quantity]]: what a run is asked for, and how exactly.
#pragma once
#include <cmath>
#include <optional>

#include "model/scene.hpp"

namespace hilo {

std::vector<KindSchema> quantity_schema();

/// How far a quantity may be off: "2%" of it, or "50 N", "1.5 MPa" in any unit of its kind.
struct QuantityTolerance {
  double value = 0;  // a fraction where relative, else in the unit of the quantity
  bool relative = false;
  /// In the unit of a quantity of this value.
  double allowed(double x) const { return relative ? value * std::abs(x) : value; }
};
/// Error (at `where`) for what is no positive number with % or a unit of the kind of `unit`.  Accelerations in g are of the kind m/s^2.
QuantityTolerance parse_tolerance(const std::string& text, const std::string& unit, const std::string& where);

/// Whether a kind asks for a figure of a mode or of a shape that buckles, and not of a run in time.
bool is_of_shapes(const std::string& kind);
/// The unit of a quantity, from its keys alone: "N", "Pa", "g"; of an injury measure nothing.
std::optional<std::string> unit_of(const Entry& quantity);

/// Regions named by quantities of stress, against those of the mesh.
void check_quantity_regions(const Scene& scene, const std::vector<std::string>& regions);

}  // namespace hilo
