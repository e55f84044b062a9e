// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/natural_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "dynamics/modes/damped_modes.hpp"
#include "dynamics/modes/rigid_motions.hpp"
#include "linear/block_krylov.hpp"

namespace hilo {
namespace {

using Vector = Eigen::VectorXd;

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

/// `found` modes, or all there are, none where more than wanted do not converge; the first `wanted` ones with their damping, where
/// `damped`, of which `notes` says what is to be said.
std::vector<FoundMode> find_modes(const System& system, KktSolver& solver, const State& rest, int found, int wanted, bool damped,
                                  const std::function<void(int)>& tell, std::vector<std::string>& notes) {
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
  pencil.shift = good_shift(at, pencil, found, [&](double shift) { at.factor(shift); });
  if (std::isnan(pencil.shift)) return {};
  at.factor(pencil.shift);
  Eigenmodes modes = lowest_modes(pencil, found, 1e-6, true, tell);
  // where all the others are as fast as the mean of all, motions that nothing resists hide them from so low a shift
  if (modes.omega2.size() < found && (modes.omega2.array().abs() < 1e-3 * pencil.shift).all()) {
    const double low = pencil.shift;
    at.factor(pencil.shift = 1e-2 * at.mean_omega2());
    if (Eigenmodes more = lowest_modes(pencil, found, 1e-6, true, tell); more.omega2.size() > modes.omega2.size())
      modes = std::move(more);
    else
      at.factor(pencil.shift = low);
  }
  if (modes.asymmetry > 1e-4)
    throw Error(
        "",
        "the forces have no potential, so these modes do not exist. Such forces are a pressure that follows its face, a moment that "
        "turns along, a load that nothing balances, friction under load, and a rolling contact that bears a force along its plane",
        "leave them out of the analysis; start = \"equilibrium\" finds a balance where there is one");
  if (!modes.converged && found > wanted) return {};
  if (!modes.converged) throw Error("", fmt::format("{} modes were not found", found), "ask for fewer: time.modes", Exit::not_converged);
  const RigidMotions rigid(system, at, rest.q);
  const Vector loads = at.loads();
  const Vector pull = system.largest_rate(rest.a) > 0 ? at.mass_of(rest.a) : Vector::Zero(at.n());
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
    f.figures.omega2 = f.figures.pole2 = modes.omega2[j];
    f.is_rigid = std::abs(modes.omega2[j]) <= 1e-9 * pencil.shift;
    f.figures.error += std::sqrt(std::abs(change.dot(at.mass(change))));  // not a number remains one
    f.figures.part = rigid.part_of(shape), f.figures.mass = f.figures.part.cwiseAbs2();
    f.figures.drag = rigid.drag.transpose() * shape, f.figures.load = loads.dot(shape);
    f.figures.pull = pull.dot(shape);
    f.x.assign(shape.begin(), shape.end());
    for (double& value : mu) value /= norm;
    clean.push_back(std::move(mu));
  }
  for (size_t j = 0; j < out.size(); ++j) out[j].mu = std::move(clean[j]);
  if (damped && !out.empty()) notes = add_damping(out, at, pencil.shift, std::min(out.size(), static_cast<size_t>(wanted)));
  return out;
}

}  // namespace

std::vector<FoundMode> natural_modes(const System& system, KktSolver& solver, const State& rest, int wanted, bool at_rest,
                                     const std::function<void(int)>& tell) {
  const bool damped = at_rest && system.traits().has_rates;
  std::vector<FoundMode> modes;
  std::vector<std::string> notes;
  for (int found = wanted;; found *= 2) {  // strong dampers couple the modes to many beyond those asked for
    std::vector<std::string> further;
    auto next = find_modes(system, solver, rest, found, wanted, damped, tell, further);
    const bool are_all = std::ssize(next) < found;
    next.resize(std::min(next.size(), static_cast<size_t>(wanted)));
    if (!next.empty() || found == wanted) modes = std::move(next), notes = std::move(further);
    const bool are_good = std::ranges::all_of(modes, [](const FoundMode& m) { return m.figures.error < most_error; });
    if (damped && !are_all && !are_good && found < 4 * wanted) continue;
    for (const std::string& note : notes) warn("modes", note);
    return modes;
  }
}

}  // namespace hilo
