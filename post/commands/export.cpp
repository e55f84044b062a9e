// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post export: one step as a VTU file for other programs, or steps as glTF.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "model/inputs.hpp"
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"
#include "post/run/run_file.hpp"
#include "post/run/times.hpp"
#include "post/scene/gltf.hpp"

namespace hilo {
namespace {

struct ExportOptions {
  std::string run, output, steps = "last", times, field, range;
  std::vector<std::string> show, hide;
  double speed = 0;
  bool deformed = false;
};

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const Mesh& mesh) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.n_nodes());
  for (std::int64_t n = 0; n < mesh.n_nodes(); ++n) points->SetPoint(n, mesh.X[static_cast<size_t>(n)].data());
  grid->SetPoints(points);
  grid->Allocate(mesh.n_cells());
  std::vector<vtkIdType> ids;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const auto cell = mesh.cell(c);
    ids.assign(cell.begin(), cell.end());
    grid->InsertNextCell(info(mesh.shape[static_cast<size_t>(c)]).vtk_type, static_cast<vtkIdType>(ids.size()), ids.data());
  }
  return grid;
}

template <class Array, class T>
void attach(vtkFieldData* to, const std::string& name, const std::vector<T>& values, int columns) {
  const auto array = vtkSmartPointer<Array>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(columns);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / columns);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  to->AddArray(array);
}

/// Regions a field has no values in: of the cells, and of the nodes that no other cell has.
void blank(RunFile& run, const std::string& name, bool of_cells, RunFile::Field& field) {
  const Mesh& mesh = run.mesh();
  std::vector<bool> has(field.value.size() / static_cast<size_t>(field.columns), false);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    if (!run.gives(static_cast<size_t>(mesh.region[static_cast<size_t>(c)]), name)) continue;
    if (of_cells)
      has[static_cast<size_t>(c)] = true;
    else
      for (const std::int64_t n : mesh.cell(c)) has[static_cast<size_t>(n)] = run.holds(n);
  }
  for (size_t i = 0; i < field.value.size(); ++i)
    if (!has[i / static_cast<size_t>(field.columns)]) field.value[i] = std::numeric_limits<double>::quiet_NaN();
}

void export_gltf(const ExportOptions& o, RunFile& file, std::vector<Step> steps) {
  if (steps.size() > 1 && !file.shapes.empty())
    throw Error("--steps", "steps of an analysis of modes or buckling are shapes, not instants", "one of them, or hilo-post movie",
                Exit::usage);
  const double span = steps.back().t - steps.front().t;
  GltfOptions g{std::move(steps), o.field.empty() ? "region" : o.field,
                o.range,          o.show,
                o.hide,           o.speed > 0 || !(span > 0) ? std::max(o.speed, 1e-9) : handy_speed(span)};
  const Gltf made = gltf_of(file, g);
  if (made.left_out > 0) warn(o.run, fmt::format("{} bars have no surface: they are not in {}", made.left_out, o.output));
  write_out(o.output, made.bytes);
}

