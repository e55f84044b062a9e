// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/whirl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "dynamics/modes/quadratic_span.hpp"
#include "dynamics/modes/rigid_motions.hpp"
#include "dynamics/modes/turning_frame.hpp"
#include "dynamics/start/start.hpp"
#include "system/collocation.hpp"
#include "system/uneven.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Complex = std::complex<double>;

/// What the spin adds to the equations of a pose, as it is seen from a frame.
class SpinTerms : AboutState {
 public:
  SpinTerms(const System& system, KktSolver& solver, const State& state, const TurningFrame& frame)
      : AboutState(system, solver, state), frame_(frame), inertia_(system, solver, state) {
    inertia_.mean_omega2();
  }
  /// Way of a point by a unit of a motion.
  double largest_of(const Vector& x) const { return system_.largest_rate(rates(state_.q, x)); }
  /// What it adds to C x and K x: of z = P(t) x with P' = P J, z' = P (x' + J x), z'' = P (x'' + 2 J x' + J J x).
  std::pair<Vector, Vector> of(const Vector& x) const {
    const auto [C, K, standing] = column_of(x);
    return in_frame(x, C, K);
  }

  struct Terms {
    Matrix M, C, K;   // what moving adds
    Matrix standing;  // K of the pose itself
    Vector force;     // that nothing balances
  };
  Terms on(const Matrix& basis) const {
    const Index m = basis.cols();
    Terms out{Matrix(m, m), Matrix(m, m), Matrix(m, m), Matrix(m, m), Vector(m)};
    for (Index j = 0; j < m; ++j) {
      const Column column = column_of(basis.col(j));
      const auto [C, K] = in_frame(basis.col(j), column.C, column.K);
      out.M.col(j) = basis.transpose() * inertia_.mass(basis.col(j));
      out.K.col(j) = basis.transpose() * K, out.C.col(j) = basis.transpose() * C;
      out.standing.col(j) = basis.transpose() * column.standing;
    }
    const Vector none = Vector::Zero(n_);
    const auto [still, moving] = residual(none, none);
    out.force = basis.transpose() * (still + moving);
    return out;
  }

 private:
  static constexpr double step = 1e-4;
  struct Column {
    Vector C, K, standing;
  };
  Column column_of(const Vector& direction) const {
    const double way = largest_of(direction);
    if (way == 0) return {Vector::Zero(n_), Vector::Zero(n_), Vector::Zero(n_)};
    const double by = step * system_.length / way;
    const Vector x = direction * by, none = Vector::Zero(n_);
    const auto [still, moving] = residual(x, none);
    const auto [still_back, moving_back] = residual(-x, none);
    const Vector C = residual(none, x).second - residual(none, -x).second;
    return {C / (2 * by), (moving - moving_back) / (2 * by), (still - still_back) / (2 * by)};
  }
  std::pair<Vector, Vector> in_frame(const Vector& x, const Vector& C, const Vector& K) const {
    if (frame_.stands()) return {C, K};
    const Vector y = frame_.across(x);
    return {C + 2 * inertia_.mass(y), K + column_of(y).C + inertia_.mass(frame_.across(y))};
  }
  /// The residual at increments z, and what moving and accelerating add to it where they change with z'.
  std::pair<Vector, Vector> residual(const Vector& z, const Vector& rate) const {
    Config q = state_.q, v = state_.v, a = state_.a;
    const std::vector<double> by = padded(z), at = padded(rate);
    system_.move(q, by);
    for (const UnknownField& f : system_.unknowns)
      for (size_t k = 0; k < f.size() && f.turns(); ++k) {
        const int b = f.item[k];
        const Mat3 turn = cayley(Eigen::Map<const Vec3>(by.data() + 3 * f.block(k)));
        const Mat3 w = skew(Eigen::Map<const Vec3>(at.data() + 3 * f.block(k)));
        v.R[b] = turn * state_.v.R[b], a.R[b] = turn * state_.a.R[b] + 2 * w * v.R[b];
      }
    system_.add_rates(v, q, at);
    system_.follow(a);
    Config before, after;
    const double h = 1e-3;  // measures are quadratic, so any h gives the exact rate
    combine(before, {{1, &q}, {-h / 2, &v}});
    combine(after, {{1, &q}, {h / 2, &v}});
    Stage s = stage_at(q, state_.t);
    s.a = &zero_;
    Residual still, moving;
    system_.evaluate(s, state_.lambda, still, nullptr);
    s.a = &a, s.w0 = &before, s.w1 = &after, s.h = h, s.v = &v, s.no_impacts = true;
    system_.evaluate(s, state_.lambda, moving, nullptr);
    for (size_t i = 0; i < moving.r.size(); ++i) moving.r[i] -= still.r[i];
    return {free_part(still.r), free_part(moving.r)};
  }

