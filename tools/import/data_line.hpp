// SPDX-License-Identifier: GPL-3.0-or-later
// Text decks: a line cut into fields that know where they stand, and the numbers in them.
#pragma once
#include <cstdint>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// A field of a data line, blanks stripped, and where it stands.
struct DataField {
  std::string_view text;
  int column = 1;
};

/// Where a reader of lines counts the fields that are asked for, as bits; a copy of a line counts no more.
struct Asked {
  std::uint64_t* bits = nullptr;
  Asked() = default;
  Asked(const Asked&) {}
  Asked& operator=(const Asked&) { return bits = nullptr, *this; }
};

/// A data line.  Fields are views into the file's text, which the reader keeps.
struct DataLine {
  const std::string* file = nullptr;
  int line = 0;
  std::vector<DataField> fields;
  Asked asked = {};

  std::string place() const;              // file:line
  std::string place(size_t field) const;  // file:line:column
  /// The text of a field, "" behind the last one.
  std::string_view text(size_t field) const {
    if (asked.bits && field < 64) *asked.bits |= std::uint64_t{1} << field;
    return field < fields.size() ? fields[field].text : std::string_view{};
  }
  /// What nobody asked for is of no effect here.
  void ignore_rest() const {
    if (asked.bits) *asked.bits = ~std::uint64_t{0};
  }
  bool empty(size_t field) const { return text(field).empty(); }
  /// A number; an empty field is `fallback`.  Throws Error with the place.
  double number(size_t field, double fallback = 0) const;
  /// Three of them, from this field on.
  Vec3 vector(size_t field) const { return {number(field), number(field + 1), number(field + 2)}; }
  std::int64_t integer(size_t field) const;
  std::int64_t integer(size_t field, std::int64_t fallback) const { return empty(field) ? fallback : integer(field); }
  bool is_integer(size_t field) const;
};

/// The lines of a text.
inline auto lines_of(std::string_view text) {
  if (text.ends_with('\n')) text.remove_suffix(1);
  return text | std::views::split('\n') | std::views::transform([](auto line) { return std::string_view(line.begin(), line.end()); });
}

/// A text without the blanks at its ends.
std::string_view strip(std::string_view s);

/// Upper case, blanks removed.
std::string upper(std::string_view s);

/// The whole text of a plain or gzip file; Error when it cannot be read.
std::string read_gz(const std::string& path, const std::string& place);

}  // namespace hilo