void run(const ExportOptions& o) {
  RunFile file = judged_run(o.run);
  if (o.output.ends_with(".gltf"))
    throw Error(o.output, "glTF is written in its binary form", "give the file the ending .glb", Exit::usage);
  const bool gltf = o.output.ends_with(".glb");
  if (o.output != "-") check_output(o.output);
  if (!gltf && o.output != "-" && !o.output.ends_with(".vtu"))
    throw Error(o.output, "no format has this ending", "run.vtu, or run.glb for glTF", Exit::usage);
  for (const auto& [given, option] : {std::pair{!o.field.empty(), "--field"},
                                      {!o.range.empty(), "--range"},
                                      {!o.show.empty(), "--show"},
                                      {!o.hide.empty(), "--hide"},
                                      {o.speed > 0, "--speed"}})
    if (given && !gltf) throw Error(option, "is of glTF alone: VTU has all fields and regions", "give -o the ending .glb", Exit::usage);
  if (gltf && o.deformed) throw Error("--deformed", "glTF has the positions of the run anyway", "leave it out", Exit::usage);
  if (!file.has_mesh() && (gltf || !file.beams().empty())) file.stand_in_bodies();
  file.draw_beams();
  const auto steps = file.select_steps(o.steps, o.times);
  if (gltf) return export_gltf(o, file, steps);
  if (steps.size() != 1) throw Error("--steps", "one step makes one VTU file", "", Exit::usage);
  const Step& step = steps.front();
  const MeshFile& tagged = file.mesh_file();
  const Mesh& mesh = tagged.mesh;
  const auto grid = grid_of(mesh);
  for (const std::string& name : file.fields(step)) {
    auto field = file.field(step, name);
    const auto rows = static_cast<std::int64_t>(field.value.size()) / field.columns;
    const auto shown = field.value;
    const bool of_cells = name.starts_with("cell_") && rows == mesh.n_cells();
    if (file.is_skin() || !file.beams().empty()) blank(file, name, of_cells, field);
    if (rows == mesh.n_nodes() && !of_cells)
      attach<vtkDoubleArray>(grid->GetPointData(), name, field.value, field.columns);
    else if (rows == mesh.n_cells())
      attach<vtkDoubleArray>(grid->GetCellData(), name, field.value, field.columns);
    else
      throw Error(o.run, fmt::format("field \"{}\" has {} rows, neither nodes nor cells of the mesh", name, rows),
                  "the mesh was changed after the run");
    if (name == "displacement" && o.deformed)
      for (std::int64_t n = 0; n < mesh.n_nodes(); ++n) {
        const Vec3 x = mesh.X[static_cast<size_t>(n)] + Eigen::Map<const Vec3>(shown.data() + 3 * n);
        grid->GetPoints()->SetPoint(n, x.data());
      }
  }
  std::vector<int> fidelity;
  for (const std::int32_t r : mesh.region) fidelity.push_back(static_cast<int>(tagged.fidelity[static_cast<size_t>(r)]));
  attach<vtkIntArray>(grid->GetCellData(), "region", mesh.region, 1);
  attach<vtkIntArray>(grid->GetCellData(), "fidelity", fidelity, 1);
  if (!tagged.rank.empty()) attach<vtkIntArray>(grid->GetCellData(), "partition", tagged.rank, 1);
  attach<vtkDoubleArray>(grid->GetFieldData(), "TimeValue", std::vector<double>{step.t}, 1);

  // Inline binary: appended data is not read by Debian's ParaView 5.11.
  const auto writer = vtkSmartPointer<vtkXMLUnstructuredGridWriter>::New();
  writer->SetInputData(grid);
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->WriteToOutputStringOn();
  if (!writer->Write()) throw Error(o.output, "could not be encoded", "", Exit::fault);
  write_out(o.output, writer->GetOutputString());
}

}  // namespace

Command export_command(CLI::App& app) {
  auto* sub = app.add_subcommand(
      "export", "one step as VTU, or the run as glTF for slides and browsers (ParaView opens run.h5 and run.xdmf without this)");
  const auto o = std::make_shared<ExportOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("-o,--output", o->output, "run.vtu, or run.glb for glTF; - for VTU on stdout")->required();
  sub->add_option("--steps,--step", o->steps, "first, last or a number; glTF moves through several: all, 0,5,10 or 0:20")
      ->capture_default_str();
  sub->add_option("--times", o->times, "times in s or FROM:TO, instead of --steps: the nearest ones");
  sub->add_flag("--deformed", o->deformed, "points where they are at that time; reference positions by default");
  const char* only = "Of glTF alone";
  sub->add_option("--field", o->field,
                  "colours, as hilo-post render has them; where steps are several, the value largest in size; region by default")
      ->group(only);
  sub->add_option("--range", o->range, "LOW,HIGH of the colours in the unit of the file; by default the range over all that is drawn")
      ->group(only);
  sub->add_option("--show", o->show, "regions, by name or glob; all by default")->allow_extra_args(false)->group(only);
  sub->add_option("--hide", o->hide, "regions to leave out")->allow_extra_args(false)->group(only);
  sub->add_option("--speed", o->speed, "seconds of the run in a second of the animation; by default it lasts about 10 s")
      ->check(CLI::PositiveNumber)
      ->group(only);
  example(*sub,
          "  hilo-post export run.h5 --steps last -o run.vtu\n"
          "  hilo-post export run.h5 --steps all --field von_mises -o run.glb");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
