// SPDX-License-Identifier: GPL-3.0-or-later
// M (v1 - v0)/h + f(q0, q1) + G(q_mid)^T lambda = F_mean,   (q1 - q0)/h = (v0 + v1)/2,   g(q1) = 0
#include "model/integrator/energy_momentum.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "dynamics/clock.hpp"
#include "dynamics/integrator/make.hpp"

namespace hilo {
namespace {

/// What dissipation recalls of the steps before (system/stage.hpp), none at first.
class StrainMemory {
 public:
  /// chi: a strain that alternates is met by the stress chi/2 C (E1 - E0).
  explicit StrainMemory(double chi) : kappa_(3 * chi / 8) {}
  void begin(const Config& q0, double h) {
    if (kappa_ == 0) return;
    if (accepted_) {
      std::swap(two_, one_), std::swap(one_, start_);
      n_ = std::min(n_ + 1, 2), share_before_ = share_, h_before_ = h_;
      accepted_ = false;
    }
    start_ = q0, h_ = h;
    share_ = n_ > 0 ? std::min(1.0, h / h_before_) : 0;
  }
  void accept() { accepted_ = true; }
  const Dissipation* of_step(const Config& q0) {
    if (kappa_ == 0) return nullptr;
    const Config* one = n_ > 0 ? &one_ : &q0;
    dissipation_ = {kappa_, one, n_ > 1 ? &two_ : one, share_, share_ * share_before_, share_before_};
    return &dissipation_;
  }
  void archive(Archive& a) { a("strain memory", n_, accepted_, h_, h_before_, share_, share_before_, start_, one_, two_); }

 private:
  double kappa_;
  int n_ = 0;              // steps that are recalled
  bool accepted_ = false;  // the step begun last: its start belongs to the memory of the next one
  double h_ = 0, h_before_ = 0, share_ = 0, share_before_ = 0;
  Config start_, one_, two_;
  Dissipation dissipation_;
};

class EnergyMomentumIntegrator final : public StageIntegrator {
 public:
  explicit EnergyMomentumIntegrator(double chi) : chi_(chi), memory_(chi) {}
  std::string name() const override { return std::string(EnergyMomentum::name) + (chi_ > 0 ? " with stress dissipation" : ""); }

  void begin(const System& system, const State& s, double h) override {
    t_ = s.t, t_end_ = s.t + h, v0_ = s.v, h_ = h;
    memory_.begin(s.q, h);
    if (clocks_) clocks_->plan(s.v, s.t, h);
    given_.at(system, t_end_, v0_), given_.mean_from(v0_, h_);
  }

  Stage stage(int, const Unknown& u) override {
    combine(mid_, {{1, &u.q0}, {0.5, &u.dq}});
    combine(v_mid_, {{1 / h_, &u.dq}});
    combine(a_, {{2 / h_, &v_mid_}, {-2 / h_, &v0_}});
    if (clocks_) retime(u.dq);
    given_.put(nullptr, &a_);
    Stage s{};
    s.end = &u.q;
    s.left = &mid_, s.slope = 0.5;
    s.e0 = s.w0 = &u.q0, s.e1 = s.w1 = &u.q;
    s.h = h_, s.elapsed = h_;
    s.a = &a_, s.v0 = &v0_, s.mass_slope = 2 / (h_ * h_);
    if (clocks_) s.tempo = clocks_->tempo().data();
    s.v = &v_mid_, s.alpha_slope = 1 / h_;
    s.dissipation = memory_.of_step(u.q0);
    s.t0 = t_, s.t1 = s.t_end = t_end_;
    return s;
  }

  void end_velocity(Config& v) override {
    combine(v, {{1, &v0_}, {h_, &a_}});
    for (size_t b = 0; clocks_ && b < a_.c.size(); ++b) {
      const double tau = h_ / clocks_->tempo()[b];
      v.c[b] = v0_.c[b] + tau * a_.c[b], v.R[b] = v0_.R[b] + tau * a_.R[b];
    }
    if (clocks_) system_->follow(v);
    given_.put(&v, nullptr);
  }
  void finish(const Config& v) override {
    memory_.accept();
    if (clocks_) clocks_->accept(v, a_, taken()[0]);
  }
  void forget() override {
    if (clocks_) clocks_->restart();
  }
  void archive_history(Archive& a, const System& system) override {
    memory_.archive(a);
    bool timed = clocks_.has_value();
    a("timed", timed);
    if (timed && !clocks_) system_ = &system, clocks_.emplace(system);
    if (timed) clocks_->archive(a);
  }
  void keep_time(const System& system) override {
    system_ = &system;
    clocks_.emplace(system);
    if (clocks_->empty()) clocks_.reset();
  }
  std::vector<std::string> timed() const override { return clocks_ ? clocks_->names() : std::vector<std::string>{}; }
  const Config& acceleration() const override { return a_; }
  Config* mean_acceleration() override { return &a_; }
  double own_time() const override { return 0.5; }
  bool alternates() const override { return true; }

 private:
  /// Accelerations of bodies whose step is longer or shorter than h: 2/tau (dq/tau - v0).
  void retime(const Config& dq) {
    const std::vector<double>& tempo = clocks_->tempo();
    for (size_t b = 0; b < tempo.size(); ++b) {
      const double f = 2 * tempo[b] / h_, g = tempo[b] / h_;
      a_.c[b] = f * (g * dq.c[b] - v0_.c[b]), a_.R[b] = f * (g * dq.R[b] - v0_.R[b]);
    }
    system_->follow(a_);
  }

  double chi_, t_ = 0, t_end_ = 0, h_ = 0;
  const System* system_ = nullptr;
  std::optional<Clocks> clocks_;
  StrainMemory memory_;
  Config v0_, mid_, v_mid_, a_;
  GivenRates given_;
};

}  // namespace

std::unique_ptr<Integrator> EnergyMomentum::make(const Entry& time) { return make_energy_momentum(time.number("dissipation")); }

std::unique_ptr<StageIntegrator> make_energy_momentum(double chi) { return std::make_unique<EnergyMomentumIntegrator>(chi); }

}  // namespace hilo
