// SPDX-License-Identifier: GPL-3.0-or-later
// mesh.h5, tags.h5 and parts-N.h5: writing them, and reading any of them through its links.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/error.hpp"
#include "model/mesh.hpp"
#include "model/mesh_source.hpp"
#include "model/schema.hpp"
#include "model/shape_row.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

/// Write an array with the unit and meaning that the schema gives its path.
template <class T>
void put(Store& store, const std::string& path, std::span<const T> values, std::vector<std::int64_t> shape) {
  for (const auto& row : file_schema())
    if (row.path == path) return store.write<T>(path, values, std::move(shape), std::string(row.unit), std::string(row.meaning));
  store.write<T>(path, values, std::move(shape));
}
template <class T>
void put(Store& store, const std::string& path, const std::vector<T>& values) {
  put<T>(store, path, values, {static_cast<std::int64_t>(values.size())});
}

void head(Store& store, const std::string& format, const std::vector<std::string>& provenance) {
  store.set("/", "format", "hilo " + format);
  store.set("/", "version", schema_version);
  store.set("/", "complete", std::int64_t{1});
  store.write_strings("/provenance", provenance);
}

void check_range(const Store& store, const std::string& array, std::span<const std::int64_t> list, std::int64_t n) {
  for (const auto i : list)
    if (i < 0 || i >= n) throw Error(store.path(), fmt::format("damaged: {} holds {}, allowed is 0 to {}", array, i, n - 1));
}

void check_size(const Store& store, const std::string& array, size_t size, size_t wanted) {
  if (size != wanted) throw Error(store.path(), fmt::format("damaged: {} has {} entries, not {}", array, size, wanted));
}

/// The attribute that names a shape from outside the tree.
std::string name_of_shape(std::uint8_t shape) { return fmt::format("shape_{}", shape); }

void check_cells(const Store& store, const Mesh& m) {
  const size_t n = m.shape.size();
  check_size(store, "/mesh/nodes/id", m.node_id.size(), m.X.size());
  check_size(store, "/mesh/cells/offset", m.offset.size(), n + 1);
  check_size(store, "/mesh/cells/region", m.region.size(), n);
  check_size(store, "/mesh/cells/id", m.cell_id.size(), n);
  check_shapes(store, m.shape);
  std::int64_t at = 0;
  for (size_t c = 0; c < n; ++c) {
    if (m.offset[c] != at)
      throw Error(store.path(), fmt::format("damaged: /mesh/cells/offset of cell {} is {}, not {}", c, m.offset[c], at));
    if (m.region[c] < 0 || m.region[c] >= static_cast<std::int32_t>(m.region_name.size()))
      throw Error(store.path(), fmt::format("damaged: /mesh/cells/region of cell {} is {}", c, m.region[c]));
    at += info(m.shape[c]).n_nodes;
  }
  if (m.offset[n] != at) throw Error(store.path(), fmt::format("damaged: /mesh/cells/offset ends with {}, not {}", m.offset[n], at));
  check_size(store, "/mesh/cells/nodes", m.nodes.size(), static_cast<size_t>(at));
  check_range(store, "/mesh/cells/nodes", m.nodes, m.n_nodes());
}

void read_sets(const Store& store, Mesh& m) {
  for (const auto& link : store.list("/mesh/sets/nodes")) {
    const std::string array = "/mesh/sets/nodes/" + link;
    auto& set = m.node_sets[from_link_name(link)] = store.read<std::int64_t>(array);
    check_range(store, array, set, m.n_nodes());
  }
  for (const auto& link : store.list("/mesh/sets/cells")) {
    const std::string array = "/mesh/sets/cells/" + link;
    auto& set = m.cell_sets[from_link_name(link)] = store.read<std::int64_t>(array);
    check_range(store, array, set, m.n_cells());
  }
  for (const auto& link : store.list("/mesh/sets/facets")) {
    const std::string array = "/mesh/sets/facets/" + link;
    const auto pairs = store.read<std::int64_t>(array);
    auto& set = m.facet_sets[from_link_name(link)];
    for (size_t i = 0; i + 1 < pairs.size(); i += 2) {
      check_range(store, array, {&pairs[i], 1}, m.n_cells());
      check_range(store, array, {&pairs[i + 1], 1}, static_cast<std::int64_t>(info(m.shape[pairs[i]]).facets.size()));
      set.push_back({pairs[i], pairs[i + 1]});
    }
  }
}

