// SPDX-License-Identifier: GPL-3.0-or-later
// Names to carriers: a body, a node, or a patch made on the spot.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "system/build/builder.hpp"
#include "system/welds.hpp"

namespace hilo {

std::vector<std::string> Builder::all_names() const {
  std::vector<std::string> names = mesh_ ? mesh_->mesh.all_names() : std::vector<std::string>{};
  for (const auto& [name, body] : body_by_name_) names.push_back(name);
  names.push_back("ground");
  return names;
}

int Builder::new_body(const std::string& name, const Vec3& Xc) {
  Body body;
  body.name = name, body.Xc = Xc;
  out_->bodies.push_back(body);
  out_->start.c.push_back(Xc);
  out_->start.R.push_back(Mat3::Identity());
  return static_cast<int>(out_->bodies.size()) - 1;
}

double Builder::count_owned(const std::vector<int>& nodes) const {
  double n = 0;
  for (int i : nodes) n += out_->node_owned[i] != 0;
  return comm_.sum(n);
}

/// The mean axes that some of the nodes follow, the same on all ranks.
std::vector<int> Builder::linear_bodies_at(const std::vector<int>& nodes) const {
  std::vector<int> out;
  for (const int i : nodes)
    if (const int b = out_->follower[i]; b >= 0 && out_->bodies[b].linear) out.push_back(b);
  out = comm_.gather(out);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Vec3 Builder::mean_of(const std::vector<int>& nodes) const {
  double all[4] = {};
  for (int i : nodes)
    if (out_->node_owned[i]) {
      for (int k = 0; k < 3; ++k) all[k] += out_->X[i][k];
      all[3] += 1;
    }
  comm_.sum(all);
  return Vec3(all[0], all[1], all[2]) / std::max(1.0, all[3]);
}

/// The node nearest to a point, of equally near ones the first of the mesh, on the rank that owns it; -1 on the others.  Collective.
int Builder::nearest_owned(const std::vector<int>& nodes, const Vec3& at) const {
  int nearest = -1;
  double least = 1e300;
  for (int i : nodes)  // in the order of the mesh file
    if (out_->node_owned[i])
      if (const double d = (out_->X[i] - at).norm(); d < least) least = d, nearest = i;
  const bool candidate = least <= -comm_.max(-least) && nearest >= 0;
  const double row = candidate ? static_cast<double>(mesh_->node_global[nearest]) : 1e300, first = -comm_.max(-row);
  return candidate && row == first ? nearest : -1;
}

/// Radius of gyration of nodes about their mean, 0 where they lie on a line [m].  Collective.
double Builder::spread_of(const std::vector<int>& nodes) const {
  const Vec3 mean = mean_of(nodes);
  double spread[6] = {};
  for (int i : nodes)
    if (out_->node_owned[i]) {
      const Vec3 d = out_->X[i] - mean;
      spread[0] += d[0] * d[0], spread[1] += d[1] * d[1], spread[2] += d[2] * d[2];
      spread[3] += d[0] * d[1], spread[4] += d[0] * d[2], spread[5] += d[1] * d[2];
    }
  comm_.sum(spread);
  Mat3 S;
  S << spread[0], spread[3], spread[4], spread[3], spread[1], spread[5], spread[4], spread[5], spread[2];
  const Vec3 values = Eigen::SelfAdjointEigenSolver<Mat3>(S).eigenvalues();
  return values[1] <= 1e-12 * values[2] ? 0 : std::sqrt(S.trace() / std::max(1.0, count_owned(nodes)));
}

Builder::Found Builder::find(const std::string& name, const std::string& where, Asks asks) const {
  Found found;
  if (name == "ground") {
    found.body = 0;
    return found;
  }
  if (const auto it = body_by_name_.find(name); it != body_by_name_.end()) {
    found.body = it->second;
    if (asks == Asks::acts) acted_on_.insert(found.body);
    return found;
  }
  const auto is_in = [&](const Mesh& m) {
    return m.find_region(name) >= 0 || m.node_sets.contains(name) || m.facet_sets.contains(name) || m.cell_sets.contains(name);
  };
  const auto block = !mesh_ || is_in(mesh_->mesh) ? -1 : std::ranges::find(mesh_->mesh.block_name, name) - mesh_->mesh.block_name.begin();
  const bool is_block = block >= 0 && block < std::ssize(mesh_->mesh.block_name);
  if (!mesh_ || !(is_block || is_in(mesh_->mesh))) {
    if (std::ranges::any_of(scene_.entries("beam"), [&](const Entry& e) { return e.name == name; })) {
      const auto section = std::ranges::find_if(body_by_name_, [&](const auto& body) { return body.first.starts_with(name + "."); });
      throw Error(where, fmt::format("\"{}\" is a beam, which goes by its sections here", name),
                  section == body_by_name_.end() ? "" : fmt::format("each is a body, as \"{}\"", section->first));
    }
    const std::string near = suggest(name, all_names());
    throw Error(where, fmt::format("no region, set or body \"{}\"", name),
                mesh_ || !near.empty() ? near : "no mesh is given: hilo-solve scene.toml tags.h5");
  }
  found.region = mesh_->mesh.find_region(name);
  found.is_region = found.region >= 0;
  if (is_block) {
    for (int i = 0; i < static_cast<int>(out_->X.size()); ++i)
      if (mesh_->mesh.block[i] == block) found.nodes.push_back(i);
  } else {
    for (std::int64_t i : mesh_->nodes_of(name, where)) found.nodes.push_back(static_cast<int>(i));
  }
  found.n_global = static_cast<std::int64_t>(std::llround(count_owned(found.nodes)));
  if (found.is_region && regions_[found.region].fidelity == Fidelity::rigid) {
    found.body = regions_[found.region].body;
    return found;
  }
  // a set whose nodes all follow one body is that body; nodes of linear regions that joints hold follow theirs in the mean
  found.linear = !linear_bodies_at(found.nodes).empty();
  double low = 1e300, high = -1e300;
  for (const int i : found.nodes) {
    const int body = found.linear && found.is_region ? -1 : held_to(i);
    low = std::min<double>(low, body), high = std::max<double>(high, body);
  }
  low = -comm_.max(-low), high = comm_.max(high);
  if (low == high && low >= 0) found.body = static_cast<int>(low);
  return found;
}

Vec3 Builder::point_of(int body) const {
  const auto section = section_at_.find(body);
  return section != section_at_.end() ? section->second : out_->bodies[body].Xc;
}

void Builder::set_follower(int node, int body, const std::string& where) {
  if (out_->follower[node] == body) return;
  if (out_->follower[node] >= 0)
    throw Error(
        where,
        fmt::format("node {} is held by {} already", mesh_->mesh.node_id[node], held_by_[node].empty() ? "a rigid region" : held_by_[node]),
        "the sets of two entries overlap");
  out_->follower[node] = body;
  held_by_[node] = where;
}

/// An overlap may show on one rank alone: all of them refuse it.
void Builder::follow_all(const std::vector<int>& nodes, int body, const std::string& where) {
  comm_.together([&] {
    for (int i : nodes) set_follower(i, body, where);
  });
}

/// The body that a node follows without modes, or that a weld has it follow; or -1.
int Builder::held_to(int node) const {
  const int body = out_->follower[node];
  if (body < 0 || !out_->bodies[body].linear) return body;
  for (const Weld& w : out_->part<Welds>().list)
    if (out_->modes[w.modes].body == body && std::find(w.nodes.begin(), w.nodes.end(), node) != w.nodes.end()) return w.body;
  return -1;
}

/// The nodes of a set become followers of one massless body; where some of them belong to a rigid body already, they all join it.
int Builder::patch_of(const std::string& name, const Found& found, const std::string& where) {
  if (const auto it = patch_by_name_.find(name); it != patch_by_name_.end()) return it->second;
  const std::vector<int> nodes = whole_blocks(found.nodes);
  double other = -1;
  for (int i : nodes) other = std::max<double>(other, held_to(i));
  int body = static_cast<int>(comm_.max(other));
  const bool joins = body >= 0;
  if (!joins) {
    body = new_body(name, mean_of(nodes));
    out_->bodies[body].patch = true;
    out_->bodies[body].size = spread_of(nodes);
    if (out_->bodies[body].size == 0)
      throw Error(where, fmt::format("the {} nodes of \"{}\" lie on a line and cannot carry a joint", found.n_global, name),
                  "name a set of nodes on a face");
  }
  const std::vector<int> linear = linear_bodies_at(nodes);
  std::vector<int> others;
  for (const int i : nodes)
    if (out_->follower[i] < 0 || !out_->bodies[out_->follower[i]].linear) others.push_back(i);
  follow_all(others, body, where);
  comm_.together([&] {
    for (const int i : nodes)
      if (const int held = held_to(i); held >= 0 && held != body)
        throw Error(where, fmt::format("node {} is held by \"{}\" already", mesh_->mesh.node_id[i], out_->bodies[held].name),
                    "the sets of two entries overlap");
  });
  for (const int of : linear) {
    std::vector<int> its;
    for (const int i : nodes)
      if (out_->follower[i] == of) its.push_back(i);
    weld(of, body, name, its);
  }
  patch_by_name_[name] = body;
  return body;
}

int Builder::body_of(const std::string& name, const Found& found, const std::string& where) {
  if (found.body >= 0) return found.body;
  if (found.is_region)
    throw Error(where, fmt::format("region \"{}\" is flexible: it has no single position", name),
                "name a set of its nodes, or tag it rigid");
  return patch_of(name, found, where);
}

Carrier Builder::carrier(const Entry& entry, std::string_view key, bool needs_orientation) {
  const std::string& name = entry.text(key);
  const std::string where = entry.where(key);
  const Found found = find(name, where);
  if (found.body < 0 && found.n_global == 1 && found.linear)
    throw Error(where, fmt::format("{}: \"{}\" is a single node of a linear region", entry.label(), name), "name a set of nodes on a face");
  if (found.body < 0 && found.n_global == 1) {
    if (needs_orientation)
      throw Error(where, fmt::format("{}: \"{}\" is a single node, which has no orientation", entry.label(), name),
                  "name a set of nodes on a face");
    return {-1, found.nodes.at(0)};  // single nodes of sets are local to every rank (model/distribute.cpp)
  }
  return {body_of(name, found, where), -1};
}

}  // namespace hilo
