// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/start/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/linear_step.hpp"
#include "dynamics/redundancy/free_part.hpp"
#include "system/revising.hpp"

namespace hilo {
namespace {

/// A stage whose tangent is the mass matrix, bordered by the joint rows.
Stage mass_stage(const Config& q, const Config& zero, double t) {
  Stage s = stage_at(q, t);
  s.slope = 0, s.chain = 1e-30;  // leaves stiffness out of the sum
  s.a = &zero, s.mass_slope = 1;
  return s;
}

}  // namespace

double assemble_positions(System& system, KktSolver& solver, Config& q) {
  const Config placed = q;
  Config moved, zero;
  combine(zero, {{0, &q}});
  const int first = 3 * system.first_joint_block();
  std::vector<double> lambda(3 * system.n_joint_blocks(), 0.0), none(lambda.size(), 0.0), z(3 * system.n_blocks());
  Residual with, without;
  // Flexible parts resist, or the mass norm would shear the cells at the joint: M (q - placed)/tau^2 + f(q) - f(placed), with a tau far
  // above the periods at which they swing.  Bodies alone follow the mass norm, whatever springs are between them.
  const bool flexible = system.traits().deforms;
  const double tau = 3, largest_turn = flexible ? 0.1 : 0.5;  // [s], [rad]
  const auto stage_of = [&](const Config& at, const Config& a) {
    Stage s = mass_stage(at, a, 0);
    if (flexible) s.slope = s.chain = 1, s.mass_slope = 1 / (tau * tau);
    return s;
  };
  if (flexible) system.evaluate(stage_of(placed, zero), none, without, nullptr);
  const double enough = 1e-12 * std::max(1.0, system.length);
  bool done = false;
  for (int it = 0; it < 200 && !done; ++it) {
    // M (q - placed) + G^T lambda: what the displacement adds to the residual as an acceleration would
    const double factor = flexible ? 1 / (tau * tau) : 1;
    combine(moved, {{factor, &q}, {-factor, &placed}});
    system.evaluate(stage_of(q, moved), lambda, with, &solver);
    if (!flexible) system.evaluate(stage_of(q, zero), none, without, nullptr);
    for (int i = 0; i < first; ++i) with.r[i] -= without.r[i];
    complete(system, solver, with.r);
    const SolveReport solved = correct(solver, with.r, z);
    if (!solved.ok) break;
    double turn = 0, shift = 0;  // long turns are taken in parts
    for (const UnknownField& f : system.unknowns)
      for (size_t k = 0; k < f.size(); ++k) {
        double& most = f.turns() ? turn : shift;
        most = std::max(most, Eigen::Map<const Vec3>(z.data() + 3 * f.block(k)).norm());
      }
    turn = system.comm->max(turn), shift = system.comm->max(shift);
    if (!std::isfinite(turn + shift) || shift > 1e3 * system.length) break;
    const double share = turn > largest_turn ? largest_turn / turn : 1;
    for (double& x : z) x *= share;
    system.move(q, z);
    system.commit(q);
    for (size_t i = 0; i < lambda.size(); ++i) lambda[i] += with.sigma * z[first + i];
    done = system.violation(q, 0).worst() <= enough && (turn + shift / system.length < 1e-6 || (!flexible && it > 20));
  }
  if (!done) {
    double worst = 0, g[max_rows];
    std::string open;
    for (const auto& c : system.constraints()) {
      c->gaps(q, 0, 1, g);
      for (int r = 0; r < c->n_rows(); ++r)
        if (!(std::abs(g[r]) <= worst)) worst = std::abs(g[r]), open = c->label();
    }
    throw Error("", fmt::format("the joints cannot be put together at the start: {} stays apart by {:.3g}", open, worst),
                "check where the joints and bodies are placed, and what drives them at t = 0");
  }
  return system.largest_difference(q, placed);
}

namespace {

constexpr double exact = 1e-9;  // of a linear solve; one that leaves more, as CG does in single precision, is asked again for what is left
constexpr int most_solves = 5;

struct Reached {
  double change = 0;                 // the largest
  std::string why = {};              // masses and joints do not determine it
  std::vector<double> impulse = {};  // of the rows, laid out like multipliers; empty: none
};

void require(const std::string& why) {
  if (!why.empty()) throw Error("", why, "a part may have no mass or inertia");
}

/// Velocities go to the nearest ones, in the mass norm, that the rows allow: nearest to v - moved.  Without a solve where nothing moves
/// unless `even_at_rest`.  `by`: rates of rows change by that, instead of to zero.  `held`: the scale of the matrix of mass and rows
/// that the solver holds; 0: it is made.
Reached to_allowed(const System& system, KktSolver& solver, const Config& q, Config& v, Config moved, double t, bool even_at_rest,
                   std::span<const double> by = {}, double* held = nullptr) {
  Config zero;
  combine(zero, {{0, &v}});
  std::vector<double> lambda(3 * system.n_joint_blocks(), 0.0), none = lambda, b, z(3 * system.n_blocks(), 0.0), rate, at_start;
  const Config start = v;
  const int first = 3 * system.first_joint_block();
  double change = 0, left = 1, own = 0;
  double& sigma = held ? *held : own;
  for (int pass = 0; pass < most_solves && left > exact; ++pass) {
    b.assign(z.size(), 0.0);
    if (pass > 0 || even_at_rest || (system.moves() && by.empty())) {  // M moved + G^T lambda
      Residual r, without;
      Stage inertia = mass_stage(system.start, moved, t);  // without strain
      inertia.left = inertia.end = &q;
      inertia.rates_alone = pass == 0, inertia.load_factor = 0;
      system.evaluate(inertia, lambda, r, nullptr);
      inertia.a = &zero;
      without.r.assign(r.r.size(), 0.0);
      if (pass > 0 || system.traits().deforms) system.evaluate(inertia, none, without, nullptr);  // also the round-off of stiff cells
      for (int k = 0; k < first; ++k) b[k] = without.r[k] - r.r[k];
      complete(system, solver, b);
    }
    if (pass > 0 || by.empty()) {
      system.row_rates(q, v, nullptr, t, rate, nullptr);
      if (!by.empty()) system.row_rates(q, start, nullptr, t, at_start, nullptr);
    } else {
      rate.assign(by.size(), 0.0), at_start = rate;
    }
    for (size_t k = 0; k < by.size(); ++k) rate[k] -= at_start[k] + by[k];
    const auto is_zero = [](double x) { return x == 0; };
    if (pass == 0 && !even_at_rest &&
        system.comm->max(std::all_of(rate.begin(), rate.end(), is_zero) && std::all_of(b.begin(), b.end(), is_zero) ? 0 : 1) == 0)
      return {};
    if (pass == 0 && sigma == 0) {
      Residual r;
      system.evaluate(mass_stage(q, zero, 0), none, r, &solver);
      sigma = r.sigma;
    }
    const std::vector<char> on = system.rows_on();
    for (size_t k = 0; k < on.size(); ++k) b[first + k] = on[k] ? -sigma * rate[k] : 0;
    const SolveReport solved = solver.solve(b, z);
    if (!solved.ok)
      return {0, fmt::format("the joints and masses do not determine the motion: {}{}", solved.message, free_part(system, solver, sigma))};
    const double changed = system.comm->max(system.add_rates(v, q, z));
    if (pass == 0) change = changed;
    system.add_rates(moved, q, z);
    for (size_t k = 0; k < lambda.size(); ++k) lambda[k] += sigma * z[first + k];
    left *= solved.residual;
  }
  return {change, {}, std::move(lambda)};
}

Reached to_nearest(const System& system, KktSolver& solver, const Config& q, Config& v, double t) {
  Config given, moved;
  combine(given, {{0, &v}});
  system.prescribe_rates(t, Side::left, &given, nullptr);
  combine(moved, {{1, &given}, {-1, &v}});
  v = given;
  return to_allowed(system, solver, q, v, std::move(moved), t, true);
}

}  // namespace

double project_velocities(const System& system, KktSolver& solver, const Config& q, Config& v, double t) {
  Config moved = v;  // what moves by a law is felt by what shares mass with it
  system.prescribe_rates(t, Side::right, &v, nullptr);
  combine(moved, {{1, &v}, {-1, &moved}});
  const Reached reached = to_allowed(system, solver, q, v, std::move(moved), t, false);
  require(reached.why);
  return reached.change;
}

std::vector<double> change_rates(const System& system, KktSolver& solver, const Config& q, Config& v, double t, std::span<const double> by,
                                 double* sigma) {
  Config reached = v, zero;
  combine(zero, {{0, &v}});
  Reached there = to_allowed(system, solver, q, reached, std::move(zero), t, false, by, sigma);
  if (!there.why.empty()) return {};
  v = std::move(reached);
  return std::move(there.impulse);
}

void nearest_velocities(const System& system, KktSolver& solver, const Config& q, Config& v, double t) {
  require(to_nearest(system, solver, q, v, t).why);
}

namespace {

/// Where something has no inertia and nothing presses it, as a body without mass that spins about its hinge, the matrix is singular and
/// what else moves is determined: by a little more inertia everywhere, which then takes no part of the forces.  False where it does.
bool solve_beside_massless(const System& system, KktSolver& solver, const Stage& stage, std::span<const double> lambda, const Residual& r,
                           std::vector<double>& z) {
  constexpr double little = 1e-13, no_part = 1e-6;
  Residual same;
  assemble(system, solver, stage, lambda, same, true);
  const auto each = [&](const auto& visit) {
    for (const UnknownField& f : system.unknowns)
      for (size_t k = 0; k < f.size(); ++k)
        if (system.owns(f.block(k))) visit(f.block(k), little * r.sigma * f.scale(k) * f.scale(k));
  };
  each([&](int block, double more) {
    const double d[3] = {more, more, more};
    solver.add_diagonal(block, d);
  });
  if (!correct(solver, r.r, z).ok) return false;
  double part = 0, whole = 0;
  each([&](int block, double more) {
    for (int i = 3 * block; i < 3 * block + 3; ++i) part = std::max(part, std::abs(more * z[i])), whole = std::max(whole, std::abs(r.r[i]));
  });
  return system.comm->max(part) <= no_part * system.comm->max(whole);
}

/// The pair of the rate terms: measures are quadratic, so any time between its two gives the exact rate.
void add_rates(Stage& stage, const State& s, Config& before, Config& after) {
  constexpr double h = 1e-3;  // [s]
  combine(before, {{1, &s.q}, {-h / 2, &s.v}});
  combine(after, {{1, &s.q}, {h / 2, &s.v}});
  stage.w0 = &before, stage.w1 = &after, stage.h = h, stage.v = &s.v;
}

}  // namespace

Instant::Instant(const State& s, Config accelerations) : a(std::move(accelerations)), stage(stage_at(s.q, s.t)) {
  add_rates(stage, s, before, after);
  stage.a = &a;
}

std::string find_acceleration(const System& system, KktSolver& solver, const State& s, Config& a, std::vector<double>& lambda,
                              bool has_mass) {
  // guess: bodies that keep their spin, everything else unaccelerated; the solve adds the rest
  combine(a, {{0, &s.v}});
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size() && f.turns(); ++k) {
      const int b = f.item[k];
      const Mat3 S = s.v.R[b] * s.q.R[b].transpose(), W = (S - S.transpose()) / 2;
      a.R[b] = W * W * s.q.R[b];
    }
  for (const Modes& m : system.modes) {  // Y = eta R, eta unaccelerated
    const Mat3& R = s.q.R[m.body];
    const Mat3 S = s.v.R[m.body] * R.transpose(), W = (S - S.transpose()) / 2;
    for (int j = 3 * m.first; j < 3 * (m.first + m.n_blocks); ++j) {
      const double rate = (R.transpose() * (s.v.Y[j] - W * s.q.Y[j])).trace() / 3;
      a.Y[j] = W * W * s.q.Y[j] + 2 * rate * W * R;
      a.eta[j / 3][j % 3] = 0;
    }
  }
  system.follow(a);
  system.prescribe_rates(s.t, Side::right, nullptr, &a);
  lambda.assign(3 * system.n_joint_blocks(), 0.0);
  Stage stage = mass_stage(s.q, a, s.t);
  Config before, after;
  add_rates(stage, s, before, after);
  // linear in accelerations and multipliers, but for friction that the multipliers press: Newton then
  const bool pressed = system.traits().is_pressed;
  Residual r;
  std::vector<double> rate, acceleration, z;
  const int first = 3 * system.first_joint_block();
  double left = 1;
  for (int it = 0; it < (pressed ? 12 : most_solves) && left > exact; ++it) {
    assemble(system, solver, stage, lambda, r, pressed || (it == 0 && !has_mass));
    system.row_rates(s.q, s.v, &a, s.t, rate, &acceleration);  // rows: d2g/dt2 = 0
    const std::vector<char> on = system.rows_on();
    for (size_t i = 0; i < on.size(); ++i) r.r[first + i] = on[i] ? r.sigma * acceleration[i] : 0;
    const SolveReport solved = correct(solver, r.r, z);
    if (!solved.ok && !solve_beside_massless(system, solver, stage, lambda, r, z))
      return fmt::format("the joints and masses do not determine the accelerations: {}{}", solved.message,
                         free_part(system, solver, r.sigma));
    system.add_rates(a, s.q, z);
    double change = 0, size = 0;
    for (size_t i = 0; i < lambda.size(); ++i) {
      lambda[i] += r.sigma * z[first + i];
      change = std::max(change, std::abs(r.sigma * z[first + i])), size = std::max(size, std::abs(lambda[i]));
    }
    if (pressed ? change <= 1e-12 * size : !solved.ok) break;
    if (!pressed) left *= solved.residual;
  }
  return {};
}

