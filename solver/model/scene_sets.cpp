// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/scene_sets.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/error.hpp"
#include "model/region_surface.hpp"
#include "model/smooth_faces.hpp"

namespace hilo {
namespace {

/// How far a point is outside of what an entry describes, 0 within [m].
class Where {
 public:
  Where(const Entry& e, double length) : kind_(e.kind) {
    if (kind_ == "box") {
      box_.extend(e.vector3("low")), box_.extend(e.vector3("high"));
      return;
    }
    at_ = e.vector3("at");
    radius_ = e.has("radius") ? e.number("radius") : 1e300;
    if (kind_ == "ball") return;
    axis_ = e.vector3("axis").normalized();
    tolerance_ = e.has("tolerance") ? e.number("tolerance") : kind_ == "plane" ? 1e-6 * length : 0.02 * radius_;
    if (e.has("length")) half_ = e.number("length") / 2;
  }
  double outside(const Vec3& x) const {
    if (kind_ == "box") return box_.exteriorDistance(x);
    const Vec3 d = x - at_;
    if (kind_ == "ball") return std::max(0.0, d.norm() - radius_);
    const double along = std::abs(d.dot(axis_)), from_axis = (d - d.dot(axis_) * axis_).norm();
    if (kind_ == "plane") return std::max({0.0, along - tolerance_, from_axis - radius_});
    return std::hypot(std::max(0.0, std::abs(from_axis - radius_) - tolerance_), std::max(0.0, along - half_));
  }

