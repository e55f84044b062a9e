// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace hilo {

std::string printable(std::string_view text) {
  constexpr std::array<std::pair<unsigned, unsigned>, 8> unseen{
      {{0, 8}, {11, 31}, {127, 159}, {0x200B, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F}, {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}}};
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[i + k]); };
    unsigned code = byte(0);
    size_t n = code >= 0xF0 ? 4 : code >= 0xE0 ? 3 : code >= 0xC0 ? 2 : 1;
    if (i + n > text.size()) n = 1;
    if (n > 1) code &= 0xFFu >> (n + 1);
    for (size_t k = 1; k < n; ++k) code = (code << 6) | (byte(k) & 0x3F);
    if (n == 1 && code >= 128) code = 'x';  // no UTF-8: as it is
    if (std::any_of(unseen.begin(), unseen.end(), [&](const auto& range) { return code >= range.first && code <= range.second; }))
      out += fmt::format("\\u{:04X}", code);
    else
      out += text.substr(i, n);
    i += n;
  }
  return out;
}

}  // namespace hilo
