// SPDX-License-Identifier: GPL-3.0-or-later
// v1 = c1 q1 + c0 q0 + cm q_-1,  a1 = c1 v1 + c0 v0 + cm v_-1,  M a1 + f(q1) + G(q1)^T lambda = F(t1),  g(q1) = 0
// at changing steps, r = h/h_-1:  c1 = (1 + 2 r)/((1 + r) h),  c0 = -(1 + r)/h,  cm = r^2/((1 + r) h).
// Before the first step stands one that was not taken, q_-1 = q0 - h v0 + h^2/2 a0 - h^3/6 j0, and the velocities of both have the error
// -h^2/3 j that those of the formula have, so that accelerations and forces are right from the first step on.
#include "model/integrator/bdf2.hpp"

#include "dynamics/integrator/make.hpp"

namespace hilo {
namespace {

class Bdf2Integrator final : public StageIntegrator {
 public:
  std::string name() const override { return std::string(Bdf2::name); }
  bool needs_acceleration() const override { return true; }
  void forget() override { h_before_ = 0; }
  void archive_history(Archive& a, const System&) override { a("step before", h_before_, dq_before_, vm_); }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, v0_ = s.v, h_ = h;
    if (fresh()) {
      combine(dq_before_, {{h, &s.v}, {-h * h / 2, &s.a}, {h * h * h / 6, &s.jerk}});
      combine(vm_, {{1, &s.v}, {-h, &s.a}, {h * h / 6, &s.jerk}});
      combine(v0_, {{1, &s.v}, {-h * h / 3, &s.jerk}});
    }
    given_.at(system, t_ + h_, v0_);
  }

  Stage stage(int, const Unknown& u) override {
    const double r = fresh() ? 1 : h_ / h_before_;
    const double c1 = (1 + 2 * r) / ((1 + r) * h_), c0 = -(1 + r) / h_, cm = r * r / ((1 + r) * h_);
    combine(v1_, {{c1, &u.dq}, {-cm, &dq_before_}});
    dq_ = u.dq;
    combine(a1_, {{c1, &v1_}, {c0, &v0_}, {cm, &vm_}});
    given_.put(&v1_, &a1_);
    combine(before_, {{1, &u.q}, {-h_ / 2, &v1_}});
    combine(after_, {{1, &u.q}, {h_ / 2, &v1_}});
    Stage s = stage_at(u.q, t_ + h_);
    s.w0 = &before_, s.w1 = &after_, s.h = h_, s.elapsed = h_;
    s.a = &a1_, s.mass_slope = c1 * c1;
    s.v = &v1_, s.alpha_slope = c1;
    return s;
  }

  void end_velocity(Config& v) override { v = v1_; }
  void finish(const Config&) override { dq_before_ = dq_, vm_ = v0_, h_before_ = h_; }
  const Config& acceleration() const override { return a1_; }
  double own_time() const override { return 1; }

 private:
  bool fresh() const { return h_before_ == 0; }
  double t_ = 0, h_ = 0, h_before_ = 0;
  Config v0_, dq_, dq_before_, vm_, v1_, a1_, before_, after_;
  GivenRates given_;
};

}  // namespace

std::unique_ptr<Integrator> Bdf2::make(const Entry&) { return make_bdf2(); }

std::unique_ptr<StageIntegrator> make_bdf2() { return std::make_unique<Bdf2Integrator>(); }

}  // namespace hilo
