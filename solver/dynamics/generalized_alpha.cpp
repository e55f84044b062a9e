// M a1 + f(q1) + G(q1)^T lambda = F(t1),  g(q1) = 0,  with auxiliary accelerations b:
//   (1 - alpha_m) b1 + alpha_m b0 = (1 - alpha_f) a1 + alpha_f a0,  q1 = q0 + h v0 + h^2 ((1/2 - beta) b0 + beta b1),  v1 = v0 + h ((1 -
//   gamma) b0 + gamma b1)
#include "dynamics/integrator.hpp"

namespace hilo {
namespace {

class GeneralizedAlpha final : public Integrator {
 public:
  explicit GeneralizedAlpha(double rho)
      : alpha_m_((2 * rho - 1) / (rho + 1)),
        alpha_f_(rho / (rho + 1)),
        gamma_(0.5 - alpha_m_ + alpha_f_),
        beta_((gamma_ + 0.5) * (gamma_ + 0.5) / 4) {}
  std::string name() const override { return "generalized-alpha"; }
  bool needs_acceleration() const override { return true; }

  void begin(const State& s, double h) override {
    start_ = &s, h_ = h;
    if (b0_.c.size() != s.a.c.size()) b0_ = s.a, a0_ = s.a;  // b(0) = a(0); the offset of b by a fraction of h costs no order
  }

  Stage stage(const Config& q1) override {
    const Config &q0 = start_->q, &v0 = start_->v;
    const double c = 1 / (h_ * h_ * beta_), m = (1 - alpha_m_) / (1 - alpha_f_);
    combine(b1_, {{c, &q1}, {-c, &q0}, {-c * h_, &v0}, {-c * h_ * h_ * (0.5 - beta_), &b0_}});
    combine(a1_, {{m, &b1_}, {alpha_m_ / (1 - alpha_f_), &b0_}, {-alpha_f_ / (1 - alpha_f_), &a0_}});
    combine(v1_, {{1, &v0}, {h_ * (1 - gamma_), &b0_}, {h_ * gamma_, &b1_}});
    combine(before_, {{1, &q1}, {-h_ / 2, &v1_}});
    combine(after_, {{1, &q1}, {h_ / 2, &v1_}});
    Stage s{};
    s.q0 = s.q1 = s.left = &q1;
    s.slope = 1, s.K_factor = 2;
    s.w0 = &before_, s.w1 = &after_, s.h = h_, s.C_factor = gamma_ / beta_;
    s.a = &a1_, s.mass_slope = m * c;
    s.v = &v1_, s.alpha_slope = gamma_ / (beta_ * h_);
    s.t0 = s.t1 = start_->t + h_;
    return s;
  }

  void finish(State& s, const Config& q1) override {
    s.v = v1_, s.q = q1, s.a = a1_;
    a0_ = a1_, b0_ = b1_;
    s.t += h_;
  }
  const Config& acceleration() const override { return a1_; }
  double own_time() const override { return 1; }

 private:
  double alpha_m_, alpha_f_, gamma_, beta_, h_ = 0;
  const State* start_ = nullptr;
  Config a0_, a1_, b0_, b1_, v1_, before_, after_;
};

}  // namespace

std::unique_ptr<Integrator> make_generalized_alpha(double rho) { return std::make_unique<GeneralizedAlpha>(rho); }

}  // namespace hilo
