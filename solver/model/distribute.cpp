// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "model/distribution.hpp"
#include "model/partition.hpp"

namespace hilo {
namespace division {

LocalMesh Distribution::run() {
  open();
  comm_.together([&] { read_cells(); });
  const auto part = choose_ranks();
  send_cells(part);
  collect_nodes();
  find_owners();
  share_sets();
  complete_names();
  return std::move(out_);
}

void Distribution::open() {
  const std::string format = checked_format(file_);
  out_.provenance = file_.read_strings("/provenance");
  if (!file_.linked("/mesh") && !file_.has("/mesh")) throw Error(file_.path(), fmt::format("this {} file has no mesh", format));
  if (const auto target = holder(file_, "mesh"); target != file_.path()) {
    other_ = Store::open(target);
    checked_format(*other_);
    refuse_changed("mesh", target);
  }
  const Store& s = mesh_file();
  Mesh& m = out_.mesh;
  m.region_name = s.read_strings("/mesh/regions/name");
  const auto density = s.read<double>("/mesh/regions/density"), E = s.read<double>("/mesh/regions/E"),
             nu = s.read<double>("/mesh/regions/nu");
  for (const auto* list : {&density, &E, &nu})
    if (list->size() != m.region_name.size())
      throw damaged(fmt::format("/mesh/regions has {} and {} entries", list->size(), m.region_name.size()));
  for (size_t r = 0; r < m.region_name.size(); ++r) m.region_data.push_back({density[r], E[r], nu[r]});
  read_blocks(s, m);
  if (s.has("/mesh/deck_scene")) m.deck_scene = s.read_text("/mesh/deck_scene");
  out_.n_nodes_global = s.shape("/mesh/nodes/X").at(0), out_.n_cells_global = s.shape("/mesh/cells/shape").at(0);
  nodes_ = {out_.n_nodes_global, comm_.size}, cells_ = {out_.n_cells_global, comm_.size};
  read_tags();
  if (file_.has("/parts/rank")) {
    n_parts_ = static_cast<int>(file_.number_attribute("/parts/rank", "n_parts").value_or(1));
    if (n_parts_ != comm_.size)
      throw Error(file_.path(), fmt::format("made for {} parts, this run has {} ranks", n_parts_, comm_.size),
                  fmt::format("hilo-part -n {}, or mpirun -n {}, or give the tags or mesh file", comm_.size, n_parts_));
    if (const auto n = file_.shape("/parts/rank").at(0); n != cells_.n)
      throw Error(file_.path(), fmt::format("parts of {} cells, the mesh has {}", n, cells_.n), "the mesh has changed: part it again");
  }
  const std::pair<Kind, const char*> groups[] = {{node, "/mesh/sets/nodes"}, {cell, "/mesh/sets/cells"}, {facet, "/mesh/sets/facets"}};
  for (const auto& [kind, group] : groups)
    for (const auto& link : s.list(group)) {
      const std::string array = fmt::format("{}/{}", group, link);
      sets_.push_back({kind, from_link_name(link), array, s.shape(array).at(0)});
      if (kind == node) m.node_sets[sets_.back().name];
      if (kind == cell) m.cell_sets[sets_.back().name];
      if (kind == facet) m.facet_sets[sets_.back().name];
      if (kind == node && sets_.back().rows == 1) lone_nodes_.push_back(s.read<std::int64_t>(array).at(0));
    }
  for (const auto row : lone_nodes_)
    if (row < 0 || row >= nodes_.n) throw damaged(fmt::format("a set of one node holds {}, allowed is 0 to {}", row, nodes_.n - 1));
}

/// One rank reads the whole file for its digest; all are refused alike.
void Distribution::refuse_changed(const std::string& what, const std::string& target) const {
  comm_.on_first([&] { refuse_if_changed(file_, what, target); });
}

void Distribution::read_tags() {
  out_.fidelity.assign(out_.mesh.region_name.size(), Fidelity::nonlinear);
  if (!file_.linked("/tags") && !file_.has("/tags")) return;
  out_.tagged = true;
  const std::string target = holder(file_, "tags");
  std::optional<Store> tags;
  if (target != file_.path()) {
    tags = Store::open(target);
    checked_format(*tags);
    refuse_changed("tags", target);
  }
  out_.fidelity = fidelity_by_name(tags ? *tags : file_, out_.mesh.region_name, file_.path());
}

void Distribution::read_cells() {
  const Store& s = mesh_file();
  const auto first = cells_.first(comm_.rank), n = cells_.first(comm_.rank + 1) - first;
  shape_ = s.read_rows<std::uint8_t>("/mesh/cells/shape", first, n);
  region_ = s.read_rows<std::int32_t>("/mesh/cells/region", first, n);
  cell_id_ = s.read_rows<std::int64_t>("/mesh/cells/id", first, n);
  offset_ = s.read_rows<std::int64_t>("/mesh/cells/offset", first, n + 1);
  if (s.shape("/mesh/cells/offset").at(0) != cells_.n + 1 || s.shape("/mesh/cells/region").at(0) != cells_.n) throw damaged("/mesh/cells");
  check_shapes(s, shape_, first);
  for (std::int64_t c = 0; c < n; ++c) {
    if (offset_[c + 1] - offset_[c] != info(shape_[c]).n_nodes)
      throw damaged(
          fmt::format("/mesh/cells/offset of cell {} is {}, not {}", first + c + 1, offset_[c + 1], offset_[c] + info(shape_[c]).n_nodes));
    if (region_[c] < 0 || region_[c] >= static_cast<std::int32_t>(out_.mesh.region_name.size()))
      throw damaged(fmt::format("/mesh/cells/region of cell {} is {}", first + c, region_[c]));
  }
  cell_nodes_ = s.read_rows<std::int64_t>("/mesh/cells/nodes", offset_[0], offset_[n] - offset_[0]);
  for (const auto i : cell_nodes_)
    if (i < 0 || i >= nodes_.n) throw damaged(fmt::format("/mesh/cells/nodes holds {}, allowed is 0 to {}", i, nodes_.n - 1));
  const auto first_node = nodes_.first(comm_.rank), n_nodes = nodes_.first(comm_.rank + 1) - first_node;
  X_ = s.read_rows<double>("/mesh/nodes/X", first_node, n_nodes);
  node_id_ = s.read_rows<std::int64_t>("/mesh/nodes/id", first_node, n_nodes);
  if (X_.size() != 3 * node_id_.size()) throw damaged("/mesh/nodes/X has not three columns");
  if (!out_.mesh.block_name.empty()) {
    block_ = s.read_rows<std::int64_t>("/mesh/nodes/block", first_node, n_nodes);
    if (block_.size() != node_id_.size()) throw damaged("/mesh/nodes/block is not as long as /mesh/nodes/id");
  }
  if (n_parts_ == 0) return;
  part_ = file_.read_rows<std::int32_t>("/parts/rank", first, n);
  for (const auto r : part_)
    if (r < 0 || r >= n_parts_) throw Error(file_.path(), fmt::format("damaged: /parts/rank holds {}, there are {} parts", r, n_parts_));
}

std::vector<int> Distribution::choose_ranks() const {
  if (!part_.empty() || n_parts_ > 0) return {part_.begin(), part_.end()};
  Rows rows = cell_nodes_;
  sort_unique(rows);
  const auto X = fetch(rows, X_, 3);
  Cloud cloud;
  for (size_t c = 0; c < shape_.size(); ++c) {
    Vec3 centre = Vec3::Zero();
    for (auto i = offset_[c]; i < offset_[c + 1]; ++i) {
      const auto at = std::lower_bound(rows.begin(), rows.end(), cell_nodes_[i - offset_[0]]) - rows.begin();
      centre += Vec3(X[3 * at], X[3 * at + 1], X[3 * at + 2]);
    }
    const bool rigid = out_.fidelity[region_[c]] != Fidelity::nonlinear;
    cloud.x.push_back(centre / static_cast<double>(offset_[c + 1] - offset_[c]));
    cloud.work.push_back(rigid ? info(shape_[c]).n_nodes : work_of_cell(static_cast<Shape>(shape_[c])));  // of a rigid cell: what is stored
    cloud.kind.push_back(rigid);
  }
  return bisect(cloud, comm_.size, comm_);
}

}  // namespace division

namespace {

LocalMesh whole_mesh(const std::string& path) {
  MeshFile f = read_mesh_file(path);
  LocalMesh out;
  out.mesh = std::move(f.mesh);
  out.fidelity = std::move(f.fidelity);
  out.tagged = f.tagged;
  out.n_nodes_global = out.mesh.n_nodes(), out.n_cells_global = out.mesh.n_cells();
  out.node_global.resize(out.mesh.X.size()), out.cell_global.resize(out.mesh.shape.size());
  for (size_t i = 0; i < out.node_global.size(); ++i) out.node_global[i] = static_cast<std::int64_t>(i);
  for (size_t c = 0; c < out.cell_global.size(); ++c) out.cell_global[c] = static_cast<std::int64_t>(c);
  out.node_owned.assign(out.mesh.X.size(), 1);
  out.file = path;
  out.provenance = std::move(f.provenance);
  Eigen::AlignedBox3d box;
  for (const Vec3& x : out.mesh.X) box.extend(x);
  if (!box.isEmpty()) out.length = box.diagonal().norm();
  return out;
}

}  // namespace

LocalMesh read_local_mesh(const std::string& path, const Comm& comm) {
  return comm.size == 1 ? whole_mesh(path) : division::Distribution(path, comm).run();
}

std::int64_t LocalMesh::put_first(const std::vector<char>& marked) {
  std::vector<std::int64_t> from;
  for (const bool wanted : {true, false})
    for (size_t i = 0; i < marked.size(); ++i)
      if ((marked[i] != 0) == wanted) from.push_back(static_cast<std::int64_t>(i));
  reorder(from);
  return std::count_if(marked.begin(), marked.end(), [](char m) { return m != 0; });
}

void LocalMesh::reorder(const std::vector<std::int64_t>& from) {
  std::vector<std::int64_t> to(from.size());
  for (size_t i = 0; i < from.size(); ++i) to[from[i]] = static_cast<std::int64_t>(i);
  const auto permute = [&](auto& values) {
    auto old = values;
    for (size_t i = 0; i < from.size(); ++i) values[i] = old[from[i]];
  };
  permute(mesh.X), permute(mesh.node_id), permute(node_global), permute(node_owned);
  if (!mesh.block.empty()) permute(mesh.block);
  for (auto& node : mesh.nodes) node = to[node];
  const auto renumber = [&](std::vector<std::int64_t>& list) {
    for (auto& node : list) node = to[node];
    std::sort(list.begin(), list.end());
  };
  for (auto& [name, list] : mesh.node_sets) renumber(list);
  for (auto& [name, list] : elsewhere) renumber(list);
}

std::vector<std::int64_t> LocalMesh::nodes_of(const std::string& name, const std::string& where) const {
  const auto mine = mesh.nodes_of(name, where);
  const auto it = elsewhere.find(name);
  if (it == elsewhere.end()) return mine;
  std::vector<std::int64_t> all;
  std::set_union(mine.begin(), mine.end(), it->second.begin(), it->second.end(), std::back_inserter(all));
  return all;
}

}  // namespace hilo
