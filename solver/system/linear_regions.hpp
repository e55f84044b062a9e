// SPDX-License-Identifier: GPL-3.0-or-later
// Linear regions: small strain on any rigid motion, by modes about mean axes.
//
//   x_a = c + R (r_a + sum_j phi_aj eta_j),   Q = (c, R e_k, Y_j e_k),   b_a = (1, r_a, phi_aj),   A = int rho b b^T constant
//   P_left^T [A a_Q - A e_0 g] + (0, 0, k eta) = 0             k eta, or the force of quadratic strains (system/quadratic_strain.hpp)
// A rigid body is the case without modes [betsch-leyendecker-2006].  Amplitudes are of modes orthonormal in mass, so k is a
// list of squared circular frequencies.
#pragma once
#include <Eigen/Dense>

#include "system/quadratic_strain.hpp"
#include "system/solids.hpp"

namespace hilo {

struct LinearRegion {
  int modes = -1;             // of Points::modes
  Eigen::MatrixXd A;          // rows: centre, directors, then three of each mode   (4 + 3m x 4 + 3m)
  Eigen::VectorXd stiffness;  // (m) [1/s^2]
  Eigen::MatrixXd viscous;    // stiffness-proportional, of the modes (m x m), of the measures where it stiffens, or empty [1/s]
  Eigen::MatrixXd A_damped;   // int alpha rho b b^T, mass-proportional damping   (as A), or empty
  QuadraticStrain strain;     // where it stiffens
  Eigen::MatrixXd left_out;   // of modes (m x m), as Reduction has it [s^2]
  Eigen::MatrixXd sites;      // as Reduction has them,
  Eigen::MatrixXd soft, second_order;
  double held_frequency = 0;
};

class LinearRegions final : public Contribution, public Equations, public Stateful, public Observer {
 public:
  explicit LinearRegions(const Points& points) : points_(points) {}
  std::vector<LinearRegion> regions;  // on all ranks the same
  std::vector<SolidBatch> cells;      // of this rank: what stress is recovered from
  std::vector<int> body_of_cells;     // whose mean axes each batch of them follows

  Traits traits() const override;
  std::string count() const override;
  std::string owner(int block) const override;
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void tie(Ties& ties) const override;
  std::string fault(const Config& q) const override;
  void commit(const Config& q, const Config* v) override;
  void archive(Archive& a) override { a("linear regions", told_, too_fast_, of_run_); }
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;

  /// The error of the reduction of region k, as the share of the largest strain that modes left out would have, in the norm of strain
  /// energy.
  double lacking(size_t k) const;
  /// Frequency of what the modes left out answer to, root mean square over the run, over that of the first of them; 0 where there is none.
  double load_band(size_t k) const;
  /// Acceleration of region k less gravity, root mean square over its mass [m/s^2].
  double inertia(size_t k, const Moment& moment) const;
  /// The largest displacement of region k from its mean axes over its length, and the largest spin over its first frequency, so far.
  double bend(size_t k) const { return of_run_[k].bend; }
  double spin(size_t k) const { return of_run_[k].spin; }
  /// The largest bend that modes are good for.
  double bend_limit(size_t k) const { return points_.modes[regions[k].modes].stiffens ? 0.05 : 0.0125; }
  static constexpr double spin_limit = 0.3;

 private:
  const Points& points_;
  std::vector<char> told_;  // by region: that it spins near its first frequency
  std::string too_fast_;    // why a region cannot go on
  struct OfRun {
    double energy = 0, left_out = 0;  // the largest so far: of strain, and what modes left out would hold [J]
    double loads = 0, rates = 0;      // of the latter: sum over time [J s], and of what changes of accelerations would bring [J/s]
    std::vector<double> a;            // accelerations of the modes in the last step, which ended at
    double t = 0;
    double bend = 0, spin = 0;  // as told by the functions above
  };
  std::vector<OfRun> of_run_;  // by region
};

}  // namespace hilo
