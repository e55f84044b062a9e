// SPDX-License-Identifier: GPL-3.0-or-later
// Radau IIA of three stages, order 5 in positions for index 3:
//   Q_i = q0 + h sum_j A_ij V_j,   V_i = v0 + h sum_j A_ij A_j,   equations of motion and g(Q_i) = 0 at every stage, q1 = Q_3, v1 = V_3
// With W = A^-1:  V_i = sum_j W_ij (Q_j - q0)/h,  A_i = sum_j W_ij (V_j - v0)/h; the stages couple through the mass and what asks for
// rates.
#include "model/integrator/radau.hpp"

#include <cmath>

#include "base/error.hpp"
#include "dynamics/integrator/coupled_stages.hpp"
#include "dynamics/integrator/make.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/stage_block.hpp"

namespace hilo {
namespace {

Eigen::Matrix3d radau_tableau() {
  const double s = std::sqrt(6.0);
  Eigen::Matrix3d A;
  A << (88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225, (296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225,
      (16 - s) / 36, (16 + s) / 36, 1. / 9;
  return A;
}

class RadauIntegrator final : public CoupledStages {
 public:
  explicit RadauIntegrator(std::unique_ptr<SerialKktSolver> solver) : CoupledStages(std::move(solver), radau_tableau()) {}
  std::string name() const override { return std::string(Radau::name); }
  int order() const override { return 5; }
  std::span<const Taken> taken() const override { return taken_; }
  const Config& acceleration() const override { return a_[2]; }
  double own_time() const override { return 1; }

  NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) override {
    const System& system = *(system_ = &tools.system);
    if (NewtonReport refused; !(refused.reason = system.too_far(s.t, s.t + h)).empty()) return refused;
    begin(system, s.t, h);
    has_rates_ = system.traits().has_rates;
    v0_ = s.v, predictor_ = predictor;
    for (int i = 0; i < 3; ++i) given_[i].at(system, t_ + c_[i] * h_, v0_);
    guess(system, s);
    const NewtonReport report = iterate(system, tools.newton);
    if (!report.converged) return drop_matrix(), report;
    for (int i = 0; i < 3; ++i) {
      u_[i].increments(system, reached_);
      for (size_t k = 0; k < reached_.size(); ++k) missed_[i][k] = reached_[k] - missed_[i][k];
    }
    restore_rotations(system, u_[2].q);
    place(system);
    taken_.resize(3);
    for (int i = 0; i < 3; ++i) {
      combine(from_[i], {{1, &u_[i].q}, {-h_ * A_(2, i), &v_[i]}});  // quadrature of the work: weight times power at the stage
      taken_[i].stage = stages_[i], taken_[i].lambda = lambda_[i];
      taken_[i].stage.work_from = &from_[i], taken_[i].stage.span = h_ * A_(2, i);
    }
    return report;
  }

  void end(State& s) override { s.q = u_[2].q, s.v = v_[2], s.lambda = lambda_[2]; }

  void accept(State& s) override {
    end(s), accepted();
    a_end_ = a_[2], s.t = t_ + h_;
    for (int i = 0; i < 3; ++i)
      if (predictor_ == Predictor::rigid_rotation)
        past_[i].accept(*system_, h_, std::move(missed_[i]), lambda_[i]);
      else  // what another guess missed says nothing of this one
        past_[i].clear();
  }

  void restart() override {
    for (Extrapolation& p : past_) p.clear();
    drop_matrix(), a_end_ = {};
  }

  void carry(const Carry& carry) override {
    for (Extrapolation& p : past_) p.carry(carry);
    forget_structure();
  }

  void archive(Archive& a, const System&) override {
    a(name(), a_end_, past_);
    forget_structure();
  }

 private:
  void check(const System& system) const override {
    if (system.comm->size > 1) throw Error("", "radau is serial", "run it without mpirun, or choose another time.integrator");
  }

  void guess(const System& system, const State& s) {
    for (int i = 0; i < 3; ++i) {
      predict(system, s, c_[i] * h_, predictor_, a_end_, guess_);
      system.prescribe(guess_, t_ + c_[i] * h_);
      u_[i].start(system, s.q, guess_);
      u_[i].increments(system, missed_[i]);
      lambda_[i] = s.lambda;
      if (predictor_ != Predictor::rigid_rotation) continue;
      if (const auto z = past_[i].increments(system, h_); !z.empty()) u_[i].shift(system, z);
      lambda_[i] = past_[i].multipliers(lambda_[i]);
    }
  }

  void move(const System& system, std::span<const double> z) override {
    const size_t n = z.size() / 3;
    for (int i = 0; i < 3; ++i) u_[i].move(system, z.subspan(i * n, n));
  }

  /// Velocities, accelerations and stages of u_.
  void place(const System&) override {
    Config::each_array([&](auto array) { differentiate(array); });
    for (int i = 0; i < 3; ++i) {
      given_[i].put(&v_[i], &a_[i]);
      Stage& s = stages_[i] = from_left(stage_at(u_[i].q, t_ + c_[i] * h_), h_);
      s.a = &a_[i], s.mass_slope = (W_ * W_)(i, i) / (h_ * h_);
      s.v = &v_[i], s.alpha_slope = W_(i, i) / h_;
      if (!has_rates_) continue;
      combine(before_[i], {{1, &u_[i].q}, {-h_ / 2, &v_[i]}});
      combine(after_[i], {{1, &u_[i].q}, {h_ / 2, &v_[i]}});
      s.w0 = &before_[i], s.w1 = &after_[i], s.h = h_;
    }
  }

  void evaluate(const System& system, SerialKktSolver* whole) override {
    for (int i = 0; i < 3; ++i) {
      if (whole) {
        StageBlock block(*whole, system, i, i, 1, r_[i].sigma);
        system.evaluate(stages_[i], lambda_[i], r_[i], &block);
      } else {
        system.evaluate(stages_[i], lambda_[i], r_[i], nullptr);
      }
    }
    phases().evaluations += 3;
    if (!whole) return;
    add_coupling(system, *whole);
    phases().evaluations += 6, phases().tangents += 9;
  }

  void add_coupling(const System& system, SerialKktSolver& whole) {
    combine(zero_, {{0, &v0_}});
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (i == j) continue;
        Stage s = stages_[i];
        s.end = &u_[j].q, s.slope = 0, s.chain = 1e-30;
        s.rates_alone = true;
        s.a = &zero_, s.mass_slope = (W_ * W_)(i, j) / (h_ * h_);
        s.alpha_slope = W_(i, j) / h_;
        // rows of velocities are over the slope, and have the scale, of their own stage
        StageBlock block(whole, system, i, j, r_[i].sigma * W_(i, j) / W_(i, i), unused_.sigma);
        system.evaluate(s, lambda_[i], unused_, &block);
      }
  }

  template <class T>
  void differentiate(std::vector<T> Config::*member) {
    const size_t n = (v0_.*member).size();
    for (int i = 0; i < 3; ++i) (v_[i].*member).resize(n), (a_[i].*member).resize(n);
    if (n == 0) return;
    const auto at = [&](const Config& c) { return (c.*member)[0].data(); };
    const auto to = [&](Config& c) { return (c.*member)[0].data(); };
    const double *d[3] = {at(u_[0].dq), at(u_[1].dq), at(u_[2].dq)}, *before = at(v0_);
    double *v[3] = {to(v_[0]), to(v_[1]), to(v_[2])}, *a[3] = {to(a_[0]), to(a_[1]), to(a_[2])};
    double w[3][4];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) w[i][j] = W_(i, j) / h_;
      w[i][3] = w[i][0] + w[i][1] + w[i][2];
    }
    for (size_t k = 0; k < n * T::SizeAtCompileTime; ++k) {
      double x[3];
      for (int i = 0; i < 3; ++i) v[i][k] = x[i] = w[i][0] * d[0][k] + w[i][1] * d[1][k] + w[i][2] * d[2][k];
      for (int i = 0; i < 3; ++i) a[i][k] = w[i][0] * x[0] + w[i][1] * x[1] + w[i][2] * x[2] - w[i][3] * before[k];
    }
  }

  const System* system_ = nullptr;
  Predictor predictor_ = Predictor::hold;
  bool has_rates_ = false;  // something asks for rates of strain or of measures
  Unknown u_[3];
  std::array<Extrapolation, 3> past_;
  std::vector<double> missed_[3], reached_;
  Residual unused_;
  Config guess_, zero_, a_end_, v0_, v_[3], a_[3], before_[3], after_[3], from_[3];
  GivenRates given_[3];
  std::vector<Taken> taken_;
};

}  // namespace

std::unique_ptr<Integrator> Radau::make(const Entry&) { return make_radau(make_light_solver()); }

std::string Radau::weakness(const Entry&, const System& system) {
  return system.layout.map.n_global > 5000 ? "all three stages are solved at once: 27 times the entries of the other methods" : "";
}

std::unique_ptr<Integrator> make_radau(std::unique_ptr<SerialKktSolver> solver) {
  return std::make_unique<RadauIntegrator>(std::move(solver));
}

}  // namespace hilo
