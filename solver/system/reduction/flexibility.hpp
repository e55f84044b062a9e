// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of the cells of a linear region to loads.
#pragma once
#include <array>

#include "linear/shared_cholesky.hpp"
#include "system/reduction/reduction.hpp"
#include "system/reduction/region_cells.hpp"

namespace hilo {

/// K^-1 of what is not held, on vectors over all nodes.  A region that nothing holds gets springs along six directions of three nodes, or
/// on a block, statically determinate, so that self-balanced loads do not feel them; its rigid motions are taken out of loads and answers.
class Flexibility {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  /// `rigid`: rigid motions, orthonormal in mass, and M_rigid their products with it   (3 n_nodes x 6).  All are kept by reference.
  /// Errors: cells that do not hold together; a factor for which there is no memory.
  Flexibility(const ReductionInput& in, const RegionCells& cells, const Matrix& rigid, const Matrix& M_rigid, SharedCholesky& factor);
  /// K^-1 F   (3 n_nodes x k)
  Matrix solve(Matrix F) const;
  int n_unknowns() const { return 3 * n_blocks_; }

 private:
  std::array<int, 6> determinate_support(const std::vector<Vec3>& X) const;
  void find_room();
  void mend(Eigen::Ref<Matrix> b) const;
  Matrix times(const Matrix& x) const;
  void number(const ReductionInput& in);
  void add_cells();
  /// What forces on the nodes are on the unknowns, T^T F, and the displacements of the nodes, T z: the nodes of a block move as one.
  Matrix on_unknowns(const Matrix& F) const;
  Matrix at_nodes(const Matrix& z) const;
  const ReductionInput& in_;
  const RegionCells& cells_;
  SharedCholesky& factor_;
  const Matrix &rigid_, &M_rigid_;
  bool free_;
  double stiff_ = 0;                             // largest of the cells
  bool single_ = false;                          // the factor is in single precision,
  std::string folder_;                           // and in a file
  std::vector<std::pair<int, double>> springs_;  // unknowns and stiffness
  std::vector<int> block_;                       // of nodes; first of two, displacement and turn, of those that move as one; -1: held
  std::vector<char> is_of_block_;
  std::vector<Vec3> arm_;  // of these, from the middle of their block
  struct Line {            // of a block whose nodes lie along it: nothing resists its turn about it
    int block;
    Vec3 along;
    double stiff = 0;
  };
  std::vector<Line> lines_;
  int n_blocks_ = 0;
};

}  // namespace hilo
