// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::export_test {
namespace {

TEST(Export, vtu_is_read_by_VTK_with_all_fields) {
  const Workplace place;
  const Mesh mesh = sample::machine();
  sample::write_run(place.path(), mesh, 3);
  succeeded(place.run("hilo-post export run.h5 --step 2 -o out/run.vtu"));
  const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  reader->SetFileName((place / "out/run.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), mesh.n_nodes());
  ASSERT_EQ(grid->GetNumberOfCells(), mesh.n_cells());
  for (const char* name : {"displacement", "velocity", "acceleration", "von_mises"})
    EXPECT_TRUE(grid->GetPointData()->HasArray(name)) << name;
  for (const char* name : {"cell_von_mises", "region", "fidelity", "partition"}) EXPECT_TRUE(grid->GetCellData()->HasArray(name)) << name;
  const double most = sample::front(mesh);
  for (std::int64_t n = 0; n < mesh.n_nodes(); n += 97) {
    EXPECT_EQ(Vec3(Eigen::Map<const Vec3>(grid->GetPoint(n))), mesh.X[static_cast<size_t>(n)]);
    const double s = grid->GetPointData()->GetArray("von_mises")->GetTuple1(n);
    if (s != 0) {
      EXPECT_EQ(s, sample::stress(mesh.X[static_cast<size_t>(n)], most, 2.0 / 3));
    }
  }
  for (std::int64_t c = 0; c < mesh.n_cells(); c += 31) {
    EXPECT_EQ(grid->GetCellType(c), info(mesh.shape[static_cast<size_t>(c)]).vtk_type);
    EXPECT_EQ(grid->GetCellData()->GetArray("region")->GetTuple1(c), mesh.region[static_cast<size_t>(c)]);
  }
  EXPECT_EQ(text_of(place / "out/run.vtu").find("appended"), std::string::npos);  // ParaView 5.11 of Debian does not read it
}

TEST(Export, deformed_points_are_moved_by_the_displacement) {
  const Workplace place;
  const Mesh mesh = sample::cube(2);
  sample::write_run(place.path(), mesh, 2);
  ASSERT_EQ(place.run("hilo-post export run.h5 --deformed -o run.vtu").exit, 0);
  const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  reader->SetFileName((place / "run.vtu").c_str());
  reader->Update();
  for (std::int64_t n = 0; n < mesh.n_nodes(); ++n) {
    const Vec3 u = Eigen::Map<const Vec3>(reader->GetOutput()->GetPointData()->GetArray("displacement")->GetTuple3(n));
    EXPECT_NEAR((Vec3(Eigen::Map<const Vec3>(reader->GetOutput()->GetPoint(n))) - mesh.X[static_cast<size_t>(n)] - u).norm(), 0, 1e-15);
  }
}

TEST(Export, a_step_that_is_not_there_is_an_error_and_leaves_nothing) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(2), 1);
  const auto before = place.files();
  const Ran ran = place.run("hilo-post export run.h5 --step 9 -o run.vtu");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_EQ(ran.err, "hilo-post: run.h5: no step 9 (there are 0 to 1)\n");
  EXPECT_EQ(place.files(), before);
}

}  // namespace
}  // namespace hilo::test::export_test
