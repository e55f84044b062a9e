// SPDX-License-Identifier: GPL-3.0-or-later
// The solid shapes that the program knows: one file each, one name here, and a row of model/mesh_shape.cpp (facets, numbers of file
// formats).
#pragma once
#include <type_traits>

#include "physics/shape/hex20r.hpp"
#include "physics/shape/shell8.hpp"
#include "physics/shape/tet10.hpp"
#include "physics/shape/wedge15.hpp"

namespace hilo {

template <class... S>
struct ShapeList {};
using SolidShapes = ShapeList<Tet4, Tet10, Wedge6, Wedge15, Hex8, Hex20, Hex20R, Shell8>;

/// The shape as it is integrated where its law remembers.
template <class S, bool remembers>
using Integrated =
    std::conditional_t<!remembers, S,
                       std::conditional_t<std::is_same_v<S, Hex8>, Hex8Full, std::conditional_t<std::is_same_v<S, Shell8>, Shell8Full, S>>>;

/// f<S>() of the S that a shape is; `otherwise` where it is none of the list: a bar.
template <class R, class F, class... S>
R of_shape(Shape shape, R otherwise, const F& f, ShapeList<S...>) {
  ((S::shape == shape ? void(otherwise = f.template operator()<S>()) : void()), ...);
  return otherwise;
}
template <class R, class F>
R of_shape(Shape shape, R otherwise, const F& f) {
  return of_shape(shape, otherwise, f, SolidShapes{});
}

}  // namespace hilo
