// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/shape/from_outside.hpp"

#include <array>

#include "base/outside_shapes.hpp"

namespace hilo {
namespace {

std::array<const ShapeFunctions*, most_shapes>& functions_of() {
  static std::array<const ShapeFunctions*, most_shapes> table{};
  return table;
}

}  // namespace

const ShapeFunctions* shape_from_outside(Shape shape) { return functions_of()[static_cast<size_t>(shape)]; }

void add_shape_functions(Shape shape, const ShapeFunctions& functions) { functions_of()[static_cast<size_t>(shape)] = &functions; }

}  // namespace hilo
