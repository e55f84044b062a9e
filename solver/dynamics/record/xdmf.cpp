// SPDX-License-Identifier: GPL-3.0-or-later
// What ParaView reads: the cells as XDMF's mixed list, and the sidecar.
#include <fmt/format.h>

#include <algorithm>

#include "dynamics/record/mesh_part.hpp"

namespace hilo {

/// The drawn facets and bars as XDMF's mixed list, in the order of the cells, with the positions of their nodes.
void MeshPart::write_skin(const std::vector<Facet>& facets) {
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
    if (const auto& shape = info(m.mesh.shape[c]); shape.dimension == 1)
      put(c, 0, {shape.xdmf_type, 2}, m.mesh.cell(c));
    else if (shape.dimension == 2)
      put(c, 0, {shape.xdmf_type}, m.mesh.cell(c));
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
  file_.on_store([&](Store& f) {
    write_array(f, "/xdmf/topology", topology, {topology_entries_});
    write_array(f, "/xdmf/region", region, {topology_cells_});
  });
  std::vector<double> X;
  for (const Vec3& x : system_.X) X.insert(X.end(), x.data(), x.data() + 3);
  file_.write_piece(*nodes_, "/xdmf/X", nodes_->collect(X, 3), true);
}

/// The cells of the mesh file as XDMF's mixed list, slice by slice, so that no rank holds the whole mesh.
void MeshPart::write_topology(Store& f) {
  const LocalMesh& m = *system_.mesh;
  const Store mesh = Store::open(m.file);
  constexpr std::int64_t slice = 1 << 16;
  start_array<std::int64_t>(f, "/xdmf/topology");
  start_array<std::int32_t>(f, "/xdmf/region");
  start_array<double>(f, "/xdmf/X");
  for (std::int64_t first = 0; first < m.n_cells_global; first += slice) {
    const std::int64_t count = std::min(slice, m.n_cells_global - first);
    const auto shape = mesh.read_rows<std::uint8_t>("/mesh/cells/shape", first, count);
    const auto offset = mesh.read_rows<std::int64_t>("/mesh/cells/offset", first, count + 1);
    const auto nodes = mesh.read_rows<std::int64_t>("/mesh/cells/nodes", offset.front(), offset.back() - offset.front());
    std::vector<std::int64_t> entries;
    for (std::int64_t c = 0; c < count; ++c) {
      entries.push_back(info(shape[c]).xdmf_type);
      if (shape[c] == static_cast<std::uint8_t>(Shape::bar2)) entries.push_back(2);
      entries.insert(entries.end(), nodes.begin() + (offset[c] - offset.front()), nodes.begin() + (offset[c + 1] - offset.front()));
    }
    f.append<std::int64_t>("/xdmf/topology", entries);
    f.append<std::int32_t>("/xdmf/region", mesh.read_rows<std::int32_t>("/mesh/cells/region", first, count));
    topology_entries_ += static_cast<std::int64_t>(entries.size());
  }
  topology_cells_ = m.n_cells_global;
  for (std::int64_t first = 0; first < m.n_nodes_global; first += slice)
    f.append<double>("/xdmf/X", mesh.read_rows<double>("/mesh/nodes/X", first, std::min(slice, m.n_nodes_global - first)));
  f.flush();
}

/// Points ParaView at the arrays of the results file.
void MeshPart::write_xdmf(Store& f) {
  const std::string& path = file_.path();
  const std::string base = path.substr(path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1);
  if (topology_entries_ == 0) write_topology(f);
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
  for (size_t k = 0; k < times_.size(); ++k) {
    const std::string group = fmt::format("/field/{:06}", k);
    const std::vector<std::string> arrays = f.list(group);
    t += fmt::format(
        "<Grid Name=\"t{}\"><Time Value=\"{:.9g}\"/>\n<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" "
        "NumberType=\"Int\" "
        "Precision=\"8\" Dimensions=\"{}\">{}:/xdmf/topology</DataItem></Topology>\n<Geometry GeometryType=\"XYZ\"><DataItem "
        "Format=\"HDF\" "
        "NumberType=\"Float\" Precision=\"8\" Dimensions=\"{} 3\">{}:/xdmf/X</DataItem></Geometry>\n",
        k, times_[k], cells, entries, base, n, base);
    for (const auto& source : sources_)
      for (const Field& field : source->fields()) {
        if (field.label.empty() || !std::ranges::binary_search(arrays, field.name)) continue;
        const auto row = row_shape(run_array(group + "/" + field.name));
        const std::int64_t count = field.of_cells ? cells : n;
        attribute(field.label, row.empty() ? "Scalar" : "Vector", field.of_cells ? "Cell" : "Node",
                  row.empty() ? fmt::format("{}", count) : fmt::format("{} {}", count, row[0]), group + "/" + field.name, file_.number());
      }
    attribute("region", "Scalar", "Cell", fmt::format("{}", cells), "/xdmf/region", "I4");
    t += "</Grid>\n";
  }
  t += "</Grid>\n</Domain>\n</Xdmf>\n";
  write_text_file(stem(path) + ".xdmf", t);
}

}  // namespace hilo
