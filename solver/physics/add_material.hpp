// SPDX-License-Identifier: GPL-3.0-or-later
// A law from outside the tree.  A program that has one writes its struct M as material/material.hpp says, and calls add_material<M>()
// before it reads its first scene; keys, checks and suggestions of [material.NAME], every shape of the tree, stress, bars where M has them,
// and memory where it has that are then as for a law of the tree.  Its kernels take two cells at once, whatever the processor can do.
#pragma once
#include "physics/bar_of_law.hpp"
#include "physics/solid_kernel_lanes.hpp"
#include "physics/stress_of_law.hpp"

namespace hilo {

/// Two doubles: what every processor has.
typedef double PortableLanes __attribute__((vector_size(16)));

template <class M>
void add_material() {
  static LawFunctions functions{
      .width = 2,
      .kernel = kernel_of_shape<M, PortableLanes>,
      .bar_kernel = bar_of<M>(),
      .bar = nullptr,
      .linear = [](const void* law) { return static_cast<const M*>(law)->linear(); },
      .stress_points =
          [](Shape shape, const void* law, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, StressPoints which,
             std::vector<StressPoint>& out) { stress::points_of_law(shape, *static_cast<const M*>(law), X, x, state, which, out); }};
  if constexpr (requires(const M& law) { law.bar(0.0); })
    functions.bar = [](const void* law, double e) { return static_cast<const M*>(law)->bar(e); };
  static const size_t place = material_kinds().size();
  MaterialKind kind = material::kind_of<M>();
  kind.make = [](const MaterialValues& v) -> Material { return LawFromOutside{&functions, place, std::make_shared<const M>(M::make(v))}; };
  kind.functions = &functions;
  material_kinds().add(std::move(kind));
}

/// Its place in the list of laws.
template <class M>
size_t place_of_law() {
  static const size_t place = [] {
    for (size_t k = 0; k < material_kinds().size(); ++k)
      if (material_kinds()[k].name == M::name) return k;
    return material_kinds().size();
  }();
  return place;
}

}  // namespace hilo
