// SPDX-License-Identifier: GPL-3.0-or-later
// A law that a program outside the tree brings: its parameters, and what is done with them.  add_material (physics/add_material.hpp) makes
// the functions from a struct like those of this folder.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/math.hpp"
#include "base/shape.hpp"
#include "physics/material/bar_state.hpp"
#include "physics/material/voigt.hpp"

namespace hilo {

struct KernelCall;  // physics/solid_kernel.hpp
using KernelFunction = void (*)(const KernelCall&);
struct StressPoint;  // physics/stress.hpp
enum class StressPoints;

/// Each takes a pointer to the parameters.
struct LawFunctions {
  int width;                               // cells that a kernel takes at once; bars: one
  KernelFunction (*kernel)(Shape);         // null for a shape that it has none of
  KernelFunction bar_kernel;               // null: it has no bars
  BarState (*bar)(const void*, double e);  // the same
  Lame (*linear)(const void*);
  void (*stress_points)(Shape, const void*, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, StressPoints which,
                        std::vector<StressPoint>& out);
};

struct LawFromOutside {
  const LawFunctions* functions;
  size_t place;  // in the list of laws
  std::shared_ptr<const void> parameters;
  Lame linear() const { return functions->linear(parameters.get()); }
};

}  // namespace hilo
