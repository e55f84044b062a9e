// SPDX-License-Identifier: GPL-3.0-or-later
// Stress at the nodes, recovered from where the cells have it best [zienkiewicz-zhu-1992], region by region: never across a material.
//
// Each corner v of a region's cells gets a polynomial p_v, fitted to the second Piola-Kirchhoff stress at the sample points of the cells
// around it (physics/patch_fit): cubic in regions of quadratic hexahedra, whose samples are an order better than the rest of the cell
// [barlow-1976]; quadratic in others with quadratic cells, for a cubic carries the errors of a tetrahedron's samples to the nodes (13 % of
// the yield stress at the border of a plastic zone); else linear.  A cell takes the mean P of those of its corners, the fullest patches
// alone and the more the deeper a corner lies inside the region: at the surface points are one cell deep and tell no curvature.  What P
// leaves of the samples is extrapolated to the nodes in the cell's own coordinates, and the cells of a node are averaged:
//
//   S*_a = mean over cells of  P(X_a) + sum_p W_ap (S_p - P(X_p))
//
// Extrapolating alone errs by f'' h^2/12, which is 4 to 7 % where stress decays within a cell; quadratics see the f'' of the cells' middle
// instead of that at the surface.  In two more passes over regions with cubics the samples S_p - sum_b N_b S*_b that the interpolated S*
// misses go to the nodes by the same W and mean.  Linear stress is exact from any mesh, the rest of third order and more on the surface too
// (verify.SurfaceStress). S lives in the reference configuration: it stays the same when a body turns, and stays a polynomial along a beam
// bent into a circle, where the components of Cauchy stress do not.  At the node it is carried to Cauchy stress F S* F^T/det F with the
// mean F of the cells there.
//
// The error at a node is the root of the mean square of the von Mises norm of (sum_a N_a S*_a - S) over the cells at it: raw stress at all
// points of a cell against the recovered one.
//
// Cells of a linear region have the linear stress of their displacements from the mean axes, turned with these: half the difference of the
// law's stress at small displacements forward and back, which is exact to the third order.
#pragma once
#include <optional>
#include <vector>

#include "base/sharing.hpp"
#include "physics/patch_fit.hpp"
#include "physics/stress.hpp"
#include "system/solids.hpp"
#include "system/system.hpp"

namespace hilo {

class StressRecovery {
 public:
  /// Collective.
  explicit StressRecovery(const System& system);

  /// A node as a region sees it: one at the border of two regions is two sites.
  struct Site {
    int node;    // local
    int region;  // 2 r for the cells of region r, 2 r + 1 for its bars
  };
  struct Result {
    std::vector<Vec6> stress;          // Cauchy, of each site                             [Pa]
    std::vector<double> von_mises;     // of it; of bars the mean of theirs                [Pa]
    std::vector<double> error;         // 0 at bars                                        [Pa]
    std::vector<double> plastic;       // equivalent plastic strain, of what the points remember, extrapolated in each cell and averaged [1]
    std::vector<double> cell;          // von Mises, mean over the integration points      [Pa]
    std::vector<double> cell_plastic;  // equivalent plastic strain, likewise           [1]
  };
  const std::vector<Site>& sites() const { return site_; }
  using Memory = std::vector<std::vector<double>>;
  /// At the pose q, the cells of each batch remembering what `memory` says.  Collective; the same on all ranks that hold a site.
  Result recover(const Config& q, const Memory& memory = {}) const;

 private:
  struct Patches {                         // corners of the cells of some regions: a patch each
    int degree;                            // of polynomials
    std::vector<int> node;                 // (n)
    std::vector<PatchFit> fit;             // (n)
    std::vector<std::vector<int>> corner;  // per batch: patch of each corner of each cell (n_cells x n_corners); empty for other batches
    Sharing sharing;
  };
  void find_sites();
  Patches made_patches(int degree, const std::vector<int>& degree_of_region) const;
  template <class Visit>
  void each_cell(const Patches& p, const Config* q, Visit&& visit) const;
  struct Cell;  // a cell at a pose
  void look_at(Cell& cell, size_t batch, size_t number, const Config* q) const;
  std::vector<double> polynomials(const Patches& p, const Config& q, const Memory& memory) const;
  void add_missed(const std::vector<std::vector<double>>& samples, std::vector<double>& at_site) const;
  void add_bars(const Config& q, std::vector<double>& at, std::vector<double>& cell) const;

  const System& system_;
  std::vector<const SolidBatch*> batches_;  // of nonlinear regions, then of linear ones,
  std::vector<int> body_;                   // whose mean axes these are; -1
  std::vector<char> stiffens_;              // with strains of the second degree
  std::vector<int> carried_;                // nodes of linear regions,
  mutable std::vector<Vec3> placed_;        // and where they are: of their own region, displaced from X; others in space (n_nodes)
  std::vector<Site> site_;
  std::vector<std::vector<int>> site_of_;  // per batch: site of each node of each cell (n_cells x n)
  std::optional<Sharing> sites_;
  std::vector<Patches> patches_;  // of degree 1 to 3
};

}  // namespace hilo
