// The answers of the cells of a linear region to loads.
#pragma once
#include <array>
#include <memory>

#include "linear/factors.hpp"
#include "system/reduction.hpp"
#include "system/region_cells.hpp"

namespace hilo {

/// K^-1 of what is not held, on vectors over all nodes.  A region that nothing holds gets springs along six directions of three nodes,
/// statically determinate, so that self-balanced loads do not feel them; its rigid motions are taken out of loads and answers.
class Flexibility {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  /// `rigid`: rigid motions, orthonormal in mass, and M_rigid their products with it   (3 n_nodes x 6).  All are kept by reference.
  /// Errors: cells that do not hold together.
  Flexibility(const ReductionInput& in, const RegionCells& cells, const Matrix& rigid, const Matrix& M_rigid);
  /// K^-1 F   (3 n_nodes x k)
  Matrix solve(Matrix F) const;
  int n_unknowns() const { return 3 * n_blocks_; }

 private:
  std::array<int, 6> determinate_support(const std::vector<Vec3>& X) const;
  std::unique_ptr<Factors> factors_;
  const Matrix &rigid_, &M_rigid_;
  bool free_;
  std::vector<int> block_;
  int n_blocks_ = 0;
};

}  // namespace hilo
