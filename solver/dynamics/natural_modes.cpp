// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/natural_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "dynamics/about_state.hpp"
#include "dynamics/start.hpp"
#include "linear/block_krylov.hpp"

namespace hilo {
namespace {

using Vector = Eigen::VectorXd;

/// Products with K and M about a state, and with the inverse of K + s M on the motions that joints and supports allow.
class Linearized : AboutState {
 public:
  Linearized(const System& system, KktSolver& solver, const State& rest)
      : AboutState(system, solver, rest), none_(rest.lambda.size(), 0.0), base_mass_(mass_residual(zero_)) {}
  Eigen::Index n() const { return n_; }

  /// Forces of inertia.  Accelerations are taken so large that the rounding of stiff cells, which is in the residual too, is small beside.
  Vector mass_of(const Config& acceleration) const {
    const double factor = typical_acceleration_ / std::max(1e-300, system_.largest_rate(acceleration));
    Config a;
    combine(a, {{factor, &acceleration}});
    return (mass_residual(a) - base_mass_) / factor;
  }
  Vector mass(const Vector& x) const { return mass_of(rates(state_.q, x)); }
  /// The mean of the squared frequencies, most of them of single cells.
  double mean_omega2() {
    std::mt19937_64 random{7};
    std::normal_distribution<double> normal;
    Vector x(n_);
    double mean = 0;
    for (double& value : x) value = normal(random);
    for (int twice = 0; twice < 2; ++twice) {
      mean = std::abs(x.dot(stiffness(x)) / x.dot(mass(x)));
      if (!std::isfinite(mean) || mean == 0) mean = 1;
      typical_acceleration_ = std::max(mean, 1.0) * system_.length;
    }
    return mean;
  }

  /// About K x, by differences of the residual between a little motion to either side.
  Vector stiffness(const Vector& x) const {
    const double step = 1e-5 * system_.length / std::max(1e-300, system_.largest_rate(rates(state_.q, x)));
    Vector out[2];
    for (const int side : {0, 1}) {
      const double by = side == 0 ? -step : step;
      Config q = state_.q;
      const std::vector<double> z = padded(x * by);
      system_.move(q, z);
      Residual r;
      system_.evaluate(stage(q), state_.lambda, r, nullptr);
      out[side] = free_part(r.r);
    }
    return (out[1] - out[0]) / (2 * step);
  }

  /// C x, by rates too small for friction to slip.
  Vector damping(const Vector& x) const {
    const double speed = 1e-6 * system_.length / std::max(1e-300, system_.largest_rate(rates(state_.q, x))), h = 1e-3;
    Vector out[2];
    for (const int moving : {0, 1}) {
      const Config v = rates(state_.q, x * (moving ? speed : 0));
      Config before, after;
      combine(before, {{1, &state_.q}, {-h / 2, &v}});
      combine(after, {{1, &state_.q}, {h / 2, &v}});
      Stage s = stage(state_.q);
      s.w0 = &before, s.w1 = &after, s.h = h, s.v = &v;
      Residual r;
      system_.evaluate(s, state_.lambda, r, nullptr);
      out[moving] = free_part(r.r);
    }
    return (out[1] - out[0]) / speed;
  }

  /// K + s M becomes the matrix of the solver.
  void factor(double shift) {
    Stage s = stage(state_.q);
    s.mass_slope = shift;
    Residual r;
    system_.evaluate(s, state_.lambda, r, &solver_);
    sigma_ = r.sigma;
  }
  /// Motion and multipliers under the forces b; what is left of the equations, over |b|.
  double solve(const Vector& b, Vector& x, std::vector<double>* mu = nullptr) const {
    std::vector<double> rhs = padded(b), z(rhs.size(), 0.0);
    const SolveReport report = solver_.solve(rhs, z);
    if (!report.ok) throw Error("", "no modes: " + report.message, "a part may have neither mass nor support");
    x = Eigen::Map<const Vector>(z.data(), n_);
    if (mu) mu->assign(z.begin() + n_, z.end());
    for (size_t i = 0; mu && i < mu->size(); ++i) (*mu)[i] *= sigma_;
    return report.residual;
  }

