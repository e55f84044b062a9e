// SPDX-License-Identifier: GPL-3.0-or-later
// The largest von Mises stress over yield stress of linear regions, whose metal does not flow.
//
// Von Mises stress is a norm of deviators, so of a cell it is at most sum_j |eta_j| s_j, s_j that of mode j alone: cells whose bound is
// below what was found already are not looked at.
#pragma once
#include "system/linear_regions.hpp"

namespace hilo {

class System;

class StressOverYield {
 public:
  /// Of all linear regions, as they are built.  Collective.
  explicit StressOverYield(const System& system);
  /// Does any region have a metal, on any rank?
  bool has_metal() const { return has_metal_; }
  /// The largest of region k on this rank at its integration points, or `least` where none is above that.
  double largest(size_t k, const Config& q, const Eigen::VectorXd& eta, double least) const;

 private:
  struct Cell {
    const SolidBatch* batch;
    size_t number;
    bool by_modes;  // they tell it: strains are small, and no node follows another body
  };
  struct Region {
    std::vector<Cell> cells;
    Eigen::MatrixXd of_mode;  // stress over yield stress, largest of the points   (n_modes x n_cells)
  };
  Eigen::VectorXd of_modes(const Modes& m, const Cell& cell) const;
  double of_cell(const Modes& m, const Cell& cell, const Config& q) const;
  const System& system_;
  std::vector<Region> regions_;
  bool has_metal_ = false;
};

}  // namespace hilo
