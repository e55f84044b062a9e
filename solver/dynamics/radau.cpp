// Radau IIA of three stages, order 5 in positions for index 3:
//   Q_i = q0 + h sum_j A_ij V_j,   V_i = v0 + h sum_j A_ij A_j,   equations of motion and g(Q_i) = 0 at every stage, q1 = Q_3, v1 = V_3
// With W = A^-1:  V_i = sum_j W_ij (Q_j - q0)/h,  A_i = sum_j W_ij (V_j - v0)/h; the stages couple through the mass alone.
#include <Eigen/Dense>
#include <cmath>

#include "base/error.hpp"
#include "dynamics/integrator.hpp"
#include "dynamics/profile.hpp"

namespace hilo {
namespace {

/// Takes the blocks of one evaluation into rows of stage `row` and columns of stage `column` of the coupled matrix.  Off the diagonal
/// only what couples positions counts, and rows that hold velocities, times share/`scale` of the evaluation: other constraints belong to
/// their own stage.
class StageBlock final : public KktSolver {
 public:
  StageBlock(SerialKktSolver& whole, const System& system, int row, int column, double share, const double& scale)
      : whole_(whole), system_(system), row_(row), column_(column), share_(share), scale_(scale) {
    for (const Connector& c : system.joints)
      for (int r = 0; r < 3 * ((c.n_rows() + 2) / 3); ++r)
        holds_velocity_.push_back(r >= c.n_position_rows() && r < c.n_rows() && c.active[r]);
  }
  void structure(const Cliques&, const BlockMap&) override {}
  void zero() override {}
  void add(int clique, const double* K) override {
    const auto blocks = system_.cliques[clique];
    const int n = static_cast<int>(blocks.size()), width = 3 * n, first_joint = system_.first_joint_block();
    const auto is_joint = [&](int i) { return blocks[i / 3] >= first_joint; };
    if (row_ != column_ && is_joint(width - 1)) {
      part_.assign(K, K + width * width);
      for (int i = 0; i < width; ++i) {
        const bool velocity = is_joint(i) && holds_velocity_[3 * (blocks[i / 3] - first_joint) + i % 3];
        for (int j = 0; j < width; ++j)
          if (is_joint(j) || (is_joint(i) && !velocity))
            part_[i * width + j] = 0;
          else if (velocity)
            part_[i * width + j] *= share_ / scale_;
      }
      K = part_.data();
    }
    whole_.add_part(clique, n * row_, n * column_, n, K);
  }
  void add_diagonal(int block, const double d[3]) override {
    if (row_ == column_) return whole_.add_diagonal(block + row_ * system_.n_blocks(), d);
    // held components are diagonal in their own stage; point masses are refused before
  }
  void sum_shared(std::span<double>) override {}
  SolveReport solve(std::span<const double>, std::span<double>, double) override { return {}; }
  std::string name() const override { return "stage block"; }

