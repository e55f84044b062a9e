// SPDX-License-Identifier: GPL-3.0-or-later
// /VTKHDF: what VTK 9.3 and ParaView 5.12 look for in an HDF5 file, version 2.0 of the layout that VTK's documentation calls "VTKHDF file
// format", an unstructured grid with steps.  It is made of views of the arrays that the run wrote, when it has ended.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/outside_shapes.hpp"
#include "dynamics/record/mesh_part.hpp"
#include "model/shape_row.hpp"

namespace hilo {
namespace {

struct DrawnShape {
  int n_nodes, vtk_type;
};

/// By the numbers of XDMF's list.
std::map<std::int64_t, DrawnShape> drawn_shapes() {
  std::map<std::int64_t, DrawnShape> of;
  for (int k = 0; k < most_shapes; ++k)
    if (const auto shape = static_cast<std::uint8_t>(k); is_shape(shape))
      of[info(shape).xdmf_type] = {info(shape).n_nodes, info(shape).vtk_type};
  return of;
}

constexpr const char *vtk_points = "/VTKHDF/Points", *vtk_types = "/VTKHDF/Types", *vtk_offsets = "/VTKHDF/Offsets",
                     *vtk_nodes = "/VTKHDF/Connectivity";

/// The cells of XDMF's list, which is read slice by slice; the number of entries.
std::int64_t write_vtk_cells(Store& f, std::int64_t n_entries) {
  const auto shapes = drawn_shapes();
  f.start_rows<std::uint8_t>(vtk_types, {});
  f.start_rows<std::int64_t>(vtk_offsets, {});
  f.start_rows<std::int64_t>(vtk_nodes, {});
  constexpr std::int64_t slice = 1 << 16;
  std::int64_t end = 0;
  f.append<std::int64_t>(vtk_offsets, {&end, 1});
  std::vector<std::int64_t> offsets, nodes;
  std::vector<std::uint8_t> types;
  std::int64_t left = 0;  // nodes of the cell that is being read
  bool is_count = false;  // the next entry, after a polyline
  for (std::int64_t first = 0; first < n_entries; first += slice) {
    for (const std::int64_t entry : f.read_rows<std::int64_t>("/xdmf/topology", first, std::min(slice, n_entries - first))) {
      if (is_count) {
        is_count = false;
      } else if (left > 0) {
        nodes.push_back(entry), --left;
      } else {
        const DrawnShape& cell = shapes.at(entry);
        types.push_back(static_cast<std::uint8_t>(cell.vtk_type));
        left = cell.n_nodes, end += left;
        offsets.push_back(end);
        is_count = entry == info(Shape::bar2).xdmf_type;
      }
    }
    f.append<std::uint8_t>(vtk_types, types), f.append<std::int64_t>(vtk_offsets, offsets), f.append<std::int64_t>(vtk_nodes, nodes);
    types.clear(), offsets.clear(), nodes.clear();
  }
  return end;
}

}  // namespace

void MeshPart::write_vtkhdf(Store& f) {
  const auto n_steps = static_cast<std::int64_t>(times_.size()), n = nodes_->n_rows(), n_cells = topology_cells_;
  const auto write = [&](const std::string& name, const std::vector<std::int64_t>& values, bool has_columns = false) {
    std::vector<std::int64_t> shape{static_cast<std::int64_t>(values.size())};
    if (has_columns) shape.push_back(1);
    f.write<std::int64_t>("/VTKHDF/" + name, values, shape);
  };
  f.remove("/VTKHDF");
  write("NumberOfPoints", {n});
  write("NumberOfCells", {n_cells});
  write("NumberOfConnectivityIds", {write_vtk_cells(f, topology_entries_)});
  f.name_also("/xdmf/X", vtk_points);
  const std::vector<std::int64_t> zeros(times_.size(), 0), ones(times_.size(), 1);
  f.write<double>("/VTKHDF/Steps/Values", times_, {n_steps});
  write("Steps/NumberOfParts", ones);
  write("Steps/PartOffsets", zeros);
  write("Steps/PointOffsets", zeros);
  write("Steps/CellOffsets", zeros, true);
  write("Steps/ConnectivityIdOffsets", zeros, true);
  f.set("/VTKHDF/Steps", "NSteps", n_steps);

  const auto still = [&](const std::string& group, const std::string& name, const std::string& array) {
    f.name_also(array, "/VTKHDF/" + group + "/" + name);
    write("Steps/" + group + "Offsets/" + name, zeros);
  };
  std::vector<std::vector<std::string>> arrays;  // of each step
  for (std::int64_t k = 0; k < n_steps; ++k) arrays.push_back(f.list(fmt::format("/field/{:06}", k)));
  for (const auto& source : sources_)
    for (const Field& field : source->fields()) {
      std::vector<std::string> parts;
      std::vector<std::int64_t> first;
      bool any = false;
      for (std::int64_t k = 0; k < n_steps; ++k) {
        const bool has = std::ranges::binary_search(arrays[k], field.name);
        any |= has;
        parts.push_back(has ? fmt::format("/field/{:06}/{}", k, field.name) : "");
        first.push_back(k * (field.of_cells ? n_cells : n));
      }
      if (!any) continue;
      const std::string group = field.of_cells ? "CellData" : "PointData";
      f.write_view("/VTKHDF/" + group + "/" + field.name, parts);
      write("Steps/" + group + "Offsets/" + field.name, first);
    }
  for (const std::string& name : f.list("/envelope"))
    still("PointData", name.ends_with("_time") ? name.substr(0, name.size() - 5) + "_envelope_time" : name + "_envelope",
          "/envelope/" + name);
  still("CellData", "region", "/xdmf/region");
  const std::int64_t version[] = {2, 0};
  f.set("/VTKHDF", "Version", version);
  f.set_ascii("/VTKHDF", "Type", "UnstructuredGrid");
  f.flush();
}

}  // namespace hilo
