// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a system that is not flexible - bodies and multipliers, "dense" - and what couples it to the flexible part:
//
//     [ F  B ]      F large (FlexibleMatrix), B and C few columns and rows, D small and sparse: all of it on every rank
//     [ C  D ]
#pragma once
#include <vector>

#include "linear/kkt.hpp"
#include "linear/petsc/shared.hpp"

namespace hilo::petsc {

class Coupling {
 public:
  Coupling(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared);
  void zero();
  /// Add the parts of a clique's matrix outside F.
  void add(std::span<const int> blocks, const double* K);
  void add_diagonal(int block, const double d[3]);
  /// Sum over the ranks: couples go to the owner of their flexible block, D to all.
  void assemble();

  /// Make B and C^T the mean of both, and D symmetric.
  void symmetrise();

  int m() const { return m_; }  // unknowns of the dense part
  bool is_dense(int local) const { return dense_[local] >= 0; }
  bool couples(std::span<const int> blocks) const;              // does a clique touch the dense part?
  const std::vector<int>& columns() const { return columns_; }  // dense unknowns that couple to flexible ones on some rank

  /// The blocks of D, row after row: visit(row, column, 3 x 3 row major).
  template <class Visit>
  void for_each_D(const Visit& visit) const {
    for (int i = 0; i < m_ / 3; ++i)
      for (int k = D_start_[i]; k < D_start_[i + 1]; ++k) visit(i, D_column_[k], &D_[9 * static_cast<size_t>(k)]);
  }
  /// q += D p
  void add_D(const double* p, double* q) const;
  /// u += factor B p;  u: owned flexible unknowns, p: all dense unknowns.
  void add_B(double factor, const double* p, double* u) const;
  /// Column j of B into u, which is zeroed first.
  void column(int j, double* u, size_t n) const;
  /// p += factor C u, this rank's share: to be summed over the ranks.
  void add_C(double factor, const double* u, double* p) const;
  /// The couples of owned flexible blocks: (local block, dense block, 3 x 3 of B, 3 x 3 of C).
  template <class Visit>
  void for_each_couple(const Visit& visit) const {
    for (size_t k = 0; k < couples_.size(); ++k)
      if (position_[couples_[k].flexible] >= 0) visit(couples_[k].flexible, couples_[k].dense, &B_[9 * k], &C_[9 * k]);
  }
  double bytes() const { return 8. * static_cast<double>(D_.size() + summand_.size() + B_.size() + C_.size()); }

 private:
  size_t find(int flexible, int dense) const;
  size_t find_D(int row, int column) const;  // where its nine values begin
  void find_pattern_of_D(const Cliques& cliques);
  struct Couple {
    int flexible, dense;  // local block, dense block
    auto operator<=>(const Couple&) const = default;
  };
  int m_ = 0;
  std::vector<int> dense_;               // dense block of each local block, -1 for flexible ones
  std::vector<int> position_;            // place of each local flexible block among the owned, -1 otherwise
  std::vector<Couple> couples_;          // sorted
  std::vector<size_t> start_;            // first couple of each local block
  std::vector<double> B_, C_;            // 3 x 3 each, B row flexible, C row dense
  std::vector<int> D_start_, D_column_;  // blocks of each row of blocks, ascending
  std::vector<double> D_, summand_;      // 9 each; what this rank has added since the last assemble()
  std::vector<int> columns_;
  std::vector<std::vector<size_t>> lent_, borrowed_;  // couples of each rank's blocks held here; couples of own blocks held there
};

}  // namespace hilo::petsc
