// SPDX-License-Identifier: GPL-3.0-or-later
// Beams that are linear or rigid: loads by length on them, and forces and moments at their sections.
//
// A section moves by the modes of its region as a body would: with u_j and w_j what a unit of amplitude j moves and turns it by,
//   c = c_axes + R r + sum_j Y_j u_j,   d_i = R d_i0 + sum_j Y_j (w_j x d_i0),   Y_j = eta_j R
// linear in the coordinates of the region.  Forces are K12 (u, w)_A,B + beta K12 d/dt (u, w)_A,B, inertia and weight of the cell less its
// loads, in the axes of the drawn sections, which turn with the mean axes: K12 the slope of the arc (physics/beam_arc) without strain.
#pragma once
#include <Eigen/Dense>
#include <vector>

#include "system/beam_cells.hpp"
#include "system/contribution.hpp"
#include "system/reduction/point_cell.hpp"

namespace hilo {

struct LinearSection {
  int modes = -1;                  // of Points::modes
  int node = -1;                   // the first of its four, of the region
  Vec3 at = Vec3::Zero();          // reference position [m]
  std::vector<Vec3> moves, turns;  // by each amplitude (3 n_blocks) [m, rad]
};

/// Bodies that a linear region moves by its modes, to small turns: directors stay orthonormal to the first power of the amplitudes.
struct CarriedBodies {
  int modes = -1;
  std::vector<int> bodies;
  Eigen::MatrixXd motions;  // displacement and the three columns of the turn of each body by each Y, axes of the region (4 n x 9 n_blocks)
};

class LinearBeams final : public Contribution, public Equations, public Observer {
 public:
  explicit LinearBeams(const Points& points) : points_(points) {}
  std::vector<Beam> beams;
  std::vector<BeamCell> cells;  // between sections of this list:
  std::vector<LineLoad> lines;
  std::vector<LinearSection> sections;
  std::vector<CarriedBodies> carried;
  /// Carried bodies from their regions: the map is linear, for positions, velocities and accelerations alike.
  void carry(Config& q) const;
  void add_cell(const SectionPlace& a, const SectionPlace& b, const SectionsAlong& sections, double beta, double alpha);
  /// Of cell k, on the nodes of its sections, which stand at `arm` from their origins.
  PointCell point_cell(size_t k, double arm) const;
  /// What points of a cell's sections are of the nodes (8 x 8).
  Eigen::Matrix<double, 8, 8> points_of_nodes(size_t k, double arm) const;
  /// Momentum, angular momentum about the centre of a region's axes, and momenta of its modes, of sections that move and turn at the start
  /// (6 + 3 n_blocks).
  std::vector<double> momenta(int modes, const std::vector<Vec3>& velocity, const std::vector<Vec3>& spin) const;

  std::string count() const override;
  void evaluate(Pass& p) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void tie(Ties& ties) const override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;

 private:
  arc::SectionPoints<double> points_of(const BeamCell& cell, const Config& q) const;
  /// Displacement and turn of both ends by amplitudes (12).
  Eigen::Matrix<double, 12, 1> ends_of(const BeamCell& cell, const Eigen::VectorXd& eta) const;
  const Points& points_;
  std::vector<Eigen::Matrix<double, 6, 12>> strains_;  // of cells, by displacement and turn of A, of B: (N/m)^1/2, as PointCell has them
};

}  // namespace hilo
