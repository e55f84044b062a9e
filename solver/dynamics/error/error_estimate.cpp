// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/error/error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/archive.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

constexpr double small_part = 0.2;  // of the motion

}  // namespace

double apart(const System& system, const Config& a, const Config& b) {
  double most = 0;
  for (size_t i = 0; i < a.x.size(); ++i) most = std::max(most, (a.x[i] - b.x[i]).norm());
  for (size_t i = 0; i < a.c.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const Vec3 c = a.c[i] - b.c[i], d = system.bodies[i].size * (a.R[i].col(k) - b.R[i].col(k));
      most = std::max({most, (c + d).norm(), (c - d).norm()});
    }
  return system.comm->max(most);
}

void ErrorEstimate::look(double t, double apart, double moved, int order, double added) {
  t_ = t, apart_ = apart, order_ = std::min(order_, order), ++looks_;
  motion_ = std::max(motion_, moved);
  if (apart > most_) most_ = apart, most_t_ = t;
  if (!samples_.empty() && t < samples_.back().t + spacing_) return;
  samples_.push_back({t, most_, added});
  if (samples_.size() < 2000) return;
  for (size_t k = 0; 2 * k + 1 < samples_.size(); ++k) samples_[k] = samples_[2 * k + 1];
  samples_.resize(samples_.size() / 2);
  spacing_ = t / static_cast<double>(samples_.size());
}

void ErrorEstimate::add_up(double t, double sum, double moved) {
  is_sum_ = true, t_ = most_t_ = t, apart_ = most_ = sum;
  motion_ = std::max(motion_, moved);
}

double ErrorEstimate::trusted() const {
  for (const Sample& s : samples_)
    if (s.most > small_part * motion_) return s.t;
  return t_;
}

/// The distance over what steps added, the largest until t.
double ErrorEstimate::grown(double t) const {
  double most = 0;
  for (const Sample& s : samples_)
    if (s.t <= t && s.added > 0) most = std::max(most, s.most / s.added);
  return most;
}

/// A power of the time grows as much from T/4 to T/2 as from T/2 to T; an exponential twice as much in the latter.
double ErrorEstimate::growth() const {
  const double T = trusted(), early = grown(T / 4), middle = grown(T / 2), late = grown(T);
  if (!(early > 0)) return 0;
  const double before = std::log(middle / early), behind = std::log(late / middle);
  return behind > 3 && before > 1 ? behind / (T / 2) : 0;
}

double ErrorEstimate::error(double apart, double t) const {
  if (is_sum_) return apart;
  const double factor = std::pow(2.0, order_) - 1, T = trusted(), rate = growth();
  if (t < T || (t <= T && apart <= small_part * motion_)) return apart / factor;
  if (rate > 0) return std::min(apart, small_part * motion_ / factor * std::exp(rate * (t - T)));
  return apart <= small_part * motion_ ? apart / factor : apart;
}

double ErrorEstimate::rounding(double t) const {
  const double rate = growth();
  return rate > 0 ? std::numeric_limits<double>::epsilon() * motion_ * std::exp(rate * t) : 0;
}

double ErrorEstimate::meaningless_from() const {
  const double nothing = small_part * motion_, never = std::numeric_limits<double>::infinity();
  if (!(motion_ > rest_)) return never;
  for (const Sample& s : samples_)
    if (error(s.most, s.t) >= nothing) return s.t;
  return never;
}

void ErrorEstimate::archive(Archive& a) {
  a("error estimate", order_, splits_, looks_, t_, apart_, most_, most_t_, motion_, spacing_, samples_, why_, is_lost_, is_sum_);
}

}  // namespace hilo
