// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.hpp"

namespace hilo {
namespace {

using Values = std::vector<double>;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Function {
  const char* name;
  size_t least, most;  // arguments
  Values (*of)(std::span<const Values> arguments, const Values& t);
};

template <double (*f)(double)>
Values each(std::span<const Values> x, const Values&) {
  Values y;
  for (const double value : x[0]) y.push_back(f(value));
  return y;
}
template <double (*f)(double, double)>
Values fold(std::span<const Values> x, const Values&) {
  Values y = x[0];
  for (const Values& next : x.subspan(1))
    for (size_t i = 0; i < y.size(); ++i) y[i] = f(y[i], next[i]);
  return y;
}

/// Where an argument is no number, neither is the result.
double least(double a, double b) { return std::isnan(a) || a < b ? a : b; }
double greatest(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// Rate in time of second order, of steps of any length: that of the parabola through the three nearest values.
Values rate(std::span<const Values> arguments, const Values& t) {
  const Values& x = arguments[0];
  const size_t n = t.size();
  Values y(n, none);
  const auto slope = [&](size_t i) { return (x[i] - x[i - 1]) / (t[i] - t[i - 1]); };
  if (n == 2) y[0] = y[1] = slope(1);
  for (size_t i = 0; n > 2 && i < n; ++i) {
    const size_t k = std::clamp<size_t>(i + 1, 2, n - 1);  // last of the three
    y[i] = slope(k - 1) + (slope(k) - slope(k - 1)) / (t[k] - t[k - 2]) * (2 * t[i] - t[k - 2] - t[k - 1]);
  }
  return y;
}
Values start(std::span<const Values> x, const Values& t) { return Values(t.size(), x[0].empty() ? none : x[0][0]); }

constexpr size_t many = 99;
constexpr Function functions[] = {
    {"abs", 1, 1, each<std::fabs>},   {"sqrt", 1, 1, each<std::sqrt>},      {"exp", 1, 1, each<std::exp>},
    {"log", 1, 1, each<std::log>},    {"sin", 1, 1, each<std::sin>},        {"cos", 1, 1, each<std::cos>},
    {"tan", 1, 1, each<std::tan>},    {"asin", 1, 1, each<std::asin>},      {"acos", 1, 1, each<std::acos>},
    {"atan", 1, 1, each<std::atan>},  {"atan2", 2, 2, fold<std::atan2>},    {"min", 2, many, fold<least>},
    {"max", 2, many, fold<greatest>}, {"hypot", 2, many, fold<std::hypot>}, {"d", 1, 1, rate},
    {"start", 1, 1, start},
};

/// Recursive descent: sum, product, sign, power, primary.
class Parser {
 public:
  Parser(const std::string& text, const Values& t, const ColumnOf& column) : text_(text), t_(t), column_(column) {}

  Values whole() {
    Values x = sum();
    if (next()) fail("expected an operator");
    return x;
  }

 private:
  char next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    const bool here = next() == c;
    if (here) ++at_;
    return here;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error("", fmt::format("\"{}\", column {}: {}", text_, at_ + 1, what), "", Exit::usage);
  }
  template <class F>
  static Values both(Values a, const Values& b, F f) {
    for (size_t i = 0; i < a.size(); ++i) a[i] = f(a[i], b[i]);
    return a;
  }

  Values sum() {
    Values x = product();
    for (;;)
      if (take('+'))
        x = both(std::move(x), product(), std::plus<>());
      else if (take('-'))
        x = both(std::move(x), product(), std::minus<>());
      else
        return x;
  }
  Values product() {
    Values x = sign();
    for (;;)
      if (take('*'))
        x = both(std::move(x), sign(), std::multiplies<>());
      else if (take('/'))
        x = both(std::move(x), sign(), std::divides<>());
      else
        return x;
  }
  /// Every level of a formula goes through here: parentheses, arguments, signs and powers.
  Values sign() {
    if (++depth_ > most_deep) fail(fmt::format("more than {} levels deep", most_deep));
    Values x = take('+') ? sign() : take('-') ? both(Values(t_.size(), -1), sign(), std::multiplies<>()) : power();
    --depth_;
    return x;
  }
  Values power() {
    Values x = primary();
    return take('^') ? both(std::move(x), sign(), [](double a, double b) { return std::pow(a, b); }) : x;
  }
  Values primary() {
    const char c = next();
    if (take('(')) {
      Values x = sum();
      if (!take(')')) fail("expected \")\"");
      return x;
    }
    if (c == '"') {
      const size_t end = text_.find('"', at_ + 1);
      if (end == text_.npos) fail("a quote without its end");
      const std::string name = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
      return column_(name);
    }
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') return name();
    fail(c ? "expected a number, a name or \"(\"" : "ends too early");
  }
  Values number() {
    double x = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), x);
    if (error != std::errc()) fail("expected a number");
    at_ = static_cast<size_t>(end - text_.data());
    return Values(t_.size(), x);
  }
  Values name() {
    const size_t from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' || text_[at_] == '.')) ++at_;
    const std::string name = text_.substr(from, at_ - from);
    if (next() == '(') return call(name, from);
    if (name == "pi") return Values(t_.size(), M_PI);
    return name == "t" ? t_ : column_(name);
  }
  Values call(const std::string& name, size_t from) {
    for (const Function& f : functions) {
      if (name != f.name) continue;
      take('(');
      std::vector<Values> arguments{sum()};
      while (take(',')) arguments.push_back(sum());
      if (!take(')')) fail("expected \",\" or \")\"");
      if (arguments.size() < f.least || arguments.size() > f.most)
        fail(fmt::format("{} needs {}{} arguments, here are {}", name, f.least, f.most == many ? " or more" : "", arguments.size()));
      return f.of(arguments, t_);
    }
    at_ = from;
    fail(fmt::format("no function \"{}\"; there are {}", name, expression_functions()));
  }

  static constexpr int most_deep = 256;  // as in TOML
  const std::string& text_;
  const Values& t_;
  const ColumnOf& column_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::vector<double> evaluate(const std::string& formula, const std::vector<double>& t, const ColumnOf& column) {
  return Parser(formula, t, column).whole();
}

std::string expression_functions() {
  std::string names;
  for (const Function& f : functions) names += std::string(names.empty() ? "" : " ") + f.name;
  return names;
}

}  // namespace hilo
