// Body of the translation units solid_lanes{2,4,8}.cpp: every kernel for W lanes.  Each unit is compiled for its own instruction set, so
// nothing here may be shared with other units: all functions are templates on the lane type or have internal linkage.
#pragma once
#include "physics/shape/tet10.hpp"
#include "physics/shape/wedge15.hpp"
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
                          k.elapsed};
  if (k.elastic != 0 || k.viscous != 0 || k.energy) evaluate_strain<S>(law, call);
  if (k.a) add_mass<S>(call);
}

template <class M, class T>
static KernelFunction kernel_of_shape(Shape shape) {
  switch (shape) {
    case Shape::tet4:
      return run_kernel<Tet4, M, T>;
    case Shape::tet10:
      return run_kernel<Tet10, M, T>;
    case Shape::wedge6:
      return run_kernel<Wedge6, M, T>;
    case Shape::wedge15:
      return run_kernel<Wedge15, M, T>;
    case Shape::hex8:
      return run_kernel<std::conditional_t<Remembers<M>, Hex8Full, Hex8>, M, T>;
    case Shape::hex20:
      return run_kernel<Hex20, M, T>;
    case Shape::hex20r:
      return run_kernel<Hex20R, M, T>;
    case Shape::bar2:
      break;
  }
  return nullptr;
}

template <class T, class... M>
static KernelFunction kernel_in(Shape shape, size_t law, const std::variant<M...>*) {
  KernelFunction (*const of_law[])(Shape) = {kernel_of_shape<M, T>...};
  return of_law[law](shape);
}
template <class T>
static KernelFunction kernel_of(Shape shape, size_t law) {
  return kernel_in<T>(shape, law, static_cast<const Material*>(nullptr));
}

}  // namespace hilo
