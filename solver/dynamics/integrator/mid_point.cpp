// SPDX-License-Identifier: GPL-3.0-or-later
// M (v1 - v0)/h + f(q_mid) + G(q_mid)^T lambda = F(t_mid),   (q1 - q0)/h = (v0 + v1)/2,   g(q1) = 0
#include "model/integrator/mid_point.hpp"

#include "dynamics/integrator/make.hpp"

namespace hilo {
namespace {

class MidPointIntegrator final : public StageIntegrator {
 public:
  std::string name() const override { return std::string(MidPoint::name); }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, v0_ = s.v, h_ = h;
    given_.at(system, t_ + h_, v0_), given_.mean_from(v0_, h_);
  }

  Stage stage(int, const Unknown& u) override {
    combine(mid_, {{1, &u.q0}, {0.5, &u.dq}});
    combine(v_mid_, {{1 / h_, &u.dq}});
    combine(a_, {{2 / h_, &v_mid_}, {-2 / h_, &v0_}});
    given_.put(nullptr, &a_);
    Stage s = stage_at(mid_, t_ + h_ / 2);
    s.end = &u.q, s.t_end = t_ + h_, s.slope = s.chain = 0.5;
    s.w0 = &u.q0, s.w1 = &u.q, s.h = h_;
    s.a = &a_, s.v0 = &v0_, s.mass_slope = 2 / (h_ * h_);
    s.v = &v_mid_, s.alpha_slope = 1 / h_;
    return s;
  }

  void end_velocity(Config& v) override {
    combine(v, {{1, &v0_}, {h_, &a_}});
    given_.put(&v, nullptr);
  }
  void finish(const Config&) override {}
  void archive_history(Archive&, const System&) override {}  // a step begins with positions and velocities alone
  const Config& acceleration() const override { return a_; }
  Config* mean_acceleration() override { return &a_; }
  double own_time() const override { return 0.5; }
  bool alternates() const override { return true; }

 private:
  double t_ = 0, h_ = 0;
  Config v0_, mid_, v_mid_, a_;
  GivenRates given_;
};

}  // namespace

std::unique_ptr<Integrator> MidPoint::make(const Entry&) { return make_mid_point(); }

std::string MidPoint::weakness(const Entry&, const System& system) {
  if (!system.traits().deforms) return "";
  return "the stress at the mid-point lets energy grow without limit on stiff turning parts; energy-momentum averages it";
}

std::unique_ptr<StageIntegrator> make_mid_point() { return std::make_unique<MidPointIntegrator>(); }

}  // namespace hilo
