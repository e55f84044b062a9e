// SPDX-License-Identifier: GPL-3.0-or-later
// The beams of a run: where their sections stand, what face they have, and the stress there by forces and moments.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "model/beam_line.hpp"
#include "physics/beam_section.hpp"
#include "post/run/run_file.hpp"

namespace hilo {

struct RunBeam {
  std::string name;
  BeamLine line;
  std::vector<std::string> on;  // what each section rides on: a body of its own, or what `a` and `b` name
  struct Section {
    std::optional<SectionFace> face = {};  // none: its numbers are all that is known of the section
    std::optional<SectionArea> area = {};  // none of a section that is given by its stiffness
    Vec3 radii = Vec3::Zero();             // of gyration about axes 1 and 2, and 0 [m]
  };
  std::vector<Section> sections;  // one, or those of a taper (n_cells + 1)
  bool bears = true;              // what it bears is in the run; a rigid beam's is not known
  const Section& section(size_t k) const { return sections[sections.size() > 1 ? k : 0]; }
  bool has_face() const { return sections.front().face.has_value(); }
  bool has_stress() const { return bears && has_face(); }
  bool has_outline() const { return has_face() && !sections.front().face->cells.empty(); }  // else points with stress alone, or none
  bool shows_stress() const { return bears && has_outline(); }
};
/// Of the scene that a run keeps.
std::vector<RunBeam> beams_of(const RunFile& run);

/// Forces and moments V1, V2, N, M1, M2, T at the first (0) or last (1) section of a cell.
Vec6 beam_forces(const Series& beam, size_t row, size_t cell, int end);

/// The history beam_stress.NAME: over the whole beam, then at both ends of each cell, the highest and the lowest axial stress and the
/// largest von Mises stress of the section [Pa].
Series described_beam_stress(const RunBeam& beam);
std::vector<double> beam_stress(const RunBeam& beam, const Series& forces);

}  // namespace hilo
