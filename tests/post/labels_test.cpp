// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of faces that lie close together.
#include <gtest/gtest.h>

#include <cmath>

#include "post/scene/numbered_faces.hpp"

namespace hilo::test::labels_test {
namespace {

double nearest(const std::vector<Vec2>& at) {
  double least = 1e9;
  for (size_t i = 0; i < at.size(); ++i)
    for (size_t j = 0; j < i; ++j) least = std::min(least, (at[i] - at[j]).norm());
  return least;
}

TEST(Labels, of_a_small_part_are_spread_and_others_stay) {
  const Box picture{0, 0, 800, 600};
  std::vector<Vec2> at{{700, 500}, {700, 530}};           // apart already
  for (int k = 0; k < 12; ++k) at.emplace_back(100, 80);  // twelve in one place
  for (int k = 0; k < 12; ++k) at.emplace_back(400 + 5 * std::cos(k), 300 + 5 * std::sin(k));
  at.emplace_back(3, 3), at.emplace_back(4, 4);  // in a corner
  const auto spread = spread_labels(at, 23, picture);
  ASSERT_EQ(spread.size(), at.size());
  EXPECT_GE(nearest(spread), 23);
  EXPECT_EQ(spread[0], at[0]);
  EXPECT_EQ(spread[1], at[1]);
  for (size_t k = 0; k < at.size(); ++k) {
    EXPECT_LT((spread[k] - at[k]).norm(), 80) << k;  // twelve discs in a row reach 253
    EXPECT_TRUE(spread[k].x() >= 0 && spread[k].y() >= 0 && spread[k].x() <= 800 && spread[k].y() <= 600) << k;
  }
}

}  // namespace
}  // namespace hilo::test::labels_test
