// SPDX-License-Identifier: GPL-3.0-or-later
// A law of forces: a spring without a linear part, f = k d^3 of its extension d.  A SpringLaw, what makes a Spring of it, and a row of
// spring_kinds().
#include "base/keys.hpp"
#include "outside.hpp"
#include "physics/spring_kinds.hpp"

namespace outside {
namespace {

using namespace hilo;

/// W = k/4 (x - free)^4.  The quotient (W1 - W0)/(x1 - x0) is a polynomial, so energy is kept exactly.
class Cubic final : public SpringLaw {
 public:
  Cubic(double k, double free) : k_(k), free_(free) {}
  void elastic(const Values& x0, const Values& x1, Response& out) const override {
    const double a = x0[0] - free_, b = x1[0] - free_;
    out.s[0] += k_ / 4 * (a * a * a + a * a * b + a * b * b + b * b * b);
    out.D[0][0] += k_ / 4 * (a * a + 2 * a * b + 3 * b * b);
    out.energy += k_ / 4 * b * b * b * b;
  }
  void viscous(const Values&, const Values&, const Interval&, Response&) const override {}
  bool conserves() const override { return true; }

 private:
  double k_, free_;
};

Spring make_cubic(const SpringPlace& s, const Config& q) {
  const Vec3 at_a = s.entry.vector3("at_a"), at_b = s.entry.vector3("at_b");
  const double free = s.entry.has("length") ? s.entry.number("length") : (at_b - at_a).norm();
  return along_distance(s.a, s.b, at_a, at_b, q, std::make_unique<Cubic>(s.entry.number("stiffness"), free));
}

}  // namespace

void add_force_law() {
  spring_kinds().add({.name = "cubic",
                      .meaning = "spring along the line of two points whose force is the cube of its extension",
                      .keys = {keys::at_a,
                               keys::at_b,
                               {"stiffness", Type::number, "N/m^3", "!", "force per cube of extension", above(0)},
                               {"length", Type::number, "m", "", "free length; the initial distance when absent", above(0)}},
                      .make = make_cubic});
}

namespace {

// Exact: without a linear part the period is 4 K(1/sqrt 2)/(A sqrt(k/m)) = 7.41629870920549/(A sqrt(k/m)): it falls as the amplitude
// grows.  After a quarter of it the mass passes the free length with the speed A^2 sqrt(k/(2 m)); energy is kept at any step.
TEST(OutsideForceLaw, SwingsWithThePeriodOfACubicSpring) {
  const test::Workplace place;
  const double k = 50, m = 2;
  for (const double A : {0.3, 0.6}) {
    const double quarter = 7.41629870920549 / (A * std::sqrt(k / m)) / 4;
    double error[2];
    for (const int fine : {0, 1}) {
      const auto r = run_scene(place, fmt::format(R"(
[[body]]
name = "bob"
mass = {}
com = [{}, 0, 0]
inertia = [1, 1, 1]
[[spring]]
kind = "cubic"
name = "k"
b = "bob"
at_a = [0, 0, 0]
at_b = [{}, 0, 0]
length = 1
stiffness = {}
[[probe]]
name = "bob"
on = "bob"
[time]
end = {}
step = {}
)",
                                                  m, 1 + A, 1 + A, k, quarter, quarter / (fine ? 200 : 100)));
      const Eigen::MatrixXd bob = r.history("probe/bob").bottomRows(1);
      error[fine] = std::abs(bob(0, 0) - 1) / A + std::abs(bob(0, 3) + A * A * std::sqrt(k / (2 * m))) / (A * A * std::sqrt(k / (2 * m)));
      EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_NEAR(r.history("energy")(0, 1), k / 4 * A * A * A * A, 1e-12);
    }
    EXPECT_LT(error[1], 1e-4);
    EXPECT_NEAR(error[0] / error[1], 4, 0.2) << "of second order";
  }
}

}  // namespace
}  // namespace outside
