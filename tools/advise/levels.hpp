// SPDX-License-Identifier: GPL-3.0-or-later
// How much of each region a model has.
#pragma once
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace hilo {

enum class Level : std::uint8_t { rigid, linear, stiffening, nonlinear };  // each knows more than the one before
using Assignment = std::vector<Level>;                                     // (n_regions)

std::string_view word(Level level);
/// Inverse of word(); Error (exit 1) at `where`.
Level level_of(std::string_view word, const std::string& where);
inline Fidelity fidelity(Level l) {
  return l == Level::rigid ? Fidelity::rigid : l == Level::nonlinear ? Fidelity::nonlinear : Fidelity::linear;
}
/// "nonlinear c; linear a", "linear all but frame"; what is not named is rigid.
std::string label(const Assignment& levels, const std::vector<std::string>& regions);

}  // namespace hilo
