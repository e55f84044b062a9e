// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that are functions of measures: exact geometry over many turns, exact discrete gradients, exact derivatives.
#include "physics/joint_rows.hpp"

#include <numbers>

#include "physics/connectors.hpp"

namespace hilo::test::joint_rows_test {
namespace {

using std::numbers::pi;
using Values = RowLaw::Values;

const Mat3 frame = some_frame();
const Vec3 axis = frame.col(2);

JointPlace place(const std::string& kind) {
  return {.kind = kind, .a = {1, -1}, .b = {2, -1}, .at = joint_point, .at_b = joint_point, .frame = frame};
}

/// A course of the two bodies, the ground standing still: angle and slide of b along the axis, angle of a.
struct Course3 {
  std::function<double(double)> angle_b, slide_b, angle_a;
};
Config on_course(const Config& q, const Course3& c, double t) {
  Config out = q;
  const auto place_body = [&](int b, double angle, const Vec3& about_axis, const Vec3& shift) {
    const Mat3 B = Eigen::AngleAxisd(angle, about_axis).toRotationMatrix();
    out.c[b] = joint_point + B * (q.c[b] - joint_point) + shift, out.R[b] = B * q.R[b];
  };
  place_body(1, c.angle_a(t), axis, Vec3::Zero());
  place_body(2, c.angle_b(t), axis, c.slide_b(t) * axis);
  return out;
}

/// Largest row along a course of ten turns, the state being accepted every tenth of a turn.
double worst_row(hilo::Joint& c, const Config& q, const Course3& course) {
  double worst = 0, g[max_rows];
  for (int i = 0; i <= 100; ++i) {
    const Config now = on_course(q, course, i / 10.0);
    c.row_values(c.values(now), g);
    for (int r = 0; r < c.n_rows(); ++r) worst = std::max(worst, std::abs(g[r]));
    c.rows->commit(c.values(now));
  }
  return worst;
}

const auto still = [](double) { return 0.0; };

TEST(ScrewJoint, SlidesByItsPitchPerTurn) {
  const Config q = somewhere(3);
  JointPlace p = place("screw");
  p.ratio = 0.3 / (2 * pi);
  hilo::Joint c = make_joint(p, q);
  EXPECT_EQ(c.n_rows(), 5);
  EXPECT_LT(worst_row(c, q, {[](double t) { return 2 * pi * t; }, [](double t) { return 0.3 * t; }, still}), 1e-12);
  hilo::Joint other = make_joint(p, q);
  EXPECT_GT(worst_row(other, q, {[](double t) { return 2 * pi * t; }, [](double t) { return -0.3 * t; }, still}), 1) << "the other hand";
}

TEST(GearJoint, KeepsTheRatioOfTheAnglesOverManyTurns) {
  Config q = somewhere(3);
  q.R[0] = Mat3::Identity(), q.c[0].setZero();
  JointPlace p = place("gear");
  p.ratio = -2.5;
  hilo::Joint c = make_joint(p, q);
  EXPECT_EQ(c.n_rows(), 1);
  const auto a = [](double t) { return 2 * pi * 0.4 * t; };
  EXPECT_LT(worst_row(c, q, {[&](double t) { return -2.5 * a(t); }, still, a}), 1e-12);
}

TEST(RackJoint, SlidesByTheRadiusTimesTheAngle) {
  const Config q = somewhere(3);
  JointPlace p = place("rack");
  p.ratio = 0.2, p.axis_b = axis;  // any direction: here along the axis, where the slide of the course is
  hilo::Joint c = make_joint(p, q);
  EXPECT_EQ(c.n_rows(), 1);
  const auto a = [](double t) { return 4 * t; };
  EXPECT_LT(worst_row(c, q, {still, [&](double t) { return 0.2 * a(t); }, a}), 1e-12);
}

TEST(DrivenJoint, MeasuresAngleOrSlide) {
  const Config q = somewhere(3);
  for (const auto driven : {JointPlace::Driven::angle, JointPlace::Driven::slide}) {
    JointPlace p = place("cylindrical");
    p.driven = driven;
    hilo::Joint c = make_joint(p, q);
    EXPECT_EQ(c.n_rows(), 5);
    EXPECT_EQ(c.drive.row, 4);
    double g[max_rows];
    for (int i = 0; i < 50; ++i) {
      const Config now = on_course(q, {[](double t) { return 3 * t; }, [](double t) { return 0.7 * t; }, still}, i / 5.0);
      c.row_values(c.values(now), g);
      EXPECT_NEAR(g[4], (driven == JointPlace::Driven::angle ? 3 : 0.7) * i / 5.0, 1e-12);
      for (int r = 0; r < 4; ++r) EXPECT_NEAR(g[r], 0, 1e-12);
      c.rows->commit(c.values(now));
    }
  }
}

/// Every law with values of its measures to visit: those with angles lie on the unit circle, as aligned axes see to.
struct Case {
  std::string name;
  std::shared_ptr<RowLaw> law;
  int n_measures;
  std::function<Values(double)> at;
};
std::vector<Case> laws() {
  std::vector<Case> out;
  out.push_back({"angle_and_slide",
                 std::make_shared<SumRows>(1, std::vector<std::vector<SumRows::Part>>{{{1, 1}, {-0.3, 2, SumRows::angle}},
                                                                                      {{2, 2, SumRows::angle}, {-1, 4, SumRows::angle}}}),
                 6,
                 [](double t) { return Values{0.1 * t, t * t, std::sin(1.1 * t), std::cos(1.1 * t), std::sin(2 - t), std::cos(2 - t)}; }});
  std::vector<Vec3> x;
  for (int i = 0; i < 9; ++i) x.emplace_back(std::cos(0.7 * i) - 1, std::sin(0.7 * i), 0.2 * i);
  out.push_back({"curve", std::make_shared<CurveRows>(Curve(x, false)), 3, [](double t) {
                   return Values{std::cos(t) - 1 + 0.02 * t, std::sin(t) - 0.01 * t, 0.28 * t};
                 }});
  const auto attitude = [](double t) { return turn(Vec3(2 * t, 0.3 - t, t * t)); };
  using Sums = std::vector<std::vector<SumRows::Part>>;
  out.push_back({"tilt", std::make_shared<SumRows>(1, Sums{{{1, 1, SumRows::tilt, 0}}, {{2, 1, SumRows::tilt, 1}}}), 4, [=](double t) {
                   const Vec3 n = attitude(t).col(2);
                   return Values{t, n[0], n[1], n[2]};
                 }});
  out.push_back({"rotation",
                 std::make_shared<SumRows>(
                     1, Sums{{{1, 1, SumRows::rotation, 0}}, {{1, 1, SumRows::rotation, 1}}, {{3, 1, SumRows::rotation, 2}, {1, 0}}}),
                 10, [=](double t) {
                   Values e{t};
                   Mat3::Map(&e[1]) = attitude(t);
                   return e;
                 }});
  out.push_back(
      {"arcsine", std::make_shared<SumRows>(0, Sums{{{1, 0, SumRows::arcsine}}}), 1, [](double t) { return Values{0.6 * t * t - 0.5}; }});
  return out;
}

class Law : public testing::TestWithParam<int> {
 protected:
  const Case c = laws()[GetParam()];
};
INSTANTIATE_TEST_SUITE_P(EveryKind, Law, testing::Values(0, 1, 2, 3, 4), [](const auto& p) { return laws()[p.param].name; });

// Truth: the discrete gradient's defining property, over steps long and short.
TEST_P(Law, DiscreteGradientTimesTheStepIsTheChangeOfTheRows) {
  for (const double t : {0.1, 0.4, 0.9})
    for (const double step : {0.5, 0.1, 1e-3, 1e-6}) {
      c.law->commit(c.at(t));
      const Values e0 = c.at(t), e1 = c.at(t + step);
      double g0[max_rows], g1[max_rows];
      c.law->values(e0, g0), c.law->values(e1, g1);
      RowLaw::Gradient g;
      c.law->gradient(e0, e1, g);
      for (int r = 0; r < c.law->n_rows(); ++r) {
        double sum = 0;
        for (int m = 0; m < c.n_measures; ++m) sum += g.d[r][m] * (e1[m] - e0[m]);
        EXPECT_NEAR(sum, g1[r] - g0[r], 2e-15) << "t = " << t << ", step " << step << ", row " << r;
      }
    }
}

// Truth: D is the derivative of d by the second argument; at equal arguments d is the gradient and D half its derivative.
TEST_P(Law, DerivativesAreThoseOfTheGradientAndTheRows) {
  const double h = 1e-6;  // central differences: truncation 1e-12, round-off 1e-9
  for (const double step : {0.4, 0.05, 0.0}) {
    c.law->commit(c.at(0.5));
    const Values e0 = c.at(0.5), e1 = c.at(0.5 + step);
    RowLaw::Gradient g, p, m;
    c.law->gradient(e0, e1, g);
    for (int k = 0; k < c.n_measures; ++k) {
      Values up = e1, down = e1, both_up = e1, both_down = e1;
      up[k] += h, down[k] -= h, both_up[k] += h, both_down[k] -= h;
      const bool equal = step == 0;
      c.law->gradient(equal ? up : e0, up, p), c.law->gradient(equal ? down : e0, down, m);
      double gp[max_rows], gm[max_rows];
      c.law->values(up, gp), c.law->values(down, gm);
      for (int r = 0; r < c.law->n_rows(); ++r) {
        for (int i = 0; i < c.n_measures; ++i)
          EXPECT_NEAR((equal ? 2 : 1) * g.D[r][i][k], (p.d[r][i] - m.d[r][i]) / (2 * h), 1e-7) << "step " << step << " row " << r;
        if (equal) {
          EXPECT_NEAR(g.d[r][k], (gp[r] - gm[r]) / (2 * h), 1e-9);
        }
      }
    }
  }
}

// Truth: a point that runs along the curve keeps both rows at zero, whatever basis of normals is in use; off it, they tell by how much.
TEST(CurveRows, VanishOnTheCurveOnly) {
  std::vector<Vec3> x;
  for (int i = 0; i < 12; ++i) x.emplace_back(std::cos(0.5236 * i) - 1, std::sin(0.5236 * i), 0.3 * std::sin(0.5236 * 2 * i));
  const Curve curve(x, true);
  CurveRows rows(curve);
  double g[2];
  for (int i = 0; i < 100; ++i) {  // twice round
    const Vec3 on = curve.at(curve.length() * i / 50).x;
    rows.values({on[0], on[1], on[2]}, g);
    EXPECT_LT(std::hypot(g[0], g[1]), 1e-14);
    EXPECT_EQ(rows.fault({on[0], on[1], on[2]}), "");
    rows.commit({on[0], on[1], on[2]});
    const Vec3 t = curve.at(curve.length() * i / 50).dx.normalized(), off = on + 0.01 * t.cross(Vec3(0.3, 0.5, 1)).normalized();
    rows.values({off[0], off[1], off[2]}, g);
    EXPECT_NEAR(std::hypot(g[0], g[1]), 0.01, 1e-12);
  }
}

TEST(CurveRows, SayWhenTheEndIsPassed) {
  CurveRows rows(Curve({{0, 0, 0}, {1, 0, 0}}, false));
  EXPECT_EQ(rows.fault({0.5, 0, 0}), "");
  EXPECT_NE(rows.fault({1.1, 0, 0}), "");
  EXPECT_NE(rows.fault({-0.1, 0, 0}), "");
}

}  // namespace
}  // namespace hilo::test::joint_rows_test
