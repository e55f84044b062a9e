// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/surface/skin.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

#include "post/surface/skin_builder.hpp"

namespace hilo {
namespace {

vtkSmartPointer<vtkPolyData> with_points(std::int64_t n) {
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(n);
  data->SetPoints(points);
  return data;
}

vtkSmartPointer<vtkPolyData> lines(vtkPoints* points, const std::vector<std::array<std::int64_t, 2>>& ends) {
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const auto& e : ends) {
    const vtkIdType ids[] = {e[0], e[1]};
    cells->InsertNextCell(2, ids);
  }
  data->SetPoints(points);
  data->SetLines(cells);
  return data;
}

float* floats(vtkPoints* points) { return static_cast<float*>(points->GetVoidPointer(0)); }

}  // namespace

Skin::Skin(const Mesh& mesh, std::span<const Facet> facets, std::span<const std::int64_t> bars, const Plane* cut,
           std::span<const std::int64_t> cells) {
  SkinBuilder build(mesh, facets, bars, cut, cells);
  first_ = std::move(build.first);
  node_ = std::move(build.node);
  weight_ = std::move(build.weight);
  point_ = std::move(build.vertex_point);
  corner_ = std::move(build.corner);
  polygon_ = std::move(build.polygon);
  face_cell_ = std::move(build.face_cell);
  bar_cell_ = std::move(build.bar_cell);

  const auto n_vertices = static_cast<std::int64_t>(point_.size());
  faces_ = with_points(n_vertices);
  const auto polygons = vtkSmartPointer<vtkCellArray>::New();
  for (size_t f = 0; f + 1 < polygon_.size(); ++f) {
    polygons->InsertNextCell(static_cast<int>(polygon_[f + 1] - polygon_[f]));
    for (std::int64_t k = polygon_[f]; k < polygon_[f + 1]; ++k) polygons->InsertCellPoint(corner_[static_cast<size_t>(k)]);
  }
  faces_->SetPolys(polygons);
  const auto normals = vtkSmartPointer<vtkFloatArray>::New();
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(n_vertices);
  faces_->GetPointData()->SetNormals(normals);

  const auto edge_points = with_points(static_cast<std::int64_t>(first_.size()) - 1);
  feature_ = lines(edge_points->GetPoints(), build.feature_edges);
  grid_ = lines(edge_points->GetPoints(), build.facet_edges);
  bars_ = lines(edge_points->GetPoints(), build.bar_ends);
  for (const auto& e : build.facet_edges) mean_edge_ += build.length(e) / static_cast<double>(build.facet_edges.size());
  move(mesh.X);
}

void Skin::move(const std::vector<Vec3>& x) {
  float* point = floats(feature_->GetPoints());
  for (size_t p = 0; p + 1 < first_.size(); ++p) {
    Vec3 sum = Vec3::Zero();
    for (std::int64_t k = first_[p]; k < first_[p + 1]; ++k)
      sum += weight_[static_cast<size_t>(k)] * x[static_cast<size_t>(node_[static_cast<size_t>(k)])];
    for (int i = 0; i < 3; ++i) point[3 * p + static_cast<size_t>(i)] = static_cast<float>(sum[i]);
  }
  float* vertex = floats(faces_->GetPoints());
  for (size_t v = 0; v < point_.size(); ++v) std::copy_n(point + 3 * point_[v], 3, vertex + 3 * v);

  // Normals of the vertices: those of their polygons, weighted with their areas.
  auto* normals = vtkFloatArray::SafeDownCast(faces_->GetPointData()->GetNormals());
  float* normal = normals->GetPointer(0);
  std::fill_n(normal, 3 * point_.size(), 0.0F);
  const auto at = [&](std::int64_t v) { return Eigen::Map<Eigen::Vector3f>(vertex + 3 * v); };
  for (size_t f = 0; f + 1 < polygon_.size(); ++f) {
    const auto* c = corner_.data() + polygon_[f];
    const auto n = polygon_[f + 1] - polygon_[f];
    Eigen::Vector3f a = n == 3 ? Eigen::Vector3f((at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])))
                               : Eigen::Vector3f((at(c[2]) - at(c[0])).cross(at(c[3]) - at(c[1])));
    for (std::int64_t k = 4; k < n; ++k) a += (at(c[k - 1]) - at(c[0])).cross(at(c[k]) - at(c[0]));
    for (std::int64_t k = 0; k < n; ++k) Eigen::Map<Eigen::Vector3f>(normal + 3 * c[k]) += a;
  }
  for (size_t v = 0; v < point_.size(); ++v) Eigen::Map<Eigen::Vector3f>(normal + 3 * v).normalize();
  feature_->GetPoints()->Modified();
  faces_->GetPoints()->Modified();
  normals->Modified();
  for (auto* data : {faces_.Get(), bars_.Get(), feature_.Get(), grid_.Get()}) data->Modified();
}

void Skin::set_values(const std::vector<double>& value) {
  const auto at_points = vtkSmartPointer<vtkFloatArray>::New();
  at_points->SetNumberOfTuples(static_cast<vtkIdType>(first_.size()) - 1);
  float* point = at_points->GetPointer(0);
  for (size_t p = 0; p + 1 < first_.size(); ++p) {
    double sum = 0;
    for (std::int64_t k = first_[p]; k < first_[p + 1]; ++k)
      sum += weight_[static_cast<size_t>(k)] * value[static_cast<size_t>(node_[static_cast<size_t>(k)])];
    point[p] = static_cast<float>(sum);
  }
  const auto at_vertices = vtkSmartPointer<vtkFloatArray>::New();
  at_vertices->SetNumberOfTuples(static_cast<vtkIdType>(point_.size()));
  for (size_t v = 0; v < point_.size(); ++v) at_vertices->SetValue(static_cast<vtkIdType>(v), point[point_[v]]);
  faces_->GetPointData()->SetScalars(at_vertices);
  bars_->GetPointData()->SetScalars(at_points);
}

void Skin::set_cell_colours(const std::vector<std::array<std::uint8_t, 3>>& colour) {
  const auto paint = [&](vtkPolyData* data, const std::vector<std::int64_t>& cell) {
    const auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(static_cast<vtkIdType>(cell.size()));
    for (size_t f = 0; f < cell.size(); ++f)
      for (int i = 0; i < 3; ++i)
        array->SetTypedComponent(static_cast<vtkIdType>(f), i, colour[static_cast<size_t>(cell[f])][static_cast<size_t>(i)]);
    data->GetCellData()->SetScalars(array);
  };
  paint(faces_, face_cell_);
  paint(bars_, bar_cell_);
}

}  // namespace hilo