  const TurningFrame& frame_;
  Linearized inertia_;
};

/// The state a while later, what spins turned further; nothing where the spin does not go on as it is.
std::optional<State> later(const System& system, KktSolver& solver, const State& state) {
  State out = state;
  const std::vector<Vec3> spin = spins(system, state.q, state.v);
  for (size_t b = 0; b < spin.size(); ++b) {
    const Mat3 turn = turned_further(spin[b], spin);
    for (auto* of : {&out.q, &out.v, &out.a}) of->R[b] = turn * of->R[b];
  }
  system.place(out.q), system.follow(out.v), system.follow(out.a);
  Config a;
  if (!find_acceleration(system, solver, out, a, out.lambda).empty()) return {};
  return out;
}

/// Whether inertia, stiffness, damping and forces are later what they are, seen from the frame.
bool is_even(const System& system, KktSolver& solver, const State& state, const State& then, const TurningFrame& frame,
             const std::vector<FoundMode>& basis, const Matrix& shapes) {
  const SpinTerms now(system, solver, state, frame);
  const SpinTerms::Terms here = now.on(shapes), further = SpinTerms(system, solver, then, frame).on(frame.turned(shapes));
  double largest = here.C.squaredNorm(), slowest = 1e300;
  for (const FoundMode& mode : basis) largest = std::max(largest, std::abs(mode.figures.omega2));
  for (const FoundMode& mode : basis)
    if (!mode.is_rigid) slowest = std::min(slowest, std::abs(mode.figures.omega2));
  const Index m = here.C.rows();
  Vector omega(m);  // by which entries are judged: a slow mode is not to hide behind fast ones
  for (Index j = 0; j < m; ++j)
    omega[j] = std::sqrt(
        std::max({std::abs(basis[static_cast<size_t>(j)].figures.omega2), here.C.row(j).squaredNorm(), std::min(slowest, largest)}));
  const Matrix K = further.K + further.standing - here.K - here.standing, C = further.C - here.C;
  const Vector unit = omega.cwiseInverse();
  bool is_even = !((unit.asDiagonal() * K * unit.asDiagonal()).cwiseAbs().maxCoeff() > 1e-5) &&
                 !((unit.cwiseSqrt().asDiagonal() * C * unit.cwiseSqrt().asDiagonal()).cwiseAbs().maxCoeff() > 1e-5) &&
                 !((further.M - here.M).cwiseAbs().maxCoeff() > 1e-5);
  for (Index j = 0; j < m; ++j) {
    const double away = std::abs(further.force[j] - here.force[j]) * unit[j] * unit[j] * now.largest_of(shapes.col(j));
    is_even = is_even && !(away > 1e-4 * system.length);
  }
  return is_even;
}

/// The frame in which coefficients are constant: that of space, or where what spins carries joints one that turns along.
TurningFrame steady_frame(const System& system, KktSolver& solver, const State& state, const std::vector<FoundMode>& basis) {
  Matrix shapes(std::ssize(basis.front().x), std::ssize(basis));
  for (size_t j = 0; j < basis.size(); ++j) shapes.col(static_cast<Index>(j)) = Eigen::Map<const Vector>(basis[j].x.data(), shapes.rows());
  const std::optional<State> then = later(system, solver, state);
  const auto serves = [&](const TurningFrame& frame) { return then && is_even(system, solver, state, *then, frame, basis, shapes); };
  std::vector<TurningFrame> frames = turning_frames(system, state);
  const std::string turns = then ? frames.front().broken_row(system, then->q, shapes) : "";
  if (turns.empty()) {
    if (serves(frames.front())) return frames.front();
    const std::string who = who_is_uneven(system, state.q, state.v);
    throw Error(
        "", "what turns is not the same all around: its frequencies change as it turns" + (who.empty() ? "" : "; " + who),
        "give bodies that spin two equal moments of inertia, and springs that hold them at points of their axes, unlike stiffnesses to "
        "what stands (a = \"ground\")");
  }
  for (size_t k = 1; k < frames.size(); ++k)
    if (frames[k].broken_row(system, then->q, shapes).empty() && serves(frames[k])) {
      warn("modes", fmt::format("{} turns with what spins: frequencies and effective masses are those seen from what spins", turns));
      return frames[k];
    }
  throw Error(
      "", fmt::format("{} turns with what spins, and what stands is not the same all around: its frequencies change as it turns", turns),
      "let gravity act along the axis of the spin, and springs to what stands be alike across it; or run it in time");
}

}  // namespace

