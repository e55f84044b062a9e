// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of every integrator in position, velocity, acceleration and reaction on the scenes of stability.md: PEND3D, TOP and SLIDER
// against RK4 on one or three coordinates in the test itself, DPSMOOTH (flexible) against Radau IIA5 at a small step.
#include "dynamics/scenes.hpp"

namespace hilo::test::methods_test {
namespace {

struct Method {
  std::string name, options;
  bool first_order = false;  // accelerations and multipliers: V0 and Bathe
  bool undamped = false;     // the trapezoidal rule: what rings stays
};

[[maybe_unused]] void PrintTo(const Method& m, std::ostream* out) { *out << m.name; }

const std::vector<Method>& methods() {
  static const std::vector<Method> list = {
      {"energy_momentum", integrator("energy-momentum")},
      {"mid_point", integrator("mid-point")},
      {"generalized_alpha_09", integrator("generalized-alpha") + "--set time.rho=0.9"},
      {"generalized_alpha_05", integrator("generalized-alpha") + "--set time.rho=0.5"},
      {"hht_07", integrator("hht") + "--set time.rho=0.7"},
      {"wbz_07", integrator("wbz") + "--set time.rho=0.7"},
      {"U0_08", integrator("U0") + "--set time.averaged=false"},
      {"averaged_U0_08", integrator("U0")},
      {"U0_of_three_radii", integrator("U0") + "--set time.rho1=0.9 --set time.rho2=0.7 --set time.rho3=0.3"},
      {"bdf2", integrator("bdf2")},
      {"averaged_V0_08", integrator("V0"), true},
      {"bathe", integrator("bathe"), true},
      {"trapezoidal", integrator("newmark"), false, true},
  };
  return list;
}

void expect_orders(const OrderCase& c, const Method& m, const Workplace& w) {
  const Errors coarse = errors(w, c, m.options, c.coarse), fine = errors(w, c, m.options, c.fine);
  const auto order = [&](double Errors::*e) { return std::log(coarse.*e / fine.*e) / std::log(c.coarse / c.fine); };
  EXPECT_GT(order(&Errors::x), 1.95) << coarse.x << " " << fine.x;
  EXPECT_GT(order(&Errors::v), 1.95) << coarse.v << " " << fine.v;
  const double least = m.undamped ? 0.9 : m.first_order ? 0.8 : 1.9, most = m.first_order ? 1.3 : 9;
  EXPECT_GT(order(&Errors::a), least) << coarse.a << " " << fine.a;
  EXPECT_GT(order(&Errors::force), least) << coarse.force << " " << fine.force;
  EXPECT_LT(order(&Errors::a), most) << "a known exception: " << coarse.a << " " << fine.a;
  EXPECT_LT(order(&Errors::force), most) << coarse.force << " " << fine.force;
}

class Orders : public testing::TestWithParam<Method> {};
class OrdersAtSpeed : public Orders {};    // the trapezoidal rule fails on the top (data/stability)
class OrdersOfElastic : public Orders {};  // the exceptions are seen on the rigid scenes

std::vector<Method> methods_of(bool first_order) {
  std::vector<Method> out;
  for (const Method& m : methods())
    if (!m.undamped && (first_order || !m.first_order)) out.push_back(m);
  return out;
}

TEST_P(Orders, OfPend3d) {
  const Workplace w;
  expect_orders(pend3d(w), GetParam(), w);
}
TEST_P(OrdersAtSpeed, OfTheTop) {
  const Workplace w;
  expect_orders(top(w), GetParam(), w);
}
TEST_P(Orders, OfTheSliderCrank) {
  const Workplace w;
  expect_orders(slider(w), GetParam(), w);
}
TEST_P(OrdersOfElastic, OfDpsmooth) {
  const Workplace w;
  expect_orders(dpsmooth(w), GetParam(), w);
}

const auto name_of = [](const testing::TestParamInfo<Method>& p) { return p.param.name; };
INSTANTIATE_TEST_SUITE_P(Methods, Orders, testing::ValuesIn(methods()), name_of);
INSTANTIATE_TEST_SUITE_P(Methods, OrdersAtSpeed, testing::ValuesIn(methods_of(true)), name_of);
INSTANTIATE_TEST_SUITE_P(Methods, OrdersOfElastic, testing::ValuesIn(methods_of(false)), name_of);

TEST(Radau, IsOfOrderFiveInPositionOnRigidScenes) {
  const Workplace w;
  for (OrderCase c : {pend3d(w), top(w), slider(w)}) {
    const double h = c.scene == "top.toml" ? 2e-3 : c.scene == "slider.toml" ? 0.04 : 0.05;
    const double coarse = errors(w, c, integrator("radau"), h).x, fine = errors(w, c, integrator("radau"), h / 2).x;
    EXPECT_GT(std::log2(coarse / fine), 4.5) << c.scene << " " << coarse << " " << fine;
  }
}

TEST(Radau, KeepsItsMatrixOverStepsAndTheJointToRoundOff) {
  const Workplace w;
  top(w);
  ASSERT_EQ(w.run("hilo-solve --quiet top.toml -o run.h5 --set time.step=1e-3 " + integrator("radau")).exit, 0);
  EXPECT_LT(Results(w / "run.h5").history("constraint").maxCoeff(), 1e-14);
  EXPECT_LT(number_of(w, "run.json", "tangents"), 9 * 1000 / 3) << "nine tangents make a matrix";
  EXPECT_LT(number_of(w, "run.json", "newton_iterations"), 2500);
}

TEST(Radau, GoesOnFromARefusedStepAsIfItHadNotBeen) {
  const Workplace w;
  const OrderCase c = top(w);
  const double whole = errors(w, c, integrator("radau"), 4e-3).x;
  ASSERT_EQ(number_of(w, "run.json", "cuts"), 0);
  const double cut = errors(w, c, integrator("radau") + "--set solver.iterations=1", 4e-3).x;  // one matrix a step is not always enough
  ASSERT_GT(number_of(w, "run.json", "cuts"), 0);
  EXPECT_LT(cut, 1.01 * whole);
}

}  // namespace
}  // namespace hilo::test::methods_test
