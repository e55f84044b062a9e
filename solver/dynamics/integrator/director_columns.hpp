// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of the matrix of coupled stages whose directors are not orthonormal.
//
// Where a stage turns, what an evaluation gives by a body's turn, d f[skew(e_k) M] with M = Stage::end's directors, is linear in M: three
// evaluations with fixed M span all nine changes of the directors of stage i, and an increment of stage j is a sum of these.
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "linear/tangent_reader.hpp"
#include "system/system.hpp"

namespace hilo {

/// Changes of the directors of a stage by the three components of a turn, as sums over k and a of skew(e_k) M_a: factors (k x component)
/// by a.
using DirectorSums = std::array<Mat3, 3>;
/// The matrices M_a.
extern const std::array<Mat3, 3> director_bases;
/// The sums that the changes N (one for each component) are.
DirectorSums director_sums(const std::array<Mat3, 3>& N);

/// Takes the blocks of one evaluation into the rows of stage `row` and the columns of all stages.
class DirectorColumns final : public TangentReader {
 public:
  static constexpr int n_stages = 3;
  /// What a stage's increments do to what the evaluation is by.
  struct Change {
    std::array<double, n_stages> factor;                               // to centres and nodes
    std::array<const std::vector<DirectorSums>*, n_stages> directors;  // of each body
  };
  /// `body_of`: of the block of a turn, or -1; `base`: a of the evaluation; `with_multipliers`: their columns are taken, too; `sigma`: the
  /// scale that rows of constraints are to have, and that they have in the evaluation.
  DirectorColumns(SerialKktSolver& whole, const System& system, const std::vector<int>& body_of, int row, const Change& change, int base,
                  bool with_multipliers, double sigma, const double& sigma_here)
      : whole_(whole),
        system_(system),
        body_of_(body_of),
        row_(row),
        change_(change),
        base_(base),
        with_multipliers_(with_multipliers),
        sigma_(sigma),
        sigma_here_(sigma_here) {}
  void add(int clique, const double* K) override;
  void add_diagonal(int block, const double d[3]) override;

 private:
  SerialKktSolver& whole_;
  const System& system_;
  const std::vector<int>& body_of_;
  int row_;
  const Change& change_;
  int base_;
  bool with_multipliers_;
  double sigma_;
  const double& sigma_here_;
  std::vector<double> part_;
};

/// The matrix of three coupled stages.
class CoupledTangent {
 public:
  /// Changes of the directors of stage i by the nine components of the turns of all stages.
  using Moves = std::array<std::array<Mat3, 9>, 3>;
  /// Adds it to `whole`, for stages of length h = Stage::h with W = A^-1, from three evaluations of each by positions, velocities and
  /// accelerations; `moves`: of a body.
  void add(const System& system, SerialKktSolver& whole, const Stage (&stages)[3], const std::vector<double> (&lambda)[3],
           const Residual (&r)[3], const Eigen::Matrix3d& W, const std::function<Moves(int)>& moves);

 private:
  void find_changes(const System& system, const std::array<Eigen::Matrix3d, 3>& by, const std::function<Moves(int)>& moves);
  std::array<Config, 3> bases_;                                                     // directors that turns are sums of
  std::vector<int> body_of_;                                                        // of the block of a turn, or -1
  std::array<std::array<std::array<std::vector<DirectorSums>, 3>, 3>, 3> changes_;  // by kind, row, column and body
  Residual unused_;
};

}  // namespace hilo
