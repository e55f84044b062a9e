// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/motion_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hilo {

MotionLaw::MotionLaw(double scale, bool is_rate, History history, bool ramped)
    : scale_(scale), is_rate_(is_rate), ramped_(ramped), history_(std::move(history)) {}

Course MotionLaw::at(double t, double near, double factor) const {
  const History::Jet h = history_.at(t, near);
  if (is_rate_) return {scale_ * t * history_.mean(0, t), scale_ * h.value, scale_ * h.slope};
  const double f = scale_ * (ramped_ ? factor : 1);
  return {f * h.value, f * h.slope, f * h.curvature};
}

double MotionLaw::jump(double t, double near) const { return std::abs(at(t, t + near).rate - at(t, t - near).rate); }

double MotionLaw::top_rate() const {
  double top = 0;
  for (size_t i = 0; i < history_.t.size(); ++i) {
    if (is_rate_) top = std::max(top, std::abs(history_.value[i]));
    if (!is_rate_ && i > 0 && history_.t[i] > history_.t[i - 1])
      top = std::max(top, std::abs((history_.value[i] - history_.value[i - 1]) / (history_.t[i] - history_.t[i - 1])));
  }
  return std::abs(scale_) * top;
}

}  // namespace hilo
