// SPDX-License-Identifier: GPL-3.0-or-later
// Frequency weighting of whole-body vibration [iso-2631, iso-8041]: a chain of second-order filters in s = 2 pi i f, parameters f1 .. f6,
// Q4 .. Q6 in Hz and 1,
//   high pass         s^2/(s^2 + s w1/Q1 + w1^2),                                  Q1 = 1/sqrt2
//   low pass          w2^2/(s^2 + s w2/Q2 + w2^2),                                 Q2 = 1/sqrt2
//   a-v transition    (1 + s/w3)/(1 + s/(Q4 w4) + (s/w4)^2)
//   upward step       (w5/w6)^2 (1 + s/(Q5 w5) + (s/w5)^2)/(1 + s/(Q6 w6) + (s/w6)^2)
// A signal is taken as straight between its samples; the answer to it is then exact at any step, equal or not.
#pragma once
#include <span>
#include <vector>

namespace hilo {

struct FrequencyWeighting {
  double f1, f2, f3, f4, Q4, f5, Q5, f6, Q6;  // no upward step where f5 = 0
};
/// Wk: seated, along the spine (z).  Wd: seated, horizontal (x, y).
inline constexpr FrequencyWeighting weighting_k{0.4, 100, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91};
inline constexpr FrequencyWeighting weighting_d{0.4, 100, 2, 2, 0.63, 0, 0, 0, 0};

/// |H| at a frequency [Hz].
double weighting_factor(const FrequencyWeighting& w, double frequency);

/// The weighted signal at the sample times, from rest; two equal times make a jump.
std::vector<double> weighted(const FrequencyWeighting& w, std::span<const double> t, std::span<const double> a);

/// Root mean square and fourth-power dose over the record, and the largest running r.m.s. over `window`, of which what lies before the
/// record counts as zero (ISO 2631-1: a_w, VDV, MTVV with 1 s); unit of a, VDV times s^(1/4).
struct Vibration {
  double rms = 0, dose = 0, running = 0;
};
Vibration vibration(std::span<const double> t, std::span<const double> weighted, double window = 1);

}  // namespace hilo
