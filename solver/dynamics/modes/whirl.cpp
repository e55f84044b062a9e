// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/whirl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "dynamics/modes/quadratic_span.hpp"
#include "dynamics/modes/rigid_motions.hpp"
#include "system/collocation.hpp"
#include "system/uneven.hpp"

namespace hilo {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Complex = std::complex<double>;

/// What the spin adds to the equations, in coordinates of the basis.
class SpinTerms : AboutState {
 public:
  SpinTerms(const System& system, KktSolver& solver, const State& state, const std::vector<FoundMode>& basis)
      : AboutState(system, solver, state) {
    basis_.resize(n_, static_cast<Eigen::Index>(basis.size()));
    for (size_t j = 0; j < basis.size(); ++j) basis_.col(static_cast<Eigen::Index>(j)) = Eigen::Map<const Vector>(basis[j].x.data(), n_);
  }
  /// Way of a point by a unit of a mode.
  double largest_of(Eigen::Index j) const { return system_.largest_rate(rates(state_.q, basis_.col(j))); }
  /// What it adds to C x and K x.
  std::pair<Vector, Vector> of(const Vector& x) const {
    const Column column = column_of(state_.q, state_.v, state_.a, x);
    return {column.C, column.K};
  }

  struct Terms {
    Matrix C, K;      // what moving adds
    Matrix standing;  // K of the pose itself
    Vector force;     // that nothing balances
  };
  /// At the pose that the bodies have after a turn by `angle` more.
  Terms at(double angle) const {
    Config q = state_.q, v = state_.v, a = state_.a;
    for (size_t b = 0; b < q.R.size(); ++b) {
      const Mat3 S = state_.v.R[b] * state_.q.R[b].transpose();
      const Vec3 w = axial(S);
      if (w.norm() == 0) continue;
      const Mat3 turn = Eigen::AngleAxisd(angle, w.normalized()).toRotationMatrix();
      for (auto* of : {&q, &v, &a}) of->R[b] = turn * of->R[b];
    }
    const Eigen::Index m = basis_.cols();
    Terms out{Matrix(m, m), Matrix(m, m), Matrix(m, m), Vector(m)};
    for (Eigen::Index j = 0; j < m; ++j) {
      const Column column = column_of(q, v, a, basis_.col(j));
      out.K.col(j) = basis_.transpose() * column.K, out.C.col(j) = basis_.transpose() * column.C;
      out.standing.col(j) = basis_.transpose() * column.standing;
    }
    const Vector none = Vector::Zero(n_);
    const auto [still, moving] = residual(q, v, a, none, none);
    out.force = basis_.transpose() * (still + moving);
    return out;
  }

