// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture shows: a field of the run as nodal numbers with a unit, or names of cells (region, fidelity, rank).
#pragma once
#include <string>
#include <vector>

#include "post/picture/colour.hpp"
#include "post/run/run_file.hpp"

namespace hilo {

/// `von_mises`, the size of `acceleration`, or one component: `acceleration.z`, `stress.xx`.
struct ShownField {
  std::string array;           // "acceleration"
  int component = -1;          // -1: the value, or the size of a vector
  std::string label, unit;     // "acceleration", "m/s^2"
  bool flexible_only = false;  // stress: rigid regions have none
  bool from_zero = true;       // never negative
};
/// Error (exit 2) with a suggestion for a name that no run can hold.
ShownField shown_field(const std::string& name, const std::vector<std::string>& known);
/// Names of the columns of an array that is shown a component at a time: stress and what shells bear; none of others.
std::vector<std::string> components_of(const std::string& array);
/// One number per row, in the stored unit: the component, or the size of a vector.  `path` is what an error names.
std::vector<double> reduced(RunFile::Field raw, const ShownField& field, const std::string& path);

/// Cells under names: one of the fields region, fidelity, partition.
bool is_named_field(const std::string& name);
struct NamedCells {
  std::vector<int> name_of;        // (n_cells)
  std::vector<std::string> names;  // of what is shown
  std::vector<Rgb> colours;
  std::string title;
};
NamedCells named_cells(const MeshFile& file, const std::string& field, const std::vector<bool>& shown, const std::string& path);

/// Regions to show: those that match one of `show` (all when empty) and none of `hide`.  A glob without a match is an Error.
std::vector<bool> shown_regions(const Mesh& mesh, const std::vector<std::string>& show, const std::vector<std::string>& hide);
Rgb fidelity_colour(Fidelity f);

}  // namespace hilo
