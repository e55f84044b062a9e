// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hilo {
namespace {

TEST(Json, ValuesAreWrittenByTheirTypes) {
  const std::string name = "a\"b\\c\n\x01";
  const Json out{{"text", name},  {"yes", true},         {"count", size_t{3}},
                 {"all", 0.1},    {"some", {2. / 3, 3}}, {"none", std::nan("")},
                 {"no", nullptr}, {"inner", {{"x", 1}}}, {"list", Json::list_of(std::vector{1.5, 2.})}};
  EXPECT_EQ(out.text(), R"({"text": "a\"b\\c\n\u0001", "yes": true, "count": 3, "all": 0.1, "some": 0.667, "none": null, "no": null, )"
                        R"("inner": {"x": 1}, "list": [1.5, 2]})");
}

TEST(Json, LinesAreIndentedWhereTheyStand) {
  Json out = Json::object(Json::In::lines), rows = Json::list(Json::In::lines);
  rows.append({{"n", 1}});
  rows.append({{"n", 2}});
  out.add("rows", rows);
  out.add("empty", Json::list(Json::In::lines));
  EXPECT_EQ(out.text(), "{\n  \"rows\": [\n    {\"n\": 1},\n    {\"n\": 2}\n  ],\n  \"empty\": []\n}");
}

}  // namespace
}  // namespace hilo
