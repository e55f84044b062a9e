// SPDX-License-Identifier: GPL-3.0-or-later
// Unknowns of a model before and after its regions are tagged.
#pragma once
#include <optional>
#include <vector>

#include "base/table.hpp"
#include "model/mesh.hpp"
#include "model/thin_regions.hpp"

namespace hilo {

/// 3 unknowns for each free node, 6 for each rigid body and linear region, whose modes are found by the run.  A node counts in the first
/// region that has it.
struct Savings {
  Table regions;  // region, cells, nodes, fidelity, body, before, after
  std::int64_t before = 0, after = 0;
  int bodies = 0, linear = 0;
};
Savings savings(const Mesh& mesh, const std::vector<Fidelity>& fidelity);
std::string savings_text(const Savings& s);
std::string savings_json(const Savings& s, const std::string& output);

/// Untagged regions are nonlinear, and that is said on stderr; those of shells and beams are rigid, and anything else of them is an Error.
std::vector<Fidelity> all_tagged(const Mesh& mesh, const std::vector<ThinRegion>& thin_regions,
                                 const std::vector<std::optional<Fidelity>>& tags);

}  // namespace hilo
