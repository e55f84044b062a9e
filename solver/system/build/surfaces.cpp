// SPDX-License-Identifier: GPL-3.0-or-later
// [[contact]] entries of two surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "model/region_surface.hpp"
#include "physics/coordinates.hpp"
#include "system/build/builder.hpp"
#include "system/contact/contacts.hpp"

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
  if (e.has("stiffness"))
    e.refuse("stiffness", "the stiffness of a surface comes from its region", "scale it by factor, or give rigid ones modulus and layer");
  SurfacePair pair(*out_);
  pair.name = e.name, pair.is_static = is_static(), pair.loses = e.number("restitution") < 1;
  pair.itself = name_a == e.text("b");
  std::array<std::vector<PairFacet>, 2> facets{on_first_rank(facets_of(e, "a"))};
  if (!pair.itself) facets[1] = on_first_rank(facets_of(e, "b"));
  comm_.on_first([&] { fill_surfaces(e, facets, pair); });
  out_->part<Contacts>().surfaces.push_back(std::move(pair));
}

namespace {

/// A facet that both have.
bool have_one_in_common(const std::array<std::vector<PairFacet>, 2>& facets) {
  std::set<std::set<int>> of_a;
  const auto key = [](const PairFacet& f) {
    std::set<int> nodes(f.node.begin(), f.node.begin() + f.n);
    nodes.insert(-1 - f.region);
    return nodes;
  };
  for (const PairFacet& f : facets[0]) of_a.insert(key(f));
  return std::ranges::any_of(facets[1], [&](const PairFacet& f) { return of_a.contains(key(f)); });
}

}  // namespace

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
  std::string bends[2];  // a region that does
  const int n_sides = pair.itself ? 1 : 2;
  for (int s = 0; s < n_sides; ++s) {
    const std::string_view key = s == 0 ? "a" : "b";
    for (const PairFacet& f : facets[s]) {
      const Region& region = regions_[f.region];
      Behind& its = behind[s].emplace_back(Behind{0, std::isnan(region.nu) ? 0.3 : region.nu, f.depth});
      if (region.fidelity == Fidelity::rigid) {
        rigid[s] = true;
      } else {
        if (!modulus.contains(f.region)) modulus[f.region] = young_of(linear_moduli(material_of(region)));
        its.compliance = f.depth / modulus[f.region], bends[s] = region.name;
      }
      mean[s] += f.area * its.compliance, area[s] += f.area;
      ContactSurface::Face& face = pair.side[s].faces.emplace_back();
      face.n = f.n, face.node = f.node, face.joint = f.node, face.cell = f.depth;
      if (!mesh.block_name.empty())
        for (int a = 0; a < face.n; ++a)
          if (const std::int64_t block = mesh.block[f.node[a]]; block >= 0) face.joint[a] = -1 - static_cast<int>(block);
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
  if (held) throw Error(e.place.text(), fmt::format("{}: {}", e.label(), pair.itself ? "it is held" : "both sides are held"));
  if (pair.itself) {
    if (rigid[0])
      e.refuse("a", fmt::format("\"{}\" is rigid, or has rigid regions: what is rigid does not meet itself", name_a),
               "name a surface that can bend");
    bodies[1] = bodies[0], nodes[1] = nodes[0], mean[1] = mean[0];
    pair.side[1].faces = pair.side[0].faces;
  }
  const bool on_one = bodies[0].size() == 1 && bodies[0] == bodies[1] && *bodies[0].begin() >= 0;
  if (on_one && out_->modes_of[*bodies[0].begin()] < 0) e.refuse("b", "both are on the same body");
  std::vector<int> both;
  std::ranges::set_intersection(nodes[0], nodes[1], std::back_inserter(both));
  pair.hangs = on_one || !both.empty();
  if (!pair.itself && pair.hangs && have_one_in_common(facets))
    e.refuse("b", "both surfaces have facets in common, which would meet twice", "name one set as a and b, or two without common facets");
  const bool both_rigid = rigid[0] && rigid[1];
  if (both_rigid && (!e.has("layer") || !e.has("modulus")))
    e.refuse("", "both surfaces have rigid regions: nothing says how stiff they are",
             "give modulus and layer, or tag one linear or nonlinear");
  for (const char* key : {"layer", "modulus"})
    if (!both_rigid && e.has(key))
      e.refuse(key, fmt::format("region \"{}\" is not rigid: its stiffness comes from its material", bends[rigid[0] ? 1 : 0]));
  const double factor = e.given("factor")               ? e.number("factor")
                        : pair.is_static && !both_rigid ? static_factor
                                                        : 1,
               layer = both_rigid ? e.number("layer") / e.number("modulus") : 0;
  pair.factor = factor;
  const ImpactLoss loss(e.number("restitution"));
  double low = 1e300, high = 0;
  for (int s = 0; s < n_sides; ++s)
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
  const auto told_at = [](const Vec3& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]); };
  if (pair.hangs) {
    auto at = pair.starts_inside_itself(out_->start);
    if (!at) at = pair.starts_crossed(out_->start);
    if (at)
      throw Error(e.place.text(),
                  pair.itself
                      ? fmt::format("{}: \"{}\" starts inside itself, at {}", e.label(), name_a, told_at(*at))
                      : fmt::format("{}: \"{}\" and \"{}\" start in each other, at {}", e.label(), name_a, e.text("b"), told_at(*at)),
                  "move what can meet apart, or name the facets that can meet as a set");
  }
  for (int s = 0; s < 2 && !deep && !pair.itself; ++s)
    if (const auto at = pair.starts_inside(s, out_->start))
      throw Error(e.place.text(),
                  fmt::format("{}: \"{}\" starts inside \"{}\", at {}", e.label(), s == 0 ? name_a : e.text("b"),
                              s == 0 ? e.text("b") : name_a, told_at(*at)),
                  "move one of them out of the other: what meets faces each other's outer sides");
  if (deep) {
    const std::string text =
        pair.itself ? fmt::format("{}: \"{}\" starts {:.3g} m deep in itself, at {}", e.label(), name_a, deep->depth, told_at(deep->at))
                    : fmt::format("{}: \"{}\" and \"{}\" start {:.3g} m deep in each other, at {}", e.label(), name_a, e.text("b"),
                                  deep->depth, told_at(deep->at));
    if (deep->depth > deep->cell) throw Error(e.place.text(), fmt::format("{}: more than a cell", text), "move one of them apart");
    if (deep->depth > 0.01 * deep->cell)
      warn(e.place.text(),
           fmt::format("{}; {}", text,
                       pair.is_static ? "the first load step presses them apart" : "they begin without force, which comes as they slide"));
    constexpr double enough = 0.1;  // of the depth
    if (deep->sag > enough * deep->depth && (pair.is_static || scene_.table("time").text("start") == "equilibrium"))
      warn(e.place.text(),
           fmt::format(
               "{}: {:.0f} % of the depth of {:.3g} m that it starts with is the sag of flat facets that face each other askew, and its "
               "force is off by up to as much; let nodes of both lie opposite each other, or take finer or quadratic cells",
               e.label(), 100 * std::min(1., deep->sag / deep->depth), deep->depth));
  }
}

}  // namespace hilo
