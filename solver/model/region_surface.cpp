// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/region_surface.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "model/facet_key.hpp"

namespace hilo {
namespace {

struct Key {
  std::array<std::int64_t, 4> at;  // global numbers of the three smallest corners, region
  std::int64_t place;              // among the facets looked at
};

Key key_of(const LocalMesh& local, const Facet& f, std::int64_t place, bool by_region) {
  const auto corner = facet_key(local.mesh, f, [&](std::int64_t n) { return local.node_global[n]; });
  return {{corner[0], corner[1], corner[2], by_region ? local.mesh.region[f.cell] : 0}, place};
}

/// Leaves those that are there once.
void keep_single(std::vector<Key>& keys) {
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return std::tie(a.at, a.place) < std::tie(b.at, b.place); });
  std::vector<Key> single;
  for (size_t i = 0, j = 0; i < keys.size(); i = j) {
    while (j < keys.size() && keys[j].at == keys[i].at) ++j;
    if (j == i + 1) single.push_back(keys[i]);
  }
  keys = std::move(single);
}

std::vector<Facet> unshared_facets(const LocalMesh& local, const Comm& comm, bool by_region) {
  const Mesh& m = local.mesh;
  std::vector<Facet> facets;
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    if (info(m.shape[c]).dimension == 3)
      for (std::int64_t f = 0; f < static_cast<std::int64_t>(info(m.shape[c]).facets.size()); ++f) facets.push_back({c, f});
  std::vector<Key> keys;
  for (size_t i = 0; i < facets.size(); ++i) keys.push_back(key_of(local, facets[i], static_cast<std::int64_t>(i), by_region));
  keep_single(keys);
  if (comm.size > 1) {  // the rank of the smallest corner decides, and says so to those that asked
    std::vector<std::vector<std::int64_t>> ask(comm.size);
    for (const Key& k : keys) {
      auto& to = ask[k.at[0] % comm.size];
      to.insert(to.end(), k.at.begin(), k.at.end()), to.push_back(k.place);
    }
    const auto asked = comm.exchange(ask);
    std::vector<Key> all;
    std::vector<std::pair<int, std::int64_t>> who;  // rank and its place
    for (int r = 0; r < comm.size; ++r)
      for (size_t i = 0; i < asked[r].size(); i += 5) {
        all.push_back({{asked[r][i], asked[r][i + 1], asked[r][i + 2], asked[r][i + 3]}, static_cast<std::int64_t>(who.size())});
        who.emplace_back(r, asked[r][i + 4]);
      }
    keep_single(all);
    std::vector<std::vector<std::int64_t>> answer(comm.size);
    for (const Key& k : all) answer[who[k.place].first].push_back(who[k.place].second);
    keys.clear();
    for (const auto& list : comm.exchange(answer))
      for (const std::int64_t place : list) keys.push_back({{}, place});
  }
  std::vector<std::int64_t> places;
  for (const Key& k : keys) places.push_back(k.place);
  std::sort(places.begin(), places.end());
  std::vector<Facet> out;
  for (const std::int64_t i : places) out.push_back(facets[i]);
  return out;
}

}  // namespace

std::vector<Facet> region_surface(const LocalMesh& local, const Comm& comm) { return unshared_facets(local, comm, true); }
std::vector<Facet> outer_surface(const LocalMesh& local, const Comm& comm) { return unshared_facets(local, comm, false); }

}  // namespace hilo
