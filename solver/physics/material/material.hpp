// SPDX-License-Identifier: GPL-3.0-or-later
// What a material offers.  A law is one file of this folder and a name in the list of materials.hpp; kernels, bars, stress output, the
// scene's schema and its checks take everything else from it:
//
//   struct M {
//     static constexpr std::string_view name, meaning;        the word of [material.NAME] kind, and a line for the page of the format
//     static std::vector<Param> keys();                       its keys in the scene, without kind and density
//     static M make(const MaterialValues&);                   from checked values in SI units
//     using Bulk = ...;                                       form of the part that a nearly incompressible cell takes by its mean
//                                                             (dilatation.hpp)
//     static constexpr double soft_below;                     stretch below which it no longer stands for a material, 0: none
//     static constexpr std::string_view soft_because;         why, in the warning
//     Lame linear() const;                                    moduli at small strain: of rate terms and of hourglass stiffness
//     M with_lambda(double) const;                            the same law with another lambda; not with NoBulk
//     T energy(const T e[6]) const;                           per reference volume, of the Green-Lagrange strain     [J/m^3]
//     void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const;
//         second Piola-Kirchhoff stress with s.(e1 - e0) = W1 - W0 exactly, and at e0 = e1 dW/de; D += ds/de1 where given
//     BarState bar(double e) const;  BarStep bar_step(double e0, double e1) const;          under uniaxial stress; without: no bars
//     Anisotropic moduli;                                     where they differ with direction (physics/anisotropic.hpp)
//   };
//
// A law that remembers has instead of energy, stress, with_lambda and bars
//
//     static constexpr int n_state, plastic_strain;           numbers a point remembers, 0 as new; which of them is the plastic strain
//     void respond(PointStep& step) const;                    all of the above for one point and step (point_step.hpp); in a file of its
//                                                             own, since kernels are compiled for several processors
//
// energy and stress are written once for any number type T: a double, a vector of cells, a number with its derivative.
#pragma once
#include <functional>

#include "base/param.hpp"
#include "physics/material/bar_state.hpp"
#include "physics/material/voigt.hpp"

namespace hilo {

/// The values of a material's keys.
struct MaterialValues {
  std::function<bool(std::string_view key)> has;       // given, or by default
  std::function<double(std::string_view key)> number;  // Error where the key has no value
  std::function<std::vector<double>(std::string_view key)> numbers;
  std::function<void(std::string_view key, const std::string& why)> refuse;  // throws Error at the key
};

constexpr Param young{"E", Type::number, "Pa", "", "Young's modulus, at small strain (may come from the deck)", above(0)};
constexpr Param poisson{"nu", Type::number, "1", "", "Poisson's ratio, at small strain (may come from the deck)", between(-1, 0.5)};

}  // namespace hilo
