// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post export: one step as a VTU file for other programs.
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
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"
#include "post/run/run_file.hpp"

namespace hilo {
namespace {

struct ExportOptions {
  std::string run, output, step = "last";
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

void run(const ExportOptions& o) {
  RunFile file(o.run);
  const auto steps = file.select_steps(o.step, "");
  if (steps.size() != 1) throw Error("--step", "one step makes one file", "", Exit::usage);
  const Step& step = steps.front();
  const MeshFile& tagged = file.mesh_file();
  const Mesh& mesh = tagged.mesh;
  const auto grid = grid_of(mesh);
  for (const std::string& name : file.fields(step)) {
    auto field = file.field(step, name);
    const auto rows = static_cast<std::int64_t>(field.value.size()) / field.columns;
    const auto shown = field.value;
    if (file.is_skin())
      for (size_t i = 0; i < field.value.size(); ++i)
        if (!file.holds(static_cast<std::int64_t>(i) / field.columns)) field.value[i] = std::numeric_limits<double>::quiet_NaN();
    if (rows == mesh.n_nodes() && !name.starts_with("cell_"))
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
  auto* sub = app.add_subcommand("export", "one step as VTU (ParaView opens run.xdmf without this)");
  const auto o = std::make_shared<ExportOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("-o,--output", o->output, "VTU file; - for stdout")->required();
  sub->add_option("--step", o->step, "first, last or a number")->capture_default_str();
  sub->add_flag("--deformed", o->deformed, "points where they are at that time; reference positions by default");
  example(*sub, "  hilo-post export run.h5 --step last -o run.vtu");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
