// SPDX-License-Identifier: GPL-3.0-or-later
// Cells whose strain is a variable of the stages of a step.
#pragma once
#include <array>

#include "system/cell_lanes.hpp"
#include "system/collocation.hpp"

namespace hilo {

/// W cells at the stages of a step that these share (system/collocation): the strain is a variable of its own, and stress
///   S_i = dW(e(Q_i)) + C (E_i - e(Q_i)) + c C way_i,   E_i = e(q0) + sum a_ij way_j,   way_j = h G(Q_j) V_j = e(after_j) - e(before_j)
/// with the law's moduli C at small strain.  Where stress is linear in strain the first two are C E_i, and c is none; elsewhere
///   c = (W1 - W0 - sum b_j S_j.way_j)/(sum b_j way_j.C way_j)
/// of the cell makes the work of the step the change of W; c way_i is of order h^6.
class CellStages {
 public:
  CellStages(const SolidBatch& b, const Collocation& step);
  void gather_cells(int first, const double* X);
  /// What is not dW(e(Q_i)), to the forces f of stage i.
  void add_rest(int i, double* f);
  /// The derivative of C (E_i - e(Q_i)) at Q_i by Q_k, but for the factor c:  B(Q_i)^T C B(Y) with Y = sum a_ij W_jk Q_j + a_ik h V_k, as
  /// B is linear, W = a^-1.
  void add_slope(int i, int k, double* K);

 private:
  static constexpr int n = Collocation::n;
  struct Store {
    Scratch start, before[n], after[n], at[n], end, f, all, missed, length, energy, to, from, K;
  };
  const double* put(Scratch& to, int first, const Config& from);
  /// v C (way_i + share (e(to) - e(from))) at Q_i.
  KernelCall along(int i, double v, double share = 0, const double* from = nullptr, const double* to = nullptr) const;
  void add(KernelCall c, double* f);
  /// C (E_i - e(Q_i)), in three calls that each take a third of a_ii way_i.
  std::array<KernelCall, n> variable(int i) const;
  void add_variable(int i, double* f);
  /// factor times the K of a call.
  void add_tangent(double factor, KernelCall c, double* K);
  /// factor f.h V_j of each cell to `sum`.
  void add_product(double factor, const double* f, int j, double* sum) const;
  /// W1 - W0 and |W1| + |W0| of each cell.
  void find_energy_change(double* change, double* size);
  const SolidBatch& b_;
  const Collocation& step_;
  int W_, size_;
  KernelCall call_{};
  const double *start_ = nullptr, *before_[n]{}, *after_[n]{}, *at_[n]{};
  static thread_local Store store_;
};

}  // namespace hilo
