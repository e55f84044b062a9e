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
// A shell's bending strain is constant along the direction it bends in.  What the mean over the cells of a node takes from a cell there,
// the node across the cell is given where no other cell is beside it: a linear course goes on to the edge.
//
// Across a shell of one layer the stress with the mean and moment of its points is linear between the two sites of a pair of nodes.  It is
// recovered as S* is and integrated over the thickness h of the moment, z upwards from the face of the nodes 0 to 3:
//
//   n_ij = int s_ij dz,   m_ij = int z s_ij dz,   q_i = int s_i3 dz,   s = F(z) S(z) F(0)^T/det F(0)
//
// with the deformation gradient linear across too: the force of a cut, however far the shell is bent.
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
  /// What a site of shells bears, in axes 1 2 3 that move with the shell: 3 is the normal, out of the face of the nodes 4 to 7; 1 is at
  /// first the projection of an axis of space, the same in the whole region: the first of x, y, z that keeps 20 degrees off its normals,
  /// else the one that keeps furthest (dynamics/shell_values.cpp).
  struct ShellValues {
    double force[5] = {};   // n11 n22 n12 q1 q2                                    [N/m]
    double moment[3] = {};  // m11 m22 m12                                          [N]
    double stress[6] = {};  // 11 22 12 at the site's own face, their means across  [Pa]
    Vec3 axis{0, 0, 0};     // 1, in space; 0 where no shell is                     [1]
  };
  struct Result {
    std::vector<Vec6> stress;          // Cauchy, of each site                             [Pa]
    std::vector<double> von_mises;     // of it; of bars the mean of theirs                [Pa]
    std::vector<double> error;         // 0 at bars                                        [Pa]
    std::vector<double> plastic;       // equivalent plastic strain, of what the points remember, extrapolated in each cell and averaged [1]
    std::vector<double> cell;          // von Mises, mean over the integration points      [Pa]
    std::vector<double> cell_plastic;  // equivalent plastic strain, likewise           [1]
    std::vector<ShellValues> shell;    // of each site; empty unless asked for
  };
  const std::vector<Site>& sites() const { return site_; }
  using Memory = std::vector<std::vector<double>>;
  /// At the pose q, the cells of each batch remembering what `memory` says.  Collective; the same on all ranks that hold a site.
  /// `shells`: of them too; an Error where a region has several layers of them, or its faces are turned about from cell to cell.
  Result recover(const Config& q, const Memory& memory = {}, bool shells = false) const;

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
  void find_free_sides();
  void go_on_to_edges(const std::vector<std::vector<double>>& own, const std::vector<double>& at_site, double* value, int stride) const;
  void find_pairs() const;
  void add_shells(const std::vector<double>& at_site, const std::vector<double>& through, Result& out) const;
  void add_bars(const Config& q, std::vector<double>& at, std::vector<double>& cell) const;

  const System& system_;
  std::vector<const SolidBatch*> batches_;  // of nonlinear regions, then of linear ones,
  std::vector<int> body_;                   // whose mean axes these are; -1
  std::vector<char> stiffens_;              // with strains of the second degree
  std::vector<int> carried_;                // nodes of linear regions,
  mutable std::vector<Vec3> placed_;        // and where they are: of their own region, displaced from X; others in space (n_nodes)
  std::vector<Site> site_;
  std::vector<std::vector<int>> site_of_;          // per batch: site of each node of each cell (n_cells x n)
  std::vector<std::vector<unsigned>> free_sides_;  // per batch of shells: bit k where no other cell lies beyond nodes k and k + 1
  bool any_shells_ = false;                        // on any rank
  std::optional<Sharing> sites_;
  std::vector<Patches> patches_;  // of degree 1 to 3
  struct Pair {                   // of a site of shells
    int other = -1;               // the site across
    bool top = false;
    Vec3 normal{0, 0, 0}, axis, across;  // of the reference: 3, 1 and from the lower node to the upper one [m]
  };
  mutable std::vector<Pair> pair_;  // of each site
  mutable bool paired_ = false;     // made when first asked for
};

}  // namespace hilo
