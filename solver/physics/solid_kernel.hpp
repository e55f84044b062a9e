// SPDX-License-Identifier: GPL-3.0-or-later
// The solid kernels by shape and material, in the widest vectors this machine has.
#pragma once
#include "base/shape.hpp"
#include "physics/material/materials.hpp"

namespace hilo {

/// Arguments of one call on `width` cells; arrays are (entry x width), lane fastest.  See SolidCall for the meaning.
struct KernelCall {
  const double *X, *x0, *x1;
  double elastic, viscous;
  const void* law;                                  // parameters(material) of the law that the kernel is of
  double *f, *K, *energy, *dissipated, *least_det;  // null where not wanted; set, not added to
  double density = 0;
  const double* a = nullptr;  // null: no inertia
  double mass_slope = 0;
  double area = 0;             // of bars [m^2]
  double weight = 0.5;         // share of x1 in the averages; 1/2: discrete gradient
  const double* h0 = nullptr;  // of laws that remember: see SolidCall
  double* h1 = nullptr;
  double elapsed = 0;
  const double *before = nullptr, *along = nullptr;
  const double* past[2] = {nullptr, nullptr};
  double recall[2] = {0, 0};
};

/// Kernel of a shape and a law (law_index(material)) and the number of cells it takes at once; no function where the law has no such cells.
struct SolidKernel {
  KernelFunction call;
  int width;
  int n_state;  // numbers that a cell remembers
};
/// Chosen at run time by what the processor can do; HILO_LANES=2|4|8 lowers the choice.
SolidKernel solid_kernel(Shape shape, size_t law);
int lanes();

}  // namespace hilo