 private:
  SerialKktSolver& whole_;
  const System& system_;
  int row_, column_;
  double share_;
  const double& scale_;
  std::vector<char> holds_velocity_;  // (3 x joint blocks)
  std::vector<double> part_;
};

constexpr int most_excess = 5;

class Radau final : public Integrator {
 public:
  Radau() {
    const double s = std::sqrt(6.0);
    A_ << (88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225, (296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225,
        (16 - s) / 36, (16 + s) / 36, 1. / 9;
    W_ = A_.inverse();
    for (int i = 0; i < 3; ++i) c_[i] = A_.row(i).sum();
  }
  std::string name() const override { return "radau"; }
  std::span<const Taken> taken() const override { return taken_; }
  const Config& acceleration() const override { return a_[2]; }
  double own_time() const override { return 1; }

  NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) override {
    const System& system = *(system_ = &tools.system);
    if (!whole_) couple(system);
    taken_.resize(3);
    if (tried_) kept_ = false;  // the step before was refused: joint rows may have been chosen anew
    tried_ = true;
    t_ = s.t, h_ = h, v0_ = s.v, predictor_ = predictor;
    guess(system, s);
    const NewtonReport report = iterate(system, tools.newton);
    if (!report.converged) return kept_ = false, report;
    for (int i = 0; i < 3; ++i) {
      const std::vector<double> reached = u_[i].increments(system);
      for (size_t k = 0; k < reached.size(); ++k) missed_[i][k] = reached[k] - missed_[i][k];
      restore_rotations(system, u_[i].q);
    }
    place();
    for (int i = 0; i < 3; ++i) {
      combine(from_[i], {{1, &u_[i].q}, {-h_ * A_(2, i), &v_[i]}});  // quadrature of the work: weight times power at the stage
      taken_[i].stage = stages_[i], taken_[i].lambda = lambda_[i];
      taken_[i].stage.work_from = &from_[i];
    }
    return report;
  }

  void accept(State& s) override {
    tried_ = false;
    s.q = u_[2].q, s.v = v_[2], s.lambda = taken_[2].lambda, s.t = t_ + h_;
    for (int i = 0; i < 3; ++i)
      if (predictor_ == Predictor::rigid_rotation)
        past_[i].accept(*system_, h_, missed_[i], lambda_[i]);
      else
        past_[i].clear();
  }

  void restart() override {
    for (Extrapolation& p : past_) p.clear();
    kept_ = false;
  }

 private:
  void guess(const System& system, const State& s) {
    u_.clear();
    for (int i = 0; i < 3; ++i) {
      Config q = predict(system, s, c_[i] * h_, predictor_, {});  // straight: `past_` bends it
      system.prescribe(q, t_ + c_[i] * h_);
      u_.emplace_back(system, s.q, q);
      missed_[i] = u_[i].increments(system);
      lambda_[i] = s.lambda;
      if (predictor_ != Predictor::rigid_rotation) continue;
      if (const auto z = past_[i].increments(system, h_); !z.empty()) u_[i].shift(system, z);
      lambda_[i] = past_[i].multipliers(lambda_[i]);
    }
  }

  /// Residuals of the stages, and the matrix of all of them where the one at hand serves no more; the largest relative residual.
  void evaluate(const System& system, NewtonReport& report) {
    const Timed timed(phases().assembly);
    place();
    if (!kept_) whole_->zero();
    report.residual = 0;
    for (int i = 0; i < 3; ++i) {
      StageBlock block(*whole_, system, i, i, 1, r_[i].sigma);
      system.evaluate(stages_[i], lambda_[i], r_[i], kept_ ? nullptr : &block);
      system.mask_fixed(r_[i].r);
      const double x = relative_residual(system, r_[i]);
      if (!(x <= report.residual)) report.residual = x;  // keeps a NaN
      report.least_det = std::min(report.least_det, r_[i].least_det);
    }
    phases().evaluations += 3;
    if (kept_) return;
    add_coupling(system);
    phases().evaluations += 6, phases().tangents += 9;
    for (int i = 0; i < 3; ++i) kept_sigma_[i] = r_[i].sigma;
  }

  /// Simplified Newton [hairer-wanner-1996, IV.8]: the matrix stays while corrections with it fall fast.
  NewtonReport iterate(const System& system, const NewtonOptions& options) {
    NewtonReport report;
    const int n = 3 * system.n_blocks(), first = 3 * system.first_joint_block();
    b_.resize(3 * n), z_.resize(3 * n);
    if (kept_ && (excess_ >= most_excess || h_ > 2 * kept_h_ || kept_h_ > 2 * h_)) kept_ = false;
    const bool lagged = kept_;
    bool built = false;
    for (double last = 0, last_residual = 0;;) {
      const bool fresh = !kept_;
      evaluate(system, report);
      if (!std::isfinite(report.residual)) return report.reason = "the residual is not finite", report;
      if (report.residual <= 1e-5 * options.tolerance && report.iterations > 0) break;
      if (report.iterations == options.max_iterations) return report.reason = "no convergence within the iterations allowed", report;
      if (fresh) kept_ = built = true, kept_h_ = h_, rate_ = 1, excess_ = 0;
      // inertia and rows have the scale sigma, so that the matrix of another step length serves
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < n; ++k) b_[i * n + k] = -r_[i].r[k] * (kept_sigma_[i] / r_[i].sigma);
      const double start = wall_clock();
      const SolveReport solved = whole_->solve(b_, z_);
      phases().solve.seconds += wall_clock() - start, ++phases().solves;
      ++report.iterations;
      if (!solved.ok) {
        if (!fresh) {
          kept_ = false;
          continue;
        }
        return report.reason = whole_->name() + ": " + solved.message, report;
      }
      const double correction = largest_correction(system);
      double rate = fresh ? 1e-3 : std::clamp(2 * rate_, 0.1, 1.);          // of the first correction
      if (last > 0) rate = correction > 2e-15 ? correction / last : report.residual / last_residual;
      if (!fresh && last > 0 && !(rate < 1) && correction > 1e-2 * options.tolerance) {
        kept_ = false;
        continue;
      }
      report.correction = correction;
      if (!(report.correction < 1e3)) return report.reason = "the correction is not finite or leaves the scene", report;
      for (int i = 0; i < 3; ++i) {
        const std::span<const double> zi(z_.data() + i * n, n);
        u_[i].move(system, zi);
        for (size_t k = 0; k < lambda_[i].size(); ++k) lambda_[i][k] += r_[i].sigma * zi[first + k];
      }
      if (!fresh && last > 0) rate_ = rate;
      const double enough = sufficient(system, options.tolerance);
      const double left = rate < 1 ? rate / (1 - rate) : 1e300;  // of what remains, per what was
      const bool settled = correction <= 1e-2 * options.tolerance;
      if (getenv("RT")) fprintf(stderr, "   it %d %s res %.1e corr %.1e rate %.1e\n", report.iterations, fresh ? "fresh" : "kept", report.residual, correction, rate);
      if (left * correction <= enough && left * report.residual <= 1e-2 * options.tolerance) break;
      if (settled && built && rate > 0.3) break;  // round-off
      // more of the like than a new matrix costs?
      if (last > 0 && (rate > 0.3 || std::log(left * correction / enough) > -4 * std::log(rate))) kept_ = false;
      last = kept_ ? correction : 0, last_residual = report.residual;
    }
    if (lagged && kept_) excess_ += std::max(0, report.iterations - 2);
    report.converged = true;
    return report;
  }

