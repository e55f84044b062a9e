// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/table.hpp"

#include <gtest/gtest.h>

namespace hilo {
namespace {

TEST(Table, AlignsNumbersToTheRightAndCountsCharactersNotBytes) {
  const Table t{{"name", "n"}, {{"größe", "1"}, {"12", "100"}}};
  EXPECT_EQ(t.text(), "name     n\ngröße    1\n12     100\n");
  EXPECT_EQ(t.json().text(), "[\n  {\"name\": \"größe\", \"n\": 1},\n  {\"name\": \"12\", \"n\": 100}\n]");
}

}  // namespace
}  // namespace hilo
