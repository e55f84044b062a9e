// SPDX-License-Identifier: GPL-3.0-or-later
// Hexahedra that a scene takes as solid-shells: which of their axes goes across the thickness.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>

#include "base/shell_shape.hpp"
#include "model/facet_key.hpp"
#include "model/region_surface.hpp"
#include "physics/shape/hex8.hpp"
#include "system/build/builder.hpp"

namespace hilo {
namespace {

/// Mean length of the four edges along each axis of a hexahedron.
std::array<double, 3> edge_lengths(const Mesh& mesh, std::int64_t c) {
  std::array<double, 3> length{};
  const auto nodes = mesh.cell(c);
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b)
      for (int r = 0; r < 3; ++r) {
        const int s = (r + 1) % 3, t = (r + 2) % 3;
        const double *p = hex_corner[a], *q = hex_corner[b];
        if (p[r] != q[r] && p[s] == q[s] && p[t] == q[t]) length[r] += (mesh.X[nodes[a]] - mesh.X[nodes[b]]).norm() / 4;
      }
  return length;
}

/// Lengths apart by more than this share are told apart.
constexpr double clear = 0.8;

/// A facet of a shell's cell, as ranks send it: three nodes, region, cell, whether the thickness goes through it, centre of the cell  [m]
using ShellFacet = std::array<double, 9>;

std::string text_of(const double* x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]); }

}  // namespace

