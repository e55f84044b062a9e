// SPDX-License-Identifier: GPL-3.0-or-later
// The members of a plain struct (an aggregate without arrays of C), so that what walks through them cannot forget one.
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

namespace hilo {
namespace members {

/// Becomes whatever a member is made of.
struct Anything {
  template <class T>
  operator T() const;
};
template <class T, size_t... i>
constexpr bool takes(std::index_sequence<i...>) {
  return requires { T{(static_cast<void>(i), Anything{})...}; };
}
inline constexpr size_t most = 12;
/// How many members T has: as many as it can be made from.
template <class T, size_t n = most>
constexpr size_t count() {
  static_assert(!takes<T>(std::make_index_sequence<most + 1>()), "more members than are walked: put some into a struct of their own");
  if constexpr (n == 0 || takes<T>(std::make_index_sequence<n>()))
    return n;
  else
    return count<T, n - 1>();
}

}  // namespace members

/// visit(all members of x).  A miscount does not compile.
template <class T, class Visit>
requires(std::is_aggregate_v<T>&& std::is_class_v<T>) void with_members(T& x, Visit visit) {
  constexpr size_t n = members::count<T>();
  static_assert(n > 0);
  if constexpr (n == 1) {
    auto& [a] = x;
    visit(a);
  } else if constexpr (n == 2) {
    auto& [a, b] = x;
    visit(a, b);
  } else if constexpr (n == 3) {
    auto& [a, b, c] = x;
    visit(a, b, c);
  } else if constexpr (n == 4) {
    auto& [a, b, c, d] = x;
    visit(a, b, c, d);
  } else if constexpr (n == 5) {
    auto& [a, b, c, d, e] = x;
    visit(a, b, c, d, e);
  } else if constexpr (n == 6) {
    auto& [a, b, c, d, e, f] = x;
    visit(a, b, c, d, e, f);
  } else if constexpr (n == 7) {
    auto& [a, b, c, d, e, f, g] = x;
    visit(a, b, c, d, e, f, g);
  } else if constexpr (n == 8) {
    auto& [a, b, c, d, e, f, g, h] = x;
    visit(a, b, c, d, e, f, g, h);
  } else if constexpr (n == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = x;
    visit(a, b, c, d, e, f, g, h, i);
  } else if constexpr (n == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = x;
    visit(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (n == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = x;
    visit(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (n == 12) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l] = x;
    visit(a, b, c, d, e, f, g, h, i, j, k, l);
  }
}

}  // namespace hilo
