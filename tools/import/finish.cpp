// SPDX-License-Identifier: GPL-3.0-or-later
// What follows every reader: nodes merged and dropped, lengths in SI, cells checked.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/error.hpp"
#include "base/joined.hpp"
#include "base/param.hpp"
#include "import/imported.hpp"
#include "model/scaled_jacobian.hpp"

namespace hilo {
namespace {

/// A listed set in which nodes become one: the deck's force acts on each as often as it has them, so that further sets have those that
/// come twice, three times ...
void repeat_merged(Imported& in, const std::vector<std::int64_t>& row) {
  SetNames names(in);
  const std::set<std::string> listed = in.as_listed;
  for (const std::string& name : listed) {
    const auto set = in.mesh.node_sets.find(name);
    if (set == in.mesh.node_sets.end()) continue;
    std::map<std::int64_t, size_t> times;
    std::vector<std::vector<std::int64_t>> sets;  // of the second time on
    for (const auto a : set->second)
      if (const size_t n = ++times[row[static_cast<size_t>(a)]]; n > 1) {
        sets.resize(std::max(sets.size(), n - 1));
        sets[n - 2].push_back(a);
      }
    if (sets.empty()) continue;
    std::vector<std::pair<std::string, size_t>> all{{name, times.size()}};
    for (size_t k = 0; k < sets.size(); ++k) {
      all.emplace_back(names.nodes(fmt::format("{}_{}_times", name, k + 2), sets[k]), sets[k].size());
      in.as_listed.insert(all.back().first);
    }
    in.scene.repeat(all);
    for (DeckCase& c : in.cases) c.scene.repeat(all);
  }
}

/// Rows of nodes move to `row`; -1 takes them out of the sets.
void renumber(Imported& in, const std::vector<std::int64_t>& row, std::int64_t n) {
  Mesh& m = in.mesh;
  const auto move_keys = [&]<class Value>(std::map<std::int64_t, Value>& of_node, const auto& put) {
    for (auto& [a, value] : std::exchange(of_node, {}))
      if (const auto b = row[static_cast<size_t>(a)]; b >= 0) put(of_node[b], value);
  };
  const auto take = [](auto& to, auto& value) { to = std::move(value); };
  move_keys(in.held, [](unsigned& to, unsigned bits) { to |= bits; });
  move_keys(in.body_of_node, take), move_keys(in.thickness_at, take), move_keys(in.nodes_counted, take);
  std::vector<Vec3> X(n);
  std::vector<std::int64_t> id(n, -1);
  for (size_t a = 0; a < row.size(); ++a)
    if (row[a] >= 0 && id[row[a]] < 0) X[row[a]] = m.X[a], id[row[a]] = m.node_id[a];
  m.X = std::move(X);
  m.node_id = std::move(id);
  for (auto& a : m.nodes) a = row[a];
  for (auto& [name, set] : m.node_sets) {
    for (auto& a : set) a = row[a];
    sort_unique(set);
    if (!set.empty() && set.front() < 0) set.erase(set.begin());
  }
}

}  // namespace

void replace_cells(Mesh& m, Mesh&& cells) {
  m.shape = std::move(cells.shape), m.offset = std::move(cells.offset), m.nodes = std::move(cells.nodes);
  m.region = std::move(cells.region), m.cell_id = std::move(cells.cell_id);
}

std::int64_t merge_nodes(Imported& in, double distance) {
  const Mesh& m = in.mesh;
  const auto n = m.n_nodes();
  Joined<std::int64_t> nodes(static_cast<size_t>(n));
  // boxes as wide as the distance: a near node is in the same box or one beside it
  struct Box {
    std::int64_t i, j, k;
    bool operator==(const Box&) const = default;
  };
  struct Hash {
    size_t operator()(const Box& b) const {
      return static_cast<size_t>(b.i) * 73856093u ^ static_cast<size_t>(b.j) * 19349663u ^ static_cast<size_t>(b.k) * 83492791u;
    }
  };
  const auto box = [&](const Vec3& x) {
    return Box{std::llround(std::floor(x.x() / distance)), std::llround(std::floor(x.y() / distance)),
               std::llround(std::floor(x.z() / distance))};
  };
  std::unordered_map<Box, std::vector<std::int64_t>, Hash> boxes;
  for (std::int64_t a = 0; a < n; ++a) {
    const Box b = box(m.X[a]);
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
          if (const auto it = boxes.find({b.i + i, b.j + j, b.k + k}); it != boxes.end())
            for (const auto c : it->second)
              if ((m.X[c] - m.X[a]).norm() <= distance) nodes.join(a, c);
    boxes[b].push_back(a);
  }
  std::vector<std::int64_t> row(n);
  std::int64_t kept = 0;
  for (std::int64_t a = 0; a < n; ++a) row[a] = nodes.root(a) == a ? kept++ : row[nodes.root(a)];  // a root comes before its members
  if (kept < n) repeat_merged(in, row), renumber(in, row, kept);
  return n - kept;
}

std::int64_t drop_unused(Imported& in) {
  const Mesh& m = in.mesh;
  std::vector<std::int64_t> row(m.X.size(), -1);
  for (const auto a : m.nodes) row[a] = 0;
  std::int64_t kept = 0;
  for (auto& r : row)
    if (r == 0) r = kept++;
  const auto gone = m.n_nodes() - kept;
  if (gone == 0) return 0;
  renumber(in, row, kept);
  auto& sets = in.mesh.node_sets;
  for (auto it = sets.begin(); it != sets.end();)
    if (it->second.empty()) {
      if (in.n_beams == 0) in.notes.push_back(fmt::format("node set \"{}\" holds only nodes of no cell: left out", it->first));
      it = sets.erase(it);
    } else
      ++it;
  return gone;
}

void check_cells(const Mesh& m, const std::string& file) {
  std::vector<std::int64_t> inverted, flat;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto nodes = m.cell(c);
    std::vector<std::int64_t> sorted(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    const bool repeated = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    Vec3 low = m.X[nodes[0]], high = low;
    for (const auto a : nodes) low = low.cwiseMin(m.X[a]), high = high.cwiseMax(m.X[a]);
    const int dimension = info(m.shape[c]).dimension;
    const auto q = quality(m, c);
    const double least = dimension == 1 ? 0 : 1e-12 * std::pow((high - low).norm(), dimension);
    if (repeated || std::abs(q.volume) <= least || std::isnan(q.volume))
      flat.push_back(m.cell_id[c]);
    else if (dimension == 3 && !(q.volume > 0 && q.scaled_jacobian > 0 && scaled_jacobian(m, c) > 0))
      inverted.push_back(m.cell_id[c]);
  }
  if (!flat.empty())
    throw Error(
        file, fmt::format("{} of {} cells have no volume or name a node twice: {}", flat.size(), m.n_cells(), some(flat, 5, ", ", ", ...")),
        "remove them from the mesh; after --merge-nodes, try a smaller distance");
  if (!inverted.empty())
    throw Error(file,
                fmt::format("{} of {} cells are inverted (scaled Jacobian <= 0 at a corner): {}", inverted.size(), m.n_cells(),
                            some(inverted, 5, ", ", ", ...")),
                "repair or remesh them; --flip turns cells that are numbered as in a mirror");
}

namespace {

/// Every solid cell is numbered as in a mirror: the deck's way, not cells gone bad.
bool is_mirrored(const Mesh& m) {
  bool any = false;
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    if (info(m.shape[c]).dimension == 3) {
      if (!(quality(m, c).volume < 0)) return false;
      any = true;
    }
  return any;
}

/// Solid cells of the same nodes, as where a file lists an element twice: mass and stiffness there are doubled.
void tell_doubled(Imported& in) {
  const Mesh& m = in.mesh;
  std::vector<std::pair<std::uint64_t, std::int64_t>> key;  // of the nodes, in any order, and the cell
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    if (info(m.shape[c]).dimension != 3) continue;
    std::uint64_t sum = 0;
    for (const auto a : m.cell(c)) {
      auto x = static_cast<std::uint64_t>(a) + 0x9e3779b97f4a7c15u;  // mixed as in splitmix64
      x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
      x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
      sum += x ^ (x >> 31);
    }
    key.emplace_back(sum, c);
  }
  std::ranges::sort(key);
  const auto sorted = [&](std::int64_t c) {
    std::vector<std::int64_t> nodes(m.cell(c).begin(), m.cell(c).end());
    std::ranges::sort(nodes);
    return nodes;
  };
  std::int64_t doubled = 0, one = 0, other = 0;
  for (size_t i = 1; i < key.size(); ++i)
    if (key[i].first == key[i - 1].first && sorted(key[i].second) == sorted(key[i - 1].second) && doubled++ == 0)
      one = m.cell_id[key[i - 1].second], other = m.cell_id[key[i].second];
  if (doubled)
    in.notes.push_back(
        fmt::format("warning: {} cells have the nodes of another cell, the first are {} and {}: mass and stiffness count twice there",
                    doubled, one, other));
}

/// Cells that pass and are nearly flat all the same: each region's, with the place of the worst.
void tell_slivers(Imported& in) {
  const Mesh& m = in.mesh;
  struct Worst {
    std::int64_t count = 0, cell = -1;
    double value = sliver_limit;
  };
  std::vector<Worst> of(m.region_name.size());
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    if (info(m.shape[c]).dimension != 3) continue;
    const double j = scaled_jacobian(m, c);
    if (!(j < sliver_limit)) continue;
    Worst& w = of[m.region[c]];
    ++w.count;
    if (j < w.value) w.value = j, w.cell = c;
  }
  for (size_t r = 0; r < of.size(); ++r) {
    if (of[r].count == 0) continue;
    Vec3 at = Vec3::Zero();
    for (const auto a : m.cell(of[r].cell)) at += m.X[a] / static_cast<double>(m.cell(of[r].cell).size());
    in.notes.push_back(fmt::format(
        "warning: region \"{}\" has {} slivers (scaled Jacobian below {}); the flattest, {:.2g}, is cell {} at ({:.4g}, {:.4g}, "
        "{:.4g}) m; hilo-post mesh --slivers shows them",
        m.region_name[r], of[r].count, sliver_limit, of[r].value, m.cell_id[of[r].cell], at.x(), at.y(), at.z()));
  }
}

}  // namespace

