// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/stage.hpp"

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkLightKit.h>
#include <vtkLookupTable.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

void shade(vtkProperty* p, const Rgb& colour, double opacity) {
  p->SetColor(colour.r, colour.g, colour.b);
  p->SetOpacity(opacity);
  p->SetAmbient(0.50);
  p->SetDiffuse(0.54);
  p->SetSpecular(0);
}

vtkSmartPointer<vtkLookupTable> lookup(const Look& look) {
  const auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int n = 512;
  table->SetNumberOfTableValues(n);
  for (int i = 0; i < n; ++i) {
    const Rgb c = map_colour(look.map, (i + 0.5) / n);
    table->SetTableValue(i, c.r, c.g, c.b);
  }
  table->SetTableRange(look.low, look.high);
  return table;
}

vtkSmartPointer<vtkPolyDataMapper> mapper_of(vtkPolyData* data, const Look& look) {
  const auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(data);
  mapper->SetScalarVisibility(look.by != Look::By::colour);
  if (look.by == Look::By::cells) mapper->SetScalarModeToUseCellData();
  if (look.by == Look::By::values) {
    mapper->SetScalarModeToUsePointData();
    mapper->SetLookupTable(lookup(look));
    mapper->UseLookupTableScalarRangeOn();
    mapper->InterpolateScalarsBeforeMappingOn();
  }
  return mapper;
}

}  // namespace

void light(vtkRenderer* stage) {
  const auto kit = vtkSmartPointer<vtkLightKit>::New();
  kit->SetKeyLightWarmth(0.5);
  kit->SetFillLightWarmth(0.5);
  kit->SetHeadLightWarmth(0.5);
  kit->SetBackLightWarmth(0.5);
  kit->SetKeyLightIntensity(0.8);
  kit->SetKeyToFillRatio(2.2);
  kit->SetKeyToHeadRatio(2.2);
  kit->AddLightsToRenderer(stage);
  vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
}

void add_skin(vtkRenderer* stage, const Skin& skin, const Look& look) {
  const auto faces = vtkSmartPointer<vtkActor>::New();
  const auto mapper = mapper_of(skin.faces(), look);
  mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(2, 4);
  faces->SetMapper(mapper);
  shade(faces->GetProperty(), look.colour, look.opacity);
  faces->GetProperty()->SetInterpolationToPhong();
  faces->GetProperty()->SetBackfaceCulling(look.opacity < 1);  // of a transparent body the front alone: no sorting needed
  stage->AddActor(faces);
  if (skin.bars()->GetNumberOfLines() == 0) return;
  const auto bars = vtkSmartPointer<vtkActor>::New();
  bars->SetMapper(mapper_of(skin.bars(), look));
  shade(bars->GetProperty(), look.colour, look.opacity);
  bars->GetProperty()->SetLineWidth(static_cast<float>(look.bar_width));
  bars->GetProperty()->RenderLinesAsTubesOn();
  stage->AddActor(bars);
}

void add_values(vtkRenderer* stage, vtkPolyData* data, const Look& look) {
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper_of(data, look));
  shade(actor->GetProperty(), look.colour, 1);
  actor->GetProperty()->SetInterpolationToPhong();
  stage->AddActor(actor);
}

vtkActor* add_surface(vtkRenderer* stage, vtkPolyData* data, const Rgb& colour, double opacity) {
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper_of(data, {}));
  shade(actor->GetProperty(), colour, opacity);
  stage->AddActor(actor);
  return actor;
}

vtkActor* add_lines(vtkRenderer* stage, vtkPolyData* data, const Rgb& colour, double width, double opacity) {
  const auto actor = vtkSmartPointer<vtkActor>::New();
  const auto mapper = mapper_of(data, {});
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(-1, -6);
  actor->SetMapper(mapper);
  shade(actor->GetProperty(), colour, opacity);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  stage->AddActor(actor);
  return actor;
}

void add_dots(vtkRenderer* stage, const std::vector<Vec3>& at, const Rgb& colour, double size) {
  const auto points = vtkSmartPointer<vtkPoints>::New();
  const auto vertices = vtkSmartPointer<vtkCellArray>::New();
  for (const Vec3& x : at) {
    const vtkIdType id = points->InsertNextPoint(x.data());
    vertices->InsertNextCell(1, &id);
  }
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(vertices);
  const auto mapper = mapper_of(data, {});
  mapper->SetRelativeCoincidentTopologyPointOffsetParameter(-12);
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  shade(actor->GetProperty(), colour, 1);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetPointSize(static_cast<float>(size));
  actor->GetProperty()->RenderPointsAsSpheresOn();
  stage->AddActor(actor);
}

void add_grid(vtkRenderer* stage, const Skin& skin, double width, double opacity, double pixels_per_metre) {
  const double apart = skin.mean_edge() * pixels_per_metre, seen = std::clamp((apart / width - 2.5) / 7, 0.0, 1.0);
  if (seen > 0) add_lines(stage, skin.cell_edges(), {0.1, 0.1, 0.12}, width, opacity * seen);
}

double pixels_per_metre(vtkRenderer* stage, double height) {
  vtkCamera* camera = stage->GetActiveCamera();
  const double half =
      camera->GetParallelProjection() ? camera->GetParallelScale() : camera->GetDistance() * std::tan(camera->GetViewAngle() * M_PI / 360);
  return height / (2 * half);
}

}  // namespace hilo
