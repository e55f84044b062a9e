// SPDX-License-Identifier: GPL-3.0-or-later
// JSON that is written: values that know how they are put down, members and items in the order given.  nlohmann's, which reads it, puts
// every item on a line of its own, or all of them on one.
#pragma once
#include <concepts>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hilo {

/// Text as a JSON string, quotes included.
std::string json_text(std::string_view text);

class Json {
 public:
  using Member = std::pair<std::string, Json>;
  enum class In { one_line, lines };  // how the items of a list and the members of an object follow one another

  Json(std::string_view text) : text_(json_text(text)) {}
  Json(const std::string& text) : Json(std::string_view(text)) {}
  Json(const char* text) : Json(std::string_view(text)) {}
  Json(std::nullptr_t) : text_("null") {}
  template <std::integral T>
  Json(T x) : text_(std::is_same_v<T, bool> ? (x ? "true" : "false") : std::to_string(x)) {}
  /// Null where it is not finite; of so many significant digits, 0: all that it has.
  Json(double x, int digits = 0);
  /// An object on one line.
  Json(std::initializer_list<Member> members) : members_(members), brackets_("{}") {}

  static Json object(In in = In::one_line) { return Json("{}", in); }
  static Json list(In in = In::one_line) { return Json("[]", in); }
  /// A list of f(x).
  template <class Range, class F = std::identity>
  static Json list_of(const Range& range, F f = {}, In in = In::one_line) {
    Json out = list(in);
    for (const auto& x : range) out.append(f(x));
    return out;
  }
  /// A number that is written already.
  static Json number(std::string text) {
    Json out(nullptr);
    out.text_ = std::move(text);
    return out;
  }

  void add(std::string_view key, Json value) { members_.emplace_back(key, std::move(value)); }
  void append(Json item) { members_.emplace_back("", std::move(item)); }
  const std::vector<Member>& members() const { return members_; }
  /// `indent`: of the line that it stands on.
  std::string text(size_t indent = 0) const;

 private:
  Json(const char* brackets, In in) : in_(in), brackets_(brackets) {}
  std::string text_;  // of what is no list and no object
  std::vector<Member> members_;
  In in_ = In::one_line;
  const char* brackets_ = nullptr;
};

}  // namespace hilo
