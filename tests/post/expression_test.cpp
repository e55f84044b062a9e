// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas over histories, and tables set beside each other, through the command line and by themselves.
#include "post/run/expression.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/error.hpp"
#include "model/store.hpp"
#include "post/files/csv.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::expression_test {
namespace {

const std::vector<double> times{0, 0.5, 1.5, 2};

std::vector<double> value(const std::string& formula) {
  return evaluate(formula, times, [](const std::string& name) {
    if (name == "a.x") return std::vector<double>{1, 2, 3, 4};
    if (name == "a.my-arm") return std::vector<double>{10, 20, 30, 40};
    throw Error("", "no column " + name);
  });
}

TEST(Expression, OperatorsBindAsInAlgebra) {
  for (const auto& [formula, expected] : {std::pair{"1 + 2*3", 7.0},
                                          {"(1 + 2)*3", 9.0},
                                          {"2^3^2", 512.0},
                                          {"-2^2", -4.0},
                                          {"2^-1", 0.5},
                                          {"8/2/2", 2.0},
                                          {"1 - 2 - 3", -4.0},
                                          {"--3", 3.0},
                                          {"1e3", 1e3},
                                          {".5", 0.5},
                                          {"cos(pi)", -1.0},
                                          {"atan2(1, -1)", 3 * M_PI / 4},
                                          {"hypot(2, 3, 6)", 7.0},
                                          {"max(1, 5, 2) - min(4, 3)", 2.0}})
    EXPECT_DOUBLE_EQ(value(formula)[2], expected) << formula;
}

TEST(Expression, NamesAreColumnsAndTimesAreT) {
  EXPECT_EQ(value("a.x*t"), (std::vector<double>{0, 1, 4.5, 8}));
  EXPECT_EQ(value("\"a.my-arm\"/10 - start(a.x)"), (std::vector<double>{0, 1, 2, 3}));
}

// Truth: rates of polynomials up to the second degree are exact, whatever the steps are, at the ends too.
TEST(Expression, TheRateOfAParabolaIsExactOnUnevenStepsAndAtTheEnds) {
  const auto rate = value("d(3*t^2 - t + 1)");
  for (size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(rate[i], 6 * times[i] - 1, 1e-13) << times[i];
  EXPECT_TRUE(std::isnan(value("max(sqrt(1 - t), 0)").back()) && std::isnan(value("min(0, sqrt(1 - t))").back())) << "none is not zero";
}

/// Largest error of a formula of t on n steps of which each third is three times as long, for t up to 1.
double farthest(const std::string& formula, int n, double (*truth)(double)) {
  std::vector<double> t{0};
  for (int i = 0; i < n; ++i) t.push_back(t.back() + (i % 3 < 2 ? 1 : 3) * 0.6 / n);
  double worst = 0;
  const auto y = evaluate(formula, t, [](const std::string& name) -> std::vector<double> { throw Error("", name); });
  for (size_t i = 0; i < t.size(); ++i) worst = std::max(worst, std::abs(y[i] - truth(t[i])));
  return worst;
}

// Truth: sin' = cos and sin'' = -sin.  The rate is of second order, that of a rate of first where the steps change.
TEST(Expression, RatesConvergeOnUnevenSteps) {
  const auto rate = [](double t) { return std::cos(t); };
  const auto second = [](double t) { return -std::sin(t); };
  EXPECT_LT(farthest("d(sin(t))", 300, rate), 2e-5);
  EXPECT_NEAR(farthest("d(sin(t))", 300, rate) / farthest("d(sin(t))", 600, rate), 4, 0.1);
  EXPECT_LT(farthest("d(d(sin(t)))", 600, second), 5e-3);
  EXPECT_NEAR(farthest("d(d(sin(t)))", 300, second) / farthest("d(d(sin(t)))", 600, second), 2, 0.1);
}

TEST(Expression, WhatIsNoFormulaIsToldWithItsColumn) {
  for (const auto& [formula, message] : {std::pair{"1 +", "column 4: ends too early"},
                                         {"(1", "column 3: expected \")\""},
                                         {"1 2", "column 3: expected an operator"},
                                         {"sine(t)", "column 1: no function \"sine\"; there are abs"},
                                         {"atan2(1)", "needs 2 arguments, here are 1"},
                                         {"a.my-arm", "no column a.my"},
                                         {"\"a", "column 1: a quote without its end"},
                                         {"1 + *2", "column 5: expected a number"}})
    try {
      value(formula);
      ADD_FAILURE() << formula;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
}

// Each level is a call within calls: without a limit a long formula ends the program.
TEST(Expression, NestingHasALimit) {
  EXPECT_EQ(value(std::string(250, '(') + "t" + std::string(250, ')')), times);
  EXPECT_EQ(value(std::string(250, '-') + "t"), times);
  std::string powers = "1", calls = "t";
  for (int k = 0; k < 20000; ++k) powers += "^1", calls = "abs(" + calls;
  for (const std::string& deep : {std::string(20000, '(') + "t", std::string(20000, '-') + "t", powers, calls}) try {
      value(deep);
      ADD_FAILURE();
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("more than 256 levels deep"), std::string::npos);
    }
}

const Workplace& sample_place() {
  static const Workplace place;
  static const std::string run = sample::write_run(place.path(), sample::cube(2), 1);
  return place;
}
Ran post(const std::string& rest) { return sample_place().run("unset DISPLAY\nhilo-post " + rest); }

TEST(SeriesFormula, ColumnsAreTheFormulaOfWhatIsStoredOverTheAbscissaAskedFor) {
  const Ran ran = post(
      "series run.h5 'pull [kN] = F/1e3' 'turned [1] = sensor.seat.x' --let 'F = hypot(joint.trunnion.Fx, joint.trunnion.Fy)' "
      "-x 'angle [deg] = 360*t' --times 0.02:0.05 -o out.csv");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const CsvTable table = read_csv(sample_place() / "out.csv");
  EXPECT_EQ(table.header, (std::vector<std::string>{"angle [deg]", "pull [kN]", "turned [1]"}));
  const Store store = Store::open(sample_place() / "run.h5");
  const auto t = store.read<double>("/history/t"), joint = store.read<double>("/history/joint/trunnion");
  ASSERT_EQ(table.rows(), 61u);  // both ends, 0.5 ms apart
  const auto angle = table.numbers(0), pull = table.numbers(1);
  for (size_t i = 0; i < table.rows(); ++i) {
    EXPECT_DOUBLE_EQ(angle[i], 360 * t[i + 40]);
    EXPECT_DOUBLE_EQ(pull[i], std::hypot(joint[6 * (i + 40)], joint[6 * (i + 40) + 1]) / 1e3);
  }
}

// Truth: a ramp of 1 N/s and the root of a time that is negative at first hold nothing above what steps of 0.5 ms resolve.
TEST(SeriesFormula, AUnitNeedsNoBlankBeforeIt) {
  EXPECT_EQ(succeeded(sample_place().run("hilo-post series run.h5 'x[mm] = t' -o -")).out.rfind("t [s],x [mm]\n", 0), 0u);
}

TEST(SeriesFormula, RowsWithoutAValueGiveNoWarning) {
  for (const char* formula : {"a [N] = d(t^2/2)", "a [N] = sqrt(t - 0.05)"}) {
    const Ran ran = post(fmt::format("series run.h5 '{}' -o none.csv", formula));
    EXPECT_EQ(ran.exit, 0);
    EXPECT_EQ(ran.err, "") << formula;
  }
}

TEST(SeriesFormula, AnUnknownColumnIsAnErrorWithTheNearestOne) {
  const Ran ran = post("series run.h5 'x = joint.trunnion.Fq'");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_EQ(ran.err, "hilo-post: run.h5: no column \"joint.trunnion.Fq\" (did you mean \"joint.trunnion.Fx\"?)\n");
  EXPECT_EQ(post("series run.h5 'x = 1 +'").exit, 1);
  EXPECT_EQ(post("series run.h5 'x = t' --let 't = 2'").exit, 1) << "t is the time";
}

TEST(Compare, FindsWhereTablesAreFarthestApartAtSharedInstantsOnly) {
  const Workplace place;
  place.write("truth.csv", "t [s],a [N],b [m]\n0,1,2\n1,-4,2\n2,3,2\n");
  place.write("run.csv", "t [s],b [m],a [N]\n0,2,1\n0.5,9,9\n1,2.5,-3\n1.5,9,9\n2.0001,2,3.5\n");
  const Ran ran = succeeded(place.run("hilo-post compare truth.csv run.csv --json"));
  EXPECT_NE(ran.err.find("run.csv: 3 of its 5 rows"), std::string::npos) << ran.err;
  EXPECT_NE(ran.out.find(R"({"column": "a [N]", "of": "truth", "start": 1, "peak": 4, "off by": null)"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find(R"("of": "run", "start": 1, "peak": 9, "off by": 1, "in % of peak": 25, "at t [s]": 1})"), std::string::npos);
  EXPECT_NE(ran.out.find(R"("off by": 0.5, "in % of peak": 25, "at t [s]": 1})"), std::string::npos) << ran.out;
}

TEST(Compare, RowsThatAreNotComparedAreTold) {
  const Workplace place;
  place.write("a.csv", "t [s],a [N]\n0,0\n1,1\n2,4\n3,9\n");
  place.write("short.csv", "t [s],a [N]\n0,0\n1,1\n");
  place.write("hole.csv", "t [s],a [N]\n0,0\n1,1\n2,\n3,9\n");
  const Ran brief = succeeded(place.run("hilo-post compare a.csv short.csv")),
            hole = succeeded(place.run("hilo-post compare a.csv hole.csv"));
  EXPECT_NE(brief.err.find("short.csv: 2 of the 4 rows of a.csv are not in it, and not compared"), std::string::npos) << brief.err;
  EXPECT_NE(hole.err.find("hole.csv: \"a [N]\": 1 of 4 rows has no number in one of the two, and is not compared"), std::string::npos)
      << hole.err;
}

TEST(Compare, TablesWithoutASharedInstantOrColumnAreRefused) {
  const Workplace place;
  place.write("a.csv", "t [s],a [N]\n0,1\n1,-4\n");
  place.write("b.csv", "t [s],a [N]\n0.4,1\n1.4,-4\n");
  place.write("c.csv", "t [s],c [N]\n0,1\n1,-4\n");
  place.write("d.csv", "t [s],a [N]\n1,1\n0,-4\n");
  EXPECT_NE(place.run("hilo-post compare a.csv b.csv").err.find("b.csv: has no t [s] in common with a.csv"), std::string::npos);
  EXPECT_NE(place.run("hilo-post compare a.csv c.csv").err.find("a.csv: has no column in common"), std::string::npos);
  EXPECT_NE(place.run("hilo-post compare a.csv d.csv").err.find("d.csv: \"t [s]\" does not rise"), std::string::npos);
  EXPECT_EQ(place.run("hilo-post compare a.csv d.csv").exit, 2);
}

// Truth: 1000 ms are 1 s.
TEST(Compare, TimesInOtherUnitsAreConvertedAndOtherQuantitiesRefused) {
  const Workplace place;
  place.write("a.csv", "t [s],x [m]\n0,0\n1,1\n2,2\n");
  place.write("b.csv", "t [ms],x [m]\n0,0\n1000,1.25\n2000,2\n");
  place.write("c.csv", "turn [deg],x [m]\n0,0\n1,1\n");
  const Ran ran = succeeded(place.run("hilo-post compare a.csv b.csv --json"));
  EXPECT_EQ(ran.err, "") << "all rows are shared";
  EXPECT_NE(ran.out.find(R"("off by": 0.25, "in % of peak": 12.5, "at t [s]": 1})"), std::string::npos) << ran.out;
  const Ran back = succeeded(place.run("hilo-post compare b.csv a.csv --json"));
  EXPECT_NE(back.out.find(R"("off by": 0.25, "in % of peak": 12.5, "at t [ms]": 1000})"), std::string::npos) << back.out;
  for (const char* command : {"compare a.csv c.csv", "chart a.csv c.csv -o c.png"})
    expect_end(place.run(std::string("hilo-post ") + command), 2,
               "c.csv: its abscissa \"turn [deg]\" does not fit \"t [s]\" of a.csv (choose abscissae of one quantity by -x)");
}

TEST(Compare, ARunDiffersFromItselfByNothing) {
  const Ran ran = post("compare run.h5 run.h5 -y energy -y 'pull [kN] = joint.trunnion.Fx/1e3' --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.out.find("\"column\": \"pull [kN]\""), std::string::npos) << ran.out;
  const std::string key = "\"off by\": ";
  int zeros = 0;
  for (size_t at = ran.out.find(key); at != std::string::npos; at = ran.out.find(key, at + 1)) {
    const char* value = ran.out.c_str() + at + key.size();
    if (std::string_view(value).starts_with("null")) continue;  // a column that is zero throughout
    EXPECT_EQ(std::strtod(value, nullptr), 0) << ran.out;
    ++zeros;
  }
  EXPECT_GT(zeros, 0) << ran.out;
}

}  // namespace
}  // namespace hilo::test::expression_test
