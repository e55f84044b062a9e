// SPDX-License-Identifier: GPL-3.0-or-later
// Where the sections of a beam stand, from its entry in the scene.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "model/scene.hpp"

namespace hilo {

struct BeamLine {
  struct Cell {
    Mat3 frame_a, frame_b;  // directors of its ends by columns
    double length = 0;      // of the chord [m]
  };
  std::vector<Vec3> at;     // sections                              (n_cells + 1)  [m]
  std::vector<Cell> cells;  // between one section and the next
  std::vector<double> s;    // way of the sections along the axis   (n_cells + 1)  [m]
  bool closed = false;      // the last section is the first
};

/// Legs through `points`, straight or arcs of circles, `cells` to each.  Errors at the keys.
BeamLine beam_line(const Entry& entry);

/// What the sections that are bodies of their own are called, NAME.0, NAME.1 ... NAME.end, and where they are on the line.
std::vector<std::pair<std::string, size_t>> section_names(const Entry& entry, const BeamLine& line);

}  // namespace hilo
