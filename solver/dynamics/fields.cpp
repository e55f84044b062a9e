// Fields of the recorder: displacement, velocity, acceleration and stress of nodes, and the XDMF sidecar for ParaView.
#include <fmt/format.h>

#include <algorithm>

#include "dynamics/profile.hpp"
#include "dynamics/recorder.hpp"
#include "model/region_surface.hpp"

namespace hilo {

/// Rows of the fields: all nodes in the order of the mesh file, or those on the surfaces of regions; followers and, in parallel, parts.
void Recorder::declare_rows() {
  const System& s = system_;
  const LocalMesh& m = *s.mesh;
  const Comm& comm = *s.comm;
  const auto n_nodes = static_cast<std::int64_t>(s.X.size());
  std::int64_t n = m.n_nodes_global;
  node_row_ = m.node_global;
  std::vector<Facet> facets;
  std::vector<std::int64_t> skin;
  if (setup_.skin) {
    facets = region_surface(m, comm);
    for (const Facet& f : facets)
      for (const std::int64_t node : m.mesh.facet_nodes(f)) skin.push_back(m.node_global[node]);
    for (std::int64_t c = 0; c < m.mesh.n_cells(); ++c)
      if (info(m.mesh.shape[c]).dimension < 3)
        for (const std::int64_t node : m.mesh.cell(c)) skin.push_back(m.node_global[node]);
    const auto unite = [&] {
      std::sort(skin.begin(), skin.end());
      skin.erase(std::unique(skin.begin(), skin.end()), skin.end());
    };
    unite();
    const auto all = comm.exchange(std::vector<std::vector<std::int64_t>>(comm.size, skin));
    for (const auto& list : all) skin.insert(skin.end(), list.begin(), list.end());
    unite();
    n = static_cast<std::int64_t>(skin.size());
    for (std::int64_t& row : node_row_) {
      const auto at = std::lower_bound(skin.begin(), skin.end(), row);
      row = at != skin.end() && *at == row ? at - skin.begin() : -1;
    }
  }
  std::vector<std::int64_t> mine = node_row_, everyones = m.node_global;
  for (std::int64_t i = 0; i < n_nodes; ++i)
    if (!s.node_owned[i]) mine[i] = everyones[i] = -1;
  nodes_.emplace(comm, std::move(mine), n);
  cells_.emplace(comm, m.cell_global, m.n_cells_global);

  std::vector<std::vector<std::int64_t>> followers(comm.size);  // node, body
  for (std::int64_t i = 0; i < n_nodes; ++i)
    if (s.node_owned[i] && s.follower[i] > 0) followers[0].push_back(m.node_global[i]), followers[0].push_back(s.follower[i] - 1);
  const auto received = comm.exchange(followers);
  on_store([&](Store& f) {
    std::vector<std::pair<std::int64_t, std::int32_t>> pairs;
    for (const auto& list : received)
      for (size_t k = 0; k < list.size(); k += 2) pairs.emplace_back(list[k], static_cast<std::int32_t>(list[k + 1]));
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::int64_t> nodes;
    std::vector<std::int32_t> bodies;
    for (const auto& [node, body] : pairs) nodes.push_back(node), bodies.push_back(body);
    const auto count = static_cast<std::int64_t>(nodes.size());
    f.write<std::int64_t>("/body/follower_node", nodes, {count}, "", "nodes that follow a body");
    f.write<std::int32_t>("/body/follower_body", bodies, {count}, "", "the body each follows");
    if (setup_.skin) f.write<std::int64_t>("/skin/node", skin, {n}, "", "nodes of the mesh that the fields hold, a row each");
  });
  if (comm.size > 1) {
    const std::vector<double> rank(m.cell_global.size(), comm.rank);
    const auto piece = cells_->collect(rank, 1);
    std::vector<std::vector<std::int64_t>> to(comm.size);
    for (const double r : piece) to[0].push_back(static_cast<std::int64_t>(r));
    const auto pieces = comm.exchange(to);
    on_store([&](Store& f) {
      std::vector<std::int32_t> all;
      for (const auto& list : pieces) all.insert(all.end(), list.begin(), list.end());
      f.write<std::int32_t>("/parts/rank", all, {m.n_cells_global});
      f.set("/parts/rank", "n_parts", static_cast<std::int64_t>(comm.size));
    });
  }
  if (setup_.skin) write_skin(facets);
}

void Recorder::write_piece(const Slabs& rows, const std::string& array, const std::vector<double>& piece, int width, const char* unit,
                           const char* meaning, bool exact) {
  try {
    Store* f = failure_ ? nullptr : store_.get();
    if (setup_.single_precision && !exact)
      rows.write<float>(f, setup_.path, array, piece, width, unit, meaning);
    else
      rows.write<double>(f, setup_.path, array, piece, width, unit, meaning);
  } catch (const Error& e) {
    if (!failure_) failure_ = e;
  }
}

void Recorder::write_field(const Row& row, const Config& a) {
  const System& s = system_;
  if (!s.mesh) return;
  const std::string group = fmt::format("/field/{:06}", n_fields_++);
  const auto vectors = [&](const char* name, auto value, const char* unit) {
    std::vector<double> local;
    local.reserve(3 * s.X.size());
    for (size_t i = 0; i < s.X.size(); ++i) {
      const Vec3 v = value(i);
      local.insert(local.end(), v.data(), v.data() + 3);
    }
    write_piece(*nodes_, group + "/" + name, nodes_->collect(local, 3), 3, unit, "");
  };
  if (setup_.wants("displacement"))
    vectors(
        "displacement", [&](size_t i) { return Vec3(row.q.x[i] - s.X[i]); }, "m");
  if (setup_.wants("velocity"))
    vectors(
        "velocity", [&](size_t i) { return row.v.x[i]; }, "m/s");
  if (setup_.wants("acceleration"))
    vectors(
        "acceleration", [&](size_t i) { return a.x[i]; }, "m/s^2");
  if (setup_.wants("stress") || setup_.wants("von_mises") || setup_.wants("stress_error")) write_stress(row, group);
  field_times_.push_back(row.t);
  on_store([&](Store& f) {
    f.set(group, "t", row.t);
    if (wall_clock() - last_xdmf_ > 1) f.flush(), write_xdmf(), last_xdmf_ = wall_clock();
  });
}

/// The drawn facets and bars as XDMF's mixed list, in the order of the cells, with the positions of their nodes.
void Recorder::write_skin(const std::vector<Facet>& facets) {
  const LocalMesh& m = *system_.mesh;
  std::vector<std::vector<std::int64_t>> send(system_.comm->size);  // cell, facet, region, length, entries
  const auto put = [&](std::int64_t c, std::int64_t facet, std::initializer_list<std::int64_t> head, std::span<const std::int64_t> nodes) {
    auto& to = send[0];
    to.insert(to.end(), {m.cell_global[c], facet, m.mesh.region[c], static_cast<std::int64_t>(head.size() + nodes.size())});
    to.insert(to.end(), head.begin(), head.end());
    for (const std::int64_t n : nodes) to.push_back(node_row_[n]);
  };
  for (const Facet& f : facets) {
    const auto nodes = m.mesh.facet_nodes(f);
    const size_t n = nodes.size();
    put(f.cell, f.facet, {n == 3 ? 4 : n == 4 ? 5 : n == 6 ? 36 : 37}, nodes);  // triangle, quadrilateral, their quadratic likes
  }
  for (std::int64_t c = 0; c < m.mesh.n_cells(); ++c)
    if (info(m.mesh.shape[c]).dimension < 3) put(c, 0, {info(m.mesh.shape[c]).xdmf_type, 2}, m.mesh.cell(c));
  const auto received = system_.comm->exchange(send);
  std::vector<const std::int64_t*> items;
  for (const auto& list : received)
    for (size_t k = 0; k < list.size(); k += 4 + list[k + 3]) items.push_back(&list[k]);
  std::sort(items.begin(), items.end(), [](const auto* a, const auto* b) { return std::pair(a[0], a[1]) < std::pair(b[0], b[1]); });
  std::vector<std::int64_t> topology;
  std::vector<std::int32_t> region;
  for (const auto* item : items) {
    region.push_back(static_cast<std::int32_t>(item[2]));
    topology.insert(topology.end(), item + 4, item + 4 + item[3]);
  }
  topology_entries_ = static_cast<std::int64_t>(topology.size()), topology_cells_ = static_cast<std::int64_t>(region.size());
  on_store([&](Store& f) {
    f.write<std::int64_t>("/xdmf/topology", topology, {topology_entries_}, "", "cells as XDMF's mixed list");
    f.write<std::int32_t>("/xdmf/region", region, {topology_cells_}, "", "region of each cell");
  });
  std::vector<double> X;
  for (const Vec3& x : system_.X) X.insert(X.end(), x.data(), x.data() + 3);
  write_piece(*nodes_, "/xdmf/X", nodes_->collect(X, 3), 3, "m", "reference positions, repeated here for ParaView", true);
}

/// The cells of the mesh file as XDMF's mixed list, slice by slice, so that no rank holds the whole mesh.
void Recorder::write_topology() {
  const LocalMesh& m = *system_.mesh;
  const Store mesh = Store::open(m.file);
  constexpr std::int64_t slice = 1 << 16;
  store_->start_rows<std::int64_t>("/xdmf/topology", {}, "", "cells as XDMF's mixed list");
  store_->start_rows<std::int32_t>("/xdmf/region", {}, "", "region of each cell");
  store_->start_rows<double>("/xdmf/X", {3}, "m", "reference positions, repeated here for ParaView");
  const auto put = [&](std::int64_t value) { store_->append<std::int64_t>("/xdmf/topology", {&value, 1}), ++topology_entries_; };
  for (std::int64_t first = 0; first < m.n_cells_global; first += slice) {
    const std::int64_t count = std::min(slice, m.n_cells_global - first);
    const auto shape = mesh.read_rows<std::uint8_t>("/mesh/cells/shape", first, count);
    const auto offset = mesh.read_rows<std::int64_t>("/mesh/cells/offset", first, count + 1);
    const auto nodes = mesh.read_rows<std::int64_t>("/mesh/cells/nodes", offset.front(), offset.back() - offset.front());
    for (std::int64_t c = 0; c < count; ++c) {
      put(info(shape[c]).xdmf_type);
      if (shape[c] == static_cast<std::uint8_t>(Shape::bar2)) put(2);
      for (std::int64_t k = offset[c]; k < offset[c + 1]; ++k) put(nodes[k - offset.front()]);
    }
    for (std::int32_t r : mesh.read_rows<std::int32_t>("/mesh/cells/region", first, count))
      store_->append<std::int32_t>("/xdmf/region", {&r, 1});
  }
  topology_cells_ = m.n_cells_global;
  for (std::int64_t first = 0; first < m.n_nodes_global; first += slice) {
    const auto X = mesh.read_rows<double>("/mesh/nodes/X", first, std::min(slice, m.n_nodes_global - first));
    for (size_t i = 0; i < X.size(); i += 3) store_->append<double>("/xdmf/X", {X.data() + i, 3});
  }
  store_->flush();
}

/// Points ParaView at the arrays of the results file.
void Recorder::write_xdmf() {
  if (!system_.mesh || !store_) return;
  const std::string path = setup_.path, base = path.substr(path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1);
  if (topology_entries_ == 0) write_topology();
  const std::int64_t n = nodes_->n_rows(), cells = topology_cells_, entries = topology_entries_;
  std::string t =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"run\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  const auto attribute = [&](const std::string& name, const char* type, const char* centre, const std::string& dims, const std::string& at,
                             const char* number) {
    t += fmt::format(
        "<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\"><DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" "
        "Dimensions=\"{}\">{}:{}"
        "</DataItem></Attribute>\n",
        name, type, centre, number[0] == 'I' ? "Int" : "Float", number[1], dims, base, at);
  };
  for (size_t k = 0; k < field_times_.size(); ++k) {
    const std::string group = fmt::format("/field/{:06}", k);
    t += fmt::format(
        "<Grid Name=\"t{}\"><Time Value=\"{:.9g}\"/>\n<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" "
        "NumberType=\"Int\" "
        "Precision=\"8\" Dimensions=\"{}\">{}:/xdmf/topology</DataItem></Topology>\n<Geometry GeometryType=\"XYZ\"><DataItem "
        "Format=\"HDF\" "
        "NumberType=\"Float\" Precision=\"8\" Dimensions=\"{} 3\">{}:/xdmf/X</DataItem></Geometry>\n",
        k, field_times_[k], cells, entries, base, n, base);
    const char* number = setup_.single_precision ? "F4" : "F8";
    for (const char* name : {"displacement", "velocity", "acceleration"})
      if (store_->has(group + "/" + name)) attribute(name, "Vector", "Node", fmt::format("{} 3", n), group + "/" + name, number);
    if (store_->has(group + "/von_mises")) {
      attribute("von Mises [Pa]", "Scalar", "Node", fmt::format("{}", n), group + "/von_mises", number);
      if (!setup_.skin) attribute("cell von Mises [Pa]", "Scalar", "Cell", fmt::format("{}", cells), group + "/cell_von_mises", number);
    }
    if (store_->has(group + "/stress_error"))
      attribute("stress error [Pa]", "Scalar", "Node", fmt::format("{}", n), group + "/stress_error", number);
    attribute("region", "Scalar", "Cell", fmt::format("{}", cells), "/xdmf/region", "I4");
    t += "</Grid>\n";
  }
  t += "</Grid>\n</Domain>\n</Xdmf>\n";
  write_text_file(stem(path) + ".xdmf", t);
}

}  // namespace hilo
