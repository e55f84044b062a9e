// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of beams, in the widest vectors this machine has.
#pragma once

namespace hilo {

/// Arguments of one call on `width` cells; arrays are (entry x width), lane fastest.  A pose is centre and directors of the body at A and
/// of that at B, 24 entries.
struct ArcCall {
  /// A pair of configurations between which strains act.
  struct Pair {
    const double *q0 = nullptr, *q1 = nullptr;  // poses
    double elastic = 0, kappa = 0;              // shares of the elastic forces, and of C* times the change of strain
    double by_beta = 0;                         // of beta, beside kappa [1/s]
    double slope = 1;                           // d q1 / d end
    bool acts = true;                           // false: in the tangent alone
    bool is_instant = false;                    // rates at `left`, as fast as q0 and q1 are apart, and no change from one to the other
    double slope0 = 0;                          // d q0 / d end, of these
    bool mean = false;                          // the forces at the mean of the measures, by the share `weight` of q1
    double weight = 0.5;
    bool end_slopes = false;                     // from the right, slopes of the strains at q1 and not at the mean
    const double* past[2] = {nullptr, nullptr};  // poses before q0, or null: kappa C* recalls changes of strain times `recall`
    double recall[2] = {0, 0};
    const double *s = nullptr, *D = nullptr;  // forces (7) and their slopes (7 x 7) where they are known
  };
  const double* cells;               // arc::ArcCell
  const double *left, *end, *a, *v;  // poses of a stage; v null: no drag
  // poses before Newton's last correction, and that to first order, for the resultants of K where a pair is one configuration; null: none
  const double *before, *along;
  double gravity[3];
  double slope, mass_slope, alpha_slope;
  int n_pairs;
  Pair pairs[4];
  const double *line_F, *line_K;  // loads by length on the points (8 x 3) and their slopes (8 x 8), or null
  /// Set: force and moment about the centres of the bodies (12), squares of the forces that have been summed (4), tangent (12 x 12) or
  /// null.
  double *f, *scale2, *K;
};
using ArcFunction = void (*)(const ArcCall&);
struct ArcKernel {
  ArcFunction call;
  int width;
};
ArcKernel arc_kernel();

}  // namespace hilo
