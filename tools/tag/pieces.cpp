// SPDX-License-Identifier: GPL-3.0-or-later
#include "tag/pieces.hpp"

#include <fmt/format.h>

#include <set>

#include "model/mesh_pieces.hpp"

namespace hilo {

std::vector<std::string> loose_pieces(const Mesh& mesh, const std::vector<Fidelity>& fidelity) {
  const auto piece = pieces_of(mesh);
  std::vector<std::set<std::int64_t>> pieces(mesh.region_name.size());
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    if (fidelity[mesh.region[c]] != Fidelity::rigid) pieces[mesh.region[c]].insert(piece[mesh.cell(c)[0]]);
  std::vector<std::string> out;
  for (size_t r = 0; r < pieces.size(); ++r)
    if (pieces[r].size() > 1)
      out.push_back(
          fmt::format("region \"{}\" is {} and in {} pieces that share no node: each moves by itself (hilo-import --merge-nodes, or a "
                      "geometry that joins them; rigid holds them together)",
                      mesh.region_name[r], word(fidelity[r]), pieces[r].size()));
  return out;
}

}  // namespace hilo
