// SPDX-License-Identifier: GPL-3.0-or-later
// Trapezoidal rule to t0 + g h, then the three-point backward difference to t0 + h; g = 2 - sqrt 2 gives both the same matrix:
//   q_g = q0 + g h/2 (v0 + v_g),  v_g = v0 + g h/2 (a0 + a_g)
//   v1 = c0 q0 + cg q_g + c1 q1,  a1 = c0 v0 + cg v_g + c1 v1,   c0 = (1-g)/(g h), cg = -1/((1-g) g h), c1 = (2-g)/((1-g) h)
#include "model/integrator/bathe.hpp"

#include "dynamics/integrator/make.hpp"

namespace hilo {
namespace {

class BatheIntegrator final : public StageIntegrator {
 public:
  std::string name() const override { return std::string(Bathe::name); }
  bool needs_acceleration() const override { return true; }
  void forget() override { fresh_ = true; }
  void archive_history(Archive& a, const System&) override { a("acceleration before", fresh_, a0_); }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, v0_ = s.v, h_ = h;
    if (fresh_) a0_ = s.a;
    given_[0].at(system, t_ + g * h_, v0_), given_[1].at(system, t_ + h_, v0_);
  }

  Stage stage(int k, const Unknown& u) override {
    const double h = h_, dt = g * h;
    if (k == 0) {
      combine(vg_, {{2 / dt, &u.dq}, {-1, &v0_}});
      combine(ag_, {{2 / dt, &vg_}, {-2 / dt, &v0_}, {-1, &a0_}});
      given_[0].put(&vg_, &ag_);
      dqg_ = u.dq;
      return at(u.q, vg_, ag_, t_ + dt, 2 / dt);
    }
    const double c0 = (1 - g) / (g * h), cg = -1 / ((1 - g) * g * h), c1 = (2 - g) / ((1 - g) * h);
    combine(v1_, {{cg, &dqg_}, {c1, &u.dq}});
    combine(a1_, {{c0, &v0_}, {cg, &vg_}, {c1, &v1_}});
    given_[1].put(&v1_, &a1_);
    return at(u.q, v1_, a1_, t_ + h, c1);
  }

  void end_velocity(Config& v) override { v = v1_; }
  void finish(const Config&) override { a0_ = a1_, fresh_ = false; }
  const Config& acceleration() const override { return a1_; }
  double own_time() const override { return 1; }

 protected:
  int n_stages() const override { return 2; }
  double instant(int k) const override { return k == 0 ? g : 1; }

 private:
  /// Everything at (q, v, a), dv/dq = da/dv = rate.
  Stage at(const Config& q, const Config& v, const Config& a, double t, double rate) {
    const int k = &v == &v1_;
    combine(before_[k], {{1, &q}, {-h_ / 2, &v}});
    combine(after_[k], {{1, &q}, {h_ / 2, &v}});
    Stage s = stage_at(q, t);
    s.w0 = &before_[k], s.w1 = &after_[k], s.h = h_;
    s.a = &a, s.mass_slope = rate * rate;
    s.v = &v, s.alpha_slope = rate;
    return s;
  }

  static constexpr double g = 2 - M_SQRT2;
  bool fresh_ = true;
  double t_ = 0, h_ = 0;
  Config v0_, a0_, dqg_, vg_, ag_, v1_, a1_, before_[2], after_[2];
  GivenRates given_[2];
};

}  // namespace

std::unique_ptr<Integrator> Bathe::make(const Entry&) { return make_bathe(); }

/// Along what joints hold, a1 is the acceleration at t1 - h/3: velocities of the two stages are off by different multiples of h^2 times the
/// jerk, and a1 has their difference over h.
std::string Bathe::weakness(const Entry&, const System& system) {
  return system.traits().constrains ? "accelerations and multipliers of Bathe are of first order where joints or ties hold" : "";
}

std::unique_ptr<StageIntegrator> make_bathe() { return std::make_unique<BatheIntegrator>(); }

}  // namespace hilo
