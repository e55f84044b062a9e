// SPDX-License-Identifier: GPL-3.0-or-later
// A solid shape from outside the tree.  A program that has one writes its struct S as physics/shape/shape.hpp says, and besides
//
//   static constexpr Shape shape{128};             a number from 128 on
//   static constexpr Quadrature<n> nodes();        where N_a = 1; no weights
//   static ShapeRow row();                         its name, facets and numbers (model/shape_row.hpp)
//
// and calls add_shape<S>() before it reads its first mesh; meshes, every law of the tree, mass, stress, compression, skins and facets are
// then as for a shape of the tree.  Laws from outside that its cells are made of too are named: add_shape<S, M>() behind add_material<M>().
// Its kernels take two cells at once, whatever the processor can do, and it is integrated as rule() says, without modes of its own.
#pragma once
#include "model/shape_row.hpp"
#include "physics/add_material.hpp"
#include "physics/cell_strain_of_shape.hpp"
#include "physics/shape/from_outside.hpp"

namespace hilo {

/// f<M>(law) of the M that a material is of.
template <class F, class... M>
bool of_law(const Material& material, const F& f, LawList<M...>) {
  return ((law_index(material) == place_of_law<M>() ? (f(*static_cast<const M*>(parameters(material))), true) : false) || ...);
}

template <class S, class... M>
void add_shape(LawList<M...>) {
  static const ShapeFunctions functions{
      .n_points = S::n_points,
      .width = 2,
      .kernel = [](size_t law) -> KernelFunction {
        KernelFunction found = nullptr;
        ((place_of_law<M>() == law ? void(found = run_kernel<S, M, PortableLanes>) : void()), ...);
        return found;
      },
      .least_stretch = least_stretch_of<S>,
      .least_det = least_det_of<S>,
      .stress_points =
          [](const Material& material, std::span<const Vec3> X, std::span<const Vec3> x, const double* state, StressPoints which,
             std::vector<StressPoint>& out) {
            return of_law(
                material, [&](const auto& law) { stress::points_of_cell<S>(law, X, x, state, which, out); }, LawList<M...>{});
          },
      .to_nodes = []() -> const Eigen::MatrixXd& {
        static const Eigen::MatrixXd table = stress::samples_to_nodes<S>();
        return table;
      },
      .nodal_gradients = stress::gradients_at_nodes<S>};
  add_shape_row(S::shape, S::row());
  add_shape_functions(S::shape, functions);
}

template <class... T, class... M>
constexpr LawList<T..., M...> laws_and(LawList<T...>, LawList<M...>) {
  return {};
}

template <class S, class... M>
void add_shape() {
  add_shape<S>(laws_and(Laws{}, LawList<M...>{}));
}

}  // namespace hilo
