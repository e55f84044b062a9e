// SPDX-License-Identifier: GPL-3.0-or-later
// What decides without an error estimate whether a region must deform: its frequency over that of its loads.
#pragma once
#include <array>
#include <vector>

namespace hilo {

/// Forces of one joint over time.
struct LoadHistory {
  std::vector<double> t;                 // [s]
  std::vector<std::array<double, 3>> F;  // (n_t)  [N]
};

/// Rate of a load: r.m.s. of dF/dt over 2 pi times that of F - mean [Hz]; of a sine its frequency, 0 where nothing changes.
double load_frequency(const LoadHistory& h);
/// |F| after the first step over the largest: 1 where a load is there at once, 0 where it rises from nothing.
double load_jump(const LoadHistory& h);
/// How many times faster than its loads a region must be to stay rigid, for a relative tolerance: 4 from 5 % on, 12 from 2 %, else 16;
/// doubled where jump >= 0.1.  Found on scenes of three beams, not derived.
double least_ratio(double tolerance, double jump);
/// The least frequency of a model with one region more that deforms which the rigid model does not have (to 5 %, one for one); 0: none.
double elastic_frequency(const std::vector<double>& rigid, const std::vector<double>& flexible);

}  // namespace hilo
