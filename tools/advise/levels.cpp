// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/levels.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace hilo {
namespace {

constexpr std::array<std::string_view, 4> words{"rigid", "linear", "stiffening", "nonlinear"};

}  // namespace

std::string_view word(Level level) { return words[static_cast<size_t>(level)]; }

Level level_of(std::string_view text, const std::string& where) {
  for (size_t k = 0; k < words.size(); ++k)
    if (words[k] == text) return static_cast<Level>(k);
  throw Error(where, "no level \"" + std::string(text) + "\"", "rigid, linear, stiffening or nonlinear", Exit::usage);
}

std::string label(const Assignment& levels, const std::vector<std::string>& regions) {
  std::string out;
  for (const Level level : {Level::nonlinear, Level::stiffening, Level::linear}) {
    const auto n = static_cast<size_t>(std::count(levels.begin(), levels.end(), level));
    if (n == 0) continue;
    const bool most = n > 3 && 2 * n > levels.size();
    std::string names;
    for (size_t r = 0; r < levels.size(); ++r)
      if ((levels[r] == level) != most) names += (names.empty() ? "" : ", ") + regions[r];
    out += (out.empty() ? "" : "; ") + std::string(word(level)) + (most ? names.empty() ? " all" : " all but " : " ") + names;
  }
  return out.empty() ? "all rigid" : out;
}

}  // namespace hilo
