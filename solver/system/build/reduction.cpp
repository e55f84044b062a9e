// SPDX-License-Identifier: GPL-3.0-or-later
// From the cells, interfaces and loads of a linear region, on all ranks, to its modes on the first.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "base/shell_shape.hpp"
#include "linear/shared_cholesky.hpp"
#include "system/build/builder.hpp"
#include "system/build/region_parcel.hpp"
#include "system/joints.hpp"
#include "system/linear_regions.hpp"
#include "system/tied_surfaces.hpp"

namespace hilo {
namespace {

constexpr size_t told_from = 100000;  // unknowns of a region from which its reduction tells how far it is

}  // namespace

bool Builder::is_of(std::int64_t cell, int linear_body) const {
  const Region& region = regions_[mesh_->mesh.region[cell]];
  return region.fidelity == Fidelity::linear && region.body == linear_body;
}

/// Collective.
RegionParcel Builder::parcel_of(int number) {
  const Mesh& mesh = mesh_->mesh;
  const int body = out_->modes[number].body;
  RegionParcel out;
  for (const Region& region : regions_)
    if (region.fidelity == Fidelity::linear && region.body == body) {
      out.modal_damping = region.modal_damping, out.up_to = std::max(out.up_to, region.up_to);
      out.n_vibrations = std::max(out.n_vibrations, region.n_vibrations);
      out.modes_given = out.modes_given || region.modes_given;
      out.stiffening = out.stiffening || region.stiffening;
      out.where = region.place;
      if (!region.shapes.empty()) out.shapes = region.shapes, out.shapes_where = region.shapes_where;
    }
  const auto to_first = [&](const auto& list) {
    std::vector<std::decay_t<decltype(list)>> to(comm_.size);
    to[0] = list;
    return comm_.exchange(to);
  };
  std::vector<std::int64_t> words, nodes;
  std::vector<double> places;
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
    if (is_of(e, body)) {
      const Shape shape = taken_as(e, nodes);
      words.push_back(mesh.region[e]), words.push_back(static_cast<std::int64_t>(shape));
      for (const std::int64_t node : nodes) {
        words.push_back(mesh_->node_global[node]);
        places.insert(places.end(), out_->X[node].data(), out_->X[node].data() + 3);
      }
    }
  out.words = to_first(words), out.places = to_first(places);
  std::vector<char> free(out_->X.size(), 0);
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
    if (regions_[mesh.region[e]].fidelity == Fidelity::nonlinear)
      for (const std::int64_t node : mesh.cell(e)) free[node] = out_->follower[node] == body;
  std::vector<std::int64_t> rows;
  for (size_t i = 0; i < free.size(); ++i)
    if (free[i]) rows.push_back(mesh_->node_global[i]);
  out.interfaces.push_back(to_first(rows));
  std::set<int> joined;
  for (const Joint& j : out_->part<Joints>().list)
    for (const Carrier& end : j.ends()) joined.insert(end.body);
  for (Weld& w : out_->part<Welds>().list)
    if (w.modes == number) {
      const Body& other = out_->bodies[w.body];
      w.yields = w.of_block && other.block && !other.held && !joined.contains(w.body);
      out.welds.push_back(&w);
      rows.clear();
      for (const int i : w.nodes) rows.push_back(mesh_->node_global[i]);
      out.interfaces.push_back(to_first(rows));
    }
  for (const TiedGroup& group : tied_groups(*out_))
    if (group.body == body) {
      auto& [name, its] = out.tied.emplace_back(group.name, std::vector<std::int64_t>());
      for (const int i : group.nodes) its.push_back(mesh_->node_global[i]);
    }
  add_interfaces(body, out);
  std::vector<NodalForces> forces;
  for (const Loading* part : out_->all<Loading>()) part->add_reference_forces(forces);
  std::vector<std::int64_t> load_sizes;
  std::vector<double> loads;
  for (const NodalForces& list : forces) {
    load_sizes.push_back(0);
    for (const auto& [node, force] : list) {
      if (out_->follower[node] != body) continue;
      ++load_sizes.back();
      loads.push_back(static_cast<double>(mesh_->node_global[node]));
      loads.insert(loads.end(), force.data(), force.data() + 3);
    }
  }
  rows.clear();
  for (size_t i = 0; i < mesh.block.size(); ++i)
    if (mesh.block[i] >= 0 && out_->follower[i] == body) rows.push_back(mesh_->node_global[i]), rows.push_back(mesh.block[i]);
  out.blocks = to_first(rows);
  if (!out.shapes.empty()) {
    rows.clear();
    for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
      if (is_of(e, body))
        for (const std::int64_t i : mesh.cell(e)) rows.push_back(mesh_->node_global[i]), rows.push_back(mesh.node_id[i]);
    out.numbers = to_first(rows);
  }
  out.load_sizes = to_first(load_sizes), out.loads = to_first(loads);
  if (comm_.rank == 0) {
    out.each_cell([&](int, Shape, std::span<const std::int64_t> nodes, const double*) {
      for (const std::int64_t row : nodes) out.local.try_emplace(row, 0);
    });
    int n = 0;
    for (auto& [row, place] : out.local) place = n++;
  }
  return out;
}

namespace {

/// Cells by their nodes: in the same order whatever ranks they came from, so that sums over them are the same bit by bit.
void sort_cells(SolidBatch& batch) {
  const auto n = static_cast<size_t>(info(batch.shape).n_nodes);
  const auto cell = [&](size_t e) { return std::span(batch.nodes).subspan(n * e, n); };
  std::vector<size_t> order(batch.nodes.size() / n);
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return std::ranges::lexicographical_compare(cell(a), cell(b)); });
  std::vector<int> nodes;
  nodes.reserve(batch.nodes.size());
  for (const size_t e : order) nodes.insert(nodes.end(), cell(e).begin(), cell(e).end());
  batch.nodes = std::move(nodes);
}

}  // namespace