void solve_acceleration(const System& system, KktSolver& solver, const State& s, Config& a, std::vector<double>& lambda, bool has_mass) {
  if (const std::string why = find_acceleration(system, solver, s, a, lambda, has_mass); !why.empty()) throw Error("", why);
}

namespace {

/// What of the jerk is no velocity that the joints allow; zero where these are not determined.
Config part_across(const System& system, KktSolver& solver, const State& s) {
  Config out, near;
  combine(out, {{1, &s.v}, {1, &s.jerk}});
  system.prescribe_rates(s.t, Side::left, &out, nullptr);
  near = out;
  if (!to_nearest(system, solver, s.q, near, s.t).why.empty()) near = out;
  combine(out, {{1, &out}, {-1, &near}});
  return out;
}

}  // namespace

void consistent_acceleration(const System& system, KktSolver& solver, State& s, double h) {
  solve_acceleration(system, solver, s, s.a, s.lambda);
  // no farther than differences mean anything: a step yet to be chosen may be far longer than the motion is smooth
  const double fast = system.largest_rate(s.a), speed = system.largest_rate(s.v);
  if (fast > 0) h = std::min(h, std::sqrt(2e-3 * system.length / fast));
  if (speed > 0) h = std::min(h, 0.1 * system.length / speed);
  // jerk by forward differences along q + tau v + tau^2/2 a, whose joints close to third order; forward, since a load may jump here
  State ahead[2];
  std::vector<double> unused;
  for (int k = 0; k < 2; ++k) {
    const double tau = (k + 1) * h;
    State& n = ahead[k];
    n.t = s.t + tau;
    combine(n.q, {{1, &s.q}, {tau, &s.v}, {tau * tau / 2, &s.a}});
    for (int i = 0; i < 3; ++i) restore_rotations(system, n.q);
    combine(n.v, {{1, &s.v}, {tau, &s.a}});
    system.prescribe(n.q, n.t);
    system.prescribe_rates(n.t, Side::right, &n.v, nullptr);
    solve_acceleration(system, solver, n, n.a, unused);
  }
  combine(s.snap, {{1 / (h * h), &ahead[1].a}, {-2 / (h * h), &ahead[0].a}, {1 / (h * h), &s.a}});
  combine(s.jerk, {{2 / h, &ahead[0].a}, {-0.5 / h, &ahead[1].a}, {-1.5 / h, &s.a}});
  // a curve rather than a line: the jerk is zero (from rest), or the motion is too fast for h, and no jerk is better than a wrong one
  Config change;
  combine(change, {{1, &ahead[1].a}, {-1, &s.a}});
  if (h * h * system.largest_rate(s.snap) > 0.25 * system.largest_rate(change)) combine(s.jerk, {{0, &s.jerk}});
  s.across = part_across(system, solver, s);
}

