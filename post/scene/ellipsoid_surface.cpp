// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/ellipsoid_surface.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <cmath>

namespace hilo {

vtkSmartPointer<vtkPolyData> ellipsoid(const Ellipsoid& body) {
  constexpr int around = 48, rows = 24;
  const double least = 0.04 * body.radii.maxCoeff();  // a rod has no thickness of its own
  const Vec3 r = body.radii.cwiseMax(least);
  const auto points = vtkSmartPointer<vtkPoints>::New();
  const auto normals = vtkSmartPointer<vtkFloatArray>::New();
  const auto quads = vtkSmartPointer<vtkCellArray>::New();
  normals->SetNumberOfComponents(3);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * M_PI * i / around, b = M_PI * j / rows;
      const Vec3 unit(std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b));
      const Vec3 x = body.centre + body.axes * r.cwiseProduct(unit), n = (body.axes * unit.cwiseQuotient(r.cwiseMax(1e-12))).normalized();
      points->InsertNextPoint(x.data());
      normals->InsertNextTuple(n.data());
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < around; ++i) {
      const vtkIdType quad[] = {j * around + i, (j + 1) * around + i, (j + 1) * around + (i + 1) % around, j * around + (i + 1) % around};
      quads->InsertNextCell(4, quad);
    }
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(quads);
  data->GetPointData()->SetNormals(normals);
  return data;
}

}  // namespace hilo