 private:
  Stage stage(const Config& q) const {
    Stage s = stage_at(q, state_.t);
    s.a = &zero_;
    return s;
  }
  Vector mass_residual(const Config& acceleration) const {
    Stage s = stage_at(system_.start, state_.t);
    s.left = s.end = &state_.q;
    s.slope = 0, s.chain = 1e-30;  // without stiffness
    s.a = &acceleration, s.mass_slope = 1;
    s.rates_alone = true, s.load_factor = 0;
    Residual r;
    system_.evaluate(s, none_, r, nullptr);
    return free_part(r.r);
  }
  std::vector<double> none_;
  Vector base_mass_;
  double sigma_ = 1, typical_acceleration_ = 1;
};

/// Motions of the whole scene as one rigid body, along x, y, z and about axes through the origin: what the unknowns do (n x 6), and the
/// forces of inertia of everything that moves along.
struct RigidMotions {
  Eigen::MatrixXd x, force;
  RigidMotions(const System& system, const Linearized& at, const Config& q) : x(at.n(), 6), force(at.n(), 6) {
    x.setZero();
    Config v;
    for (int k = 0; k < 6; ++k) {
      const Vec3 e = Vec3::Unit(k % 3);
      const auto moved = [&](const Vec3& p) { return k < 3 ? e : Vec3(e.cross(p)); };
      const Mat3 spin = k < 3 ? Mat3(Mat3::Zero()) : skew(e);
      combine(v, {{0, &q}});
      for (size_t i = 0; i < q.x.size(); ++i) v.x[i] = moved(q.x[i]);
      for (size_t b = 0; b < q.c.size(); ++b) v.c[b] = moved(q.c[b]), v.R[b] = spin * q.R[b];
      for (size_t j = 0; j < q.Y.size(); ++j) v.Y[j] = spin * q.Y[j];
      force.col(k) = at.mass_of(v);
      for (const UnknownField& f : system.unknowns)
        for (size_t i = 0; i < f.size(); ++i) {
          if (f.turns() && k >= 3) x.col(k).segment<3>(3 * f.block(i)) = e;
          if (!f.turns() && f.array != &Config::eta) x.col(k).segment<3>(3 * f.block(i)) = moved((q.*f.array)[f.item[i]]);
        }
    }
  }
  /// Share of a mode of unit mass in these motions, those about axes through the centre of mass.
  Vec6 part_of(const Vector& mode) const {
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {  // sum of m x, over m, by a turn about z and a push along y
      const int along = (k + 1) % 3, about = 3 + (k + 2) % 3;
      const double m = x.col(along).dot(force.col(along));
      if (m > 0) centre[k] = x.col(about).dot(force.col(along)) / m;
    }
    Vec6 p = force.transpose() * mode;
    for (int k = 0; k < 3; ++k) p[3 + k] -= Vec3(Vec3::Unit(k)).cross(centre).dot(p.head<3>());
    return p;
  }
};

/// Half of the lowest squared frequency that is no rigid motion: there both are told apart, and the factors are exact.  A first look is
/// taken far below the frequencies of single cells, and far above what rounding makes of motions that nothing holds.  Not a number where
/// nothing moves: all that the factor of the first look answers is rounding.
double good_shift(Linearized& at, Pencil pencil, int wanted, const std::function<void(double)>& factor) {
  const double first = 1e-7 * at.mean_omega2();
  pencil.shift = first;
  for (int pass = 0; pass < 4; ++pass) {
    factor(pencil.shift);
    double lowest = 1e300;
    for (const double x : lowest_modes(pencil, std::min(wanted, 14), 1e-3, false).omega2)
      if (std::abs(x) > 1e-3 * pencil.shift) lowest = std::min(lowest, std::abs(x));
    if (pass == 0 && lowest < 1e300 && lowest > 1e10 * first) return std::numeric_limits<double>::quiet_NaN();
    if (lowest == 1e300) {  // they lie lower still, or nothing but rigid motions was asked for
      if (pencil.shift < first) return first;
      pencil.shift = 1e-3 * first;
    } else if (lowest / 2 > pencil.shift / 4 && lowest / 2 < 4 * pencil.shift) {
      break;
    } else {
      pencil.shift = lowest / 2;
    }
  }
  return pencil.shift;
}

}  // namespace

std::vector<FoundMode> natural_modes(const System& system, KktSolver& solver, const State& rest, int wanted,
                                     const std::function<void(int)>& tell) {
  Linearized at(system, solver, rest);
  const auto by_columns = [](const Eigen::MatrixXd& X, auto&& product) {
    Eigen::MatrixXd out(X.rows(), X.cols());
    for (Eigen::Index j = 0; j < X.cols(); ++j) out.col(j) = product(Vector(X.col(j)));
    return out;
  };
  const auto inverse = [&](const Vector& b) {
    Vector x;
    at.solve(b, x);
    return x;
  };
  Pencil pencil{at.n(), [&](const Eigen::MatrixXd& X) { return by_columns(X, [&](const Vector& x) { return at.mass(x); }); },
                [&](const Eigen::MatrixXd& X) { return by_columns(X, inverse); }, 0};
  pencil.shift = good_shift(at, pencil, wanted, [&](double shift) { at.factor(shift); });
  if (std::isnan(pencil.shift)) return {};
  at.factor(pencil.shift);
  const Eigenmodes modes = lowest_modes(pencil, wanted, 1e-6, true, tell);
  if (modes.asymmetry > 1e-4)
    throw Error("", "the forces of small motions are no gradient: a pressure that follows, a moment that turns along or that nothing balances, "
                "friction under load",
                "start = \"equilibrium\" balances what can be; modes need forces that have a potential");
  if (!modes.converged) throw Error("", fmt::format("{} modes were not found", wanted), "ask for fewer: time.modes", Exit::not_converged);
  const RigidMotions rigid(system, at, rest.q);
  // Once more through the inverse, for the multipliers and to see what changes; what rounding brings of other modes goes.
  const Eigen::Index m = modes.omega2.size();
  Eigen::MatrixXd M(at.n(), m), x(at.n(), m);
  std::vector<FoundMode> out(static_cast<size_t>(m));
  std::vector<std::vector<double>> clean;  // multipliers
  Vector one;
  for (Eigen::Index j = 0; j < m; ++j) {
    const double nu = 1 / (modes.omega2[j] + pencil.shift);
    FoundMode& f = out[static_cast<size_t>(j)];
    M.col(j) = at.mass(modes.shapes.col(j));
    f.figures.error = at.solve(M.col(j), one, &f.mu);
    x.col(j) = one / nu;
    for (double& value : f.mu) value /= nu;
  }
  const Eigen::MatrixXd share = M.transpose() * x;
  for (Eigen::Index j = 0; j < m; ++j) {
    FoundMode& f = out[static_cast<size_t>(j)];
    Vector shape = x.col(j);
    std::vector<double> mu = f.mu;
    for (Eigen::Index k = 0; k < m; ++k) {
      if (k == j) continue;
      shape -= share(k, j) * modes.shapes.col(k);
      for (size_t i = 0; i < mu.size(); ++i) mu[i] -= share(k, j) * out[static_cast<size_t>(k)].mu[i];
    }
    const Vector change = shape - modes.shapes.col(j);
    Eigen::Index most = 0;
    shape.cwiseAbs().maxCoeff(&most);
    const double norm = std::copysign(std::sqrt(shape.dot(at.mass(shape))), shape[most]);
    shape /= norm;
    f.figures.omega2 = modes.omega2[j];
    f.figures.error += std::sqrt(std::abs(change.dot(at.mass(change))));  // not a number remains one
    f.figures.part = rigid.part_of(shape), f.figures.mass = f.figures.part.cwiseAbs2();
    if (system.traits().has_rates && f.figures.omega2 > 1e-9 * pencil.shift)
      f.figures.damping = shape.dot(at.damping(shape)) / (2 * std::sqrt(f.figures.omega2));
    f.x.assign(shape.begin(), shape.end());
    for (double& value : mu) value /= norm;
    clean.push_back(std::move(mu));
  }
  for (size_t j = 0; j < out.size(); ++j) out[j].mu = std::move(clean[j]);
  return out;
}

}  // namespace hilo
