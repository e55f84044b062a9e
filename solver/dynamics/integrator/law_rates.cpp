// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator/law_rates.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/start/start.hpp"

namespace hilo {
namespace {

constexpr double none = 1e-11;  // of the largest rate of a law: what rows miss by round-off

double largest(const std::vector<double>& x) {
  double out = 0;
  for (const double value : x) out = std::max(out, std::abs(value));
  return out;
}

/// Rates of rows less those of the laws at time t: with velocities v, and where nothing moves but by laws (0: a row that follows none).
struct LawRows {
  std::vector<double> rates, of_laws;
  LawRows(const System& system, const Config& q, const Config& v, double t) {
    t -= 3 * system.same_time;  // before what jumps there
    Config laws;
    combine(laws, {{0, &v}});
    system.prescribe_rates(t, Side::left, &laws, nullptr);
    system.row_rates(q, laws, nullptr, t, of_laws, nullptr);
    system.row_rates(q, v, nullptr, t, rates, nullptr);
    const std::vector<char> on = system.rows_on();
    for (size_t k = 0; k < on.size(); ++k)
      if (!on[k]) rates[k] = of_laws[k] = 0;
  }
};

/// a = f b to round-off; 0: no such f.
double share(const std::vector<double>& a, const std::vector<double>& b) {
  size_t at = 0;
  for (size_t k = 0; k < b.size(); ++k)
    if (std::abs(b[k]) > std::abs(b[at])) at = k;
  if (b.empty() || b[at] == 0) return 0;
  const double f = a[at] / b[at];
  for (size_t k = 0; k < a.size(); ++k)
    if (!(std::abs(a[k] - f * b[k]) <= 1e-14 * std::abs(a[at]))) return 0;
  return f;
}

}  // namespace

LawRates::Kicked LawRates::kick(const System& system, KktSolver& solver, const Config& q, const Config& v, double t, double kinetic,
                                std::vector<double> by, double h, double* sigma) {
  Config after = v;
  std::vector<double> impulse = change_rates(system, solver, q, after, t, by, sigma);
  if (impulse.empty()) return std::nullopt;
  Kick out{.h = h, .rates = std::move(by), .v = {}, .impulse = std::move(impulse)};
  combine(out.v, {{1, &after}, {-1, &v}});
  out.own = system.energy(q, out.v).kinetic, out.along = system.energy(q, after).kinetic - kinetic - out.own;
  return out;
}

/// Where its rates are f times those of another one at the same velocities.
void LawRates::Kick::scale(double f) {
  for (double& x : rates) x *= f;
  for (double& x : impulse) x *= f;
  combine(v, {{f, &v}});
  along *= f, own *= f * f;
}

const Config* LawRates::begin(double h) {
  begun_ = next_, ended_.reset(), after_.reset();
  if (!begun_) return nullptr;
  const double f = h * h / (begun_->h * begun_->h);
  if (f != 1) begun_->scale(f);
  return &begun_->v;
}

bool LawRates::end(const System& system, KktSolver& solver, const State& s, double h, const Config& q, const Config& v) {
  ended_.reset(), after_.reset();
  const LawRows rows(system, q, v, s.t + h);
  std::vector<double> change(rows.rates.size());
  for (size_t k = 0; k < change.size(); ++k) change[k] = rows.of_laws[k] != 0 ? -rows.rates[k] : 0;
  if (largest(change) <= none * largest(rows.of_laws)) return true;
  double sigma = 0;
  if (!begun_) {
    for (double& x : change) x /= -2;
    begun_ = kick(system, solver, s.q, s.v, s.t, system.energy(s.q, s.v).kinetic, std::move(change), h, &sigma);
    return !begun_;
  }
  std::vector<double> next(change.size());
  for (size_t k = 0; k < change.size(); ++k) next[k] = (begun_->rates[k] - change[k]) / 2;
  const double kinetic = system.energy(q, v).kinetic;
  ended_ = kick(system, solver, q, v, s.t + h, kinetic, std::move(change), h, &sigma);
  if (!ended_) return true;
  if (const double f = share(next, ended_->rates); f != 0) {
    after_ = ended_, after_->along += 2 * after_->own;  // at the velocities that it leads to
    after_->scale(f);
    return true;
  }
  Config there;
  combine(there, {{1, &v}, {1, &ended_->v}});
  after_ = kick(system, solver, q, there, s.t + h, kinetic + ended_->work(), std::move(next), h, &sigma);
  return true;
}

void LawRates::add_to(std::vector<double>& lambda, Config& acceleration, double h) const {
  for (const Kicked* kick : {&begun_, &ended_}) {
    if (!*kick) continue;
    for (size_t i = 0; i < lambda.size(); ++i) lambda[i] += (*kick)->impulse[i] / h;
    combine(acceleration, {{1, &acceleration}, {1 / h, &(*kick)->v}});
  }
}

void LawRates::carry(const Carry& carry) {
  if (!next_) return;
  next_->rates = carry(next_->rates), next_->impulse = carry(next_->impulse);
}

}  // namespace hilo
