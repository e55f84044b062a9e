// SPDX-License-Identifier: GPL-3.0-or-later
// A step of a material with memory at one point: strains are those of its ends, state is what the point remembers.
#pragma once

namespace hilo {

struct PointStep {
  const double *e0, *e1;  // Green-Lagrange strain at the start and the end                                          (6)
  const double* h0;       // state at the start                                                                      (n_state)
  double elapsed;         // time of the step; 0: nothing flows, infinite: so slow that rates do not count           [s]
  bool conserving;        // s.(e1 - e0) = W1 - W0 + dissipated exactly; else s is that of the end
  double mean = 0;        // what of lambda acts on the mean dilatation of the cell instead                          [Pa]
  double* s = nullptr;    // second Piola-Kirchhoff stress                                                           (6)  [Pa]
  double* D = nullptr;    // ds/de1 by rows, or null                                                                 (36) [Pa]
  double* h1 = nullptr;   // state at the end, or null                                                               (n_state)
  double energy = 0;      // stored at the end, per reference volume                                                 [J/m^3]
  double dissipated = 0;  // by flow over the step, never negative                                                   [J/m^3]
};

}  // namespace hilo
