// SPDX-License-Identifier: GPL-3.0-or-later
// Units, ranges, and a schema that can be read.
#include "base/param.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/scene.hpp"

namespace hilo::test::param_test {
namespace {

TEST(Units, OfEveryKeyHaveAFactorInEverySystem) {
  for (const auto& kind : scene_schema())
    for (const auto& p : kind.params)
      for (const auto& system : unit_systems()) {
        const double f = to_si(p.unit, system);
        EXPECT_TRUE(std::isfinite(f) && f > 0) << p.key << " [" << p.unit << "] in " << system;
        if (system == "m-kg-s") {
          EXPECT_EQ(f, 1) << p.key;
        }
      }
}

TEST(Units, ConvertByTheirDimensions) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-14 * std::abs(b); };
  EXPECT_TRUE(near(to_si("kg/m^3", "mm-t-s"), 1e12));
  EXPECT_TRUE(near(to_si("Pa", "mm-t-s"), 1e6));
  EXPECT_TRUE(near(to_si("N", "mm-t-s"), 1));
  EXPECT_TRUE(near(to_si("kg m^2", "mm-t-s"), 1e-3));
  EXPECT_TRUE(near(to_si("N m s/rad", "mm-t-s"), 1e-3));
  EXPECT_TRUE(near(to_si("m/s^2", "mm-kg-ms"), 1e3));
  EXPECT_TRUE(near(to_si("N", "mm-kg-ms"), 1e3));
  EXPECT_TRUE(near(to_si("Pa", "mm-kg-ms"), 1e9));
  EXPECT_NEAR(to_si("N", "in-lbf-s"), 4.4482216152605, 1e-10);  // the pound-force, exact by definition
  EXPECT_NEAR(to_si("N", "ft-lbf-s"), 4.4482216152605, 1e-10);
  EXPECT_NEAR(to_si("Pa", "in-lbf-s"), 6894.757293168, 1e-6);
}

TEST(Units, OfAnUnknownSystemAreRefusedWithASuggestion) {
  try {
    to_si("m", "mm-t");
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()), "unknown unit system \"mm-t\" (did you mean \"mm-t-s\"?)");
  }
  EXPECT_THROW(to_si("furlong", "m-kg-s"), Error);
}

TEST(Ranges, AreOpenOrClosedAsWritten) {
  EXPECT_FALSE(above(0).contains(0));
  EXPECT_TRUE(at_least(0).contains(0));
  EXPECT_FALSE(between(-1, 0.5).contains(0.5));
  EXPECT_TRUE(from_to(0, 1).contains(1));
  EXPECT_FALSE(any_number.contains(std::nan("")));
  EXPECT_EQ(between(-1, 0.5).text(), "(-1, 0.5)");
  EXPECT_EQ(at_least(0).text(), ">= 0");
}

TEST(Schema, HasDefaultsThatAreValid) {
  for (const auto& kind : scene_schema())
    for (const auto& p : kind.params) {
      if (p.fallback.empty() || p.fallback == "!") continue;
      Value v;
      ASSERT_NO_THROW(v = default_value(p)) << kind.section << "." << p.key;
      EXPECT_FALSE(v.given);
      const auto words = choices(kind.section, p.key);
      for (const auto& t : v.texts)
        EXPECT_TRUE(words.empty() || std::find(words.begin(), words.end(), t) != words.end()) << p.key << " = " << t;
      if (p.type == Type::numbers && p.counts[0] != 0) {
        EXPECT_TRUE(std::find(p.counts.begin(), p.counts.end(), v.numbers.size()) != p.counts.end()) << p.key;
      }
    }
}

TEST(Schema, NamesEachKindAndKeyOnceAndSaysWhatItMeans) {
  std::set<std::pair<std::string_view, std::string_view>> kinds;
  for (const auto& kind : scene_schema()) {
    EXPECT_TRUE(kinds.insert({kind.section, kind.kind}).second) << kind.section << " " << kind.kind;
    EXPECT_FALSE(kind.meaning.empty());
    std::set<std::string_view> keys;
    for (const auto& p : kind.params) {
      EXPECT_TRUE(keys.insert(p.key).second) << kind.section << "." << p.key;
      EXPECT_FALSE(p.meaning.empty()) << p.key;
    }
    EXPECT_EQ(keys.contains("kind"), !kind.kind.empty() || kind.section == "solver") << kind.section;
  }
}

}  // namespace
}  // namespace hilo::test::param_test
