// The materials that the program knows: one file each, one name here.
#pragma once
#include <variant>

#include "physics/material/j2.hpp"
#include "physics/material/mooney_rivlin.hpp"
#include "physics/material/neo_hookean.hpp"
#include "physics/material/ogden.hpp"
#include "physics/material/orthotropic.hpp"
#include "physics/material/stvk.hpp"

namespace hilo {

/// A law with its parameters; the first is what a region has whose material does not say its kind.
using Material = std::variant<StVenantKirchhoff, NeoHookean, J2, MooneyRivlin, Ogden, Orthotropic>;

/// What is known of a law before it has parameters.
struct MaterialKind {
  std::string_view name, meaning;
  std::vector<Param> keys;
  Material (*make)(const MaterialValues&);
  double soft_below;
  std::string_view soft_because;
};

namespace material {
template <class... M>
std::vector<MaterialKind> kinds_in(const std::variant<M...>*) {
  return {
      {M::name, M::meaning, M::keys(), [](const MaterialValues& v) -> Material { return M::make(v); }, M::soft_below, M::soft_because}...};
}
template <class M, class... All>
constexpr int place_in(const std::variant<All...>*) {
  int at = 0, i = 0;
  ((std::is_same_v<M, All> ? at = i : 0, ++i), ...);
  return at;
}
}  // namespace material

/// All of them, in the order of the list.
inline const std::vector<MaterialKind>& material_kinds() {
  static const auto kinds = material::kinds_in(static_cast<const Material*>(nullptr));
  return kinds;
}
/// Place of a law in the list: Material::index() of those that hold it.
template <class M>
inline constexpr int place_of = material::place_in<M>(static_cast<const Material*>(nullptr));

inline Lame linear_moduli(const Material& m) {
  return std::visit([](const auto& law) { return law.linear(); }, m);
}
/// Where the parameters of the law lie, as the kernels take them.
inline const void* parameters(const Material& m) {
  return std::visit([](const auto& law) -> const void* { return &law; }, m);
}

}  // namespace hilo