namespace {

using StageOf = std::function<Stage(const Config&)>;

/// What moves by a law takes the rest along: q (whose prescribed part is in its new place already) and the multipliers move by the tangent
/// at `before` under the loads of `own`, where nothing is strained by the first guess yet.  `stage` makes the stage of a configuration
/// under the loads to come.  `foreseen` receives the way; null: both loads are the same. Returns how.
std::optional<Correction> take_along(System& system, KktSolver& solver, const StageOf& own, const StageOf& stage, const Config& before,
                                     Config& q, std::vector<double>& lambda, std::optional<Config>* foreseen) {
  constexpr double little = 1e-3;  // of the way: the difference quotient is the tangent's columns of what is prescribed
  Residual at;
  system.evaluate(own(before), lambda, at, &solver);
  if (foreseen) system.evaluate(stage(before), lambda, at, nullptr);
  Config nudged;
  combine(nudged, {{1 - little, &before}, {little, &q}});
  system.place(nudged);
  Residual ahead;
  system.evaluate(stage(nudged), lambda, ahead, nullptr);
  for (size_t i = 0; i < at.r.size(); ++i) at.r[i] += (ahead.r[i] - at.r[i]) / little;
  std::vector<double> z;
  complete(system, solver, at.r);
  if (!correct(solver, at.r, z, 1e-6).ok) return {};
  Correction out{before, {}};
  combine(out.along, {{1, &q}, {-1, &before}});
  system.add_rates(out.along, before, z);
  if (foreseen) *foreseen = out.along;
  Unknown u(system, before, q);
  u.move(system, z);
  q = u.q;
  add_multipliers(system, at.sigma, z, lambda);
  return out;
}

}  // namespace

