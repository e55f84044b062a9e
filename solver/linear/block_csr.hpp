// SPDX-License-Identifier: GPL-3.0-or-later
// A serial matrix of 3 x 3 blocks, by scalar rows: what sparse factors read and what a residual is multiplied with.
#pragma once
#include <span>
#include <vector>

#include "linear/kkt.hpp"

namespace hilo {

class BlockCsr {
 public:
  /// The pattern: every block of a clique couples to every other one, and to itself.
  void structure(const Cliques& cliques, int n_blocks);
  void zero();
  void add(int clique, const double* K);
  void add_part(int clique, int row, int column, int n, const double* K);
  void add_diagonal(int block, const double d[3]);

  /// y := A x, and the sums of the absolute values of the terms of each row.
  void multiply(const double* x, double* y, double* sums = nullptr) const;

  int n() const { return 3 * n_blocks(); }
  int n_blocks() const { return static_cast<int>(block_start_.size()) - 1; }
  /// Block columns of a block row, ascending.
  std::span<const int> neighbours(int block) const {
    return {columns_.data() + block_start_[block], static_cast<size_t>(block_start_[block + 1] - block_start_[block])};
  }
  /// Entry (r, c) of the k-th block of a block row.
  double entry(int block, int k, int r, int c) const { return values_[row_start_[3 * block + r] + 3 * k + c]; }
  /// Place of a column among the neighbours of a block row.
  int place(int block, int column) const;

  // scalar rows (n + 1), columns and values; read as columns they are the transpose
  const std::vector<int>& row_start() const { return row_start_; }
  const std::vector<int>& column() const { return column_; }
  const std::vector<double>& values() const { return values_; }
  /// Of a matrix with the same structure.
  void subtract(const BlockCsr& other) {
    for (size_t i = 0; i < values_.size(); ++i) values_[i] -= other.values_[i];
  }
  double bytes() const { return 12. * static_cast<double>(values_.size()) + 4. * static_cast<double>(position_.size()); }

 private:
  const Cliques* cliques_ = nullptr;
  std::vector<int> block_start_{0}, columns_, row_start_, column_, position_, diagonal_;
  int longest_ = 0;  // neighbours of a block
  std::vector<size_t> clique_position_;
  std::vector<double> values_;
};

}  // namespace hilo
