// SPDX-License-Identifier: GPL-3.0-or-later
// A time integrator with a key of its own: the one-leg theta family, backward Euler (1) to the trapezoidal rule (1/2),
//   q1 = q0 + h ((1 - theta) v0 + theta v1),   v1 = v0 + h ((1 - theta) a0 + theta a1),   equations of motion and g = 0 at the end.
// A StageIntegrator, what a scene may say of it, and one call that adds both.
#include "dynamics/integrator.hpp"

#include <cmath>

#include "dynamics/integrator_kinds.hpp"
#include "dynamics/kept_run.hpp"
#include "outside.hpp"

namespace outside {
namespace {

using namespace hilo;

class ThetaIntegrator final : public StageIntegrator {
 public:
  explicit ThetaIntegrator(double theta) : theta_(theta) {}
  std::string name() const override { return "theta"; }
  bool needs_acceleration() const override { return true; }
  void forget() override { fresh_ = true; }
  void archive_history(Archive& a, const System&) override { a("acceleration before", fresh_, a0_); }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, v0_ = s.v, h_ = h;
    if (fresh_) a0_ = s.a;
    given_.at(system, t_ + h, v0_);
  }
  Stage stage(int, const Unknown& u) override {
    const double f = 1 / (theta_ * h_), past = (1 - theta_) / theta_;
    combine(v1_, {{f, &u.dq}, {-past, &v0_}});
    combine(a1_, {{f, &v1_}, {-f, &v0_}, {-past, &a0_}});
    given_.put(&v1_, &a1_);
    combine(before_, {{1, &u.q}, {-h_ / 2, &v1_}});
    combine(after_, {{1, &u.q}, {h_ / 2, &v1_}});
    Stage s = stage_at(u.q, t_ + h_);
    s.w0 = &before_, s.w1 = &after_, s.h = s.elapsed = h_;
    s.a = &a1_, s.mass_slope = f * f;
    s.v = &v1_, s.alpha_slope = f;
    return s;
  }
  void end_velocity(Config& v) override { v = v1_; }
  void finish(const Config&) override { a0_ = a1_, fresh_ = false; }
  const Config& acceleration() const override { return a1_; }
  double own_time() const override { return 1; }

 private:
  double theta_, t_ = 0, h_ = 0;
  bool fresh_ = true;  // a0_ is not that of a step taken
  Config v0_, a0_, v1_, a1_, before_, after_;
  GivenRates given_;
};

struct Theta : Method {
  static constexpr std::string_view name = "theta", meaning = "backward Euler to the trapezoidal rule";
  static std::vector<Param> keys() {
    return {{"theta", Type::number, "1", "1", "weight of the end of a step: 1 backward Euler, 1/2 trapezoidal rule", from_to(0.5, 1)}};
  }
  static constexpr bool carries_state = true;
  static std::unique_ptr<Integrator> make(const Entry& time) { return std::make_unique<ThetaIntegrator>(time.number("theta")); }
};

}  // namespace

void add_integrator() { hilo::add_integrator<Theta>(); }

namespace {

const std::string oscillator = body("mass", 2, Vec3::Zero(), {1, 1, 1}) +
                               axial("prismatic", "guide", "ground", "mass", Vec3::Zero(), {1, 0, 0}) +
                               spring("axial", "coil", "ground", "mass", "at_a = [-1, 0, 0]\nat_b = [0, 0, 0]\nstiffness = 50") +
                               initial("mass", "velocity = [0.5, 0, 0]") + in_time(1, 0.02, "integrator = \"theta\"");

/// Energy at the end over that at the start.
double kept(const std::string& more) {
  const test::Workplace place;
  const auto energy = run_scene(place, std::string(oscillator) + more).history("energy");
  const Eigen::Index last = energy.rows() - 1;
  return (energy(last, 0) + energy(last, 1)) / (energy(0, 0) + energy(0, 1));
}

// Exact: a step of backward Euler divides the energy of an oscillator by 1 + (omega h)^2, here 50 times by 1 + 25 h^2; the trapezoidal rule
// keeps it.
TEST(OutsideIntegrator, TakesFromAnOscillatorWhatItsThetaSays) {
  EXPECT_NEAR(kept(""), std::pow(1 + 25 * 0.02 * 0.02, -50), 1e-9);
  EXPECT_NEAR(kept("theta = 0.5\n"), 1, 1e-9);
}

TEST(OutsideIntegrator, IsAWordOfTheSceneWithItsKey) {
  const auto words = choices("time", "integrator");
  EXPECT_NE(std::find(words.begin(), words.end(), "theta"), words.end());
  EXPECT_THROW(kept("theta = 0.3\n"), Error);
  try {
    Scene::parse("[time]\nintegrator = \"theta2\"\nend = 1\nstep = 1\n", "scene.toml");
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("theta"), std::string::npos) << e.what();
  }
}

TEST(OutsideIntegrator, GoesOnFromWhatWasKept) {
  const test::Folder folder;
  test::expect_goes_on(folder.path(), oscillator, "", {1, 17, 30}, {"time.theta=0.7"});
}

}  // namespace
}  // namespace outside
