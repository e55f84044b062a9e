// SPDX-License-Identifier: GPL-3.0-or-later
// FNV-1a of 64 bits: tells contents apart that nobody forges.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace hilo {

class Digest {
 public:
  Digest& add(std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) value_ = (value_ ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
    return *this;
  }
  template <class T>
  requires std::is_arithmetic_v<T> Digest& add(const T& number) { return add(std::as_bytes(std::span(&number, 1))); }
  Digest& add(std::string_view text) { return add(text.size()).add(std::as_bytes(std::span(text))); }
  std::uint64_t value() const { return value_; }
  /// "fnv1a64:<16 hex digits>"
  std::string text() const { return fmt::format("fnv1a64:{:016x}", value_); }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace hilo