NewtonReport equilibrium(System& system, KktSolver& solver, Config& q, std::vector<double>& lambda, double t, double ramp, bool mechanism,
                         const NewtonOptions& options, LoadStep* step) {
  const Config before = q;
  system.prescribe(q, t, ramp);
  Config zero = q;
  combine(zero, {{0, &q}});
  double tau = 0.05;  // of the pseudo mass M/tau^2, grows
  const auto stage_under = [&](const Config& at, double time, double factor) {
    Stage s = stage_at(at, time);
    s.a = &zero;
    s.load_factor = factor, s.elapsed = slow;
    s.mass_slope = mechanism ? 1 / (tau * tau) : 0;
    return s;
  };
  const auto stage = [&](const Config& at) { return stage_under(at, t, ramp); };
  NewtonOptions o = options;
  o.foresees = !mechanism;
  if (mechanism) o.max_iterations = std::max(o.max_iterations, 200), o.patient = true;
  std::optional<Correction> taken;
  if (system.moves() && !mechanism) {
    const auto own = [&](const Config& at) { return step ? stage_under(at, step->t, step->ramp) : stage(at); };
    taken = take_along(system, solver, own, stage, before, q, lambda, step ? &step->foreseen : nullptr);
  }
  Unknown u(system, q, q);
  NewtonReport report = newton(
      system, solver,
      [&](const Unknown& at) {
        const Stage s = stage(at.q);
        if (mechanism) tau = std::min(tau * 1.3, 20.0);
        return s;
      },
      u, lambda, o, std::move(taken));
  q = u.q;
  if (report.least_det.det <= 0) report.converged = false, report.reason = system.inside_out(report.least_det);
  if (report.converged) system.commit(q);
  return report;
}

}  // namespace hilo
