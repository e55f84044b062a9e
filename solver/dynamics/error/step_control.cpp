// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/error/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {

std::vector<Event> events(const System& system, double end, double step) {
  std::vector<Event> out, sparse;  // those that all count, and those that do where they are apart
  for (const UsedHistory& used : system.histories)
    for (const History::Break& b : used.history.breaks()) {
      const int order = b.order - static_cast<int>(used.acts);  // of the derivative of forces that jumps; -1: velocities jump
      if (order > 1) continue;
      (order < 0 || b.order == 0 ? out : sparse).push_back({b.t, order <= 0});
    }
  const auto earlier = [](const Event& a, const Event& b) { return a.t < b.t; };
  std::sort(sparse.begin(), sparse.end(), earlier);
  const auto apart = [&](double a, double b) { return std::abs(a - b) > 1e-9 * step; };
  for (size_t i = 0; i < sparse.size(); ++i) {
    size_t before = i, behind = i;  // neighbours at another time
    while (before > 0 && !apart(sparse[before].t, sparse[i].t)) --before;
    while (behind + 1 < sparse.size() && !apart(sparse[behind].t, sparse[i].t)) ++behind;
    const bool dense = (apart(sparse[before].t, sparse[i].t) && sparse[i].t - sparse[before].t < step) ||
                       (apart(sparse[behind].t, sparse[i].t) && sparse[behind].t - sparse[i].t < step);
    if (!dense) out.push_back(sparse[i]);
  }
  std::sort(out.begin(), out.end(), earlier);
  std::vector<Event> merged;
  for (const Event& e : out) {
    if (e.t < 1e-9 * step || e.t > end - 1e-9 * step) continue;
    if (merged.empty() || apart(merged.back().t, e.t))
      merged.push_back(e);
    else
      merged.back().jump = merged.back().jump || e.jump;
  }
  return merged;
}

StepControl::StepControl(const System& system, int order, double demand, double end, double largest_step)
    : system_(system), order_(order), demand_(demand), end_(end), largest_(largest_step) {}

void StepControl::restart(const State& s) {
  t_ = started_ = s.t;
  past_.clear();
  double third = 0, top[2] = {0, 0};  // |q'''|; sqrt(|q''| |q''''|) and the frequency there
  const auto look = [&](double size, const Vec3& a, const Vec3& jerk, const Vec3& snap) {
    third = std::max(third, size * jerk.norm());
    const double wave = size * std::sqrt(a.norm() * snap.norm());
    if (wave > top[0]) top[0] = wave, top[1] = std::sqrt(snap.norm() / a.norm());
  };
  const auto free = [](const std::array<bool, 3>& held, Vec3 x) {  // components that move by a law are as they should be
    for (int k = 0; k < 3; ++k)
      if (held[k]) x[k] = 0;
    return x;
  };
  for (const UnknownField& f : system_.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const int i = f.item[k];
      const auto held = f.held_of(k);
      if (!f.turns()) look(f.scale(k), free(held, (s.a.*f.array)[i]), free(held, (s.jerk.*f.array)[i]), free(held, (s.snap.*f.array)[i]));
      for (int c = 0; c < 3 && f.turns(); ++c) look(f.scale(k), s.a.R[i].col(c), s.jerk.R[i].col(c), s.snap.R[i].col(c));
    }
  first_third_ = system_.comm->max(top[0]);
  fade_ = first_third_ > 0 ? 1 / -system_.comm->max(top[0] == first_third_ ? -top[1] : -1e300) : 0;
  const double worst = std::max(system_.comm->max(third), first_third_);
  const double wish = worst > 0 ? std::pow(12 * demand_ / worst, order_ == 2 ? 1. / 2 : 1. / 3) : 1e300;
  step_ = std::min({wish / 2, largest_, end_ / 16, largest_ / 4});  // half: forces may grow at once
  for (double back : {2 * step_, step_, 0.0}) {
    Past p{s.t - back, {}};
    combine(p.q, {{1, &s.q}, {-back, &s.v}, {back * back / 2, &s.a}, {-back * back * back / 6, &s.jerk}});
    past_.push_back(std::move(p));
  }
  calm_ = 0;
}

double largest_third_derivative(const System& system, const std::array<const Config*, 4>& q, const std::array<double, 4>& t) {
  double w[4];  // q[t0, t1, t2, t3] = sum w_k q_k
  for (int i = 0; i < 4; ++i) {
    w[i] = 6;
    for (int j = 0; j < 4; ++j)
      if (j != i) w[i] /= t[i] - t[j];
  }
  double top = 0;
  const auto look = [&](double size, const std::array<bool, 3>& held, const auto& value) {
    Vec3 d = Vec3::Zero();
    for (int k = 0; k < 4; ++k) d += w[k] * value(*q[k]);
    for (int k = 0; k < 3; ++k)
      if (held[k]) d[k] = 0;  // moves by a law
    top = std::max(top, size * d.norm());
  };
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const int i = f.item[k];
      if (!f.turns()) look(f.scale(k), f.held_of(k), [&](const Config& c) { return (c.*f.array)[i]; });
      for (int c = 0; c < 3 && f.turns(); ++c) look(f.scale(k), {}, [&](const Config& at) { return Vec3(at.R[i].col(c)); });
    }
  return system.comm->max(top);
}

double StepControl::error(const Config& q1, double h) const {
  const double third =
      largest_third_derivative(system_, {&past_[0].q, &past_[1].q, &past_[2].q, &q1}, {past_[0].t, past_[1].t, past_[2].t, t_ + h});
  const double at_first = fade_ > 0 ? first_third_ * std::exp(-(t_ - started_) / fade_) : 0;
  return h * h * h / 12 * std::max(third, at_first);
}

bool StepControl::accept(const Config& q1, double h) {
  const double e = error(q1, h), seen = order_ == 2 ? e / h : e;
  const double ratio = seen > 0 ? demand_ / seen : 1e300, power = order_ == 2 ? 1. / 2 : 1. / 3;
  if (ratio < 0.2) {
    step_ = h * std::max(0.3, 0.9 * std::pow(ratio, power));
    calm_ = 0;
    return false;
  }
  sum_ += e, added_ += std::pow(e / demand_, (order_ + 1) / 3.0);
  t_ += h;
  past_.pop_front();
  past_.push_back({t_, q1});
  // a smooth sequence of steps keeps the order: two thirds of the exponent, and a bound on growth, tighter after a cut
  const double most = ++calm_ < 4 ? 1.0 : ratio > 16 ? 2.0 : 1.2;
  step_ = std::min(largest_, h * std::clamp(0.97 * std::pow(ratio, power * 2 / 3), 0.6, calm_ < 2 && ratio > 4 ? 1.2 : most));
  return true;
}

void StepControl::cut(double h) { step_ = h / 2, calm_ = 0; }

}  // namespace hilo
