#include "model/scene_sets.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "model/region_surface.hpp"

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

}  // namespace

void add_scene_sets(const Scene& scene, LocalMesh& local, const Comm& comm) {
  const auto entries = scene.entries("set");
  if (entries.empty()) return;
  Mesh& mesh = local.mesh;
  const auto names = mesh.all_names();
  const std::vector<Facet> surface = outer_surface(local, comm);
  for (const Entry& e : entries) {
    const auto fail = [&](std::string_view key, const std::string& what, const std::string& hint) {
      throw Error(e.where(key), e.label() + ": " + what, hint);
    };
    if (std::find(names.begin(), names.end(), e.name) != names.end())
      fail("kind", fmt::format("the mesh has a region or set \"{}\" already", e.name), "give the set another name");
    std::vector<std::int64_t> candidates;
    for (const std::string& pattern : e.texts("of")) {
      bool any = false;
      for (const std::string& region : mesh.region_name) {
        if (fnmatch(pattern.c_str(), region.c_str(), 0) != 0) continue;
        any = true;
        const auto nodes = local.nodes_of(region, e.where("of"));
        candidates.insert(candidates.end(), nodes.begin(), nodes.end());
      }
      if (!any) fail("of", fmt::format("no region \"{}\"", pattern), suggest(pattern, mesh.region_name));
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    const Where place(e, local.length);
    std::vector<std::int64_t> nodes;
    double nearest = 1e300, owned = 0;
    for (const std::int64_t i : candidates) {
      const double outside = place.outside(mesh.X[i]);
      nearest = std::min(nearest, outside);
      if (outside == 0) nodes.push_back(i), owned += local.node_owned[i] != 0;
    }
    nearest = -comm.max(-nearest), owned = comm.sum(owned);
    if (owned == 0)
      fail("kind", fmt::format("no node lies there; the nearest is {:.4g} m off", nearest),
           "look at the places: hilo-post mesh --edges all");
    if (owned == 1 && comm.size > 1)
      fail("kind", "a single node, which on several ranks only a set of the mesh can be", "a larger place, or one rank");
    std::vector<Facet> facets;
    for (const Facet& f : surface) {
      const auto its = mesh.facet_nodes(f);
      if (std::all_of(its.begin(), its.end(), [&](std::int64_t i) { return std::binary_search(nodes.begin(), nodes.end(), i); }))
        facets.push_back(f);
    }
    mesh.node_sets[e.name] = std::move(nodes);
    if (comm.sum(static_cast<double>(facets.size())) > 0) mesh.facet_sets[e.name] = std::move(facets);
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
  add_scene_sets(scene, local, Comm::world());
  mesh = std::move(local.mesh);
}

}  // namespace hilo
