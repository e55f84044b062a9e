// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/solid_kernel.hpp"

#include <algorithm>
#include <cstdlib>

#include "physics/bar.hpp"
#include "physics/shape/from_outside.hpp"
#include "physics/shape/shapes.hpp"
#include "physics/shell_cell.hpp"

namespace hilo {

KernelFunction kernel_lanes2(Shape, size_t);
KernelFunction kernel_lanes4(Shape, size_t);
KernelFunction kernel_lanes8(Shape, size_t);

int lanes() {
  static const int width = [] {
    int w = 2;
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) w = 4;
    if (w == 4 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) w = 8;
#endif
    if (const char* wish = std::getenv("HILO_LANES")) w = std::min(w, std::max(2, std::atoi(wish)));
    return w >= 8 ? 8 : w >= 4 ? 4 : 2;
  }();
  return width;
}

namespace {

int flowing_points(Shape shape) {
  if (const ShapeFunctions* other = shape_from_outside(shape)) return other->n_points;
  return of_shape(shape, 0, []<class S>() { return Integrated<S, true>::n_points; });
}

/// Modes that a shell keeps where stress is not linear in strain (physics/shell.hpp).
int kept_modes(Shape shape, size_t law) {
  return shape != shell8 || law == place_of<StVenantKirchhoff> || law == place_of<Orthotropic> ? 0 : shell::n_modes;
}

}  // namespace

SolidKernel solid_kernel(Shape shape, size_t law) {
  const MaterialKind& kind = material_kinds()[law];
  const int n_state = kind.n_state * flowing_points(shape) + kept_modes(shape, law);
  if (shape == Shape::bar2) return {bar_kernel(law), 1, n_state};
  if (const ShapeFunctions* other = shape_from_outside(shape)) return {other->kernel(law), other->width, n_state};
  if (kind.functions) return {kind.functions->kernel(shape), kind.functions->width, n_state};
  const int w = shape == shell8 ? std::min(lanes(), 4) : lanes();  // eight shells are more than the first cache holds
  return {w == 8 ? kernel_lanes8(shape, law) : w == 4 ? kernel_lanes4(shape, law) : kernel_lanes2(shape, law), w, n_state};
}

}  // namespace hilo
