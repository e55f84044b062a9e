// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/inp/parameter.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.hpp"
#include "base/param.hpp"

namespace hilo {
namespace {

class Expression {
 public:
  Expression(std::string_view text, const std::map<std::string, InpParameter>& known, const std::string& place)
      : text_(text), known_(known), place_(place) {}

  InpParameter all() {
    const InpParameter x = sum();
    blanks();
    if (at_ < text_.size()) fail(fmt::format("\"{}\" is not understood", text_.substr(at_)));
    if (!std::isfinite(x.value)) fail("no finite number");
    return x;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(place_, fmt::format("*PARAMETER: {} in \"{}\"", what, text_), "write the numbers out");
  }
  void blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(std::string_view sign) {
    blanks();
    if (!text_.substr(at_).starts_with(sign)) return false;
    at_ += sign.size();
    blanks();
    return true;
  }
  template <class F>
  static InpParameter both(const InpParameter& x, const InpParameter& y, F f) {
    return {f(x.value, y.value), x.whole && y.whole};
  }
  InpParameter sum() {
    InpParameter x = product();
    for (;;)
      if (take("+"))
        x = both(x, product(), std::plus<>());
      else if (take("-"))
        x = both(x, product(), std::minus<>());
      else
        return x;
  }
  InpParameter product() {
    InpParameter x = sign();
    for (;;)
      if (!text_.substr(at_).starts_with("**") && take("*")) {
        x = both(x, sign(), std::multiplies<>());
      } else if (take("/")) {
        const auto y = sign();
        if (y.value == 0) fail("a division by zero");
        if (x.whole && y.whole && std::fmod(x.value, y.value) != 0) fail("a division of whole numbers with a rest");
        x = both(x, y, std::divides<>());
      } else {
        return x;
      }
  }
  InpParameter sign() {
    if (depth_ > 100) fail("too deep a nesting");
    if (take("-")) {
      const Deeper deeper(depth_);
      const auto x = sign();
      return {-x.value, x.whole};
    }
    if (take("+")) {
      const Deeper deeper(depth_);
      return sign();
    }
    return power();
  }
  InpParameter power() {
    const InpParameter x = atom();
    if (!take("**")) return x;
    const Deeper deeper(depth_);
    const InpParameter y = sign();
    return {std::pow(x.value, y.value), x.whole && y.whole && y.value >= 0};
  }
  InpParameter atom() {
    blanks();
    if (take("(")) {
      const Deeper deeper(depth_);
      const auto x = sum();
      if (!take(")")) fail("a \")\" is missing");
      return x;
    }
    const size_t from = at_;
    if (at_ < text_.size() && (std::isalpha(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) return named();
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("a number is missing");
    at_ = static_cast<size_t>(end - text_.data());
    return {value, text_.substr(from, at_ - from).find_first_not_of("0123456789") == std::string_view::npos};
  }
  InpParameter named() {
    const size_t from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
    const std::string name(text_.substr(from, at_ - from));
    if (!take("(")) {
      const auto x = known_.find(name);
      if (x == known_.end()) fail(fmt::format("no parameter \"{}\" so far", name));
      return x->second;
    }
    static const std::map<std::string, double (*)(double)> functions{{"sqrt", std::sqrt},
                                                                     {"sin", std::sin},
                                                                     {"cos", std::cos},
                                                                     {"tan", std::tan},
                                                                     {"asin", std::asin},
                                                                     {"acos", std::acos},
                                                                     {"atan", std::atan},
                                                                     {"exp", std::exp},
                                                                     {"log", std::log},
                                                                     {"log10", std::log10},
                                                                     {"radians", [](double x) { return x * std::numbers::pi / 180; }},
                                                                     {"degrees", [](double x) { return x * 180 / std::numbers::pi; }},
                                                                     {"float", [](double x) { return x; }}};
    const Deeper deeper(depth_);
    const auto x = sum();
    if (!take(")")) fail("a \")\" is missing");
    if (name == "int") return {std::trunc(x.value), true};
    if (name == "abs") return {std::abs(x.value), x.whole};
    const auto f = functions.find(name);
    if (f == functions.end()) fail(fmt::format("no function \"{}\"", name));
    return {f->second(x.value), false};
  }

  struct Deeper {
    explicit Deeper(int& d) : d(d) { ++d; }
    ~Deeper() { --d; }
    int& d;
  };
  std::string_view text_;
  const std::map<std::string, InpParameter>& known_;
  const std::string& place_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::string InpParameter::text() const {
  return whole && std::abs(value) < 1e15 ? fmt::format("{:.0f}", value) : fmt::format("{:.17g}", value);
}

InpParameter evaluate_parameter(std::string_view expression, const std::map<std::string, InpParameter>& known, const std::string& place) {
  return Expression(expression, known, place).all();
}

}  // namespace hilo
