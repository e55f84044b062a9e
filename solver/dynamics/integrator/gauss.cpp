// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss collocation of three stages, order 6, with rates in the rows:
//   Q_i = q0 + h sum_j a_ij V_j,   V_i = v0 + h sum_j a_ij A_j,   q1 = q0 + h sum_i b_i V_i,   v1 = v0 + h sum_i b_i A_i
//   M A_i + B(Q_i)^T S_i + G(Q_i)^T lambda_i = F(t_i),   G(Q_i) V_i = 0
// with S_i at the strains E_i = e(q0) + h sum_j a_ij G_e(Q_j) V_j (system/collocation).  Gauss keeps what is of degree two in (q, v, e):
// energy, both momenta and g(q) = 0; one stage is the energy-momentum method.
//
// Directors: R_i' = w_i x R_i, so that R_i = R0 + sum_j a_ij skew(h w_j) R_j, which is linear in R, and R1 is orthonormal to round-off; the
// R_i are not.  An increment turns R_i by the block's vector to first order: the angular velocities move as sum_j W_ij dR_j - skew dR_i.
#include "model/integrator/gauss.hpp"

#include <Eigen/LU>
#include <cmath>

#include "base/error.hpp"
#include "dynamics/integrator/coupled_stages.hpp"
#include "dynamics/integrator/director_columns.hpp"
#include "dynamics/integrator/given_stages.hpp"
#include "dynamics/integrator/make.hpp"
#include "dynamics/integrator/stage_directors.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/start/start.hpp"
#include "system/collocation.hpp"