 private:
  std::string kind_;
  Eigen::AlignedBox3d box_;
  Vec3 at_ = Vec3::Zero(), axis_ = Vec3::UnitZ();
  double radius_ = 0, half_ = 1e300, tolerance_ = 0;
};

[[noreturn]] void fail_set(const Entry& e, std::string_view key, const std::string& what, const std::string& hint) {
  throw Error(e.where(key), e.label() + ": " + what, hint);
}

struct Found {
  std::vector<std::int64_t> nodes;
  std::vector<Facet> facets;
};

/// Nodes of the regions that `of` names.
std::vector<std::int64_t> nodes_of_regions(const Entry& e, const LocalMesh& local) {
  std::vector<std::int64_t> found;
  for (const std::string& pattern : e.texts("of")) {
    bool any = false;
    for (const std::string& region : local.mesh.region_name) {
      if (fnmatch(pattern.c_str(), region.c_str(), 0) != 0) continue;
      any = true;
      const auto nodes = local.nodes_of(region, e.where("of"));
      found.insert(found.end(), nodes.begin(), nodes.end());
    }
    if (!any) fail_set(e, "of", fmt::format("no region \"{}\"", pattern), suggest(pattern, local.mesh.region_name));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// The nodes within a place, and the outer facets between them.
Found within(const Entry& e, const LocalMesh& local, const std::vector<Facet>& surface, const Comm& comm) {
  const Mesh& mesh = local.mesh;
  const Where place(e, local.length);
  Found found;
  double nearest = 1e300;
  for (const std::int64_t i : nodes_of_regions(e, local)) {
    const double outside = place.outside(mesh.X[i]);
    nearest = std::min(nearest, outside);
    if (outside == 0) found.nodes.push_back(i);
  }
  nearest = -comm.max(-nearest);
  if (nearest > 0)
    fail_set(e, "kind", fmt::format("no node lies there; the nearest is {:.4g} m off", nearest),
             "look at the places: hilo-post mesh --edges all");
  for (const Facet& f : surface) {
    const auto its = mesh.facet_nodes(f);
    if (std::all_of(its.begin(), its.end(), [&](std::int64_t i) { return std::binary_search(found.nodes.begin(), found.nodes.end(), i); }))
      found.facets.push_back(f);
  }
  return found;
}

/// The smooth face that a point lies on: all ranks see the whole surface, and each takes its own part.
Found face_near(const Entry& e, const LocalMesh& local, const std::vector<Facet>& surface, const Comm& comm) {
  const Mesh& mesh = local.mesh;
  nodes_of_regions(e, local);  // for its errors
  std::vector<Facet> candidates;
  std::vector<SurfaceFacet> mine;
  for (const Facet& f : surface) {
    const std::string& region = mesh.region_name[mesh.region[f.cell]];
    if (std::ranges::none_of(e.texts("of"), [&](const std::string& p) { return fnmatch(p.c_str(), region.c_str(), 0) == 0; })) continue;
    candidates.push_back(f);
    mine.push_back(surface_facet(mesh, f, [&](std::int64_t i) { return local.node_global[i]; }));
  }
  const auto before = static_cast<size_t>(comm.before(static_cast<std::int64_t>(mine.size())));
  const std::vector<SurfaceFacet> all = comm.gather(mine);
  const std::vector<int> face = smooth_faces(all, e.number("angle"));
  const Vec3 at = e.vector3("at");
  const double tolerance = e.has("tolerance") ? e.number("tolerance") : 0.01 * local.length;
  std::vector<double> nearest;  // by face
  for (size_t i = 0; i < all.size(); ++i) {
    nearest.resize(std::max(nearest.size(), static_cast<size_t>(face[i]) + 1), 1e300);
    nearest[face[i]] = std::min(nearest[face[i]], distance(all[i], at));
  }
  const auto best = std::min_element(nearest.begin(), nearest.end());
  if (best == nearest.end()) fail_set(e, "of", "the regions have no outer facets", "");
  if (*best > tolerance)
    fail_set(e, "at", fmt::format("the nearest face is {:.4g} m off", *best), "look at the places: hilo-post mesh --faces");
  for (auto other = nearest.begin(); other != nearest.end(); ++other)
    if (other != best && *other <= *best + 1e-6 * local.length)
      fail_set(e, "at", "two faces are as near to the point as each other",
               "a point amid the face, not on its border: hilo-post mesh --faces");
  const int wanted = static_cast<int>(best - nearest.begin());
  Found found;
  std::set<std::int64_t> nodes;
  for (size_t i = 0; i < all.size(); ++i) {
    if (face[i] != wanted) continue;
    for (size_t k = 0; k < static_cast<size_t>(all[i].n_nodes); ++k) nodes.insert(all[i].node[k]);
    if (i >= before && i < before + mine.size()) found.facets.push_back(candidates[i - before]);
  }
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i)
    if (nodes.contains(local.node_global[i])) found.nodes.push_back(i);
  return found;
}

}  // namespace

void add_scene_sets(const Scene& scene, LocalMesh& local, const Comm& comm) {
  const auto entries = scene.entries("set");
  if (entries.empty()) return;
  Mesh& mesh = local.mesh;
  const auto names = mesh.all_names();
  const std::vector<Facet> surface = outer_surface(local, comm);
  for (const Entry& e : entries) {
    if (std::find(names.begin(), names.end(), e.name) != names.end())
      fail_set(e, "kind", fmt::format("the mesh has a region or set \"{}\" already", e.name), "give the set another name");
    Found found = e.kind == "near" ? face_near(e, local, surface, comm) : within(e, local, surface, comm);
    double owned = 0;
    for (const std::int64_t i : found.nodes) owned += local.node_owned[i] != 0;
    if (comm.sum(owned) == 1 && comm.size > 1)
      fail_set(e, "kind", "a single node, which on several ranks only a set of the mesh can be", "a larger place, or one rank");
    mesh.node_sets[e.name] = std::move(found.nodes);
    if (comm.sum(static_cast<double>(found.facets.size())) > 0) mesh.facet_sets[e.name] = std::move(found.facets);
  }
}

void add_scene_sets(const Scene& scene, Mesh& mesh) {
  if (scene.entries("set").empty()) return;
  LocalMesh local;
  local.mesh = std::move(mesh);
  local.node_global.resize(local.mesh.X.size());
  std::iota(local.node_global.begin(), local.node_global.end(), 0);
  local.node_owned.assign(local.mesh.X.size(), 1);
  Eigen::AlignedBox3d box;
  for (const Vec3& x : local.mesh.X) box.extend(x);
  if (!box.isEmpty()) local.length = box.diagonal().norm();
  add_scene_sets(scene, local, Comm::alone());
  mesh = std::move(local.mesh);
}

}  // namespace hilo
