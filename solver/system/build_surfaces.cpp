// SPDX-License-Identifier: GPL-3.0-or-later
// [[contact]] entries of two surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "model/region_surface.hpp"
#include "physics/coordinates.hpp"
#include "system/builder.hpp"
#include "system/contacts.hpp"

namespace hilo {

std::vector<Facet> Builder::facets_of(const Entry& e, std::string_view key) {
  const std::string& name = e.text(key);
  const std::string where = e.where(key);
  const Found found = find(name, where);
  if (!mesh_ || found.n_global == 0)
    throw Error(where, fmt::format("{}: \"{}\" has no surface", e.label(), name),
                "put an [[obstacle]] of kind sphere or box on it, and name that");
  const Mesh& mesh = mesh_->mesh;
  std::vector<Facet> facets;
  if (const auto set = mesh.facet_sets.find(name); set != mesh.facet_sets.end()) {
    facets = set->second;
  } else if (found.is_region) {
    for (const Facet& f : outer_surface(*mesh_, comm_))
      if (mesh.region[f.cell] == found.region) facets.push_back(f);
  } else {
    throw Error(where, fmt::format("{}: \"{}\" is not a region or a set of facets", e.label(), name), "name a 2-D group or *SURFACE");
  }
  std::erase_if(facets, [&](const Facet& f) { return info(mesh.shape[f.cell]).dimension != 3; });
  const auto place = [](const Facet& f) { return std::pair(f.cell, f.facet); };
  std::ranges::sort(facets, {}, place);
  facets.erase(std::ranges::unique(facets, {}, place).begin(), facets.end());
  return facets;
}

void Builder::add_surfaces(const Entry& e, const std::vector<std::string>& obstacles) {
  const std::string& name_a = e.text("a");
  if (!mesh_ || (mesh_->mesh.find_region(name_a) < 0 && !mesh_->mesh.facet_sets.contains(name_a)))
    throw Error(e.where("a"), fmt::format("{}: no obstacle{} \"{}\"", e.label(), mesh_ ? ", region or set of facets" : "", name_a),
                suggest(name_a, obstacles));
  if (std::find(obstacles.begin(), obstacles.end(), e.text("b")) != obstacles.end()) e.refuse("b", "it is an obstacle: name it as a");
  if (name_a == e.text("b")) e.refuse("b", "a surface does not meet itself");
  if (e.has("stiffness"))
    e.refuse("stiffness", "the stiffness of a surface comes from its region", "scale it by factor, or give rigid ones modulus and layer");
  SurfacePair pair(*out_);
  pair.name = e.name, pair.is_static = is_static(), pair.loses = e.number("restitution") < 1;
  const std::array<std::vector<PairFacet>, 2> facets{on_first_rank(facets_of(e, "a")), on_first_rank(facets_of(e, "b"))};
  comm_.on_first([&] { fill_surfaces(e, facets, pair); });
  out_->part<Contacts>().surfaces.push_back(std::move(pair));
}

/// What rank 0 has of a pair: all of it.
void Builder::fill_surfaces(const Entry& e, const std::array<std::vector<PairFacet>, 2>& facets, SurfacePair& pair) {
  const std::string& name_a = e.text("a");
  const Mesh& mesh = mesh_->mesh;
  struct Behind {                 // a facet
    double compliance, nu, cell;  // l/E [m/Pa]; 0: rigid
  };
  std::vector<Behind> behind[2];
  double mean[2] = {0, 0}, area[2] = {0, 0};  // compliance, over the area
  std::map<int, double> modulus;              // of regions
  std::set<int> bodies[2];                    // -1: nodes of their own
  std::vector<int> nodes[2];
  bool rigid[2] = {false, false}, held = true;
  for (int s = 0; s < 2; ++s) {
    const std::string_view key = s == 0 ? "a" : "b";
    for (const PairFacet& f : facets[s]) {
      const Region& region = regions_[f.region];
      Behind& its = behind[s].emplace_back(Behind{0, std::isnan(region.nu) ? 0.3 : region.nu, f.depth});
      if (region.fidelity == Fidelity::rigid) {
        rigid[s] = true;
      } else {
        if (!modulus.contains(f.region)) modulus[f.region] = young_of(linear_moduli(material_of(region)));
        its.compliance = f.depth / modulus[f.region];
      }
      mean[s] += f.area * its.compliance, area[s] += f.area;
      ContactSurface::Face& face = pair.side[s].faces.emplace_back();
      face.n = f.n, face.node = f.node;
      for (int a = 0; a < face.n; ++a) {
        const int i = face.node[a];
        nodes[s].push_back(i);
        const int body = out_->follower[i];
        bodies[s].insert(body);
        const auto& fixed = out_->fixed[i];
        held = held && (body >= 0 ? body == 0 || !out_->bodies[body].free() : fixed[0] && fixed[1] && fixed[2]);
      }
    }
    if (pair.side[s].faces.empty()) throw Error(e.where(key), fmt::format("{}: \"{}\" has no surface", e.label(), e.text(key)));
    mean[s] /= area[s];
    std::sort(nodes[s].begin(), nodes[s].end());
  }
  if (held) throw Error(e.place.text(), fmt::format("{}: both sides are held", e.label()));
  std::vector<int> both;
  std::set_intersection(nodes[0].begin(), nodes[0].end(), nodes[1].begin(), nodes[1].end(), std::back_inserter(both));
  if (!both.empty())
    e.refuse("b", fmt::format("both surfaces have node {}: what hangs together does not meet", mesh.node_id[both.front()]),
             "name the facets that can meet as two sets");
  if (bodies[0].size() == 1 && bodies[0] == bodies[1] && *bodies[0].begin() >= 0) e.refuse("b", "both are on the same body");
  const bool both_rigid = rigid[0] && rigid[1];
  if (both_rigid && (!e.has("layer") || !e.has("modulus")))
    e.refuse("", "both surfaces have rigid regions: nothing says how stiff they are",
             "give modulus and layer, or tag one linear or nonlinear");
  for (const char* key : {"layer", "modulus"})
    if (!both_rigid && e.has(key)) e.refuse(key, "a surface that can bend has its stiffness from its material");
  const double factor = e.given("factor")               ? e.number("factor")
                        : pair.is_static && !both_rigid ? static_factor
                                                        : 1,
               layer = both_rigid ? e.number("layer") / e.number("modulus") : 0;
  pair.factor = factor;
  const double loss = hunt_crossley(e.number("restitution"));
  double low = 1e300, high = 0;
  for (int s = 0; s < 2; ++s)
    for (size_t f = 0; f < behind[s].size(); ++f) {
      ContactSurface::Face& face = pair.side[s].faces[f];
      const Behind& its = behind[s][f];
      const double series = its.compliance + mean[1 - s], k = factor / (series > 0 ? series : layer);
      low = std::min(low, k), high = std::max(high, k);
      std::vector<Vec3> X;
      for (int a = 0; a < face.n; ++a) X.push_back(mesh.X[face.node[a]]);
      const FacetPoints at = facet_points(X, pair.is_static ? 4 : face.n > 4 ? 3 : 2);
      face.first = static_cast<int>(pair.side[s].points.size()), face.n_points = static_cast<int>(at.area.size());
      for (size_t j = 0; j < at.area.size(); ++j) {
        SurfacePoint point;
        point.face = static_cast<int>(f);
        std::copy(at.share[j].begin(), at.share[j].end(), point.share.begin());
        point.area = at.area[j];
        point.law.k = k * at.area[j] / 2, point.law.kt = tangential_ratio(its.nu) * point.law.k, point.law.friction = e.number("friction");
        point.law.loss = loss, point.law.slow = e.number("rest_speed");
        point.cell = both_rigid ? std::min(its.cell, e.number("layer")) : its.cell;
        pair.side[s].points.push_back(point);
      }
    }
  pair.told =
      fmt::format("{} Pa/m: {}{}", high <= low * (1 + 1e-3) ? fmt::format("{:.4g}", high) : fmt::format("{:.4g} to {:.4g}", low, high),
                  factor == 1 ? "" : fmt::format("{:g} times ", factor),
                  both_rigid ? fmt::format("{:.4g} Pa over a layer of {} m", e.number("modulus"), e.number("layer"))
                             : "E over the depth of the cells, both sides in series");
  pair.prepare();
  const auto deep = pair.deepest_start(out_->start);
  for (int s = 0; s < 2 && !deep; ++s)
    if (const auto at = pair.starts_inside(s, out_->start))
      throw Error(e.place.text(),
                  fmt::format("{}: \"{}\" starts inside \"{}\", at ({:.4g}, {:.4g}, {:.4g})", e.label(), s == 0 ? name_a : e.text("b"),
                              s == 0 ? e.text("b") : name_a, (*at)[0], (*at)[1], (*at)[2]),
                  "move one of them out of the other: what meets faces each other's outer sides");
  if (deep) {
    const std::string text = fmt::format("{}: \"{}\" and \"{}\" start {:.3g} m deep in each other, at ({:.4g}, {:.4g}, {:.4g})", e.label(),
                                         name_a, e.text("b"), deep->depth, deep->at[0], deep->at[1], deep->at[2]);
    if (deep->depth > deep->cell) throw Error(e.place.text(), fmt::format("{}: more than a cell", text), "move one of them apart");
    if (deep->depth > 0.01 * deep->cell)
      warn(e.place.text(),
           fmt::format("{}; {}", text,
                       pair.is_static ? "the first load step presses them apart" : "they begin without force, which comes as they slide"));
  }
}

}  // namespace hilo
