// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces on which a nodal field has given values, found anew at each instant.
#pragma once
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "model/mesh.hpp"

namespace hilo {

class IsoSurface {
 public:
  IsoSurface(const Mesh& mesh, std::vector<std::int64_t> cells, std::vector<double> levels);

  /// The surfaces at nodal values and positions; each point carries its level as its value.
  void update(const std::vector<double>& value, const std::vector<Vec3>& x);
  vtkPolyData* surface() const { return surface_; }

 private:
  const Mesh& mesh_;
  std::vector<std::int64_t> cells_;
  std::vector<double> levels_;
  vtkSmartPointer<vtkPolyData> surface_;
};

}  // namespace hilo
