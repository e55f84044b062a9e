// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/spring_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hilo {
namespace {

/// Force over the coordinate less `free`, linear between its points and constant beyond them.
struct CurveLaw final : SpringLaw {
  double free, c;
  std::vector<double> x, f, work;  // work: from the first point to each
  CurveLaw(double free_value, double damping, std::vector<double> at, std::vector<double> force)
      : free(free_value), c(damping), x(std::move(at)), f(std::move(force)), work(x.size(), 0.0) {
    for (size_t i = 1; i < x.size(); ++i) work[i] = work[i - 1] + (f[i] + f[i - 1]) / 2 * (x[i] - x[i - 1]);
  }
  struct At {
    double force, slope, work;
  };
  /// At the first point the slope is that behind it: a table that begins at rest resists what begins to pull.
  At at(double e) const {
    if (e < x.front()) return {f.front(), 0, f.front() * (e - x.front())};
    if (e >= x.back()) return {f.back(), 0, work.back() + f.back() * (e - x.back())};
    const auto i = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), e) - x.begin());
    const double slope = (f[i] - f[i - 1]) / (x[i] - x[i - 1]), d = e - x[i - 1];
    return {f[i - 1] + slope * d, slope, work[i - 1] + (f[i - 1] + slope * d / 2) * d};
  }
  void elastic(const Values& e0, const Values& e1, Response& out) const override {
    const At a = at(e0[0] - free), b = at(e1[0] - free);
    const double d = e1[0] - e0[0], size = x.back() - x.front();
    // a discrete gradient; over a short way the mean of the ends, which is the same where they lie on one line
    const bool near = std::abs(d) < 1e-7 * size;
    const double s = near ? (a.force + b.force) / 2 : (b.work - a.work) / d;
    out.s[0] += s;
    out.D[0][0] += near ? b.slope / 2 : (b.force - s) / d;
    out.energy += b.work - at(0).work;
  }
  void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const override {
    if (c == 0) return;
    const double s = c * (r1[0] - r0[0]) / step.h;
    out.s[0] += s, out.D[0][0] += c / step.h, out.dissipated += s * (r1[0] - r0[0]);
  }
  bool conserves() const override { return c == 0; }
  bool is_smooth() const override { return false; }  // at the points of its table
};

}  // namespace

std::unique_ptr<SpringLaw> make_curve(double free, double damping, std::vector<double> extension, std::vector<double> force) {
  return std::make_unique<CurveLaw>(free, damping, std::move(extension), std::move(force));
}

}  // namespace hilo
