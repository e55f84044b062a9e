// SPDX-License-Identifier: GPL-3.0-or-later
// M a1 + f(q1) + G(q1)^T lambda = F(t1),  g(q1) = 0,  with auxiliary accelerations b:
//   (1 - alpha_m) b1 + alpha_m b0 = (1 - alpha_f) a1 + alpha_f a0
//   q1 = q0 + h v0 + h^2 ((1/2 - beta) b0 + beta b1),   v1 = v0 + h ((1 - gamma) b0 + gamma b1)
//
// b_n stands for the acceleration at t_n + (alpha_m - alpha_f) h: it starts there, and moves when h changes, or the order is lost.  Along
// what joints hold, where q1 is given, v_n misses by (1/6 - (alpha_m - alpha_f)/2 - beta) h^2 times the jerk: it starts so too, or the
// multipliers ring with an amplitude of first order [arnold-2015].
#include "model/integrator/generalized_alpha.hpp"

#include <fmt/format.h>

#include "dynamics/integrator/make.hpp"

namespace hilo {
namespace {

class GeneralizedAlphaIntegrator final : public StageIntegrator {
 public:
  GeneralizedAlphaIntegrator(const AlphaParameters& p, std::string name) : p_(p), name_(std::move(name)) {}
  std::string name() const override { return name_; }
  bool needs_acceleration() const override { return true; }
  void forget() override { h_b_ = 0; }
  void archive_history(Archive& a, const System&) override { a("accelerations before", h_b_, a0_, jerk_, b_at_start_); }

  void begin(const System& system, const State& s, double h) override {
    const double offset = p_.alpha_m - p_.alpha_f;
    t_ = s.t, v0_ = s.v, h_ = h;
    if (h_b_ == 0) {
      a0_ = s.a, jerk_ = s.jerk, b_at_start_ = s.a;
      if (s.across.c.size() == s.v.c.size()) combine(v0_, {{1, &s.v}, {(1. / 6 - offset / 2 - p_.beta) * h * h, &s.across}});
    }
    combine(b0_, {{1, &b_at_start_}, {offset * (h - h_b_), &jerk_}});
    given_.at(system, t_ + h_, v0_);
  }

  Stage stage(int, const Unknown& u) override {
    const double c = 1 / (h_ * h_ * p_.beta), m = (1 - p_.alpha_m) / (1 - p_.alpha_f);
    combine(b1_, {{c, &u.dq}, {-c * h_, &v0_}, {-c * h_ * h_ * (0.5 - p_.beta), &b0_}});
    combine(a1_, {{m, &b1_}, {p_.alpha_m / (1 - p_.alpha_f), &b0_}, {-p_.alpha_f / (1 - p_.alpha_f), &a0_}});
    combine(v1_, {{1, &v0_}, {h_ * (1 - p_.gamma), &b0_}, {h_ * p_.gamma, &b1_}});
    given_.put(&v1_, &a1_), given_.put(nullptr, &b1_);
    combine(before_, {{1, &u.q}, {-h_ / 2, &v1_}});
    combine(after_, {{1, &u.q}, {h_ / 2, &v1_}});
    Stage s = stage_at(u.q, t_ + h_);
    s.w0 = &before_, s.w1 = &after_, s.h = h_, s.elapsed = h_;
    s.a = &a1_, s.mass_slope = m * c;
    s.v = &v1_, s.alpha_slope = p_.gamma / (p_.beta * h_);
    return s;
  }

  void end_velocity(Config& v) override { v = v1_; }
  void finish(const Config&) override {
    combine(jerk_, {{1 / h_, &a1_}, {-1 / h_, &a0_}});
    a0_ = a1_, b_at_start_ = b1_, h_b_ = h_;
  }
  const Config& acceleration() const override { return a1_; }
  double own_time() const override { return 1; }

 private:
  AlphaParameters p_;
  std::string name_;
  double t_ = 0, h_ = 0, h_b_ = 0;  // h_b: the step that b at the start of this one belongs to; 0 at a restart
  Config v0_, a0_, jerk_, b_at_start_, b0_, a1_, b1_, v1_, before_, after_;
  GivenRates given_;
};

AlphaParameters second_order(double alpha_m, double alpha_f) {
  const double gamma = 0.5 - alpha_m + alpha_f;
  return {alpha_m, alpha_f, (gamma + 0.5) * (gamma + 0.5) / 4, gamma};
}

}  // namespace

AlphaParameters generalized_alpha(double rho) { return second_order((2 * rho - 1) / (rho + 1), rho / (rho + 1)); }
AlphaParameters hht(double rho) { return second_order(0, (1 - rho) / (1 + rho)); }
AlphaParameters wbz(double rho) { return second_order((rho - 1) / (rho + 1), 0); }

namespace {

/// Where nothing is damped.
std::string gains_energy(const System& system) {
  if (system.traits().constrains)
    return "with joints its multipliers oscillate and grow until the run stops, sometimes after many thousand steps";
  if (system.traits().deforms) return "it gains energy on parts that turn while they deform";
  return "";
}

}  // namespace

std::string GeneralizedAlpha::weakness(const Entry& time, const System& system) {
  return time.number("rho") >= 0.9 ? gains_energy(system) : "";
}
std::string Newmark::weakness(const Entry& time, const System& system) { return time.number("gamma") < 0.55 ? gains_energy(system) : ""; }

std::unique_ptr<Integrator> GeneralizedAlpha::make(const Entry& time) {
  return make_generalized_alpha(generalized_alpha(time.number("rho")));
}
std::unique_ptr<Integrator> Newmark::make(const Entry& time) {
  const double gamma = time.number("gamma"), beta = time.given("beta") ? time.number("beta") : (gamma + 0.5) * (gamma + 0.5) / 4;
  return make_generalized_alpha({0, 0, beta, gamma}, name);
}
std::unique_ptr<Integrator> Hht::make(const Entry& time) {
  const double rho = time.number("rho");
  if (rho < 0.5) throw Error(time.where("rho"), fmt::format("rho is {:g}: the spectral radius of HHT is 1/2 to 1", rho));
  return make_generalized_alpha(hilo::hht(rho), name);
}
std::unique_ptr<Integrator> Wbz::make(const Entry& time) { return make_generalized_alpha(hilo::wbz(time.number("rho")), name); }

std::unique_ptr<StageIntegrator> make_generalized_alpha(const AlphaParameters& p, std::string_view name) {
  return std::make_unique<GeneralizedAlphaIntegrator>(p, std::string(name));
}

}  // namespace hilo
