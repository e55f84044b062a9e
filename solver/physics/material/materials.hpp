// SPDX-License-Identifier: GPL-3.0-or-later
// The materials that the program knows: one file each, one name here.  A program outside the tree has further ones
// (physics/add_material.hpp).
#pragma once
#include <variant>

#include "base/registry.hpp"
#include "physics/material/from_outside.hpp"
#include "physics/material/j2.hpp"
#include "physics/material/mooney_rivlin.hpp"
#include "physics/material/neo_hookean.hpp"
#include "physics/material/ogden.hpp"
#include "physics/material/orthotropic.hpp"
#include "physics/material/stvk.hpp"

namespace hilo {

template <class... M>
struct LawList {};
/// The first is what a region has whose material does not say its kind.
using Laws = LawList<StVenantKirchhoff, NeoHookean, J2, MooneyRivlin, Ogden, Orthotropic>;

namespace material {
template <class... M>
std::variant<M..., LawFromOutside> any_in(LawList<M...>);
template <class M, class... All>
constexpr size_t place_in(LawList<All...>) {
  size_t at = 0, i = 0;
  ((std::is_same_v<M, All> ? at = i : 0, ++i), ...);
  return at;
}
}  // namespace material

/// A law with its parameters.
using Material = decltype(material::any_in(Laws{}));

/// What is known of a law before it has parameters.
struct MaterialKind {
  std::string_view name, meaning;
  std::vector<Param> keys;
  Material (*make)(const MaterialValues&);
  double soft_below;
  std::string_view soft_because;
  int n_state = 0;                          // numbers that a point remembers
  const LawFunctions* functions = nullptr;  // of laws from outside the tree
};

namespace material {
/// But for `make`.
template <class M>
MaterialKind kind_of() {
  MaterialKind kind{M::name, M::meaning, M::keys(), nullptr, M::soft_below, M::soft_because};
  if constexpr (requires { M::n_state; }) kind.n_state = M::n_state;
  return kind;
}
template <class M>
MaterialKind kind_of_tree() {
  MaterialKind kind = kind_of<M>();
  kind.make = [](const MaterialValues& v) -> Material { return M::make(v); };
  return kind;
}
template <class... M>
Registry<MaterialKind> kinds_in(LawList<M...>) {
  return {"law", {kind_of_tree<M>()...}};
}
}  // namespace material

/// All of them: those of the tree in the order of its list, then others.
inline Registry<MaterialKind>& material_kinds() {
  static auto kinds = material::kinds_in(Laws{});
  return kinds;
}
/// Place of a law of the tree in the list.
template <class M>
inline constexpr size_t place_of = material::place_in<M>(Laws{});
/// Place of the law that a material is of.
inline size_t law_index(const Material& m) {
  const auto* other = std::get_if<LawFromOutside>(&m);
  return other ? other->place : m.index();
}
inline const MaterialKind& kind_of(const Material& m) { return material_kinds()[law_index(m)]; }

inline Lame linear_moduli(const Material& m) {
  return std::visit([](const auto& law) { return law.linear(); }, m);
}
/// Where the parameters of the law lie, as the kernels take them.
inline const void* parameters(const Material& m) {
  if (const auto* other = std::get_if<LawFromOutside>(&m)) return other->parameters.get();
  return std::visit([](const auto& law) -> const void* { return &law; }, m);
}

}  // namespace hilo
