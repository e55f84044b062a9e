// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/gate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hilo {

double load_frequency(const LoadHistory& h) {
  const size_t n = h.t.size();
  if (n < 3) return 0;
  double variance = 0, rate = 0, largest = 0;
  for (size_t a = 0; a < 3; ++a) {
    double mean = 0;
    for (const auto& F : h.F) mean += F[a] / static_cast<double>(n), largest = std::max(largest, std::abs(F[a]));
    for (const auto& F : h.F) variance += (F[a] - mean) * (F[a] - mean) / static_cast<double>(n);
    for (size_t i = 1; i < n; ++i)
      if (const double dt = h.t[i] - h.t[i - 1]; dt > 0)
        rate += std::pow((h.F[i][a] - h.F[i - 1][a]) / dt, 2) * dt / (h.t.back() - h.t.front());
  }
  return variance > 1e-18 * largest * largest ? std::sqrt(rate / variance) / (2 * std::numbers::pi) : 0;
}

double load_jump(const LoadHistory& h) {
  double largest = 0;
  const auto size = [](const std::array<double, 3>& F) { return std::hypot(F[0], F[1], F[2]); };
  for (const auto& F : h.F) largest = std::max(largest, size(F));
  return largest > 0 && h.F.size() > 1 ? size(h.F[1]) / largest : 0;
}

double least_ratio(double tolerance, double jump) { return (tolerance >= 0.05 ? 4 : tolerance >= 0.02 ? 12 : 16) * (jump >= 0.1 ? 2 : 1); }

double elastic_frequency(const std::vector<double>& rigid, const std::vector<double>& flexible) {
  std::vector<double> left = rigid, found = flexible;
  std::sort(found.begin(), found.end());
  for (const double f : found) {
    if (f < 1e-3) continue;
    const auto same = std::find_if(left.begin(), left.end(), [&](double r) { return std::abs(f - r) <= 0.05 * r; });
    if (same == left.end()) return f;
    left.erase(same);
  }
  return 0;
}

}  // namespace hilo