/// On rank 0.
ReductionInput Builder::reduction_input(const RegionParcel& parcel, const Body& axes) const {
  ReductionInput in;
  in.X.resize(parcel.local.size());
  std::map<std::pair<int, Shape>, SolidBatch> by_kind;
  parcel.each_cell([&](int region, Shape shape, std::span<const std::int64_t> nodes, const double* X) {
    auto it = by_kind.find({region, shape});
    if (it == by_kind.end()) it = by_kind.emplace(std::pair(region, shape), batch_of(region, shape)).first;
    for (size_t a = 0; a < nodes.size(); ++a) {
      const int i = parcel.local.at(nodes[a]);
      in.X[i] = Vec3(X[3 * a], X[3 * a + 1], X[3 * a + 2]);
      it->second.nodes.push_back(i);
    }
  });
  for (auto& [kind, batch] : by_kind) {
    sort_cells(batch);
    const Region& r = regions_[kind.first];
    in.made_of.push_back((kind.second == shell8 ? "shell " : "") +
                         (r.material ? r.material->all_values() : fmt::format("E {} nu {}", r.E, r.nu)));
    in.cells.push_back(std::move(batch));
  }
  std::vector<char> taken(in.X.size(), 0);
  size_t n_yield = 0;
  for (size_t k = 0; k < parcel.welds.size(); ++k) {
    auto set = parcel.nodes_of(k + 1);
    std::erase_if(set, [&](int i) { return taken[i] != 0; });
    for (const int i : set) taken[i] = parcel.welds[k]->yields ? 2 : 1;
    n_yield += parcel.welds[k]->yields;
    if (!set.empty()) in.rigid.push_back(std::move(set)), in.rigid_names.push_back(parcel.welds[k]->name);
  }
  if (n_yield > most_free / 2)
    warn(axes.name,
         fmt::format("linear, it meets other shells at {} nodes of folds: they move together by polynomials of the fifth degree", n_yield));
  std::map<std::int64_t, std::set<int>> blocks;
  for (const auto& list : parcel.blocks)
    for (size_t k = 0; k < list.size(); k += 2)
      if (const auto i = parcel.local.find(list[k]); i != parcel.local.end()) blocks[list[k + 1]].insert(i->second);
  for (const auto& [block, nodes] : blocks)
    if (!std::ranges::all_of(nodes, [&](int i) { return taken[i] == 1; })) in.blocks.emplace_back(nodes.begin(), nodes.end());
  for (const auto& [name, of_tie] : parcel.tied) {
    std::vector<int> set;
    for (const std::int64_t row : of_tie)
      if (const int i = parcel.local.at(row); taken[i] == 0) set.push_back(i), taken[i] = 3;
    std::sort(set.begin(), set.end());
    if (set.size() > most_free)
      warn(axes.name,
           fmt::format("linear, {} nodes of it are of {}: they move together by polynomials of the fifth degree", set.size(), name));
    if (!set.empty()) in.tied.push_back(std::move(set)), in.tied_names.push_back(name);
  }
  in.free = parcel.nodes_of(0);
  std::erase_if(in.free, [&](int i) { return taken[i] != 0; });
  if (in.free.size() > most_free)
    warn(axes.name, fmt::format("linear, it shares {} nodes with nonlinear cells: they move together by polynomials of the fifth degree",
                                in.free.size()));
  in.loads.resize(parcel.load_sizes[0].size());
  for (size_t k = 0; k < parcel.loads.size(); ++k) {
    const double* v = parcel.loads[k].data();
    for (size_t load = 0; load < in.loads.size(); ++load)
      for (std::int64_t i = 0; i < parcel.load_sizes[k][load]; ++i, v += 4)
        in.loads[load].emplace_back(parcel.local.at(static_cast<std::int64_t>(v[0])), Vec3(v[1], v[2], v[3]));
  }
  std::erase_if(in.loads, [](const auto& load) { return load.empty(); });
  for (auto& load : in.loads) std::stable_sort(load.begin(), load.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  set_wishes(in, parcel, axes);
  if (!parcel.shapes.empty()) in.given = given_shapes(parcel);
  return in;
}

/// How many modes are asked for, and what there is to find them with.
void Builder::set_wishes(ReductionInput& in, const RegionParcel& parcel, const Body& axes) const {
  const double step = scene_.table("time").has("step") ? scene_.table("time").number("step") : 0;
  in.centre = axes.Xc;
  in.n_vibrations = parcel.n_vibrations, in.may_be_fewer = !parcel.modes_given;
  in.up_to = parcel.up_to > 0 ? parcel.up_to : step > 0 ? 0.1 / step : 0;
  in.stiffening = parcel.stiffening, in.length = axes.size;
  in.memory = room_.memory, in.scratch = room_.scratch;
  if (!is_quiet() && 3 * in.X.size() > told_from)
    in.progress = [name = axes.name](const std::string& what) { fmt::print(stderr, "linear region \"{}\": {}\n", name, what); };
}

/// The modes that a region is given, at its nodes.  On rank 0.
Eigen::MatrixXd Builder::given_shapes(const RegionParcel& parcel) const {
  const std::filesystem::path file = parcel.shapes;
  const std::string path = (scene_.folder == "." ? file : scene_.folder / file).string();
  const auto rows = read_rows_csv(path, parcel.shapes_where,
                                  {"a node and three of each shape", "node,x,y,z", [](size_t n) { return n > 1 && n % 3 == 1; }});
  std::map<std::int64_t, const std::vector<double>*> by_number;
  for (const auto& row : rows) by_number[std::llround(row[0])] = &row;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(parcel.local.size()),
                                              rows.empty() ? 0 : static_cast<Eigen::Index>(rows.front().size() / 3));
  const double length = to_si("m", scene_.units);
  for (const auto& list : parcel.numbers)
    for (size_t k = 0; k < list.size(); k += 2) {
      const auto it = by_number.find(list[k + 1]);
      if (it == by_number.end())
        throw Error(parcel.shapes_where, fmt::format("{} has no line for node {} of the region", path, list[k + 1]),
                    "a line for every node, by its number in the deck");
      for (Eigen::Index j = 0; j < out.cols(); ++j)
        out.block<3, 1>(3 * parcel.local.at(list[k]), j) = length * Vec3(it->second->data() + 1 + 3 * j);
    }
  return out;
}

