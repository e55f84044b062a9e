// M (v1 - v0)/h + f(q_mid) + G(q_mid)^T lambda = F(t_mid),   (q1 - q0)/h = (v0 + v1)/2,   g(q1) = 0
#include "dynamics/integrator.hpp"

namespace hilo {
namespace {

class MidPoint final : public StageIntegrator {
 public:
  std::string name() const override { return "mid-point"; }

  void begin(const State& s, double h) override { t_ = s.t, q0_ = s.q, v0_ = s.v, h_ = h; }

  Stage stage(int, const Config& q1) override {
    combine(mid_, {{0.5, &q0_}, {0.5, &q1}});
    combine(v_mid_, {{1 / h_, &q1}, {-1 / h_, &q0_}});
    combine(a_, {{2 / h_, &v_mid_}, {-2 / h_, &v0_}});
    Stage s = stage_at(mid_, t_ + h_ / 2);
    s.end = &q1, s.slope = s.chain = 0.5;
    s.w0 = &q0_, s.w1 = &q1, s.h = h_;
    s.a = &a_, s.mass_slope = 2 / (h_ * h_);
    s.v = &v_mid_, s.alpha_slope = 1 / h_;
    return s;
  }

  void finish(State& s, const Config&) override { combine(s.v, {{1, &v0_}, {h_, &a_}}); }
  const Config& acceleration() const override { return a_; }
  double own_time() const override { return 0.5; }
  bool alternates() const override { return true; }

 private:
  double t_ = 0, h_ = 0;
  Config q0_, v0_, mid_, v_mid_, a_;
};

}  // namespace

std::unique_ptr<StageIntegrator> make_mid_point() { return std::make_unique<MidPoint>(); }

}  // namespace hilo
