// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of an ellipsoid: how a body without a mesh is drawn.
#pragma once
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "post/run/ellipsoid.hpp"

namespace hilo {

vtkSmartPointer<vtkPolyData> ellipsoid(const Ellipsoid& body);

}  // namespace hilo
