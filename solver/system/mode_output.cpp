// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/mode_output.hpp"

#include <cmath>
#include <numbers>

namespace hilo {

double NaturalMode::frequency() const { return std::copysign(std::sqrt(std::abs(pole2)), pole2) / (2 * std::numbers::pi); }

void ModeOutput::observe(const Sight& at) {
  std::vector<double>& out = at.end;
  out.push_back(now.frequency());
  out.push_back(now.damping);
  out.insert(out.end(), now.mass.data(), now.mass.data() + 6);
  out.push_back(now.error);
  out.push_back(now.amplitude);
  out.insert(out.end(), now.part.data(), now.part.data() + 6);
  out.push_back(now.omega2);
  for (size_t k = 0; k < static_cast<size_t>(most_); ++k) out.push_back(k < now.coupling.size() ? now.coupling[k] : 0);
  out.insert(out.end(), now.drag.data(), now.drag.data() + 6);
  out.push_back(now.load);
}

}  // namespace hilo
