// Every rank reads a slice of the rows; cells travel to the rank that computes them, and nodes, sets and names follow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "model/local_mesh.hpp"
#include "model/mesh_source.hpp"
#include "model/partition.hpp"

namespace hilo {
namespace {

using Rows = std::vector<std::int64_t>;

/// Rows cut into one contiguous slice per rank.
struct Slices {
  std::int64_t n = 0;
  int size = 1;
  std::int64_t first(int rank) const { return n * rank / size; }
  int holder(std::int64_t row) const { return static_cast<int>((size * (row + 1) - 1) / n); }
};

void sort_unique(Rows& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

class Distribution {
 public:
  Distribution(const std::string& path, const Comm& comm) : comm_(comm), file_(Store::open(path)) { out_.file = path; }
  LocalMesh run() {
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

 private:
  enum Kind { node, cell, facet };
  struct Set {
    Kind kind;
    std::string name, array;
    std::int64_t rows;
  };

  const Store& mesh_file() const { return other_ ? *other_ : file_; }
  Error damaged(const std::string& what) const { return Error(mesh_file().path(), "damaged: " + what); }

  /// Everything that is small and the same on all ranks; its errors are the same too.
  void open() {
    const std::string format = checked_format(file_);
    out_.provenance = file_.read_strings("/provenance");
    if (!file_.linked("/mesh") && !file_.has("/mesh")) throw Error(file_.path(), fmt::format("this {} file has no mesh", format));
    if (const auto target = holder(file_, "mesh"); target != file_.path()) {
      other_ = Store::open(target);
      checked_format(*other_);
      if (comm_.rank == 0) warn_if_changed(file_, "mesh", target);
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

  void read_tags() {
    out_.fidelity.assign(out_.mesh.region_name.size(), Fidelity::nonlinear);
    if (!file_.linked("/tags") && !file_.has("/tags")) return;
    out_.tagged = true;
    const std::string target = holder(file_, "tags");
    std::optional<Store> tags;
    if (target != file_.path()) {
      tags = Store::open(target);
      checked_format(*tags);
      if (comm_.rank == 0) warn_if_changed(file_, "tags", target);
    }
    const auto words = (tags ? *tags : file_).read_strings("/tags/fidelity");
    if (words.size() != out_.fidelity.size())
      throw Error(file_.path(), fmt::format("{} tags for the {} regions of the mesh", words.size(), out_.fidelity.size()),
                  "the mesh has changed: tag it again");
    for (size_t r = 0; r < words.size(); ++r) out_.fidelity[r] = fidelity_of(words[r], target);
  }

  /// This rank's slices of the cells and of the node coordinates.
  void read_cells() {
    const Store& s = mesh_file();
    const auto first = cells_.first(comm_.rank), n = cells_.first(comm_.rank + 1) - first;
    shape_ = s.read_rows<std::uint8_t>("/mesh/cells/shape", first, n);
    region_ = s.read_rows<std::int32_t>("/mesh/cells/region", first, n);
    cell_id_ = s.read_rows<std::int64_t>("/mesh/cells/id", first, n);
    offset_ = s.read_rows<std::int64_t>("/mesh/cells/offset", first, n + 1);
    if (s.shape("/mesh/cells/offset").at(0) != cells_.n + 1 || s.shape("/mesh/cells/region").at(0) != cells_.n)
      throw damaged("/mesh/cells");
    for (std::int64_t c = 0; c < n; ++c) {
      if (shape_[c] >= n_shapes) throw damaged(fmt::format("/mesh/cells/shape of cell {} is {}", first + c, shape_[c]));
      if (offset_[c + 1] - offset_[c] != info(shape_[c]).n_nodes)
        throw damaged(fmt::format("/mesh/cells/offset of cell {} is {}, not {}", first + c + 1, offset_[c + 1],
                                  offset_[c] + info(shape_[c]).n_nodes));
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
    if (n_parts_ == 0) return;
    part_ = file_.read_rows<std::int32_t>("/parts/rank", first, n);
    for (const auto r : part_)
      if (r < 0 || r >= n_parts_) throw Error(file_.path(), fmt::format("damaged: /parts/rank holds {}, there are {} parts", r, n_parts_));
  }

  /// Ask the holders of sorted rows; the answers come in the order of the rows, `width` values each.
  template <class T>
  std::vector<T> fetch(const Rows& rows, const std::vector<T>& slice, int width) const {
    std::vector<Rows> ask(comm_.size);
    for (const auto row : rows) ask[nodes_.holder(row)].push_back(row);
    const auto asked = comm_.exchange(ask);
    std::vector<std::vector<T>> answer(comm_.size);
    for (int r = 0; r < comm_.size; ++r)
      for (const auto row : asked[r]) {
        const auto at = (row - nodes_.first(comm_.rank)) * width;
        answer[r].insert(answer[r].end(), slice.begin() + at, slice.begin() + at + width);
      }
    std::vector<T> values;
    for (const auto& list : comm_.exchange(answer)) values.insert(values.end(), list.begin(), list.end());
    return values;
  }

  std::vector<int> choose_ranks() const {
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
      const bool rigid = out_.fidelity[region_[c]] == Fidelity::rigid;
      cloud.x.push_back(centre / static_cast<double>(offset_[c + 1] - offset_[c]));
      cloud.work.push_back(rigid ? info(shape_[c]).n_nodes : work_of_cell[shape_[c]]);  // of a rigid cell: what is stored
      cloud.kind.push_back(rigid);
    }
    return bisect(cloud, comm_.size, comm_);
  }

  void send_cells(const std::vector<int>& part) {
    rank_of_cell_.assign(part.begin(), part.end());
    std::vector<Rows> send(comm_.size);
    const auto first = cells_.first(comm_.rank);
    for (size_t c = 0; c < part.size(); ++c) {
      auto& to = send[part[c]];
      to.insert(to.end(), {first + static_cast<std::int64_t>(c), shape_[c], region_[c], cell_id_[c]});
      to.insert(to.end(), cell_nodes_.begin() + (offset_[c] - offset_[0]), cell_nodes_.begin() + (offset_[c + 1] - offset_[0]));
    }
    Rows().swap(cell_nodes_), Rows().swap(offset_), Rows().swap(cell_id_), std::vector<std::uint8_t>().swap(shape_);
    for (const auto& list : comm_.exchange(send))  // slices come in the order of their ranks: rows stay sorted
      for (size_t k = 0; k < list.size();) {
        const auto shape = static_cast<Shape>(list[k + 1]);
        const auto n = static_cast<size_t>(info(shape).n_nodes);
        out_.cell_global.push_back(list[k]);
        out_.mesh.add_cell(shape, {&list[k + 4], n}, static_cast<std::int32_t>(list[k + 2]), list[k + 3]);
        k += 4 + n;
      }
  }

  std::int64_t local_node(std::int64_t row) const {
    const auto at = std::lower_bound(out_.node_global.begin(), out_.node_global.end(), row);
    return at != out_.node_global.end() && *at == row ? at - out_.node_global.begin() : -1;
  }
  std::int64_t local_cell(std::int64_t row) const {
    return std::lower_bound(out_.cell_global.begin(), out_.cell_global.end(), row) - out_.cell_global.begin();
  }

  /// The nodes of the local cells and the lone nodes of sets; every holder of a slice learns who has which of its nodes.
  void collect_nodes() {
    Rows& rows = out_.node_global;
    rows = out_.mesh.nodes;
    sort_unique(rows);
    std::vector<Rows> tell(comm_.size);
    for (const auto row : rows) tell[nodes_.holder(row)].push_back(2 * row + 1);  // odd: has a cell
    for (const auto row : lone_nodes_)
      if (!std::binary_search(out_.node_global.begin(), out_.node_global.end(), row)) tell[nodes_.holder(row)].push_back(2 * row);
    rows.insert(rows.end(), lone_nodes_.begin(), lone_nodes_.end());
    sort_unique(rows);
    const auto told = comm_.exchange(tell);
    const auto first = nodes_.first(comm_.rank), n = nodes_.first(comm_.rank + 1) - first;
    holders_.resize(n), owner_.assign(n, -1);
    for (int r = 0; r < comm_.size; ++r)
      for (const auto word : told[r]) {
        const auto i = word / 2 - first;
        if (holders_[i].empty() || holders_[i].back() != r) holders_[i].push_back(r);
        if (word % 2 && owner_[i] < 0) owner_[i] = r;
      }
    // nodes of no cell belong to rank 0
    std::vector<Rows> orphans(comm_.size);
    for (std::int64_t i = 0; i < n; ++i) {
      if (owner_[i] >= 0) continue;
      owner_[i] = 0;
      if (!holders_[i].empty()) continue;
      holders_[i].push_back(0);
      orphans[0].push_back(first + i);
    }
    for (const auto& list : comm_.exchange(orphans)) rows.insert(rows.end(), list.begin(), list.end());
    sort_unique(rows);
    for (auto& i : out_.mesh.nodes) i = local_node(i);
  }

  void find_owners() {
    const Rows& rows = out_.node_global;
    std::vector<std::int64_t> facts;  // owner, and whether several ranks have the node
    facts.reserve(2 * owner_.size());
    for (size_t i = 0; i < owner_.size(); ++i) facts.insert(facts.end(), {owner_[i], holders_[i].size() > 1});
    const auto known = fetch(rows, facts, 2);
    out_.node_owned.resize(rows.size()), shared_.resize(rows.size());
    for (size_t i = 0; i < rows.size(); ++i) out_.node_owned[i] = known[2 * i] == comm_.rank, shared_[i] = known[2 * i + 1] != 0;
    const auto X = fetch(rows, X_, 3);
    out_.mesh.X.resize(rows.size());
    for (size_t i = 0; i < rows.size(); ++i) out_.mesh.X[i] = Vec3(X[3 * i], X[3 * i + 1], X[3 * i + 2]);
    out_.mesh.node_id = fetch(rows, node_id_, 1);
    double box[6];
    for (int k = 0; k < 6; ++k) {
      double high = -1e300;
      for (size_t i = k % 3; i < X_.size(); i += 3) high = std::max(high, k < 3 ? -X_[i] : X_[i]);
      box[k] = comm_.max(high);
    }
    if (nodes_.n > 0) out_.length = std::hypot(box[0] + box[3], box[1] + box[4], box[2] + box[5]);
    std::vector<double>().swap(X_), Rows().swap(node_id_);
  }

  /// Every rank reads a slice of each set and hands the entries to the holders of their rows, who know which ranks want them.
  void share_sets() {
    std::vector<Rows> entries(comm_.size);
    comm_.together([&] {
      for (size_t s = 0; s < sets_.size(); ++s) {
        const Slices slices{sets_[s].rows, comm_.size};
        const auto first = slices.first(comm_.rank), n = slices.first(comm_.rank + 1) - first;
        const auto values = mesh_file().read_rows<std::int64_t>(sets_[s].array, first, n);
        const int width = sets_[s].kind == facet ? 2 : 1;
        if (static_cast<std::int64_t>(values.size()) != width * n) throw damaged(sets_[s].array + " has a wrong number of columns");
        for (std::int64_t i = 0; i < n; ++i) {
          const auto row = values[i * width];
          const Slices& of = sets_[s].kind == node ? nodes_ : cells_;
          if (row < 0 || row >= of.n) throw damaged(fmt::format("{} holds {}, allowed is 0 to {}", sets_[s].array, row, of.n - 1));
          entries[of.holder(row)].insert(entries[of.holder(row)].end(),
                                         {static_cast<std::int64_t>(s), row, width == 2 ? values[2 * i + 1] : 0});
        }
      }
    });
    std::vector<Rows> forward(comm_.size);
    for (const auto& list : comm_.exchange(entries))
      for (size_t k = 0; k < list.size(); k += 3) {
        const auto pass = [&](int r) { forward[r].insert(forward[r].end(), list.begin() + k, list.begin() + k + 3); };
        if (sets_[list[k]].kind == node)
          for (const int r : holders_[list[k + 1] - nodes_.first(comm_.rank)]) pass(r);
        else
          pass(rank_of_cell_[list[k + 1] - cells_.first(comm_.rank)]);
      }
    Mesh& m = out_.mesh;
    const auto received = comm_.exchange(forward);
    comm_.together([&] {
      for (const auto& list : received)
        for (size_t k = 0; k < list.size(); k += 3) {
          const Set& set = sets_[list[k]];
          if (set.kind == node) {
            m.node_sets[set.name].push_back(local_node(list[k + 1]));
            continue;
          }
          const auto c = local_cell(list[k + 1]);
          if (set.kind == cell) {
            m.cell_sets[set.name].push_back(c);
            continue;
          }
          if (list[k + 2] < 0 || list[k + 2] >= static_cast<std::int64_t>(info(m.shape[c]).facets.size()))
            throw damaged(fmt::format("{} names facet {} of a {}", set.array, list[k + 2], info(m.shape[c]).name));
          m.facet_sets[set.name].push_back({c, list[k + 2]});
        }
    });
    for (auto& [name, set] : m.node_sets) std::sort(set.begin(), set.end());
    for (auto& [name, set] : m.cell_sets) std::sort(set.begin(), set.end());
    for (auto& [name, set] : m.facet_sets)
      std::sort(set.begin(), set.end(),
                [](const Facet& a, const Facet& b) { return std::pair(a.cell, a.facet) < std::pair(b.cell, b.facet); });
  }

  /// A shared node may belong to a name through a cell of another rank: all ranks that have the node learn it.
  void complete_names() {
    const Mesh& m = out_.mesh;
    std::vector<std::string> names = m.region_name;
    std::vector<std::pair<std::int64_t, std::int64_t>> mine;  // row of a shared node, name
    const auto belongs = [&](std::span<const std::int64_t> nodes, size_t name) {
      for (const auto i : nodes)
        if (shared_[i]) mine.emplace_back(out_.node_global[i], name);
    };
    for (std::int64_t c = 0; c < m.n_cells(); ++c) belongs(m.cell(c), m.region[c]);
    // where kinds of sets share a name, Mesh::nodes_of takes the first of region, node set, facet set and cell set
    const auto is_taken = [&](const std::string& name) { return m.find_region(name) >= 0 || m.node_sets.contains(name); };
    for (const auto& [name, set] : m.facet_sets) {
      if (is_taken(name)) continue;
      for (const auto& f : set) belongs(m.facet_nodes(f), names.size());
      names.push_back(name);
    }
    for (const auto& [name, set] : m.cell_sets) {
      if (is_taken(name) || m.facet_sets.contains(name)) continue;
      for (const auto c : set) belongs(m.cell(c), names.size());
      names.push_back(name);
    }
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    std::vector<Rows> tell(comm_.size), forward(comm_.size);
    for (const auto& [row, name] : mine) tell[nodes_.holder(row)].insert(tell[nodes_.holder(row)].end(), {row, name});
    const auto told = comm_.exchange(tell);
    for (int from = 0; from < comm_.size; ++from)
      for (size_t k = 0; k < told[from].size(); k += 2)
        for (const int r : holders_[told[from][k] - nodes_.first(comm_.rank)])
          if (r != from) forward[r].insert(forward[r].end(), {told[from][k], told[from][k + 1]});
    for (const auto& list : comm_.exchange(forward))
      for (size_t k = 0; k < list.size(); k += 2)
        if (!std::binary_search(mine.begin(), mine.end(), std::pair(list[k], list[k + 1])))
          out_.elsewhere[names[list[k + 1]]].push_back(local_node(list[k]));
    for (auto& [name, nodes] : out_.elsewhere) sort_unique(nodes);
  }

  const Comm& comm_;
  LocalMesh out_;
  Store file_;
  std::optional<Store> other_;  // the mesh, where file_ links to it
  std::vector<Set> sets_;
  Rows lone_nodes_;  // of sets of one node
  Slices nodes_, cells_;
  int n_parts_ = 0;  // of a parts file
  // this rank's slice of the file
  std::vector<std::uint8_t> shape_;
  std::vector<std::int32_t> region_, part_;
  Rows cell_id_, offset_, cell_nodes_, node_id_;
  std::vector<double> X_;
  std::vector<int> rank_of_cell_;          // where each cell of the slice went
  std::vector<std::vector<int>> holders_;  // ranks that have each node of the slice, ascending
  std::vector<int> owner_;                 // the one among them that owns it
  std::vector<char> shared_;               // of local nodes: other ranks have it too
};

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
  return comm.size == 1 ? whole_mesh(path) : Distribution(path, comm).run();
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
