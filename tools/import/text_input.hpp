// SPDX-License-Identifier: GPL-3.0-or-later
// A text that is read word by word and number by number; an error says the line.
#pragma once
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

namespace hilo {

class TextInput {
 public:
  /// `comment`: what begins one, to the end of its line.
  TextInput(const std::string& path, std::string text, char comment = '\0') : path_(path), text_(std::move(text)), comment_(comment) {}
  virtual ~TextInput() = default;

  [[noreturn]] void fail(const std::string& what, const std::string& hint = "") const;
  /// The next word; "" at the end.
  std::string_view word();
  /// What is left of the line.
  std::string_view line();
  /// The next number; Error where the next word is none.
  template <class T>
  T number() {
    blanks();
    const size_t start = at_;
    const auto w = word();
    T value{};
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error == std::errc() && end == w.data() + w.size()) {
      if (!std::isfinite(static_cast<double>(value))) fail(fmt::format("\"{}\" is no number that can be computed with", w));
      return value;
    }
    at_ = start;
    if (w.empty()) fail("the file ends here");
    fail(fmt::format("\"{}\" is not {}", w.substr(0, 40), std::is_integral_v<T> ? "a whole number" : "a number"));
  }

 protected:
  /// Goes behind blanks and comments.
  void blanks();
  virtual std::string place() const;

  std::string path_, text_;
  size_t at_ = 0;

 private:
  char comment_;
};

}  // namespace hilo
