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
  StageBlock(KktSolver& whole, const System& system, int row, int column, double share, const double& scale)
      : whole_(whole), system_(system), row_(row), column_(column), share_(share), scale_(scale) {
    for (const Connector& c : system.joints)
      for (int r = 0; r < 3 * ((c.n_rows() + 2) / 3); ++r)
        holds_velocity_.push_back(r >= c.n_position_rows() && r < c.n_rows() && c.active[r]);
  }
  void structure(const Cliques&, const BlockMap&) override {}
  void zero() override {}
  void add(int clique, const double* K) override {
    const auto blocks = system_.cliques[clique];
    const int n = static_cast<int>(blocks.size()), width = 9 * n, first_joint = system_.first_joint_block();
    dense_.assign(static_cast<size_t>(width) * width, 0.0);
    for (int i = 0; i < 3 * n; ++i)
      for (int j = 0; j < 3 * n; ++j) {
        const bool velocity = blocks[i / 3] >= first_joint && holds_velocity_[3 * (blocks[i / 3] - first_joint) + i % 3];
        if (row_ == column_ || ((blocks[i / 3] < first_joint || velocity) && blocks[j / 3] < first_joint))
          dense_[static_cast<size_t>(3 * n * row_ + i) * width + 3 * n * column_ + j] =
              (row_ != column_ && velocity ? share_ / scale_ : 1) * K[i * 3 * n + j];
      }
    whole_.add(clique, dense_.data());
  }
  void add_diagonal(int block, const double d[3]) override {
    if (row_ == column_) return whole_.add_diagonal(block + row_ * system_.n_blocks(), d);
    // held components are diagonal in their own stage; point masses are refused before
  }
  void sum_shared(std::span<double>) override {}
  SolveReport solve(std::span<const double>, std::span<double>, double) override { return {}; }
  std::string name() const override { return "stage block"; }

 private:
  KktSolver& whole_;
  const System& system_;
  int row_, column_;
  double share_;
  const double& scale_;
  std::vector<char> holds_velocity_;  // (3 x joint blocks)
  std::vector<double> dense_;
};

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
    const System& system = tools.system;
    if (!whole_) couple(system);
    t_ = s.t, h_ = h, v0_ = s.v;
    std::vector<double> lambda[3];
    u_.clear(), u_.reserve(3);
    for (int i = 0; i < 3; ++i) {
      Config guess = predict(system, s, c_[i] * h, predictor, a_[2]);
      system.prescribe(guess, t_ + c_[i] * h);
      u_.emplace_back(system, s.q, guess);
      lambda[i] = s.lambda;
    }
    NewtonReport report;
    const int n = 3 * system.n_blocks(), first = 3 * system.first_joint_block();
    Residual r[3];
    std::vector<double> b(3 * n), z(3 * n);
    for (;;) {
      whole_->zero();
      const double start = wall_clock();
      place();
      report.residual = 0;
      for (int i = 0; i < 3; ++i) {
        StageBlock block(*whole_, system, i, i, 1, r[i].sigma);
        system.evaluate(stages_[i], lambda[i], r[i], &block);
        system.mask_fixed(r[i].r);
        report.residual = std::max(report.residual, relative_residual(system, r[i]));
        report.least_det = std::min(report.least_det, r[i].least_det);
        for (int k = 0; k < n; ++k) b[i * n + k] = -r[i].r[k];
      }
      if (!std::isfinite(report.residual)) return report.reason = "the residual is not finite", report;
      if (report.residual <= tools.newton.tolerance && report.iterations > 0) break;
      if (report.iterations == tools.newton.max_iterations) return report.reason = "no convergence within the iterations allowed", report;
      add_coupling(system, r);
      const double assembled = wall_clock();
      phases().assembly.seconds += assembled - start, phases().evaluations += 9, phases().tangents += 9;
      const SolveReport solved = whole_->solve(b, z);
      phases().solve.seconds += wall_clock() - assembled, ++phases().solves;
      ++report.iterations;
      if (!solved.ok) return report.reason = whole_->name() + ": " + solved.message, report;
      report.correction = 0;
      for (int i = 0; i < 3; ++i) {
        const std::span<const double> zi(z.data() + i * n, n);
        report.correction = std::max(report.correction, relative_correction(system, zi));
        if (!(report.correction < 1e3)) return report.reason = "the correction is not finite or leaves the scene", report;
        u_[i].move(system, zi);
        for (size_t k = 0; k < lambda[i].size(); ++k) lambda[i][k] += r[i].sigma * zi[first + k];
      }
      if (report.correction <= tools.newton.tolerance * 1e-2) break;
    }
    report.converged = true;
    for (Unknown& u : u_) restore_rotations(system, u.q);
    place();
    taken_.resize(3);
    for (int i = 0; i < 3; ++i) {
      combine(from_[i], {{1, &u_[i].q}, {-h_ * A_(2, i), &v_[i]}});  // quadrature of the work: weight times power at the stage
      taken_[i] = {stages_[i], lambda[i]};
      taken_[i].stage.work_from = &from_[i];
    }
    return report;
  }

  void accept(State& s) override { s.q = u_[2].q, s.v = v_[2], s.lambda = taken_[2].lambda, s.t = t_ + h_; }

 private:
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

  void add_coupling(const System& system, const Residual* r) {
    Config zero;
    combine(zero, {{0, &v0_}});
    const std::vector<double> none(3 * system.n_joint_blocks(), 0.0);
    Residual unused;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (i == j) continue;
        Stage s = stage_at(u_[i].q, t_);
        s.end = &u_[j].q, s.slope = 0, s.chain = 1e-30;  // the mass alone
        s.a = &zero, s.mass_slope = (W_ * W_)(i, j) / (h_ * h_);
        s.v = &v_[i], s.alpha_slope = W_(i, j) / h_;
        // rows of velocities are over the slope, and have the scale, of their own stage
        StageBlock block(*whole_, system, i, j, r[i].sigma * W_(i, j) / W_(i, i), unused.sigma);
        system.evaluate(s, none, unused, &block);
      }
  }

  Eigen::Matrix3d A_, W_;
  double c_[3], t_ = 0, h_ = 0;
  std::unique_ptr<KktSolver> whole_;
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