Mesh read_mesh(const Store& store) {
  Mesh m;
  const auto X = store.read<double>("/mesh/nodes/X");
  m.X.resize(X.size() / 3);
  for (size_t n = 0; n < m.X.size(); ++n) m.X[n] = Vec3(X[3 * n], X[3 * n + 1], X[3 * n + 2]);
  m.node_id = store.read<std::int64_t>("/mesh/nodes/id");
  m.shape = store.read<std::uint8_t>("/mesh/cells/shape");
  m.offset = store.read<std::int64_t>("/mesh/cells/offset");
  m.nodes = store.read<std::int64_t>("/mesh/cells/nodes");
  m.region = store.read<std::int32_t>("/mesh/cells/region");
  m.cell_id = store.read<std::int64_t>("/mesh/cells/id");
  m.region_name = store.read_strings("/mesh/regions/name");
  const auto density = store.read<double>("/mesh/regions/density"), E = store.read<double>("/mesh/regions/E"),
             nu = store.read<double>("/mesh/regions/nu");
  for (const auto* list : {&density, &E, &nu}) check_size(store, "/mesh/regions", list->size(), m.region_name.size());
  for (size_t r = 0; r < m.region_name.size(); ++r) m.region_data.push_back({density[r], E[r], nu[r]});
  check_cells(store, m);
  read_blocks(store, m);
  if (store.has("/mesh/nodes/block")) {
    m.block = store.read<std::int64_t>("/mesh/nodes/block");
    check_size(store, "/mesh/nodes/block", m.block.size(), m.X.size());
    check_blocks(store, m);
  }
  read_sets(store, m);
  if (store.has("/mesh/deck_scene")) m.deck_scene = store.read_text("/mesh/deck_scene");
  return m;
}

}  // namespace

void check_shapes(const Store& mesh, std::span<const std::uint8_t> shapes, std::int64_t first) {
  std::array<bool, most_shapes> seen{};
  for (size_t c = 0; c < shapes.size(); ++c) {
    const std::uint8_t shape = shapes[c];
    if (std::exchange(seen[shape], true)) continue;
    const auto name = shape < first_outside ? std::nullopt : mesh.text_attribute("/mesh/cells/shape", name_of_shape(shape));
    if (name && (!is_shape(shape) || info(shape).name != *name))
      throw Error(mesh.path(), fmt::format("cells of shape {}, \"{}\", which this program does not have", shape, *name),
                  "it is of a program that adds shapes of its own");
    if (!is_shape(shape) || (shape >= first_outside && !name))
      throw Error(mesh.path(), fmt::format("damaged: /mesh/cells/shape of cell {} is {}", first + static_cast<std::int64_t>(c), shape));
  }
}

void read_blocks(const Store& store, Mesh& m) {
  if (!store.has("/mesh/nodes/block")) return;
  m.block_name = store.read_strings("/mesh/blocks/name");
  const auto X = store.read<double>("/mesh/blocks/X");
  check_size(store, "/mesh/blocks/X", X.size(), 3 * m.block_name.size());
  for (size_t b = 0; b < m.block_name.size(); ++b) m.block_at.emplace_back(X[3 * b], X[3 * b + 1], X[3 * b + 2]);
}

void check_blocks(const Store& store, const Mesh& m) {
  for (const auto b : m.block)
    if (b < -1 || b >= static_cast<std::int64_t>(m.block_name.size()))
      throw Error(store.path(), fmt::format("damaged: /mesh/nodes/block holds {}, allowed is -1 to {}", b,
                                            static_cast<std::int64_t>(m.block_name.size()) - 1));
}

std::string holder(const Store& store, const std::string& what) {
  const auto link = store.linked("/" + what);
  if (!link) return store.path();
  const std::string target = resolved_from(store.path(), link->first);
  if (std::error_code ignored; !std::filesystem::exists(target, ignored))
    throw Error(store.path(), fmt::format("{} is in {}, which is missing", what, target),
                "files that belong together stay in the same places");
  return target;
}

