// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/utf8.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hilo::test::utf8_test {
namespace {

TEST(Utf8, Latin1BecomesUtf8AndUtf8Stays) {
  EXPECT_EQ(as_utf8("K\xF6rper"), "K\xC3\xB6rper");
  EXPECT_EQ(as_utf8("K\xC3\xB6rper"), "K\xC3\xB6rper");
  EXPECT_EQ(as_utf8("K\xC3\xB6rper, b\xEAte"), "K\xC3\xB6rper, b\xC3\xAAte");
  EXPECT_EQ(as_utf8("plain"), "plain");
  EXPECT_EQ(as_utf8("\xE2\x82\xAC \xF0\x9F\x98\x80"), "\xE2\x82\xAC \xF0\x9F\x98\x80");  // three and four bytes
  EXPECT_EQ(as_utf8("\xC3"), "\xC3\x83");                                                // cut off
  EXPECT_EQ(as_utf8("\xC0\xAF"), "\xC3\x80\xC2\xAF");                                    // an overlong '/'
  EXPECT_EQ(as_utf8("\xED\xA0\x80"), "\xC3\xAD\xC2\xA0\xC2\x80");                        // half of a pair of UTF-16
}

TEST(Utf8, WhatItGivesItLeavesAsItIs) {
  std::mt19937 random(3);
  for (int k = 0; k < 2000; ++k) {
    std::string text(random() % 12, ' ');
    for (char& c : text) c = static_cast<char>(random() % 3 ? 0x80 + random() % 0x80 : random() % 0x80);
    const std::string once = as_utf8(text);
    EXPECT_EQ(as_utf8(once), once);
  }
}

}  // namespace
}  // namespace hilo::test::utf8_test