/// The thickness goes along the shortest edges of a cell where these are clearly shorter than the others, else between the only two
/// opposite facets that no other cell of the region has; neighbours in a region must agree, on whichever rank they are.  Collective.
void Builder::find_shells() {
  if (!mesh_) return;
  const Mesh& mesh = mesh_->mesh;
  const auto is_shell = [&](std::int64_t c) {
    const Region& r = regions_[mesh.region[c]];
    return r.shell && r.fidelity != Fidelity::rigid;
  };
  comm_.together([&] {
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
      const Region& r = regions_[mesh.region[c]];
      if (r.fidelity != Fidelity::linear || !r.stiffening || !(r.shell || static_cast<Shape>(mesh.shape[c]) == shell8)) continue;
      std::string where;
      for (const Entry& e : scene_.entries("region"))
        if (e.given("stiffening") && fnmatch(e.name.c_str(), r.name.c_str(), 0) == 0) where = e.where("stiffening");
      throw Error(where, fmt::format("region \"{}\": shells have no strains of the second degree in modes", r.name),
                  "leave out stiffening, or tag the region nonlinear");
    }
  });
  if (!std::any_of(regions_.begin(), regions_.end(), [](const Region& r) { return r.shell && r.fidelity != Fidelity::rigid; })) return;
  shell_axis_.assign(static_cast<size_t>(mesh.n_cells()), 0);
  std::vector<unsigned> free(shell_axis_.size(), 0);
  for (const Facet& f : region_surface(*mesh_, comm_)) free[static_cast<size_t>(f.cell)] |= 1U << f.facet;
  const auto refuse_in = [&](std::int64_t region, const std::string& why, const char* hint) {
    const auto r = static_cast<size_t>(region);
    throw Error(regions_[r].shell_where, fmt::format("region \"{}\": {}", mesh.region_name[r], why), hint);
  };
  const auto centre = [&](std::int64_t c) {
    Vec3 x = Vec3::Zero();
    for (const std::int64_t i : mesh.cell(c)) x += mesh.X[i] / static_cast<double>(mesh.cell(c).size());
    return x;
  };
  std::vector<std::vector<double>> sides(static_cast<size_t>(comm_.size));  // to the rank of the smallest node
  comm_.together([&] {
    const auto refuse = [&](std::int64_t c, const std::string& why, const char* hint) { refuse_in(mesh.region[c], why, hint); };
    const auto place = [&](std::int64_t c) { return text_of(centre(c).data()); };
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
      if (!is_shell(c)) continue;
      const auto shape = static_cast<Shape>(mesh.shape[c]);
      const auto at = static_cast<size_t>(c);
      if (shape == shell8) {
        shell_axis_[at] = 3;
      } else if (shape != Shape::hex8) {
        refuse(c, fmt::format("shells are of hex8, and it has {}", info(shape).name),
               "hexahedra of one or more layers: hilo-import --order 1");
      } else {
        const auto length = edge_lengths(mesh, c);
        std::array<int, 3> order{0, 1, 2};
        std::sort(order.begin(), order.end(), [&](int a, int b) { return length[a] < length[b]; });
        int axis = length[order[0]] <= clear * length[order[1]] ? order[0] : -1, open = -1, n_open = 0;
        for (int r = 0; r < 3; ++r)
          if ((free[at] >> (2 * r) & 3U) == 3U) open = r, ++n_open;
        if (n_open == 1 && axis >= 0 && axis != open)
          refuse(c,
                 fmt::format("the thickness of the cell at {} is not clear: it is {:.3g} long between its only two outer faces that are "
                             "opposite, and {:.3g} along its shortest edges",
                             place(c), length[open], length[axis]),
                 "cells longer than the shell is thick");
        if (axis < 0 && n_open == 1 && clear * length[open] <= length[order[0]]) axis = open;
        if (axis < 0)
          refuse(c,
                 fmt::format("the thickness of the cell at {} is not clear: its edges are {:.3g}, {:.3g} and {:.3g} long", place(c),
                             length[0], length[1], length[2]),
                 "cells clearly longer than thick, or one layer of them");
        shell_axis_[at] = static_cast<char>(1 + axis);
      }
      const Vec3 x = centre(c);
      for (int f = 0; f < 6; ++f) {
        if (free[at] >> f & 1U) continue;
        const auto n = facet_key(mesh, {c, f}, [&](std::int64_t i) { return mesh_->node_global[i]; });
        const double across = f / 2 == shell_axis_[at] - 1 ? 1 : 0, region = mesh.region[c];
        const auto number = [](std::int64_t i) { return static_cast<double>(i); };
        const ShellFacet side{number(n[0]), number(n[1]), number(n[2]), region, number(mesh_->cell_global[c]), across, x[0], x[1], x[2]};
        auto& to = sides[static_cast<size_t>(n[0] % comm_.size)];
        to.insert(to.end(), side.begin(), side.end());
      }
    }
  });
  const auto received = comm_.exchange(sides);
  comm_.together([&] {
    std::vector<ShellFacet> all;
    for (const auto& from : received)
      for (size_t i = 0; i < from.size(); i += 9) std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(i), 9, all.emplace_back().begin());
    std::sort(all.begin(), all.end());
    for (size_t i = 1; i < all.size(); ++i) {
      const ShellFacet &a = all[i - 1], &b = all[i];
      if (std::equal(a.begin(), a.begin() + 4, b.begin()) && a[5] != b[5])
        refuse_in(static_cast<std::int64_t>(b[3]),
                  fmt::format("the thickness turns between the neighbouring cells at {} and {}", text_of(&a[6]), text_of(&b[6])),
                  "regions of their own for plates that meet");
    }
  });
}

Shape Builder::taken_as(std::int64_t cell, std::vector<std::int64_t>& nodes) const {
  const Mesh& mesh = mesh_->mesh;
  const auto own = mesh.cell(cell);
  nodes.assign(own.begin(), own.end());
  const int axis = shell_axis_.empty() ? 0 : shell_axis_[static_cast<size_t>(cell)];
  if (axis == 0) return static_cast<Shape>(mesh.shape[cell]);
  const auto corner = [](const std::array<double, 3>& x) {
    for (int a = 0; a < 8; ++a)
      if (std::equal(x.begin(), x.end(), hex_corner[a])) return a;
    return -1;
  };
  for (int a = 0; a < 8; ++a) {  // its third axis is that one, and it is no mirror
    std::array<double, 3> x{};
    for (int r = 0; r < 3; ++r) x[(axis + r) % 3] = hex_corner[a][r];
    nodes[a] = own[corner(x)];
  }
  return shell8;
}

}  // namespace hilo
