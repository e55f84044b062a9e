// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/curve.hpp"

#include <algorithm>
#include <cmath>

#include "base/spline.hpp"

namespace hilo {

Curve::Curve(std::vector<Vec3> points, bool closed) : closed_(closed), x_(std::move(points)) {
  if (closed_) x_.push_back(x_.front());
  const size_t n = x_.size(), pieces = n - 1;
  s_.assign(n, 0.0);
  for (size_t i = 1; i < n; ++i) s_[i] = s_[i - 1] + (x_[i] - x_[i - 1]).norm();
  m_.assign(n, Vec3::Zero());
  if (n < 3) return;
  const auto h = [&](size_t i) { return s_[i + 1] - s_[i]; };
  const auto slope = [&](size_t i) { return Vec3((x_[i + 1] - x_[i]) / h(i)); };
  // h_{i-1} m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_i m_{i+1} = 6 (slope_i - slope_{i-1})
  if (closed_) {  // unknowns m_0 .. m_{pieces-1}
    Tridiagonal a(pieces);
    std::vector<Vec3> rhs(pieces);
    for (size_t i = 0; i < pieces; ++i) {
      const size_t before = (i + pieces - 1) % pieces;
      a.low[i] = h(before), a.up[i] = h(i), a.mid[i] = 2 * (h(before) + h(i));
      rhs[i] = 6 * (slope(i) - slope(before));
    }
    solve_cyclic(a, rhs);
    std::copy(rhs.begin(), rhs.end(), m_.begin());
    m_[pieces] = m_[0];
    return;
  }
  if (n == 3) {  // the parabola
    m_[0] = m_[1] = m_[2] = 2 * (slope(1) - slope(0)) / (h(0) + h(1));
    return;
  }
  const size_t k = n - 2;  // unknowns m_1 .. m_{n-2}; third derivatives are continuous at the second and the last but one point
  Tridiagonal a(k);
  std::vector<Vec3> rhs(k);
  for (size_t i = 0; i < k; ++i) {
    a.low[i] = h(i), a.up[i] = h(i + 1), a.mid[i] = 2 * (h(i) + h(i + 1));
    rhs[i] = 6 * (slope(i + 1) - slope(i));
  }
  const double h0 = h(0), h1 = h(1), ha = h(n - 3), hb = h(n - 2);
  a.mid[0] += h0 * (h0 + h1) / h1, a.up[0] -= h0 * h0 / h1;
  a.mid[k - 1] += hb * (ha + hb) / ha, a.low[k - 1] -= hb * hb / ha;
  solve_tridiagonal(a, rhs);
  std::copy(rhs.begin(), rhs.end(), m_.begin() + 1);
  m_[0] = ((h0 + h1) * m_[1] - h0 * m_[2]) / h1;
  m_[n - 1] = ((ha + hb) * m_[n - 2] - hb * m_[n - 3]) / ha;
}

Curve::Point Curve::at(double s) const {
  if (closed_) s -= length() * std::floor(s / length());
  const double inside = std::clamp(s, 0.0, length());
  const size_t i = std::clamp<size_t>(std::upper_bound(s_.begin(), s_.end(), inside) - s_.begin(), 1, s_.size() - 1) - 1;
  const double h = s_[i + 1] - s_[i], b = (inside - s_[i]) / h, a = 1 - b;
  Point p;
  p.x = a * x_[i] + b * x_[i + 1] + h * h / 6 * ((a * a * a - a) * m_[i] + (b * b * b - b) * m_[i + 1]);
  p.dx = (x_[i + 1] - x_[i]) / h + h / 6 * ((1 - 3 * a * a) * m_[i] + (3 * b * b - 1) * m_[i + 1]);
  p.ddx = a * m_[i] + b * m_[i + 1];
  if (s != inside) p.x += (s - inside) * p.dx, p.ddx.setZero();
  return p;
}

double Curve::nearest(const Vec3& x) const {
  double best = 0, least = 1e300;
  for (size_t i = 0; i + 1 < s_.size(); ++i)
    for (int k = 0; k <= 8; ++k) {
      const double s = s_[i] + (s_[i + 1] - s_[i]) * k / 8, d = (at(s).x - x).squaredNorm();
      if (d < least) least = d, best = s;
    }
  for (int it = 0; it < 50; ++it) {
    const Point p = at(best);
    const double slope = p.dx.squaredNorm() + (p.x - x).dot(p.ddx), full = p.dx.squaredNorm();
    const double step = -(p.x - x).dot(p.dx) / (slope > 0.2 * full ? slope : full);
    best += step;
    if (!closed_) best = std::clamp(best, 0.0, length());
    if (std::abs(step) < 1e-15 * length()) break;
  }
  return best;
}

}  // namespace hilo
