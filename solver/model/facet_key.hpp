// SPDX-License-Identifier: GPL-3.0-or-later
// What tells a facet of a mesh from all others: its three smallest corners.
#pragma once
#include <algorithm>
#include <array>
#include <limits>

#include "model/mesh.hpp"

namespace hilo {

/// The three smallest corners of a facet of a solid cell, ascending, by what `number` calls a node of the mesh.
template <class Number>
std::array<std::int64_t, 3> facet_key(const Mesh& mesh, const Facet& f, const Number& number) {
  const auto& local = info(mesh.shape[static_cast<size_t>(f.cell)]).facets[static_cast<size_t>(f.facet)];
  const auto cell = mesh.cell(f.cell);
  std::array<std::int64_t, 4> corner;
  corner.fill(std::numeric_limits<std::int64_t>::max());
  for (size_t k = 0; k < (local.size() % 3 == 0 ? 3 : 4); ++k) corner[k] = number(cell[static_cast<size_t>(local[k])]);
  std::sort(corner.begin(), corner.end());
  return {corner[0], corner[1], corner[2]};
}

}  // namespace hilo
