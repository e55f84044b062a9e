// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/surface/iso_surface.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <unordered_map>

#include "post/surface/pieces.hpp"

namespace hilo {
namespace {

/// Points that polygons share, by the places of the two ends of the edge they lie on: smooth shading needs them shared.
struct Welder {
  struct Hash {
    size_t operator()(const std::array<float, 3>& k) const {
      size_t h = 0;
      for (const float v : k) h = (h ^ std::hash<float>()(v)) * 0x9E3779B97F4A7C15ull;
      return h;
    }
  };
  std::unordered_map<std::array<float, 3>, vtkIdType, Hash> known;
  std::vector<Vec3> x;

  vtkIdType operator()(const Vec3& at) {
    const std::array<float, 3> key{static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())};
    const auto [found, fresh] = known.try_emplace(key, static_cast<vtkIdType>(x.size()));
    if (fresh) x.push_back(at);
    return found->second;
  }
};

}  // namespace

IsoSurface::IsoSurface(const Mesh& mesh, std::vector<std::int64_t> cells, std::vector<double> levels)
    : mesh_(mesh), cells_(std::move(cells)), levels_(std::move(levels)), surface_(vtkSmartPointer<vtkPolyData>::New()) {}

void IsoSurface::update(const std::vector<double>& value, const std::vector<Vec3>& x) {
  const auto points = vtkSmartPointer<vtkPoints>::New();
  const auto polygons = vtkSmartPointer<vtkCellArray>::New();
  const auto normals = vtkSmartPointer<vtkFloatArray>::New();
  normals->SetNumberOfComponents(3);
  const auto level_at = vtkSmartPointer<vtkFloatArray>::New();
  std::vector<double> v;
  std::vector<Vec3> at;
  for (const double level : levels_) {
    Welder weld;
    std::vector<Vec3> normal;
    const vtkIdType before = points->GetNumberOfPoints();
    for (const std::int64_t c : cells_) {
      const auto nodes = mesh_.cell(c);
      const auto [least, most] = std::minmax_element(
          nodes.begin(), nodes.end(), [&](auto a, auto b) { return value[static_cast<size_t>(a)] < value[static_cast<size_t>(b)]; });
      if (!(value[static_cast<size_t>(*least)] < level && value[static_cast<size_t>(*most)] >= level)) continue;
      const Pieces& p = pieces(static_cast<Shape>(mesh_.shape[static_cast<size_t>(c)]));
      v.assign(p.point.size(), -level), at.assign(p.point.size(), Vec3::Zero());
      for (size_t k = 0; k < p.point.size(); ++k)
        for (size_t a = 0; a < nodes.size(); ++a)
          v[k] += p.point[k][a] * value[static_cast<size_t>(nodes[a])], at[k] += p.point[k][a] * x[static_cast<size_t>(nodes[a])];
      for (size_t t = 0; t < p.tet.size(); ++t) {
        const auto corner = [&](int i) { return static_cast<size_t>(p.tet[t][static_cast<size_t>(i)]); };
        const Crossing cross = crossing({v[corner(0)], v[corner(1)], v[corner(2)], v[corner(3)]}, p.on_border[t]);
        if (cross.n == 0) continue;
        std::array<vtkIdType, 4> id{};
        std::array<Vec3, 4> where;
        for (size_t k = 0; k < static_cast<size_t>(cross.n); ++k) {
          const size_t a = corner(cross.edge[k][0]), b = corner(cross.edge[k][1]);
          where[k] = at[a] + v[a] / (v[a] - v[b]) * (at[b] - at[a]);
          id[k] = weld(where[k]);
        }
        Vec3 area =
            cross.n == 3 ? Vec3((where[1] - where[0]).cross(where[2] - where[0])) : Vec3((where[2] - where[0]).cross(where[3] - where[1]));
        const Vec3 uphill = at[corner(cross.edge[0][1])] - at[corner(cross.edge[0][0])];
        if (area.dot(uphill) < 0) std::reverse(id.begin(), id.begin() + cross.n), area = -area;
        normal.resize(weld.x.size(), Vec3::Zero());
        polygons->InsertNextCell(cross.n);
        for (size_t k = 0; k < static_cast<size_t>(cross.n); ++k)
          polygons->InsertCellPoint(before + id[k]), normal[static_cast<size_t>(id[k])] += area;
      }
    }
    for (size_t k = 0; k < weld.x.size(); ++k) {
      points->InsertNextPoint(weld.x[k].data());
      const Vec3 n = normal[k].normalized();
      normals->InsertNextTuple(n.data());
      level_at->InsertNextValue(static_cast<float>(level));
    }
  }
  surface_->SetPoints(points);
  surface_->SetPolys(polygons);
  surface_->GetPointData()->SetNormals(normals);
  surface_->GetPointData()->SetScalars(level_at);
  surface_->Modified();
}

}  // namespace hilo
