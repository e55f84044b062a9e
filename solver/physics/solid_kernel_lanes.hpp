// SPDX-License-Identifier: GPL-3.0-or-later
// Body of the translation units solid_lanes{2,4,8}.cpp: every kernel for W lanes.  Each unit is compiled for its own instruction set, so
// nothing here may be shared with other units: all functions are templates on the lane type or have internal linkage.
#pragma once
#include "physics/shape/shapes.hpp"
#include "physics/solid_cell.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo {

template <class S, class M, class T>
static void run_kernel(const KernelCall& k) {
  constexpr int n3 = 3 * S::n;
  const auto lanes_of = [](const double* p) { return reinterpret_cast<const T*>(p); };
  const auto clear = [](double* p, int count) {
    T* t = reinterpret_cast<T*>(p);
    if (t)
      for (int i = 0; i < count; ++i) t[i] = T{};
    return t;
  };
  T* least = reinterpret_cast<T*>(k.least_det);
  if (least) *least = T{} + 1e300;
  const M& law = *static_cast<const M*>(k.law);
  const SolidCall<T> call{lanes_of(k.X),
                          lanes_of(k.x0),
                          lanes_of(k.x1),
                          k.elastic,
                          k.viscous,
                          law.linear(),
                          clear(k.f, n3),
                          clear(k.K, n3 * n3),
                          clear(k.energy, 1),
                          clear(k.dissipated, 1),
                          least,
                          k.density,
                          lanes_of(k.a),
                          k.mass_slope,
                          k.weight,
                          lanes_of(k.h0),
                          reinterpret_cast<T*>(k.h1),
                          k.elapsed,
                          0,
                          lanes_of(k.before),
                          lanes_of(k.along),
                          {lanes_of(k.past[0]), lanes_of(k.past[1])},
                          {k.recall[0], k.recall[1]}};
  if (k.elastic != 0 || k.viscous != 0 || k.energy) evaluate_strain<S>(law, call);
  if (k.a) add_mass<S>(call);
}

template <class M, class T>
static KernelFunction kernel_of_shape(Shape shape) {
  return of_shape<KernelFunction>(shape, nullptr,
                                  []<class S>() -> KernelFunction { return run_kernel<Integrated<S, Remembers<M>>, M, T>; });
}

template <class T, class... M>
static KernelFunction kernel_in(Shape shape, size_t law, LawList<M...>) {
  KernelFunction (*const of_law[])(Shape) = {kernel_of_shape<M, T>...};
  return of_law[law](shape);
}
/// Of a law of the tree.
template <class T>
static KernelFunction kernel_of(Shape shape, size_t law) {
  return kernel_in<T>(shape, law, Laws{});
}

}  // namespace hilo