 private:
  static constexpr double step = 1e-4;
  struct Column {
    Vector C, K, standing;
  };
  Column column_of(const Config& q, const Config& v, const Config& a, const Vector& direction) const {
    const double by = step / std::max(1e-300, system_.largest_rate(rates(q, direction)) / system_.length);
    const Vector x = direction * by, none = Vector::Zero(n_);
    const auto [still, moving] = residual(q, v, a, x, none);
    const auto [still_back, moving_back] = residual(q, v, a, -x, none);
    const Vector C = residual(q, v, a, none, x).second - residual(q, v, a, none, -x).second;
    return {C / (2 * by), (moving - moving_back) / (2 * by), (still - still_back) / (2 * by)};
  }
  /// The residual at increments z, and what moving and accelerating add to it where they change with z'.
  std::pair<Vector, Vector> residual(const Config& q0, const Config& v0, const Config& a0, const Vector& z, const Vector& rate) const {
    Config q = q0, v = v0, a = a0;
    const std::vector<double> by = padded(z), at = padded(rate);
    system_.move(q, by);
    for (const UnknownField& f : system_.unknowns)
      for (size_t k = 0; k < f.size() && f.turns(); ++k) {
        const int b = f.item[k];
        const Mat3 turn = cayley(Eigen::Map<const Vec3>(by.data() + 3 * f.block(k)));
        const Mat3 w = skew(Eigen::Map<const Vec3>(at.data() + 3 * f.block(k)));
        v.R[b] = turn * v0.R[b], a.R[b] = turn * a0.R[b] + 2 * w * v.R[b];
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
    s.a = &a, s.w0 = &before, s.w1 = &after, s.h = h, s.v = &v;
    system_.evaluate(s, state_.lambda, moving, nullptr);
    for (size_t i = 0; i < moving.r.size(); ++i) moving.r[i] -= still.r[i];
    return {free_part(still.r), free_part(moving.r)};
  }

  Matrix basis_;
};

/// Error where stiffness, damping or forces at another angle of the spin are others.
void refuse_uneven(const System& system, const State& state, const SpinTerms& spin, const std::vector<FoundMode>& basis) {
  const SpinTerms::Terms here = spin.at(0), further = spin.at(1);
  double largest = here.C.squaredNorm(), slowest = 1e300;
  for (const FoundMode& mode : basis) largest = std::max(largest, std::abs(mode.figures.omega2));
  for (const FoundMode& mode : basis)
    if (!mode.is_rigid) slowest = std::min(slowest, std::abs(mode.figures.omega2));
  const Eigen::Index m = here.C.rows();
  Vector omega(m);  // by which entries are judged: a slow mode is not to hide behind fast ones
  for (Eigen::Index j = 0; j < m; ++j)
    omega[j] = std::sqrt(
        std::max({std::abs(basis[static_cast<size_t>(j)].figures.omega2), here.C.row(j).squaredNorm(), std::min(slowest, largest)}));
  const Matrix K = further.K + further.standing - here.K - here.standing, C = further.C - here.C;
  const Vector unit = omega.cwiseInverse();
  bool is_uneven = (unit.asDiagonal() * K * unit.asDiagonal()).cwiseAbs().maxCoeff() > 1e-5 ||
                   (unit.cwiseSqrt().asDiagonal() * C * unit.cwiseSqrt().asDiagonal()).cwiseAbs().maxCoeff() > 1e-5;
  for (Eigen::Index j = 0; j < m; ++j) {
    const double away = std::abs(further.force[j] - here.force[j]) * unit[j] * unit[j] * spin.largest_of(j);
    is_uneven = is_uneven || away > 1e-4 * system.length;
  }
  if (!is_uneven) return;
  const std::string who = who_is_uneven(system, state.q, state.v);
  throw Error(
      "", "what turns is not the same all around: its frequencies change as it turns" + (who.empty() ? "" : "; " + who),
      "give bodies that spin two equal moments of inertia, and springs that hold them at points of their axes, unlike stiffnesses to "
      "what stands (a = \"ground\")");
}

}  // namespace

std::string not_steady(const System& system, const State& state) {
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k)
      if (!f.turns() && (state.v.*f.array)[f.item[k]].norm() > 1e-9 * system.largest_rate(state.v)) return "something moves along";
  for (const Modes& m : system.modes)
    if (state.v.R[m.body].norm() > 0) return fmt::format("linear region \"{}\" turns", system.bodies[m.body].name);
  for (size_t b = 0; b < state.q.R.size(); ++b) {
    const Mat3 W = state.v.R[b] * state.q.R[b].transpose(), A = state.a.R[b] * state.q.R[b].transpose();
    if ((A - W * W).norm() > 1e-6 * W.squaredNorm())
      return fmt::format("body \"{}\" does not turn at a constant rate", system.bodies[b].name);
  }
  return {};
}

std::vector<FoundMode> whirling_modes(const System& system, KktSolver& solver, const State& state, const std::vector<FoundMode>& basis,
                                      int wanted) {
  const SpinTerms spin(system, solver, state, basis);
  refuse_uneven(system, state, spin, basis);
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
  const Eigen::Index n = poles.shape.rows();
  const RigidMotions rigid(system, at, state.q);
  Eigen::Matrix<double, Eigen::Dynamic, 6> parts(n, 6);
  for (Eigen::Index j = 0; j < n; ++j) parts.row(j) = rigid.part_of(span.basis().col(j)).transpose();
  std::vector<FoundMode> out;
  for (const size_t i : slowest(poles)) {
    const Complex s = poles.value[i];
    Eigen::VectorXcd y = poles.shape.col(static_cast<Eigen::Index>(i));
    const Eigen::VectorXcd z = poles.left.col(static_cast<Eigen::Index>(i));
    Eigen::Index most = 0;
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
