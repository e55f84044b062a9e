// M (v1 - v0)/h + f(q0, q1) + G(q_mid)^T lambda = F_mean,   (q1 - q0)/h = (v0 + v1)/2,   g(q1) = 0
#include <optional>

#include "dynamics/clock.hpp"
#include "dynamics/integrator.hpp"

namespace hilo {
namespace {

class EnergyMomentum final : public StageIntegrator {
 public:
  explicit EnergyMomentum(double chi) : chi_(chi) {}
  std::string name() const override {
    if (clock_) return "energy-momentum on the clock of one degree of freedom";
    return chi_ > 0 ? "energy-momentum with stress dissipation" : "energy-momentum";
  }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, t_end_ = s.t + h, v0_ = s.v;
    h_ = clock_ ? clock_->length(s.v, h) : h;
    given_.at(system, t_end_, v0_), given_.mean_from(v0_, h_);
  }

  Stage stage(int, const Unknown& u) override {
    combine(mid_, {{1, &u.q0}, {0.5, &u.dq}});
    combine(v_mid_, {{1 / h_, &u.dq}});
    combine(a_, {{2 / h_, &v_mid_}, {-2 / h_, &v0_}});
    given_.put(nullptr, &a_);
    Stage s{};
    s.end = &u.q;
    s.left = &mid_, s.slope = 0.5;
    s.e0 = s.w0 = &u.q0, s.e1 = s.w1 = &u.q;
    s.h = h_;
    s.a = &a_, s.v0 = &v0_, s.mass_slope = 2 / (h_ * h_);
    s.v = &v_mid_, s.alpha_slope = 1 / h_;
    s.chi = chi_;
    s.t0 = t_, s.t1 = s.t_end = t_end_;
    return s;
  }

  void end_velocity(Config& v) override {
    combine(v, {{1, &v0_}, {h_, &a_}});
    given_.put(&v, nullptr);
  }
  void finish(const Config& v) override {
    if (clock_) clock_->accept(v, a_);
  }
  void forget() override {
    if (clock_) clock_->restart();
  }
  void keep_time(const System& system) override { clock_.emplace(system); }
  const Config& acceleration() const override { return a_; }
  double own_time() const override { return 0.5; }
  bool alternates() const override { return true; }
  bool keeps_energy() const override { return true; }

 private:
  double chi_, t_ = 0, t_end_ = 0, h_ = 0;
  std::optional<Clock> clock_;
  Config v0_, mid_, v_mid_, a_;
  GivenRates given_;
};

}  // namespace

std::unique_ptr<StageIntegrator> make_energy_momentum(double chi) { return std::make_unique<EnergyMomentum>(chi); }

}  // namespace hilo
