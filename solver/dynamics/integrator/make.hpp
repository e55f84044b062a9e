// SPDX-License-Identifier: GPL-3.0-or-later
// Integrators made by their parameters, for those who have no entry of a scene.
#pragma once
#include "dynamics/integrator.hpp"
#include "model/integrator/generalized_alpha.hpp"

namespace hilo {

/// chi: dissipation in the stress of flexible parts, chi/2 C (E1 - E0) for what alternates, of order h^2 for what steps resolve.
std::unique_ptr<StageIntegrator> make_energy_momentum(double chi);
std::unique_ptr<StageIntegrator> make_mid_point();
struct AlphaParameters {
  double alpha_m, alpha_f, beta, gamma;
};
AlphaParameters generalized_alpha(double rho);
AlphaParameters hht(double rho);  // rho at infinite frequency, 1/2 to 1
AlphaParameters wbz(double rho);
std::unique_ptr<StageIntegrator> make_generalized_alpha(const AlphaParameters& p, std::string_view name = GeneralizedAlpha::name);
std::unique_ptr<StageIntegrator> make_zhou_tamma(bool velocity_family, const double rho[3], bool averaged);
std::unique_ptr<StageIntegrator> make_bathe();
std::unique_ptr<StageIntegrator> make_bdf2();
/// Serial; `solver`: of the matrix of all three stages.
std::unique_ptr<Integrator> make_radau(std::unique_ptr<SerialKktSolver> solver);
std::unique_ptr<Integrator> make_gauss(std::unique_ptr<SerialKktSolver> solver);

}  // namespace hilo
