// SPDX-License-Identifier: GPL-3.0-or-later
// Where the tangent of one stage by the unknowns of one stage goes in the matrix of coupled stages.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "linear/tangent_reader.hpp"
#include "system/system.hpp"

namespace hilo {

/// Takes the blocks of one evaluation into rows of stage `row` and columns of stage `column` of the coupled matrix, whose cliques are those
/// of the system once for each stage.  Off the diagonal only what couples positions counts, and rows that hold velocities, times
/// share/`scale` of the evaluation: other constraints belong to their own stage.
class StageBlock final : public TangentReader {
 public:
  StageBlock(SerialKktSolver& whole, const System& system, int row, int column, double share, const double& scale)
      : whole_(whole), system_(system), row_(row), column_(column), share_(share), scale_(scale) {
    if (row == column) return;
    holds_velocity_.assign(3 * static_cast<size_t>(system.n_joint_blocks()), 0);
    for (const auto& c : system.constraints())
      for (int r = c->n_position_rows(); r < c->n_rows(); ++r) holds_velocity_[c->row() + r] = c->active()[r];
  }
  void add(int clique, const double* K) override {
    const auto blocks = system_.layout.cliques[clique];
    const int n = static_cast<int>(blocks.size()), width = 3 * n, first_joint = system_.first_joint_block();
    const auto is_joint = [&](int i) { return blocks[i / 3] >= first_joint; };
    if (row_ != column_ && is_joint(width - 1)) {
      part_.assign(K, K + static_cast<size_t>(width) * width);
      for (int i = 0; i < width; ++i) {
        const bool velocity = is_joint(i) && holds_velocity_[3 * (blocks[i / 3] - first_joint) + i % 3];
        for (int j = 0; j < width; ++j)
          if (is_joint(j) || (is_joint(i) && !velocity))
            part_[i * width + j] = 0;
          else if (velocity)
            part_[i * width + j] *= share_ / scale_;
      }
      K = part_.data();
    }
    whole_.add_part(clique, n * row_, n * column_, n, K);
  }
  void add_diagonal(int block, const double d[3]) override {
    if (row_ == column_) return whole_.add_diagonal(block + row_ * system_.n_blocks(), d);
    // held components are diagonal in their own stage; point masses are refused before
  }

 private:
  SerialKktSolver& whole_;
  const System& system_;
  int row_, column_;
  double share_;
  const double& scale_;
  std::vector<char> holds_velocity_;  // (3 x joint blocks)
  std::vector<double> part_;
};

}  // namespace hilo
