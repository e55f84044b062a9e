// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace hilo::registry {

void refuse(std::string_view what, std::string_view word, const std::vector<std::string>& words, const std::string& where) {
  const std::string near = suggest(word, words);
  throw Error(where, fmt::format("no {} \"{}\"", what, word), near.empty() ? fmt::format("one of: {}", fmt::join(words, ", ")) : near);
}

void refuse_row(std::string_view what, std::string_view word, bool late) {
  throw Error("", fmt::format("{} \"{}\" {}", what, word, late ? "is added after the first scene was read" : "stands in its list already"),
              late ? "add it at the start of the program" : "", Exit::fault);
}

}  // namespace hilo::registry
