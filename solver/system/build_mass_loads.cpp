// SPDX-License-Identifier: GPL-3.0-or-later
// Loads on mass: what cells weigh under an acceleration.
#include <fmt/format.h>

#include "physics/solid_kernel.hpp"
#include "system/builder.hpp"

namespace hilo {

/// By the mass rule of the cells.
std::map<int, Vec3> Builder::forces_of_mass(const Entry& e, const std::function<Vec3(const Vec3&)>& acceleration) const {
  const std::string where = e.where("on"), &on = e.text("on");
  if (!mesh_) throw Error(where, fmt::format("{}: the scene has no mesh", e.label()), "name a body");
  const Mesh& mesh = mesh_->mesh;
  const int region = mesh.find_region(on);
  const auto set = mesh.cell_sets.find(on);
  if (region < 0 && set == mesh.cell_sets.end())
    throw Error(where, fmt::format("{}: \"{}\" is no region and no set of cells", e.label(), on), "mass is in cells");
  std::vector<std::int64_t> cells;
  for (std::int64_t c = 0; region >= 0 && c < mesh.n_cells(); ++c)
    if (mesh.region[c] == region) cells.push_back(c);
  if (region < 0) cells = set->second;
  std::map<int, Vec3> force;
  const StVenantKirchhoff no_matter{{1, 1}};  // the mass alone is asked for
  struct alignas(64) Line {
    double value[8];
  };
  std::vector<Line> scratch;
  comm_.together([&] {
    for (const std::int64_t c : cells) {
      const Region& r = regions_[mesh.region[c]];
      if (r.fidelity != Fidelity::nonlinear)
        throw Error(where, fmt::format("{}: region \"{}\" is {}", e.label(), r.name, r.fidelity == Fidelity::rigid ? "rigid" : "linear"),
                    fmt::format("tag it nonlinear: hilo-tag --nonlinear '{}'", r.name));
      if (!(r.density > 0))
        throw Error(where, fmt::format("{}: region \"{}\" has no density", e.label(), r.name), "give its material a density");
      if (info(mesh.shape[c]).dimension == 2) continue;  // has none as a cell
      const auto nodes = mesh.cell(c);
      const SolidKernel kernel = solid_kernel(static_cast<Shape>(mesh.shape[c]), place_of<StVenantKirchhoff>);
      const int n3 = 3 * static_cast<int>(nodes.size()), w = std::min(lanes(), kernel.width);
      scratch.resize(9 * nodes.size());
      double *X = scratch[0].value, *a = scratch[n3].value, *f = scratch[2 * static_cast<size_t>(n3)].value;
      for (int i = 0; i < n3; ++i)
        for (int l = 0; l < w; ++l)
          X[i * w + l] = mesh.X[nodes[i / 3]][i % 3] - origin_[i % 3], a[i * w + l] = acceleration(mesh.X[nodes[i / 3]])[i % 3];
      kernel.call({X, X, X, 0, 0, &no_matter, f, nullptr, nullptr, nullptr, nullptr, r.density, a, 0, r.area});
      for (int i = 0; i < n3; i += 3)
        force.try_emplace(static_cast<int>(nodes[i / 3]), Vec3::Zero()).first->second += Vec3(f[i * w], f[(i + 1) * w], f[(i + 2) * w]);
    }
  });
  return force;
}

}  // namespace hilo