  /// Correction of positions, over the scene's length, that counts no more: below round-off of accelerations to 1e-8 (at the usual
  /// tolerance), to which a position error of (W^2)_ii/h^2 times itself adds.
  double sufficient(const System& system, double tolerance) const {
    double force = 0, inertia = 0;
    for (const Residual& r : r_)
      force = std::max(force, r.force_scale), inertia = std::max(inertia, r.sigma * static_cast<double>(system.map.n_global));
    return std::max(2e-16, tolerance * std::min(1e-5, 10 * force / (inertia * system.length)));
  }

  double largest_correction(const System& system) const {
    const size_t n = z_.size() / 3;
    double worst = 0;
    for (int i = 0; i < 3; ++i) {
      const double x = relative_correction(system, {z_.data() + i * n, n});
      if (!(x <= worst)) worst = x;
    }
    return worst;
  }

  /// One system of three times the unknowns, each clique covering its blocks of all stages.
  void couple(const System& system) {
    if (system.comm->size > 1) throw Error("", "radau is serial", "run it without mpirun, or choose another time.integrator");
    if (!system.point_masses.empty()) throw Error("", "radau knows no point masses on flexible parts", "use [[body]] entries");
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
    whole_ = make_light_solver();
    whole_->structure(cliques_, map_);
    u_.reserve(3);
  }

  /// Velocities, accelerations and stages of u_.
  void place() {
    for (int i = 0; i < 3; ++i) combine(v_[i], {{W_(i, 0) / h_, &u_[0].dq}, {W_(i, 1) / h_, &u_[1].dq}, {W_(i, 2) / h_, &u_[2].dq}});
    for (int i = 0; i < 3; ++i) {
      const double sum = -W_.row(i).sum();
      combine(a_[i], {{W_(i, 0) / h_, &v_[0]}, {W_(i, 1) / h_, &v_[1]}, {W_(i, 2) / h_, &v_[2]}, {sum / h_, &v0_}});
      combine(before_[i], {{1, &u_[i].q}, {-h_ / 2, &v_[i]}});
      combine(after_[i], {{1, &u_[i].q}, {h_ / 2, &v_[i]}});
      Stage& s = stages_[i] = from_left(stage_at(u_[i].q, t_ + c_[i] * h_), h_);
      s.w0 = &before_[i], s.w1 = &after_[i], s.h = h_;
      s.a = &a_[i], s.mass_slope = (W_ * W_)(i, i) / (h_ * h_);
      s.v = &v_[i], s.alpha_slope = W_(i, i) / h_;
    }
  }

  void add_coupling(const System& system) {
    Config zero;
    combine(zero, {{0, &v0_}});
    const std::vector<double> none(3 * system.n_joint_blocks(), 0.0);
    Residual unused;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (i == j) continue;
        Stage s = stage_at(u_[i].q, t_);
        s.end = &u_[j].q, s.slope = 0, s.chain = 1e-30;  // the mass alone
        s.inertia_alone = true;
        s.a = &zero, s.mass_slope = (W_ * W_)(i, j) / (h_ * h_);
        s.v = &v_[i], s.alpha_slope = W_(i, j) / h_;
        // rows of velocities are over the slope, and have the scale, of their own stage
        StageBlock block(*whole_, system, i, j, r_[i].sigma * W_(i, j) / W_(i, i), unused.sigma);
        system.evaluate(s, none, unused, &block);
      }
  }

  Eigen::Matrix3d A_, W_;
  double c_[3], t_ = 0, h_ = 0;
  const System* system_ = nullptr;
  Predictor predictor_ = Predictor::hold;
  Extrapolation past_[3];
  std::vector<double> missed_[3], lambda_[3], b_, z_;
  Residual r_[3];
  bool tried_ = false, kept_ = false;  // the step solved last is not accepted yet; the matrix at hand serves
  double kept_h_ = 0, kept_sigma_[3]{}, rate_ = 0;
  int excess_ = 0;
  std::unique_ptr<SerialKktSolver> whole_;
  Cliques cliques_;
  BlockMap map_;
  std::vector<Unknown> u_;
  Config v0_, v_[3], a_[3], before_[3], after_[3], from_[3];
  Stage stages_[3];
  std::vector<Taken> taken_;
};

}  // namespace

std::unique_ptr<Integrator> make_radau() { return std::make_unique<Radau>(); }

}  // namespace hilo