void finish(Imported& in, const std::string& file, const ImportOptions& options) {
  Mesh& m = in.mesh;
  if (in.metre && *in.metre != 1 && std::abs(options.scale - *in.metre) < 1e-9 * options.scale)
    throw Error("",
                fmt::format("--scale {:g}: {} says that {:g} m is its unit of length, and becomes metres by itself", options.scale, file,
                            *in.metre),
                "leave --scale away", Exit::usage);
  if (in.metre && options.units_given && std::abs(to_si("m", options.units) - *in.metre) > 1e-9 * *in.metre)
    throw Error("", fmt::format("--units {}: {} says that {:g} m is its unit of length", options.units, file, *in.metre),
                "leave --units away", Exit::usage);
  for (std::int64_t a = 0; a < m.n_nodes(); ++a)
    if (!m.X[a].allFinite()) throw Error(file, fmt::format("node {} has a coordinate that is not a number", m.node_id[a]));
  if (options.merge) {
    const auto gone = merge_nodes(in, *options.merge);
    in.notes.push_back(fmt::format("{} nodes merged with one nearer than {:g}", gone, *options.merge));
  }
  if (const auto gone = drop_unused(in); gone && in.n_beams == 0 && m.n_cells() > 0)
    in.notes.push_back(fmt::format("{} nodes belong to no cell: dropped", gone));
  if (!options.thickness.empty() || (options.thicken && !in.thin.empty())) thicken(in, file);
  if (options.flip || is_mirrored(m))
    in.notes.push_back(fmt::format("{} of {} cells were numbered as in a mirror: turned", flip(m), m.n_cells()));
  const double factor = options.scale * in.metre.value_or(to_si("m", options.units));
  if (options.order == 2) raise_order(in, factor);
  add_placed_sets(in, options.sets);
  for (auto* points : {&m.X, &m.block_at})
    for (auto& x : *points) x *= factor;
  if (!m.block.empty()) m.block.resize(m.X.size(), -1);
  if (const auto n = straighten(m))
    in.notes.push_back(in.curved ? fmt::format("{} cells that a curved surface turned inside out have straight edges", n)
                                 : fmt::format("warning: {} cells that the nodes on their edges turned inside out have straight edges", n));
  check_cells(m, file);
  add_thin_moments(in, factor);
  for (size_t r = 0; r < in.thin_regions.size(); ++r)
    if (in.thin_regions[r].any())
      in.notes.push_back(
          fmt::format("region \"{}\" has shells or beams: it can be rigid alone (--thicken makes solid-shells)", m.region_name[r]));
  if (in.n_beams > 0) in.notes.push_back(fmt::format("{} beams stand in the scene lines alone (--scene-out)", in.n_beams));
  tell_doubled(in);
  tell_slivers(in);
  tell_untouched(in);
  const auto complete = [](SceneWriter& scene, const std::vector<NotRead>& not_read) {
    if (!scene.empty()) scene.append(left_out(not_read));
  };
  complete(in.scene, in.not_read);
  for (DeckCase& c : in.cases) complete(c.scene, c.not_read);
  m.deck_scene = (in.cases.empty() ? in.scene : in.cases.front().scene).text();
  for (size_t r = 0; r < m.region_name.size(); ++r) {
    auto& data = m.region_data[r];
    data.density *= to_si("kg/m^3", options.units);
    data.E *= to_si("Pa", options.units);
    if (data.density < 0.05 || data.density > 5e4)
      in.notes.push_back(fmt::format("warning: region \"{}\" has a density of {:g} kg/m^3: is the file in mm-t-s? say so with --units",
                                     m.region_name[r], data.density));
  }
}

}  // namespace hilo
