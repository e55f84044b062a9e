// SPDX-License-Identifier: GPL-3.0-or-later
// M a~ + f + G(q~)^T lambda = F(t~),  g(q1) = 0,  all at t~ = t0 + W1 h, with D = a1 - a0:
//   a~ = a0 + A D,   v~ = v0 + W1 h a0 + V h D,   q~ = q0 + W1 h v0 + Q h^2 a0 + B h^2 D
//   q1 = q0 + h v0 + h^2/2 a0 + l3 h^2 D,         v1 = v0 + h a0 + l5 h D
// a_n stands for the acceleration at t_n + (W1 - A) h: it starts there, and moves when h changes.
// Averaged: f = B(q_w)^T S((1 - W1) E0 + W1 E1) and G at q_w = (1 - W1) q0 + W1 q1, which for U0 is q~ itself.
#include "model/integrator/zhou_tamma.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/integrator/make.hpp"

namespace hilo {
namespace {

class ZhouTammaIntegrator final : public StageIntegrator {
 public:
  ZhouTammaIntegrator(bool velocity_family, const double r[3], bool averaged) : averaged_(averaged) {
    const double p = (1 + r[0]) * (1 + r[1]), p3 = p * (1 + r[2]);
    const double third = (3 + r[0] + r[1] - r[0] * r[1]) / (2 * p);
    A_ = (2 + r[0] + r[1] + r[2] - r[0] * r[1] * r[2]) / p3;
    B_ = 1 / p3;
    if (velocity_family) {
      W_ = third, Q_ = 1 / p, V_ = 2 / p3, l3_ = 0.5 / (1 + r[2]), l5_ = 1 / (1 + r[2]);
    } else {
      W_ = 1 / (1 + r[2]), Q_ = W_ / 2, V_ = third * W_, l3_ = 1 / p, l5_ = third;
    }
    name_ = fmt::format("{}{}({:g},{:g},{:g})", averaged ? "averaged " : "", velocity_family ? "V0" : "U0", r[0], r[1], r[2]);
  }
  std::string name() const override { return name_; }
  bool needs_acceleration() const override { return true; }
  void forget() override { h_a_ = 0; }
  void archive_history(Archive& a, const System&) override { a("acceleration before", h_a_, jerk_, a_at_start_); }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, v0_ = s.v, h_ = h;
    if (h_a_ == 0) jerk_ = s.jerk, a_at_start_ = s.a;
    combine(a0_, {{1, &a_at_start_}, {(W_ - A_) * (h - h_a_), &jerk_}});
    given_.at(system, t_ + W_ * h_, v0_), given_end_.at(system, t_ + h_, v0_);
  }

  Stage stage(int, const Unknown& u) override {
    const double c = 1 / (l3_ * h_ * h_);
    combine(D_, {{c, &u.dq}, {-c * h_, &v0_}, {-c * h_ * h_ / 2, &a0_}});
    combine(a_, {{1, &a0_}, {A_, &D_}});
    combine(v_, {{1, &v0_}, {W_ * h_, &a0_}, {V_ * h_, &D_}});
    given_.put(&v_, &a_);
    if (averaged_)
      combine(left_, {{1, &u.q0}, {W_, &u.dq}});
    else
      combine(left_, {{1, &u.q0}, {W_ * h_, &v0_}, {Q_ * h_ * h_, &a0_}, {B_ * h_ * h_, &D_}});
    combine(before_, {{1, &left_}, {-h_ / 2, &v_}});
    combine(after_, {{1, &left_}, {h_ / 2, &v_}});
    Stage s = stage_at(left_, t_ + W_ * h_);
    s.end = &u.q, s.t_end = t_ + h_;
    s.slope = averaged_ ? W_ : B_ / l3_;
    if (averaged_)
      s.e0 = &u.q0, s.e1 = &u.q, s.weight = W_;
    else
      s.chain = s.slope;
    s.w0 = &before_, s.w1 = &after_, s.h = h_;
    s.a = &a_, s.mass_slope = A_ * c;
    s.v = &v_, s.alpha_slope = V_ * h_ * c;
    return s;
  }

  void end_velocity(Config& v) override {
    combine(v, {{1, &v0_}, {h_, &a0_}, {l5_ * h_, &D_}});
    given_end_.put(&v, nullptr);
  }
  void finish(const Config&) override {
    combine(jerk_, {{1 / h_, &D_}});
    combine(a_at_start_, {{1, &a0_}, {1, &D_}});
    h_a_ = h_;
  }
  const Config& acceleration() const override { return a_; }
  double own_time() const override { return W_; }

 private:
  bool averaged_;
  std::string name_;
  double A_, B_, W_, Q_, V_, l3_, l5_, t_ = 0, h_ = 0, h_a_ = 0;
  Config v0_, a0_, a_at_start_, jerk_, D_, a_, v_, left_, before_, after_;
  GivenRates given_, given_end_;
};

}  // namespace

namespace {

struct Radii {
  double rho[3];
  explicit Radii(const Entry& time) {
    const char* keys[3] = {"rho1", "rho2", "rho3"};
    for (int i = 0; i < 3; ++i) rho[i] = time.number(time.has(keys[i]) ? keys[i] : "rho");
  }
};

}  // namespace

std::unique_ptr<Integrator> U0::make(const Entry& time) { return make_zhou_tamma(false, Radii(time).rho, time.boolean("averaged")); }
std::unique_ptr<Integrator> V0::make(const Entry& time) { return make_zhou_tamma(true, Radii(time).rho, time.boolean("averaged")); }

std::string U0::weakness(const Entry& time, const System& system) {
  if (!time.boolean("averaged") && system.traits().deforms) return "without averaged = true stiff parts that turn are stretched unnoticed";
  const auto [rho] = Radii(time);
  if (rho[0] == 1 && rho[1] == 1 && rho[2] < 1 && system.traits().constrains)
    return "U0(1, 1, rho3 < 1) does not damp the oscillation of multipliers";
  return "";
}
std::string V0::weakness(const Entry& time, const System& system) {
  if (!time.boolean("averaged") && system.traits().deforms) return "without averaged = true stiff parts that turn are stretched unnoticed";
  const auto [rho] = Radii(time);
  return std::min({rho[0], rho[1], rho[2]}) < 1 ? "accelerations and multipliers of V0 with a spectral radius below 1 are of first order"
                                                : "";
}

std::unique_ptr<StageIntegrator> make_zhou_tamma(bool velocity_family, const double rho[3], bool averaged) {
  return std::make_unique<ZhouTammaIntegrator>(velocity_family, rho, averaged);
}

}  // namespace hilo