/// As it is on file, where that fits, or found now.  On rank 0, with the others in the factor's serve().
Reduction Builder::reduction_of(const ReductionInput& in, const Body& axes, const std::string& where) {
  SharedCholesky factor(comm_);
  const auto named = [&](const std::string& what, const std::string& hint, Exit exit = Exit::input) {
    return Error(where, fmt::format("linear region \"{}\": {}", axes.name, what), hint, exit);
  };
  const ReductionKey key = key_of(in);
  std::optional<Reduction> out;
  std::error_code ignored;
  const bool grows = std::filesystem::is_directory(files_.from, ignored);
  const std::string from = grows ? kept_place(axes.name, key) : files_.from;
  if (!from.empty() && (!grows || std::filesystem::exists(from, ignored))) {
    const ReducedFile file(from);
    const std::string unfit = file.unfit(axes.name, key);
    if (unfit.empty())
      out = file.read(axes.name, in.X.size());
    else if (files_.to.empty() && !grows)
      throw named(fmt::format("{} does not serve: {}", files_.from, unfit),
                  fmt::format("hilo-reduce with this scene and mesh, -o {}", files_.from));
  }
  const bool kept = out.has_value();
  using Clock = std::chrono::steady_clock;
  const auto began = Clock::now();
  if (!kept) try {
      out = reduced(in, factor);
    } catch (const Error& e) {
      throw named(e.message, e.hint, e.exit);
    }
  if (!files_.to.empty()) {
    if (!is_quiet())
      fmt::print("{}: {} nodes, {} interfaces, {} modes{}\n", axes.name, in.X.size(), key.interfaces.size(), out->omega2.size(),
                 kept ? ", as before" : fmt::format(", found in {:.1f} s", std::chrono::duration<double>(Clock::now() - began).count()));
  }
  if (!files_.to.empty() || (grows && !kept)) reductions_.push_back({axes.name, key, {}});  // with what is returned, once it has served
  return std::move(*out);
}

std::string Builder::kept_place(const std::string& region, const ReductionKey& key) const {
  Digest all;
  for (const std::string* part : {&region, &key.mesh, &key.material, &key.loads, &key.basis}) all.add(*part);
  for (const auto* list : {&key.interfaces, &key.digests})
    for (const std::string& part : *list) all.add(part);
  return fmt::format("{}/{:016x}.h5", files_.from, all.value());
}

/// On rank 0, to the file that is made, or each to its own in the folder that grows, where other runs may write the same.
void Builder::keep_reductions() const {
  if (!files_.to.empty()) return write_reduced(files_.to, reductions_, files_.provenance);
  for (const KeptReduction& r : reductions_) {
    const std::string place = kept_place(r.region, r.key), own = fmt::format("{}.{}", place, getpid());
    write_reduced(own, {r}, files_.provenance);
    std::filesystem::rename(own, place);
  }
}

}  // namespace hilo
