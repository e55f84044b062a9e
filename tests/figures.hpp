// SPDX-License-Identifier: GPL-3.0-or-later
// Makes gtest print what it compares, passed or not: compile the tests with `-include tests/figures.hpp` to get the figures of
// docs/verification.md.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace hilo::test {

inline ::testing::AssertionResult near_with_figure(const char* a, const char* b, const char* t, double va, double vb, double vt) {
  std::printf("FIGURE %s - %s: |%.9g - %.9g| = %.2g (limit %.2g)\n", a, b, va, vb, std::abs(va - vb), vt);
  return ::testing::internal::DoubleNearPredFormat(a, b, t, va, vb, vt);
}

template <class A, class B>
::testing::AssertionResult less_with_figure(const char* a, const char* b, const A& va, const B& vb) {
  std::printf("FIGURE %s: %.3g (limit %.3g)\n", a, static_cast<double>(va), static_cast<double>(vb));
  return ::testing::internal::CmpHelperLT(a, b, va, vb);
}

}  // namespace hilo::test

#undef EXPECT_NEAR
#define EXPECT_NEAR(a, b, t) EXPECT_PRED_FORMAT3(::hilo::test::near_with_figure, a, b, t)
#undef EXPECT_LT
#define EXPECT_LT(a, b) EXPECT_PRED_FORMAT2(::hilo::test::less_with_figure, a, b)
