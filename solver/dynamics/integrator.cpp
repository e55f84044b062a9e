// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator.hpp"

#include <array>
#include <cassert>
#include <type_traits>

namespace hilo {

void restore_rotations(const System& system, Config& q) {
  for (Mat3& R : q.R) R = R * (1.5 * Mat3::Identity() - 0.5 * R.transpose() * R);
  system.place(q);
}

void GivenRates::at(const System& system, double t, const Config& like) {
  system_ = system.moves() ? &system : nullptr;
  if (!system_) return;
  v_.resize_like(like), a_.resize_like(like);
  system.prescribe_rates(t, Side::left, &v_, &a_);
}

void GivenRates::mean_from(const Config& v0, double h) {
  if (system_) combine(a_, {{1 / h, &v_}, {-1 / h, &v0}});
}

void GivenRates::put(Config* v, Config* a) const {
  if (system_ && v) system_->copy_prescribed(v_, *v);
  if (system_ && a) system_->copy_prescribed(a_, *a);
}

NewtonReport StageIntegrator::solve(const StepTools& tools, const State& s, double h, Predictor predictor) {
  const System& system = *(system_ = &tools.system);
  NewtonReport all;
  all.reason = system.too_far(s.t, s.t + h);
  if (!all.reason.empty()) return all;
  const auto from = [&](const Config* more) -> const State& {
    if (!more) return s;
    begun_ = s;
    combine(begun_.v, {{1, &s.v}, {1, more}});
    return begun_;
  };
  const Config* more = laws_.begin(h);
  all = stages(tools, from(more), h, predictor);
  if (!all.converged || !mean_acceleration() || !system.traits().is_driven || system.n_joint_blocks() == 0) return all;
  Config v;
  end_velocity(v);
  if (laws_.end(system, tools.solver, s, h, solved_.back().q, v)) return all;
  tried_h_ = 0;
  NewtonReport once_more = stages(tools, from(laws_.again()), h, predictor);
  once_more.iterations += all.iterations, once_more.linear_iterations += all.linear_iterations;
  if (!once_more.converged) return once_more;
  end_velocity(v);
  laws_.end(system, tools.solver, s, h, solved_.back().q, v);
  return once_more;
}

NewtonReport StageIntegrator::stages(const StepTools& tools, const State& s, double h, Predictor predictor) {
  const System& system = tools.system;
  NewtonReport all;
  begin(system, s, h);
  h_ = h, predictor_ = predictor, lambda_ = s.lambda;
  solved_.clear(), solved_.reserve(n_stages());
  missed_.resize(n_stages()), past_.resize(n_stages());
  taken_.resize(n_stages());
  all.converged = true;
  for (int k = 0; k < n_stages(); ++k) {
    const double dt = instant(k) * h;
    Config guess;
    predict(system, s, dt, predictor, {}, guess);  // straight: `past_` bends it
    system.prescribe(guess, s.t + dt);
    solved_.emplace_back(system, s.q, guess);
    missed_[k] = solved_[k].increments(system);
    if (predictor == Predictor::rigid_rotation) {
      if (const auto z = past_[k].increments(system, h); !z.empty()) solved_[k].shift(system, z);
      lambda_ = past_[k].multipliers(lambda_);
    }
    if (k == 0 && is_tried(system, h)) {
      all.converged = false;
      return all;
    }
    const NewtonReport r = newton(
        system, tools.solver, [&](const Unknown& u) { return from_left(stage(k, u), h); }, solved_[k], lambda_, tools.newton);
    all.iterations += r.iterations, all.linear_iterations += r.linear_iterations;
    all.correction = r.correction, all.residual = r.residual;
    all.left += r.left, all.gaps = r.gaps;
    all.least_det.take(r.least_det);
    if (!r.converged) {
      all.converged = false, all.reason = r.reason;
      return all;
    }
    const std::vector<double> increments = solved_[k].increments(system);
    restore_rotations(system, solved_[k].q);
    taken_[k] = {from_left(stage(k, solved_[k]), h), lambda_};
    for (size_t i = 0; i < missed_[k].size(); ++i) missed_[k][i] = increments[i] - missed_[k][i];
    taken_[k].stage.work_from = k == 0 ? &solved_[0].q0 : &solved_[k - 1].q;
    taken_[k].stage.span = (k + 1 == n_stages() ? 1 : instant(k)) * h - (k == 0 ? 0 : instant(k - 1)) * h;
  }
  return all;
}

/// Whether a step of this length was tried from this guess, within a thousandth, since one was accepted.
bool StageIntegrator::is_tried(const System& system, double h) {
  std::vector<double> guess = solved_[0].increments(system), other = guess;
  const bool comparable = h == tried_h_ && tried_.size() == guess.size();
  for (size_t i = 0; comparable && i < other.size(); ++i) other[i] -= tried_[i];
  tried_ = std::move(guess), tried_h_ = h;
  return comparable && size_of(system, other) <= 1e-3 * size_of(system, tried_);
}

void StageIntegrator::end(State& s) {
  end_velocity(s.v);
  if (const Config* more = laws_.at_end()) combine(s.v, {{1, &s.v}, {1, more}});
  s.q = solved_.back().q, s.lambda = lambda_;
}

void StageIntegrator::accept(State& s) {
  end(s);
  if (Config* a = mean_acceleration()) laws_.add_to(taken_.back().lambda, *a, h_);
  finish(s.v);
  laws_.accept();
  for (int k = 0; k < n_stages(); ++k)
    if (predictor_ == Predictor::rigid_rotation)
      past_[k].accept(*system_, h_, std::move(missed_[k]), k + 1 == n_stages() ? lambda_ : taken_[k].lambda);
    else  // what another guess missed says nothing of this one
      past_[k].clear();
  s.t += h_, tried_h_ = 0;
}

void combine(Config& out, std::initializer_list<std::pair<double, const Config*>> terms) {
  constexpr size_t most = 8;
  assert(terms.size() <= most);
  const auto* t = terms.begin();
  Config::each_array([&](auto member) {
    const auto& first = t->second->*member;
    const size_t n = first.size() * std::remove_cvref_t<decltype(first)>::value_type::SizeAtCompileTime;
    (out.*member).resize(first.size());
    if (n == 0) return;
    double* to = (out.*member)[0].data();
    std::array<const double*, most> from;
    for (size_t k = 0; k < terms.size(); ++k) from[k] = (t[k].second->*member)[0].data();
    const auto sum = [&](auto n_terms) {  // number by number: `out` may be one of the terms
      for (size_t i = 0; i < n; ++i) {
        double value = t[0].first * from[0][i];
        for (size_t k = 1; k < n_terms; ++k) value += t[k].first * from[k][i];
        to[i] = value;
      }
    };
    terms.size() == 1   ? sum(std::integral_constant<size_t, 1>())
    : terms.size() == 2 ? sum(std::integral_constant<size_t, 2>())
                        : sum(terms.size());
  });
}

}  // namespace hilo
