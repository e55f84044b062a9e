// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/error/phase_error.hpp"

#include <cmath>

#include "dynamics/integrator/make.hpp"
#include "model/integrators.hpp"

namespace hilo {
namespace {

/// Of generalized-alpha, of second order where gamma is 1/2 - alpha_m + alpha_f.
double of_alpha(const AlphaParameters& p) { return (p.beta - 1. / 12 - (p.gamma - 0.5) * p.alpha_f) / 2; }

/// Of U0 and V0, with the numbers of integrator/zhou_tamma.
double of_radii(const Entry& time, bool velocity_family) {
  const auto radius = [&](const char* key) { return time.number(time.has(key) ? key : "rho"); };
  const double r1 = radius("rho1"), r2 = radius("rho2"), last = 1 / (1 + radius("rho3")), both = 1 / ((1 + r1) * (1 + r2));
  const double third = (3 + r1 + r2 - r1 * r2) / 2 * both;
  if (!velocity_family) return (both - 1. / 12 + (0.5 - third) * (1 - last)) / 2;
  const double apart = time.boolean("averaged") ? 0 : both - third / 2;  // of the position that forces see, from the averaged one
  return (last / 2 - 1. / 12 + apart + (0.5 - last) * (1 - third)) / 2;
}

}  // namespace

std::optional<double> phase_error(const Entry& time, std::string_view method) {
  constexpr double trapezoidal = 1. / 12;
  const auto rho = [&] { return time.number("rho"); };
  if (method == EnergyMomentum::name || method == MidPoint::name) return trapezoidal;
  if (method == GeneralizedAlpha::name) return of_alpha(generalized_alpha(rho()));
  if (method == Hht::name) return of_alpha(hht(rho()));
  if (method == Wbz::name) return of_alpha(wbz(rho()));
  if (method == U0::name || method == V0::name) return of_radii(time, method == V0::name);
  if (method == Bathe::name) return M_SQRT1_2 - 2. / 3;
  if (method == Bdf2::name) return 1. / 3;
  if (method == Newmark::name && time.number("gamma") == 0.5) return of_alpha({0, 0, time.given("beta") ? time.number("beta") : 0.25, 0.5});
  return std::nullopt;
}

}  // namespace hilo
