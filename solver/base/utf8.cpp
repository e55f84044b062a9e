// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/utf8.hpp"

#include <algorithm>
#include <cstddef>

namespace hilo {
namespace {

/// Bytes of the character that begins at `i`, by the table of well-formed sequences of the Unicode standard (3-7); 0 where there is none.
size_t length_of_character(const std::string& text, size_t i) {
  const auto byte = [&](size_t k) -> unsigned { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u; };
  const auto within = [](unsigned b, unsigned low, unsigned high) { return b >= low && b <= high; };
  const unsigned b = byte(0);
  const auto follow = [&](size_t from, size_t n) {
    for (size_t k = from; k < n; ++k)
      if (!within(byte(k), 0x80, 0xBF)) return size_t{0};
    return n;
  };
  if (b < 0x80) return 1;
  if (within(b, 0xC2, 0xDF)) return follow(1, 2);
  if (within(b, 0xE0, 0xEF)) return within(byte(1), b == 0xE0 ? 0xA0 : 0x80, b == 0xED ? 0x9F : 0xBF) ? follow(2, 3) : 0;
  if (within(b, 0xF0, 0xF4)) return within(byte(1), b == 0xF0 ? 0x90 : 0x80, b == 0xF4 ? 0x8F : 0xBF) ? follow(2, 4) : 0;
  return 0;
}

}  // namespace

std::string as_utf8(std::string text) {
  if (std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; })) return text;
  std::string out;
  for (size_t i = 0; i < text.size();) {
    if (const size_t n = length_of_character(text, i)) {
      out.append(text, i, n);
      i += n;
      continue;
    }
    const auto b = static_cast<unsigned char>(text[i++]);
    out += static_cast<char>(0xC0 | (b >> 6));
    out += static_cast<char>(0x80 | (b & 0x3F));
  }
  return out;
}

}  // namespace hilo
