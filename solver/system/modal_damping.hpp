// SPDX-License-Identifier: GPL-3.0-or-later
// `modal_damping` of linear regions: the ratio of the modes of what hangs together, as it is held at the start.
//
// Joints, welds and springs hold the regions, rigid bodies move along with their masses, nodes of nonlinear cells stand still.  Of the
// modes (K - omega_i^2 M) phi_i = 0 of that, unit in mass, C = M (sum 2 zeta omega_i phi_i phi_i^T) M has the ratio zeta in each
// [wilson-penzien-1972].  With M phi = K phi/omega^2, K of the regions alone, it acts on amplitudes and leaves rigid motions be:
//
//   C = sum_i 2/omega_i^3 (K D phi_i)(K D phi_i)^T,     D = sqrt(zeta) of each region
//
// The same in each mode where the regions alone give way; where springs do too, a mode has about the share of its strain energy.  Regions
// that hang together damp each other: by themselves they would not have the ratio in the modes that they share.
#pragma once
#include <Eigen/Dense>

#include "system/system.hpp"

namespace hilo {

class ModalDamping final : public Contribution, public Equations {
 public:
  explicit ModalDamping(const System& system) : system_(system) {}
  std::vector<double> ratio;  // by number of Points::modes

  /// The matrices, at the pose q.  Collective.  Error where more unknowns hang together than a dense matrix is for.
  void find(const Config& q);

  Traits traits() const override { return {.has_rates = !groups_.empty()}; }
  void number(Layout& layout) override;
  void evaluate(Pass& p) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void archive(Archive& a) override;
  void tie(Ties&) const override {}  // linear regions have no clock

 private:
  struct Group {               // what hangs together
    std::vector<int> bodies;   // all of them, mean axes included
    std::vector<int> regions;  // numbers of Points::modes
    int clique = -1;           // of the amplitudes of the regions
    Eigen::MatrixXd C;         // over these, padding included; empty before find()
  };
  void find_groups(const Cliques& cliques);
  Eigen::VectorXd way(const Group& group, const Stage& s) const;
  Eigen::MatrixXd damping_of(const Group& group, const Config& q) const;
  const System& system_;
  bool found_ = false;  // groups_, by what the other contributions connect at the start
  std::vector<Group> groups_;
};

/// Of a system, at the pose q that its run starts from.  Collective.
void find_modal_damping(System& system, const Config& q);

}  // namespace hilo