void refuse_if_changed(const Store& store, const std::string& what, const std::string& target) {
  const auto then = store.text_attribute("/", what + "_digest");
  if (!then || *then == digest(target)) return;
  std::string command;  // the last that began anew
  if (store.has("/provenance"))
    for (const std::string& line : store.read_strings("/provenance"))
      if (line.find(" --restart") == line.npos) command = ": " + line;
  throw Error(store.path(), fmt::format("{} has changed since this file was made", target), "make it again" + command);
}

void link_to(Store& store, const std::string& what, const std::string& target) {
  store.link("/" + what, target, "/" + what);
  store.set("/", what + "_file", relative_to(store.path(), target));
  store.set("/", what + "_digest", digest(target));
}

std::vector<Fidelity> fidelity_by_name(const Store& tags, const std::vector<std::string>& regions, const std::string& source) {
  const auto words = tags.read_strings("/tags/fidelity");
  std::vector<Fidelity> levels(regions.size());
  if (!tags.has("/tags/region")) {  // made before tags had names
    if (words.size() != regions.size())
      throw Error(source, fmt::format("{} tags for the {} regions of the mesh", words.size(), regions.size()),
                  "the mesh has changed: tag it again");
    for (size_t r = 0; r < words.size(); ++r) levels[r] = fidelity_of(words[r], tags.path());
    return levels;
  }
  const auto names = tags.read_strings("/tags/region");
  check_size(tags, "/tags/fidelity", words.size(), names.size());
  std::unordered_map<std::string_view, size_t> number;
  for (size_t k = 0; k < names.size(); ++k) number.emplace(names[k], k);
  for (size_t r = 0; r < regions.size(); ++r) {
    const auto at = number.find(regions[r]);
    if (at == number.end())
      throw Error(source, fmt::format("no tag for the region \"{}\" of the mesh", regions[r]), "the mesh has changed: tag it again");
    levels[r] = fidelity_of(words[at->second], tags.path());
  }
  return levels;
}

std::string checked_format(const Store& store) {
  const auto format = store.text_attribute("/", "format");
  if (!format || !format->starts_with("hilo ")) throw Error(store.path(), "not a hilo file: it has no attribute format = \"hilo ...\"");
  const double version = store.number_attribute("/", "version").value_or(0);
  if (version > static_cast<double>(schema_version))
    throw Error(store.path(), fmt::format("format version {:g} is newer than this program's {}", version, schema_version));
  if (*format != "hilo run" && store.number_attribute("/", "complete").value_or(0) != 1) throw Error(store.path(), "incomplete file");
  return format->substr(5);
}

MeshFile read_mesh_file(const std::string& path) {
  const Store store = Store::open(path);
  const std::string format = checked_format(store);
  MeshFile f;
  f.provenance = store.read_strings("/provenance");
  if (!store.linked("/mesh") && !store.has("/mesh")) throw Error(path, fmt::format("this {} file has no mesh", format));
  const auto read_from = [&](const std::string& what, const auto& body) {
    const std::string target = holder(store, what);
    if (target == path) return body(store);
    const Store other = Store::open(target);
    checked_format(other);
    refuse_if_changed(store, what, target);
    body(other);
  };
  read_from("mesh", [&](const Store& s) { f.mesh = read_mesh(s); });
  f.fidelity.assign(f.mesh.region_name.size(), Fidelity::nonlinear);
  if (store.linked("/tags") || store.has("/tags")) {
    f.tagged = true;
    read_from("tags", [&](const Store& s) { f.fidelity = fidelity_by_name(s, f.mesh.region_name, path); });
  }
  if (store.has("/parts/rank")) {
    f.rank = store.read<std::int32_t>("/parts/rank");
    f.n_parts = static_cast<int>(store.number_attribute("/parts/rank", "n_parts").value_or(1));
    if (f.rank.size() != f.mesh.shape.size())
      throw Error(path, fmt::format("parts of {} cells, the mesh has {}", f.rank.size(), f.mesh.shape.size()),
                  "the mesh has changed: part it again");
    for (const auto r : f.rank)
      if (r < 0 || r >= f.n_parts) throw Error(path, fmt::format("damaged: /parts/rank holds {}, there are {} parts", r, f.n_parts));
  }
  return f;
}

