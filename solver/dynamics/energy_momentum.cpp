// M (v1 - v0)/h + f(q0, q1) + G(q_mid)^T lambda = F_mean,   (q1 - q0)/h = (v0 + v1)/2,   g(q1) = 0
#include "dynamics/integrator.hpp"

namespace hilo {
namespace {

class EnergyMomentum final : public Integrator {
 public:
  explicit EnergyMomentum(double chi) : chi_(chi) {}
  std::string name() const override { return chi_ > 0 ? "energy-momentum with stress dissipation" : "energy-momentum"; }

  void begin(const State& s, double h) override { start_ = &s, h_ = h; }

  Stage stage(const Config& q1) override {
    const Config &q0 = start_->q, &v0 = start_->v;
    combine(mid_, {{0.5, &q0}, {0.5, &q1}});
    combine(v_mid_, {{1 / h_, &q1}, {-1 / h_, &q0}});
    combine(a_, {{2 / h_, &v_mid_}, {-2 / h_, &v0}});
    Stage s{};
    s.q0 = s.w0 = &q0, s.q1 = s.w1 = &q1;
    s.h = h_;
    s.left = &mid_, s.slope = 0.5;
    s.a = &a_, s.mass_slope = 2 / (h_ * h_);
    s.v = &v_mid_, s.alpha_slope = 1 / h_;
    s.chi = chi_;
    s.t0 = start_->t, s.t1 = start_->t + h_;
    return s;
  }

  void finish(State& s, const Config& q1) override {
    // v1 = v0 + h a; a holds (v1 - v0)/h of the accepted q1
    combine(s.v, {{1, &s.v}, {h_, &a_}});
    s.q = q1;
    s.t += h_;
  }
  const Config& acceleration() const override { return a_; }
  double own_time() const override { return 0.5; }

 private:
  double chi_, h_ = 0;
  const State* start_ = nullptr;
  Config mid_, v_mid_, a_;
};

}  // namespace

std::unique_ptr<Integrator> make_energy_momentum(double chi) { return std::make_unique<EnergyMomentum>(chi); }

void combine(Config& out, std::initializer_list<std::pair<double, const Config*>> terms) {
  const Config& first = *terms.begin()->second;
  out.x.resize(first.x.size()), out.c.resize(first.c.size()), out.R.resize(first.R.size());
  const auto run = [&](auto member) {
    auto& to = out.*member;
    for (size_t i = 0; i < to.size(); ++i) {
      auto sum = (terms.begin()->first * (terms.begin()->second->*member)[i]).eval();
      for (auto t = terms.begin() + 1; t != terms.end(); ++t) sum += t->first * (t->second->*member)[i];
      to[i] = sum;
    }
  };
  run(&Config::x), run(&Config::c), run(&Config::R);
}

}  // namespace hilo