namespace hilo {
namespace {

Eigen::Matrix3d gauss_tableau() {
  const double s = std::sqrt(15.0);
  Eigen::Matrix3d A;
  A << 5. / 36, 2. / 9 - s / 15, 5. / 36 - s / 30, 5. / 36 + s / 24, 2. / 9, 5. / 36 - s / 24, 5. / 36 + s / 30, 2. / 9 + s / 15, 5. / 36;
  return A;
}
constexpr double weight[3] = {5. / 18, 4. / 9, 5. / 18};

/// Takes the place of the tableau where one matrix serves all stages: an iteration shrinks the error of an oscillation to .253 or less at
/// any step.
Eigen::Matrix3d triangular() {
  const double d = 0.1945;
  Eigen::Matrix3d T;
  T << d, 0, 0, 0.3192, d, 0, 0.0086, 0.3425, d;
  return T;
}

class GaussIntegrator final : public CoupledStages {
 public:
  explicit GaussIntegrator(std::unique_ptr<SerialKktSolver> solver) : CoupledStages(std::move(solver), gauss_tableau()) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) step_.a[i][j] = A_(i, j);
      step_.b[i] = weight[i], step_.c[i] = c_[i];
    }
  }
  std::string name() const override { return std::string(Gauss::name); }
  int order() const override { return 6; }
  std::span<const Taken> taken() const override { return taken_; }
  const Config& acceleration() const override { return a_end_; }
  const Config* velocity() const override { return &v_end_; }
  double own_time() const override { return 1; }
  Besides besides() const override { return besides_; }

  NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) override {
    const System& system = *(system_ = &tools.system);
    if (NewtonReport refused; !(refused.reason = system.too_far(s.t, s.t + h)).empty()) return refused;
    if (s.t == refused_t_ && h == refused_h_) return {};  // whatever the guess
    begin(system, s.t, h);
    q0_ = s.q, v0_ = s.v;
    step_.t = s.t, step_.h = h, step_.start = &q0_;
    predictor_ = predictor;
    NewtonReport report;
    if (!given_.find(system, step_, A_, q0_, v0_)) return report.reason = "a motion turns too far in a step", report;
    if (coupled_steps_ == 0) {
      is_coupled_ = false, guess(system, s);
      report = iterate_triangular(system, tools.solver, triangular(), tools.newton);
    }
    if (!report.converged && system.modes.empty() && system.comm->size == 1) {
      // for some steps, since what made it hard seldom passes at once
      coupled_steps_ = coupled_steps_ == 0 ? 8 : coupled_steps_ - 1;
      const int before = report.iterations;
      is_coupled_ = true, guess(system, s);
      report = iterate(system, tools.newton);
      report.iterations += before;
    }
    if (!report.converged) return drop_matrix(), report;
    place(system);
    combine(q1_, {{1, &q0_}, {weight[0], &way_[0]}, {weight[1], &way_[1]}, {weight[2], &way_[2]}});
    given_.put_end(q1_);
    restore_rotations(system, q1_);
    combine(v1_, {{1, &v0_}, {h * weight[0], &a_[0]}, {h * weight[1], &a_[1]}, {h * weight[2], &a_[2]}});
    if (!end_solver_) end_solver_ = tools.another_solver();
    if (!settle_velocities()) {
      refused_t_ = s.t, refused_h_ = h;
      report.converged = false, report.reason = "a step this long leaves the joints too much of the kinetic energy";
      return report;
    }
    take();
    return report;
  }

  void end(State& s) override { s.q = q1_, s.v = v1_, s.lambda = taken_.back().lambda; }

  /// Accelerations and multipliers at the end, at velocities that the joints allow: those of the stages are of lower order.
  void accept(State& s) override {
    State at{.t = end_time(), .q = q1_, .v = v_end_, .a = {}, .jerk = {}, .snap = {}, .across = {}, .lambda = {}};
    solve_acceleration(*system_, *end_solver_, at, a_end_, taken_.back().lambda, true);
    if (given_.any()) system_->prescribe_rates(t_ + h_, Side::left, nullptr, &a_end_), system_->follow(a_end_);
    end(s), accepted();
    most_kinetic_ = kinetic_;
    s.t = t_ + h_;
    for (int i = 0; i < 3; ++i) {
      past_a_[i] = a_[i], past_lambda_[i] = lambda_[i];
      for (size_t k = 0; k < lambda_[i].size(); ++k) guessed_[i][k] = lambda_[i][k] - guessed_[i][k];
      increments(*system_, i, reached_);
      for (size_t k = 0; k < reached_.size(); ++k) missed_[i][k] = reached_[k] - missed_[i][k];
      if (predictor_ == Predictor::rigid_rotation && past_h_ > 0)
        missed_before_[i].accept(*system_, h_, std::move(missed_[i]), std::move(guessed_[i]));
      else  // what another guess missed says nothing of this one
        missed_before_[i].clear();
    }
    past_h_ = h_;
  }

  void restart() override {
    for (Extrapolation& e : missed_before_) e.clear();
    drop_matrix(), past_h_ = 0;
  }

  void carry(const Carry& carry) override {
    for (int i = 0; i < 3; ++i) past_lambda_[i] = carry(past_lambda_[i]), missed_before_[i].carry(carry);
    forget_structure(), end_solver_.reset();
  }

  void archive(Archive& a, const System&) override {
    a(name(), past_h_, past_a_, past_lambda_, missed_before_, coupled_steps_, most_kinetic_);
    forget_structure(), end_solver_.reset();
  }

 private:
  /// The polynomials of the step before go on; without one, constant velocities, or none.
  void guess(const System& system, const State& s) {
    const bool goes_on = past_h_ > 0 && predictor_ == Predictor::rigid_rotation;
    double x[3][3];  // values at the stages of the step before, continued to those of this one
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        x[i][j] = 1;
        for (int k = 0; k < 3 && goes_on; ++k)
          if (k != j) x[i][j] *= (1 + c_[i] * h_ / past_h_ - c_[k]) / (c_[j] - c_[k]);
      }
    const auto sum = [&](const double* f, auto& out, const auto& in) {
      for (size_t k = 0; k < out.size(); ++k) out[k] = f[0] * in[0][k] + f[1] * in[1][k] + f[2] * in[2][k];
    };
    for (int i = 0; i < 3; ++i) {
      lambda_[i] = s.lambda;
      if (goes_on) sum(x[i], lambda_[i], past_lambda_);
      if (goes_on) combine(a_[i], {{x[i][0], &past_a_[0]}, {x[i][1], &past_a_[1]}, {x[i][2], &past_a_[2]}});
    }
    for (int i = 0; i < 3; ++i) {
      combine(way_[i], {{predictor_ == Predictor::hold ? 0 : h_, &v0_}});
      const double f = h_ * h_;
      if (goes_on) combine(way_[i], {{1, &way_[i]}, {f * A_(i, 0), &a_[0]}, {f * A_(i, 1), &a_[1]}, {f * A_(i, 2), &a_[2]}});
    }
    for (int i = 0; i < 3; ++i) {
      combine(dq_[i], {{A_(i, 0), &way_[0]}, {A_(i, 1), &way_[1]}, {A_(i, 2), &way_[2]}});
      turn_[i].resize(q0_.R.size());
      for (size_t b = 0; b < q0_.R.size(); ++b)
        turn_[i][b] = axial(way_[i].R[b] * (goes_on ? Mat3(q0_.R[b] + dq_[i].R[b]) : q0_.R[b]).inverse());
    }
    for (int i = 0; i < 3; ++i) {
      given_.put(i, dq_[i], turn_[i]);
      increments(system, i, missed_[i]);
      if (const auto z = missed_before_[i].increments(system, h_); goes_on && !z.empty()) shift(system, i, z);
      guessed_[i] = lambda_[i];
      if (!goes_on) continue;
      const std::vector<double> more = missed_before_[i].multipliers(std::vector<double>(lambda_[i].size(), 0.0));
      for (size_t k = 0; k < more.size(); ++k) lambda_[i][k] += more[k];
    }
    place_directors(system);
  }

  /// The unknowns of stage i (3 x blocks of nodes and bodies): increments from the start, and h w of bodies.
  void increments(const System& system, int i, std::vector<double>& out) const {
    out.assign(3 * static_cast<size_t>(system.first_joint_block()), 0.0);
    for (const UnknownField& f : system.unknowns)
      for (size_t k = 0; k < f.size(); ++k)
        Eigen::Map<Vec3>(out.data() + 3 * f.block(k)) = f.turns() ? turn_[i][f.item[k]] : (dq_[i].*f.array)[f.item[k]];
  }
  void shift(const System& system, int i, std::span<const double> z) {
    for (const UnknownField& f : system.unknowns)
      for (size_t k = 0; k < f.size(); ++k)
        (f.turns() ? turn_[i][f.item[k]] : (dq_[i].*f.array)[f.item[k]]) += Eigen::Map<const Vec3>(z.data() + 3 * f.block(k));
  }

  void move(const System& system, std::span<const double> z) override {
    const size_t n = z.size() / 3;
    const auto of = [&](int i, int block) { return Eigen::Map<const Vec3>(z.data() + i * n + 3 * block); };
    for (const UnknownField& f : system.unknowns)
      for (size_t k = 0; k < f.size(); ++k) {
        const int item = f.item[k];
        if (!f.turns()) {
          for (int i = 0; i < 3; ++i) (dq_[i].*f.array)[item] += of(i, f.block(k));
          continue;
        }
        Vec9 turned;
        for (int i = 0; i < 3; ++i) turned.segment<3>(3 * i) = of(i, f.block(k));
        const StageDirectors directors = directors_of(item);
        const std::array<Mat3, 3> R = {q_[0].R[item], q_[1].R[item], q_[2].R[item]};
        const Vec9 change = is_coupled_ ? directors.spins(R, turned) : directors.nearly_spins(R, turned);
        for (int i = 0; i < 3; ++i) turn_[i][item] += change.segment<3>(3 * i);
      }
    place_directors(system);
  }

  void evaluate(const System& system, SerialKktSolver* whole) override {
    for (int i = 0; i < 3; ++i) system.evaluate(stages_[i], lambda_[i], r_[i], nullptr);
    phases().evaluations += 3;
    if (!whole) return;
    const auto moves = [&](int b) { return directors_of(b).moves_by_turns({q_[0].R[b], q_[1].R[b], q_[2].R[b]}); };
    tangent_.add(system, *whole, stages_, lambda_, r_, W_, moves);
  }

  StageDirectors directors_of(int b) const { return {A_, {turn_[0][b], turn_[1][b], turn_[2][b]}}; }

  /// Directors of the stages from the angular velocities, and the products of amplitudes and directors, Y' = w x Y + eta' R^-T, for which
  /// R^T Y = eta I is kept.
  void place_directors(const System& system) {
    for (const UnknownField& f : system.unknowns)
      for (size_t k = 0; k < f.size() && f.turns(); ++k) {
        const int b = f.item[k];
        const auto dR = directors_of(b).grow(q0_.R[b]);
        for (int i = 0; i < 3; ++i) dq_[i].R[b] = dR[i];
      }
    for (const Modes& m : system.modes)
      for (int y = 3 * m.first; y < 3 * (m.first + m.n_blocks); ++y) {
        std::array<Mat3, 3> more;
        for (int i = 0; i < 3; ++i) more[i] = way_of_amplitude(i, y) * upright(i, m.body);
        const auto dY = directors_of(m.body).grow(q0_.Y[y], &more);
        for (int i = 0; i < 3; ++i) dq_[i].Y[y] = dY[i];
      }
    for (int i = 0; i < 3; ++i) {
      system.follow(dq_[i]);
      combine(q_[i], {{1, &q0_}, {1, &dq_[i]}});
    }
  }
  double way_of_amplitude(int i, int y) const {
    double sum = 0;
    for (int j = 0; j < 3; ++j) sum += W_(i, j) * dq_[j].eta[y / 3][y % 3];
    return sum;
  }
  /// R^-T.
  Mat3 upright(int i, int b) const { return (q0_.R[b] + dq_[i].R[b]).inverse().transpose(); }

  void place(const System& system) override {
    for (int i = 0; i < 3; ++i) {
      combine(way_[i], {{W_(i, 0), &dq_[0]}, {W_(i, 1), &dq_[1]}, {W_(i, 2), &dq_[2]}});
      for (size_t b = 0; b < turn_[i].size(); ++b) way_[i].R[b] = skew(turn_[i][b]) * q_[i].R[b];
      for (const Modes& m : system.modes)
        for (int y = 3 * m.first; y < 3 * (m.first + m.n_blocks); ++y)
          way_[i].Y[y] = skew(turn_[i][m.body]) * q_[i].Y[y] + way_of_amplitude(i, y) * upright(i, m.body);
      system.follow(way_[i]);
      combine(v_[i], {{1 / h_, &way_[i]}});
      combine(before_[i], {{1, &q_[i]}, {-0.5, &way_[i]}}), combine(after_[i], {{1, &q_[i]}, {0.5, &way_[i]}});
      step_.before[i] = &before_[i], step_.after[i] = &after_[i];
    }
    for (int i = 0; i < 3; ++i) {
      const double f = 1 / (h_ * h_);
      combine(a_[i], {{f * W_(i, 0), &way_[0]}, {f * W_(i, 1), &way_[1]}, {f * W_(i, 2), &way_[2]}, {-W_.row(i).sum() / h_, &v0_}});
      stages_[i] = stage(q_[i], v_[i], a_[i], before_[i], after_[i], t_ + c_[i] * h_);
      stages_[i].mass_slope = f * (W_ * W_)(i, i), stages_[i].alpha_slope = W_(i, i) / h_;
      stages_[i].step = &step_, stages_[i].member = i;
    }
  }

  Stage stage(const Config& q, const Config& v, const Config& a, const Config& before, const Config& after, double t) const {
    Stage s = stage_at(q, t);
    s.w0 = &before, s.w1 = &after, s.h = h_;
    s.a = &a, s.v = &v;
    return s;
  }

  void around(const Config& q, const Config& v, Config& before, Config& after) const {
    combine(before, {{1, &q}, {-h_ / 2, &v}}), combine(after, {{1, &q}, {h_ / 2, &v}});
  }

  double end_time() const { return t_ + h_ - 3 * system_->same_time; }  // before what jumps there

  /// The joints allow v_end; v1 has a part w besides, orthogonal in the mass norm, which is of order h^4, alternates from step to step and
  /// has its energy from the motion.  Where it is no longer small, it goes, and its energy with it [ascher-petzold-1991]; false where it is
  /// large.
  bool settle_velocities() {
    besides_ = {};
    if (given_.any()) besides_.work = -system_->energy(q1_, v1_).kinetic;
    given_.put_rates(v1_);
    if (given_.any()) besides_.work += system_->energy(q1_, v1_).kinetic;
    v_end_ = v1_;
    nearest_velocities(*system_, *end_solver_, q1_, v_end_, end_time());
    given_.put_rates(v_end_);
    Config w;
    combine(w, {{1, &v1_}, {-1, &v_end_}});
    const Energy now = system_->energy(q1_, v1_);
    const double kinetic = now.kinetic, besides = system_->energy(q1_, w).kinetic;
    kinetic_ = std::max({kinetic, system_->energy(q_[1], v_[1]).kinetic, most_kinetic_});
    if (besides > small_besides * kinetic) besides_.dissipated = kinetic - system_->energy(q1_, v_end_).kinetic, v1_ = v_end_;
    return besides <= large_besides * kinetic_ + round_off * (std::abs(now.elastic) + std::abs(now.gravity));  // what rests has no other
  }

  /// The stages with what they stand for in the work of the step, and its end, which stands for nothing, for reactions.
  void take() {
    taken_.resize(4);
    for (int i = 0; i < 3; ++i) {
      combine(from_[i], {{1, &q_[i]}, {-weight[i], &way_[i]}});
      taken_[i] = {stages_[i], lambda_[i]};
      taken_[i].stage.work_from = &from_[i], taken_[i].stage.span = h_ * weight[i];
    }
    a_end_ = a_[2], around(q1_, v_end_, before_end_, after_end_);
    taken_[3] = {from_left(stage(q1_, v_end_, a_end_, before_end_, after_end_, t_ + h_), h_), lambda_[2]};
    taken_[3].stage.work_from = &q1_, taken_[3].stage.span = 1e-200;
  }

  static constexpr double small_besides = 1e-8, large_besides = 1e-3, round_off = 1e-12;  // of the kinetic energy; of the others
  Besides besides_;                                                                       // of the step solved last
  double kinetic_ = 0, most_kinetic_ = 0;  // the largest so far, without the step solved last [J]
  double refused_t_ = -1, refused_h_ = 0;  // for losing too much
  const System* system_ = nullptr;
  std::unique_ptr<KktSolver> end_solver_;  // of accelerations at the end: the other one keeps its matrix
  bool is_coupled_ = false;                // the matrix of all stages is at work
  int coupled_steps_ = 0;                  // so many more with the matrix of all stages
  Collocation step_;
  Config q0_, v0_, q1_, v1_, a_end_, v_end_, before_end_, after_end_;
  std::array<Config, 3> dq_, q_, way_, v_, a_, before_, after_, from_, past_a_;  // way: h V
  std::array<std::vector<double>, 3> past_lambda_;
  std::array<std::vector<Vec3>, 3> turn_;  // h w of each body
  CoupledTangent tangent_;
  GivenStages given_;
  Predictor predictor_ = Predictor::hold;  // of the step solved last
  std::array<Extrapolation, 3> missed_before_;
  std::array<std::vector<double>, 3> missed_, guessed_;  // by the first guess; multipliers of the polynomials, and what these missed
  std::vector<double> reached_;
  double past_h_ = 0;  // 0: no step before
  std::vector<Taken> taken_;
};

}  // namespace

std::unique_ptr<Integrator> Gauss::make(const Entry&) { return make_gauss(make_light_solver()); }

std::string Gauss::weakness(const Entry&, const System& system) {
  return system.layout.map.n_global > 5000 && system.modes.empty() && system.comm->size == 1
             ? "a step whose iteration does not converge is solved with all three stages at once, 27 times the entries of other methods"
             : "";
}

std::unique_ptr<Integrator> make_gauss(std::unique_ptr<SerialKktSolver> solver) {
  return std::make_unique<GaussIntegrator>(std::move(solver));
}

}  // namespace hilo