std::string not_steady(const System& system, const State& state) {
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k)
      if (!f.turns() && (state.v.*f.array)[f.item[k]].norm() > 1e-9 * system.largest_rate(state.v)) return "something moves along";
  const std::vector<Vec3> spin = spins(system, state.q, state.v);
  for (const Modes& m : system.modes)
    if (spin[static_cast<size_t>(m.body)].norm() > 0) return fmt::format("linear region \"{}\" turns", system.bodies[m.body].name);
  for (size_t b = 0; b < state.q.R.size(); ++b) {
    if (spin[b].norm() == 0) continue;
    const Mat3 W = state.v.R[b] * state.q.R[b].transpose(), A = state.a.R[b] * state.q.R[b].transpose();
    if ((A - W * W).norm() > 1e-6 * W.squaredNorm())
      return fmt::format("body \"{}\" does not turn at a constant rate", system.bodies[b].name);
  }
  return {};
}

std::vector<FoundMode> whirling_modes(const System& system, KktSolver& solver, const State& state, const std::vector<FoundMode>& basis,
                                      int wanted) {
  if (basis.empty()) return {};
  const TurningFrame frame = steady_frame(system, solver, state, basis);
  const SpinTerms spin(system, solver, state, frame);
  double shift = 1e300;
  for (const FoundMode& mode : basis)
    if (!mode.is_rigid) shift = std::min(shift, std::abs(mode.figures.omega2) / 2);
  if (shift == 1e300) shift = std::pow(system.largest_rate(state.v) / system.length, 2);
  Linearized at(system, solver, state);
  at.mean_omega2();
  at.factor(shift);
  QuadraticSpan span(at, shift, basis, [&](const Vector& x) { return spin.of(x); });
  const auto swings = [](const Complex& s) { return s.imag() > 1e-7 * std::abs(s); };
  const auto slowest = [&](const Poles& poles) {
    std::vector<size_t> out;
    for (size_t i = 0; i < poles.value.size(); ++i)
      if (const Complex s = poles.value[i]; std::abs(s) > 1e-5 * std::sqrt(shift) && (swings(s) || s.real() > 0)) out.push_back(i);
    std::ranges::sort(out, {}, [&](size_t i) { return std::abs(poles.value[i]); });
    out.resize(std::min(out.size(), static_cast<size_t>(wanted)));
    return out;
  };
  const Poles poles = span.settle(slowest);
  const Index n = poles.shape.rows();
  const RigidMotions rigid(system, at, state.q);
  Eigen::Matrix<double, Eigen::Dynamic, 6> parts(n, 6);
  for (Index j = 0; j < n; ++j) parts.row(j) = rigid.part_of(span.basis().col(j)).transpose();
  std::vector<FoundMode> out;
  for (const size_t i : slowest(poles)) {
    const Complex s = poles.value[i];
    Eigen::VectorXcd y = poles.shape.col(static_cast<Index>(i));
    const Eigen::VectorXcd z = poles.left.col(static_cast<Index>(i));
    Index most = 0;
    y.cwiseAbs().maxCoeff(&most);
    y *= std::conj(y[most]) / std::abs(y[most]);  // its largest share at its turning point
    FoundMode f;
    f.is_real = false;
    const Vector x = span.basis().leftCols(n) * y.real(), mu = span.multipliers().leftCols(n) * y.real();
    f.x.assign(x.begin(), x.end()), f.mu.assign(mu.begin(), mu.end());
    f.figures.error = poles.error[i];
    for (const FoundMode& mode : basis) f.figures.error = std::max(f.figures.error, mode.figures.error);
    f.figures.omega2 = swings(s) ? s.imag() * s.imag() : -s.real() * s.real();
    f.figures.pole2 = swings(s) ? std::norm(s) : f.figures.omega2;
    f.figures.damping = swings(s) ? -s.real() / std::abs(s) : 0;
    // with p the parts of the basis, p.(s^2 M + s C + K)^-1 p = sum of r/(s - mu) over all poles, and the sum of r mu is p.M^-1 p
    const Complex slope = (z.transpose() * (2.0 * s * (poles.M * y) + poles.C * y)).value();
    for (int k = 0; k < 6; ++k)
      f.figures.mass[k] =
          (swings(s) ? 2 : 1) * (s * (y.transpose() * parts.col(k)).value() * (z.transpose() * parts.col(k)).value() / slope).real();
    out.push_back(std::move(f));
  }
  return out;
}

}  // namespace hilo