void write_mesh(const std::string& path, const Mesh& m, const std::vector<std::string>& provenance) {
  unpublished_mesh(path, m, provenance).publish();
}

Store unpublished_mesh(const std::string& path, const Mesh& m, const std::vector<std::string>& provenance) {
  Store store = Store::create(path);
  head(store, "mesh", provenance);
  const auto n = m.n_nodes();
  put<double>(store, "/mesh/nodes/X", {n ? m.X[0].data() : nullptr, m.X.size() * 3}, {n, 3});
  put(store, "/mesh/nodes/id", m.node_id);
  if (!m.block.empty()) {
    put(store, "/mesh/nodes/block", m.block);
    store.write_strings("/mesh/blocks/name", m.block_name);
    put<double>(store, "/mesh/blocks/X", {m.block_at[0].data(), 3 * m.block_at.size()}, {static_cast<std::int64_t>(m.block_at.size()), 3});
  }
  put(store, "/mesh/cells/shape", m.shape);
  for (const std::uint8_t shape : std::set<std::uint8_t>(m.shape.begin(), m.shape.end()))
    if (shape >= first_outside) store.set("/mesh/cells/shape", name_of_shape(shape), std::string(info(shape).name));
  put(store, "/mesh/cells/offset", m.offset);
  put(store, "/mesh/cells/nodes", m.nodes);
  put(store, "/mesh/cells/region", m.region);
  put(store, "/mesh/cells/id", m.cell_id);
  store.write_strings("/mesh/regions/name", m.region_name);
  std::vector<double> density, E, nu;
  for (size_t r = 0; r < m.region_name.size(); ++r) {
    const RegionData d = r < m.region_data.size() ? m.region_data[r] : RegionData{};
    density.push_back(d.density), E.push_back(d.E), nu.push_back(d.nu);
  }
  put(store, "/mesh/regions/density", density);
  put(store, "/mesh/regions/E", E);
  put(store, "/mesh/regions/nu", nu);
  for (const auto& [name, set] : m.node_sets) put(store, "/mesh/sets/nodes/" + to_link_name(name), set);
  for (const auto& [name, set] : m.cell_sets) put(store, "/mesh/sets/cells/" + to_link_name(name), set);
  static_assert(sizeof(Facet) == 2 * sizeof(std::int64_t));
  for (const auto& [name, set] : m.facet_sets)
    put<std::int64_t>(store, "/mesh/sets/facets/" + to_link_name(name), {set.empty() ? nullptr : &set[0].cell, 2 * set.size()},
                      {static_cast<std::int64_t>(set.size()), 2});
  store.write_text("/mesh/deck_scene", m.deck_scene);
  store.flush();
  return store;
}

void write_tags(const std::string& path, const std::string& from, const std::vector<Fidelity>& fidelity,
                const std::vector<std::string>& provenance) {
  const std::string mesh = holder(Store::open(from), "mesh");
  Store store = Store::create(path);
  head(store, "tags", provenance);
  link_to(store, "mesh", mesh);
  std::vector<std::string> tags;
  for (const auto f : fidelity) tags.emplace_back(word(f));
  const Store source = Store::open(mesh);
  store.write_strings("/tags/region", source.read_strings("/mesh/regions/name"));
  store.write_strings("/tags/fidelity", tags);
  store.publish();
}

void write_parts(const std::string& path, const std::string& from, int n_parts, const std::vector<std::int32_t>& rank,
                 const std::vector<std::string>& provenance) {
  const Store source = Store::open(from);
  const std::string mesh = holder(source, "mesh");
  Store store = Store::create(path);
  head(store, "parts", provenance);
  link_to(store, "mesh", mesh);
  if (source.has("/tags") || source.linked("/tags")) link_to(store, "tags", holder(source, "tags"));
  put(store, "/parts/rank", rank);
  store.set("/parts/rank", "n_parts", std::int64_t{n_parts});
  store.publish();
}

}  // namespace hilo
