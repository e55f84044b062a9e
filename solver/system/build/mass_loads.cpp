// SPDX-License-Identifier: GPL-3.0-or-later
// Loads on mass: what cells weigh under an acceleration.
#include <fmt/format.h>

#include <array>

#include "physics/solid_kernel.hpp"
#include "system/build/builder.hpp"
#include "system/loads.hpp"

namespace hilo {

/// By the mass rule of the cells, each of them of its own density.
std::map<int, Vec3> Builder::forces_of_mass(const std::vector<std::int64_t>& cells, const std::function<double(const Region&)>& density,
                                            const std::function<Vec3(const Vec3&)>& acceleration) const {
  const Mesh& mesh = mesh_->mesh;
  std::map<int, Vec3> force;
  const StVenantKirchhoff no_matter{{1, 1}};  // the mass alone is asked for
  struct alignas(64) Line {
    double value[8];
  };
  std::vector<Line> scratch;
  for (const std::int64_t c : cells) {
    const Region& r = regions_[mesh.region[c]];
    if (info(mesh.shape[c]).dimension == 2) continue;  // has none as a cell
    const auto nodes = mesh.cell(c);
    const SolidKernel kernel = solid_kernel(static_cast<Shape>(mesh.shape[c]), place_of<StVenantKirchhoff>);
    const int n3 = 3 * static_cast<int>(nodes.size()), w = std::min(lanes(), kernel.width);
    scratch.resize(9 * nodes.size());
    double *X = scratch[0].value, *a = scratch[n3].value, *f = scratch[2 * static_cast<size_t>(n3)].value;
    for (int i = 0; i < n3; ++i)
      for (int l = 0; l < w; ++l)
        X[i * w + l] = mesh.X[nodes[i / 3]][i % 3] - origin_[i % 3], a[i * w + l] = acceleration(mesh.X[nodes[i / 3]])[i % 3];
    kernel.call({X, X, X, 0, 0, &no_matter, f, nullptr, nullptr, nullptr, nullptr, density(r), a, 0, r.area});
    for (int i = 0; i < n3; i += 3)
      force.try_emplace(static_cast<int>(nodes[i / 3]), Vec3::Zero()).first->second += Vec3(f[i * w], f[(i + 1) * w], f[(i + 2) * w]);
  }
  return force;
}

std::vector<std::int64_t> Builder::cells_of(int region) const {
  std::vector<std::int64_t> cells;
  for (std::int64_t c = 0; c < mesh_->mesh.n_cells(); ++c)
    if (mesh_->mesh.region[c] == region) cells.push_back(c);
  return cells;
}

std::map<int, Vec3> Builder::forces_of_mass(const Entry& e, const std::function<Vec3(const Vec3&)>& acceleration) const {
  const std::string where = e.where("on"), &on = e.text("on");
  if (!mesh_) throw Error(where, fmt::format("{}: the scene has no mesh", e.label()), "name a body");
  const int region = mesh_->mesh.find_region(on);
  const auto set = mesh_->mesh.cell_sets.find(on);
  if (region < 0 && set == mesh_->mesh.cell_sets.end())
    throw Error(where, fmt::format("{}: \"{}\" is no region and no set of cells", e.label(), on), "mass is in cells");
  const std::vector<std::int64_t> cells = region >= 0 ? cells_of(region) : set->second;
  std::map<int, Vec3> force;
  comm_.together([&] {
    force = forces_of_mass(
        cells,
        [&](const Region& r) {
          if (r.density > 0) return r.density;
          throw Error(where, fmt::format("{}: region \"{}\" has no density", e.label(), r.name), "give its material a density");
        },
        acceleration);
  });
  return force;
}

/// Forces along one axis and of one sign have one resultant, at their centre, however the body turns.
std::vector<Load> Builder::take_rigid_share(std::map<int, Vec3>& force, const Load& like) const {
  std::map<std::array<int, 3>, Eigen::Vector4d> sums;  // by body, axis and sign: of force times position, and of forces
  std::erase_if(force, [&](const auto& at) {
    const auto& [node, f] = at;
    const int body = out_->follower[node];
    if (body < 0 || out_->bodies[body].linear) return false;
    for (int k = 0; k < 3; ++k)
      sums.try_emplace({body, k, f[k] < 0}, Eigen::Vector4d::Zero()).first->second += f[k] * out_->X[node].homogeneous();
    return true;
  });
  std::vector<Load> loads;
  for (const auto& [of, sum] : sum_over_ranks(sums)) {
    if (sum[3] == 0) continue;
    Load one = like;
    one.kind = Load::Kind::body_force, one.body = of[0];
    one.value = sum[3] * Vec3::Unit(of[1]);
    one.arm = sum.hnormalized() - out_->bodies[of[0]].Xc;
    loads.push_back(std::move(one));
  }
  return loads;
}

std::vector<std::pair<int, double>> Builder::shares_of(const Found& found) const {
  std::vector<std::pair<int, double>> shares;
  double sum = 0;
  if (found.is_region)
    for (const auto& [node, force] : forces_of_mass(
             cells_of(found.region), [](const Region&) { return 1.0; }, [](const Vec3&) { return Vec3(Vec3::UnitX()); }))
      shares.emplace_back(node, force[0]), sum += force[0];
  sum = comm_.sum(sum);
  if (sum > 0) {
    for (auto& [node, share] : shares) share /= sum;
    return shares;
  }
  shares.clear();  // a set, or a region of cells without a volume
  for (const int i : found.nodes)
    if (out_->node_owned[i]) shares.emplace_back(i, 1 / static_cast<double>(found.n_global));
  return shares;
}

/// Between mid-side nodes corners have less than nothing of a load.  The former give theirs to the corners at both sides: along straight
/// edges no centre moves.
std::vector<std::pair<int, double>> Builder::positive_shares_of(const Found& found) const {
  const auto shares = shares_of(found);
  double least = 0;
  for (const auto& [node, share] : shares) least = std::min(least, share);
  if (!found.is_region || comm_.max(-least) <= 0) return shares;
  std::map<int, double> all(shares.begin(), shares.end());
  const Mesh& mesh = mesh_->mesh;
  for (const std::int64_t c : cells_of(found.region)) {
    const ShapeInfo& shape = info(mesh.shape[c]);
    for (size_t k = 0; shape.n_nodes > shape.n_corners && k < shape.facets.size(); ++k) {
      const auto nodes = mesh.facet_nodes({c, static_cast<std::int64_t>(k)});
      const size_t n = nodes.size() / 2;
      for (size_t i = 0; i < n; ++i)
        if (const auto mid = all.find(static_cast<int>(nodes[n + i])); mid != all.end()) {
          const double half = mid->second / 2;
          all.erase(mid);
          all[static_cast<int>(nodes[i])] += half, all[static_cast<int>(nodes[(i + 1) % n])] += half;
        }
    }
  }
  return {all.begin(), all.end()};
}

Vec3 Builder::centre_of(const std::vector<std::pair<int, double>>& shares) const {
  Vec3 centre = Vec3::Zero();
  for (const auto& [node, share] : shares) centre += share * out_->X[node];
  comm_.sum(std::span<double>(centre.data(), 3));
  return centre;
}

}  // namespace hilo
