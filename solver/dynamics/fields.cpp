// Fields of the recorder: displacement, velocity, acceleration and stress of every node, and the XDMF sidecar for ParaView.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "dynamics/profile.hpp"
#include "dynamics/recorder.hpp"
#include "physics/stress.hpp"

namespace hilo {

/// Owned rows of all ranks on rank 0, in the order of the file; `width` numbers a node.
std::vector<double> Recorder::gather(const std::vector<double>& local, int width) const {
  const System& s = system_;
  if (s.comm->size == 1) return local;
  std::vector<std::vector<double>> send(s.comm->size);
  for (size_t i = 0; i < s.X.size(); ++i)
    if (s.node_owned[i]) {
      send[0].push_back(static_cast<double>(s.mesh->node_global[i]));
      send[0].insert(send[0].end(), local.begin() + i * width, local.begin() + (i + 1) * width);
    }
  const auto received = s.comm->exchange(send);
  if (s.comm->rank != 0) return {};
  std::vector<double> all(s.mesh->n_nodes_global * width);
  for (const auto& list : received)
    for (size_t k = 0; k < list.size(); k += width + 1)
      std::copy(list.begin() + k + 1, list.begin() + k + 1 + width, all.begin() + static_cast<std::int64_t>(list[k]) * width);
  return all;
}

void Recorder::write_field(const Row& row, const Config& a) {
  const System& s = system_;
  if (!s.mesh) return;
  const std::string group = fmt::format("/field/{:06}", n_fields_++);
  const std::int64_t n = s.mesh->n_nodes_global;
  const auto wants = [&](const char* field) { return std::find(setup_.fields.begin(), setup_.fields.end(), field) != setup_.fields.end(); };
  const auto write = [&](const char* name, const std::vector<double>& local, int width, const char* unit) {
    const auto all = gather(local, width);
    if (!store_) return;
    std::vector<std::int64_t> shape{n};
    if (width > 1) shape.push_back(width);
    on_store([&](Store& f) {
      if (setup_.single_precision)
        f.write<float>(group + "/" + name, std::vector<float>(all.begin(), all.end()), shape, unit);
      else
        f.write<double>(group + "/" + name, all, shape, unit);
    });
  };
  const auto vectors = [&](const char* name, auto value, const char* unit) {
    std::vector<double> local;
    local.reserve(3 * s.X.size());
    for (size_t i = 0; i < s.X.size(); ++i) {
      const Vec3 v = value(i);
      local.insert(local.end(), v.data(), v.data() + 3);
    }
    write(name, local, 3, unit);
  };
  if (wants("displacement"))
    vectors(
        "displacement", [&](size_t i) { return Vec3(row.q.x[i] - s.X[i]); }, "m");
  if (wants("velocity"))
    vectors(
        "velocity", [&](size_t i) { return row.v.x[i]; }, "m/s");
  if (wants("acceleration"))
    vectors(
        "acceleration", [&](size_t i) { return a.x[i]; }, "m/s^2");
  if (wants("stress") || wants("von_mises")) {
    // mean over the cells of a node's first flexible region (first: lowest number), summed across ranks through shared nodes
    std::vector<double> sum(8 * s.X.size(), 0.0);  // six stresses, von Mises, count
    std::vector<int> region(s.X.size(), -1);
    for (const SolidBatch& b : s.batches)
      for (int i : b.nodes)
        if (region[i] < 0 || b.region < region[i]) region[i] = b.region;
    std::vector<double> cell(s.mesh->mesh.n_cells(), 0.0);
    for (const SolidBatch& b : s.batches) {
      const int k = info(b.shape).n_nodes;
      std::vector<Vec3> X(k), x(k);
      std::vector<Vec6> stress(k);
      for (size_t e = 0; e < b.cells.size(); ++e) {
        const int* nodes = b.nodes.data() + e * k;
        for (int i = 0; i < k; ++i) X[i] = s.X[nodes[i]], x[i] = row.q.x[nodes[i]];
        nodal_stress(b.shape, b.law, b.c, X, x, stress);
        for (int i = 0; i < k; ++i) {
          const double vm = von_mises(stress[i]);
          cell[b.cells[e]] += vm / k;
          if (region[nodes[i]] != b.region) continue;
          double* to = sum.data() + 8 * nodes[i];
          for (int c = 0; c < 6; ++c) to[c] += stress[i][c];
          to[6] += vm, to[7] += 1;
        }
      }
    }
    // every rank's share goes to the row of the file
    std::vector<double> all(8 * (s.comm->size == 1 ? s.X.size() : 0));
    if (s.comm->size == 1) {
      all = std::move(sum);
    } else {
      std::vector<std::vector<double>> send(s.comm->size);
      for (size_t i = 0; i < s.X.size(); ++i)
        if (region[i] >= 0) {
          send[0].push_back(static_cast<double>(s.mesh->node_global[i]));
          send[0].push_back(region[i]);
          send[0].insert(send[0].end(), sum.begin() + 8 * i, sum.begin() + 8 * i + 8);
        }
      const auto received = s.comm->exchange(send);
      if (s.comm->rank == 0) {
        all.assign(8 * n, 0.0);
        std::vector<int> first(n, -1);
        for (const auto& list : received)
          for (size_t k = 0; k < list.size(); k += 10) {
            const auto r = static_cast<std::int64_t>(list[k]);
            if (first[r] < 0 || list[k + 1] < first[r]) first[r] = static_cast<int>(list[k + 1]);
          }
        for (const auto& list : received)
          for (size_t k = 0; k < list.size(); k += 10) {
            const auto r = static_cast<std::int64_t>(list[k]);
            if (static_cast<int>(list[k + 1]) == first[r])
              for (int c = 0; c < 8; ++c) all[8 * r + c] += list[k + 2 + c];
          }
      }
    }
    std::vector<std::vector<double>> cells(s.comm->size);
    for (size_t c = 0; c < cell.size(); ++c)
      if (cell[c] != 0) cells[0].push_back(static_cast<double>(s.mesh->cell_global[c])), cells[0].push_back(cell[c]);
    const auto gathered = s.comm->exchange(cells);
    on_store([&](Store& f) {
      std::vector<double> stress(6 * n, 0.0), vm(n, 0.0), by_cell(s.mesh->n_cells_global, 0.0);
      for (std::int64_t i = 0; i < n; ++i)
        if (const double count = all[8 * i + 7]; count > 0) {
          for (int c = 0; c < 6; ++c) stress[6 * i + c] = all[8 * i + c] / count;
          vm[i] = all[8 * i + 6] / count;
        }
      for (const auto& list : gathered)
        for (size_t k = 0; k < list.size(); k += 2) by_cell[static_cast<std::int64_t>(list[k])] = list[k + 1];
      if (wants("stress")) f.write<double>(group + "/stress", stress, {n, 6}, "Pa", "Cauchy stress xx yy zz yz xz xy");
      if (wants("von_mises")) {
        f.write<double>(group + "/von_mises", vm, {n}, "Pa", "von Mises stress");
        f.write<double>(group + "/cell_von_mises", by_cell, {s.mesh->n_cells_global}, "Pa", "von Mises stress, mean over the cell");
      }
    });
  }
  field_times_.push_back(row.t);
  on_store([&](Store& f) {
    f.set(group, "t", row.t);
    if (wall_clock() - last_xdmf_ > 1) f.flush(), write_xdmf(), last_xdmf_ = wall_clock();
  });
}

/// Points ParaView at the arrays of the results file; topology as an XDMF mixed list written beside the fields once.
void Recorder::write_xdmf() {
  if (!system_.mesh || !store_) return;
  const LocalMesh& m = *system_.mesh;
  const std::string path = setup_.path, base = path.substr(path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1);
  if (topology_entries_ == 0) {
    // slice by slice, so that no rank holds the whole mesh
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
    for (std::int64_t first = 0; first < m.n_nodes_global; first += slice) {
      const auto X = mesh.read_rows<double>("/mesh/nodes/X", first, std::min(slice, m.n_nodes_global - first));
      for (size_t i = 0; i < X.size(); i += 3) store_->append<double>("/xdmf/X", {X.data() + i, 3});
    }
    store_->flush();
  }
  const std::int64_t n = m.n_nodes_global, cells = m.n_cells_global, entries = topology_entries_;
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
      attribute("von Mises [Pa]", "Scalar", "Node", fmt::format("{}", n), group + "/von_mises", "F8");
      attribute("cell von Mises [Pa]", "Scalar", "Cell", fmt::format("{}", cells), group + "/cell_von_mises", "F8");
    }
    attribute("region", "Scalar", "Cell", fmt::format("{}", cells), "/xdmf/region", "I4");
    t += "</Grid>\n";
  }
  t += "</Grid>\n</Domain>\n</Xdmf>\n";
  write_text_file(stem(path) + ".xdmf", t);
}

}  // namespace hilo
