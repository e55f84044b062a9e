// Radau IIA of three stages, order 5 in positions for index 3:
//   Q_i = q0 + h sum_j A_ij V_j,   V_i = v0 + h sum_j A_ij A_j,   equations of motion and g(Q_i) = 0 at every stage, q1 = Q_3, v1 = V_3
// With W = A^-1:  V_i = sum_j W_ij (Q_j - q0)/h,  A_i = sum_j W_ij (V_j - v0)/h; the stages couple through the mass and what asks for
// rates.
//
// Simplified Newton [hairer-wanner-1996, IV.8]: matrix and factors stay, over steps too, while corrections with them fall fast.
#include "model/integrator/radau.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "base/error.hpp"
#include "dynamics/integrator/make.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/stage_block.hpp"

namespace hilo {
namespace {

class RadauIntegrator final : public Integrator {
 public:
  explicit RadauIntegrator(std::unique_ptr<SerialKktSolver> solver) : whole_(std::move(solver)) {
    const double s = std::sqrt(6.0);
    A_ << (88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225, (296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225,
        (16 - s) / 36, (16 + s) / 36, 1. / 9;
    W_ = A_.inverse();
    for (int i = 0; i < 3; ++i) c_[i] = A_.row(i).sum();
  }
  std::string name() const override { return std::string(Radau::name); }
  std::span<const Taken> taken() const override { return taken_; }
  const Config& acceleration() const override { return a_[2]; }
  double own_time() const override { return 1; }

  NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) override {
    const System& system = *(system_ = &tools.system);
    if (NewtonReport refused; !(refused.reason = system.too_far(s.t, s.t + h)).empty()) return refused;
    if (map_.global.empty()) couple(system);
    if (tried_) kept_ = false;  // the step before was refused: joint rows may have been chosen anew
    tried_ = true;
    t_ = s.t, h_ = h, v0_ = s.v, predictor_ = predictor;
    for (int i = 0; i < 3; ++i) given_[i].at(system, t_ + c_[i] * h_, v0_);
    guess(system, s);
    const NewtonReport report = iterate(system, tools.newton);
    if (!report.converged) return kept_ = false, report;
    for (int i = 0; i < 3; ++i) {
      u_[i].increments(system, reached_);
      for (size_t k = 0; k < reached_.size(); ++k) missed_[i][k] = reached_[k] - missed_[i][k];
    }
    restore_rotations(system, u_[2].q);
    place();
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
    end(s);
    tried_ = false, a_end_ = a_[2], s.t = t_ + h_;
    for (int i = 0; i < 3; ++i)
      if (predictor_ == Predictor::rigid_rotation)
        past_[i].accept(*system_, h_, std::move(missed_[i]), lambda_[i]);
      else  // what another guess missed says nothing of this one
        past_[i].clear();
  }

  void restart() override {
    for (Extrapolation& p : past_) p.clear();
    kept_ = false, a_end_ = {};
  }

  void archive(Archive& a, const System&) override {
    a(name(), a_end_, past_);
    kept_ = tried_ = false, map_ = {}, cliques_ = {};  // couple() begins anew
  }

 private:
  /// One system of three times the unknowns, each clique covering its blocks of all stages.
  void couple(const System& system) {
    if (system.comm->size > 1) throw Error("", "radau is serial", "run it without mpirun, or choose another time.integrator");
    if (system.traits().lumps_masses) throw Error("", "radau knows no point masses on flexible parts", "use [[body]] entries");
    const int n = system.n_blocks();
    std::vector<int> list;
    for (int e = 0; e < system.cliques.size(); ++e) {
      list.clear();
      for (int i = 0; i < 3; ++i)
        for (int block : system.cliques[e]) list.push_back(block < 0 ? -1 : block + i * n);
      cliques_.add(list);
    }
    for (int i = 0; i < 3 * n; ++i) map_.global.push_back(i);
    map_.n_owned = map_.n_global = 3 * n;
    whole_->structure(cliques_, map_);
    has_rates_ = system.traits().has_rates;
    b_.resize(9 * static_cast<size_t>(n)), z_.assign(b_.size(), 0.0);
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

  NewtonReport iterate(const System& system, const NewtonOptions& options) {
    NewtonReport report;
    const int n = 3 * system.n_blocks(), first = 3 * system.first_joint_block();
    if (h_ > 2 * kept_h_ || kept_h_ > 2 * h_) kept_ = false;
    const bool lagged = kept_;
    int built = 0;      // matrices in this step, iterations of Newton; those between are modified Newton
    bool full = false;  // Newton alone: the step is too far from linear for less
    double last = 0, last_residual = 0, now = wall_clock();  // of the iteration before with the same matrix
    const auto lap = [&](Phase& phase) {
      const double then = now;
      phase.seconds += (now = wall_clock()) - then;
    };
    for (;;) {
      const bool fresh = !kept_;
      evaluate(system, report);
      if (!std::isfinite(report.residual)) return report.reason = "the residual is not finite", report;
      if (fresh && ++built > options.max_iterations) {
        if (report.residual <= options.tolerance) break;
        return report.reason = "no convergence within the iterations allowed", report;
      }
      if (fresh) kept_ = true, kept_h_ = h_, rate_ = 1, excess_ = 0;
      // inertia and constraint rows are to the scale sigma, so that the matrix of another step length serves
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < n; ++k) b_[i * n + k] = -r_[i].r[k] * (kept_sigma_[i] / r_[i].sigma);
      lap(phases().assembly);
      const SolveReport solved = whole_->solve(b_, z_);
      lap(phases().solve), ++phases().solves;
      ++report.iterations;
      if (!solved.ok && fresh) return report.reason = whole_->name() + ": " + solved.message, report;
      const double correction = solved.ok ? largest_correction(system) : 1e300;
      // contraction: seen from the second iteration on, in residuals where corrections are at round-off
      double rate = fresh ? 1e-3 : std::clamp(2 * rate_, 0.1, 1.0);
      if (last > 0) rate = correction > 2e-15 ? correction / last : report.residual / last_residual;
      const bool settled = correction <= 1e-2 * options.tolerance;
      if (!fresh && !settled && !(correction < 1e-3 && (last == 0 || rate < 1))) {
        kept_ = false, full = built > 0, last = 0;  // it leads astray
        continue;
      }
      report.correction = correction;
      if (!(correction <= options.reach)) return report.reason = "the correction is not finite or leaves the scene", report;
      for (int i = 0; i < 3; ++i) {
        const std::span<const double> zi(z_.data() + i * n, n);
        u_[i].move(system, zi);
        for (size_t k = 0; k < lambda_[i].size(); ++k) lambda_[i][k] += r_[i].sigma * zi[first + k];
      }
      if (!fresh && last > 0) rate_ = rate;
      const double left = rate < 1 ? rate / (1 - rate) : 1e300, enough = sufficient(system, options.tolerance);
      if (left * correction <= enough && left * report.residual <= 1e-2 * options.tolerance) break;
      if (full ? settled : built && rate > 0.3 && (settled || report.residual <= options.tolerance)) break;  // round-off
      // a new matrix costs about five iterations
      if (last > 0 && (rate > 0.3 || std::log(left * correction / enough) > -5 * std::log(rate))) kept_ = false;
      if (built && last > 0 && rate > 0.3) full = true;
      if (full || correction > 1e-3) kept_ = false;
      last = kept_ ? correction : 0, last_residual = report.residual;
    }
    if (lagged && kept_ && (excess_ += std::max(0, report.iterations - 2)) >= 2) kept_ = false;
    report.converged = true;
    return report;
  }

  /// Residuals of the stages, and the matrix where none is at hand; the largest relative residual.
  void evaluate(const System& system, NewtonReport& report) {
    place();
    if (!kept_) whole_->zero();
    report.residual = 0;
    for (int i = 0; i < 3; ++i) {
      StageBlock block(*whole_, system, i, i, 1, r_[i].sigma);
      system.evaluate(stages_[i], lambda_[i], r_[i], kept_ ? nullptr : &block);
      system.mask_fixed(r_[i].r);
      const double x = relative_residual(system, r_[i]);
      if (!(x <= report.residual)) report.residual = x;  // keeps a NaN
      report.least_det.take(r_[i].least_det);
    }
    phases().evaluations += 3;
    if (kept_) return;
    add_coupling(system);
    phases().evaluations += 6, phases().tangents += 9;
    for (int i = 0; i < 3; ++i) kept_sigma_[i] = r_[i].sigma;
  }

  double largest_correction(const System& system) const {
    const size_t n = z_.size() / 3;
    double worst = 0;
    for (int i = 0; i < 3; ++i)
      if (const double x = relative_correction(system, {z_.data() + i * n, n}); !(x <= worst)) worst = x;
    return worst;
  }

  /// What may be left of positions, over the scene's length: round-off, unless the tolerance is loose; less where it would be seen in the
  /// accelerations, (W^2)_ii/h^2 times as large.
  double sufficient(const System& system, double tolerance) const {
    double force = 0, inertia = 0;
    for (const Residual& r : r_)
      force = std::max(force, r.force_scale), inertia = std::max(inertia, r.sigma * static_cast<double>(system.map.n_global));
    return std::max(2e-16, tolerance * std::min(1e-5, 10 * force / (inertia * system.length)));
  }

  /// Velocities, accelerations and stages of u_.
  void place() {
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

  void add_coupling(const System& system) {
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
        StageBlock block(*whole_, system, i, j, r_[i].sigma * W_(i, j) / W_(i, i), unused_.sigma);
        system.evaluate(s, lambda_[i], unused_, &block);
      }
  }

  Eigen::Matrix3d A_, W_;
  double c_[3], t_ = 0, h_ = 0;
  const System* system_ = nullptr;
  Predictor predictor_ = Predictor::hold;
  bool has_rates_ = false;  // something asks for rates of strain or of measures
  std::unique_ptr<SerialKktSolver> whole_;
  Cliques cliques_;
  BlockMap map_;
  bool tried_ = false;                              // the step solved last is not accepted yet
  bool kept_ = false;                               // the matrix at hand serves,
  double kept_h_ = 0, kept_sigma_[3]{}, rate_ = 1;  // built for this step length and these scales; how it contracted last
  int excess_ = 0;                                  // iterations that its age has cost
  Unknown u_[3];
  std::array<Extrapolation, 3> past_;
  std::vector<double> lambda_[3], missed_[3], reached_, b_, z_;
  Residual r_[3], unused_;
  Config guess_, zero_, a_end_, v0_, v_[3], a_[3], before_[3], after_[3], from_[3];
  GivenRates given_[3];
  Stage stages_[3];
  std::vector<Taken> taken_;
};

}  // namespace

std::unique_ptr<Integrator> Radau::make(const Entry&) { return make_radau(make_light_solver()); }

std::string Radau::weakness(const Entry&, const System& system) {
  return system.map.n_global > 5000 ? "all three stages are solved at once: 27 times the entries of the other methods" : "";
}

std::unique_ptr<Integrator> make_radau(std::unique_ptr<SerialKktSolver> solver) {
  return std::make_unique<RadauIntegrator>(std::move(solver));
}

}  // namespace hilo
