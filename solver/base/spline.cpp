// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/spline.hpp"

#include <cmath>

namespace hilo {

std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& value, SplineEnds ends, double first,
                                  double last) {
  const size_t n = t.size();
  std::vector<double> m(n, 0.0);
  if (n < 2) return m;
  const auto h = [&](size_t i) { return t[i + 1] - t[i]; };
  const auto chord = [&](size_t i) { return (value[i + 1] - value[i]) / h(i); };
  Tridiagonal a(n);
  // curvatures agree: m_{i-1}/h_{i-1} + 2 (1/h_{i-1} + 1/h_i) m_i + m_{i+1}/h_i = 3 (chord_{i-1}/h_{i-1} + chord_i/h_i)
  const auto row = [&](size_t i, size_t before) {
    a.low[i] = 1 / h(before), a.up[i] = 1 / h(i), a.mid[i] = 2 * (a.low[i] + a.up[i]);
    m[i] = 3 * (chord(before) * a.low[i] + chord(i) * a.up[i]);
  };
  for (size_t i = 1; i + 1 < n; ++i) row(i, i - 1);
  if (ends == SplineEnds::periodic) {
    row(0, n - 2);
    m.pop_back();
    solve_cyclic(a, m);
    m.push_back(m[0]);
    return m;
  }
  const auto end = [&](size_t i, size_t piece, double& beside, double slope) {
    const bool clamped = ends == SplineEnds::clamped;
    a.mid[i] = clamped ? 1 : 2, beside = clamped ? 0 : 1;
    m[i] = clamped ? slope : 3 * chord(piece);
  };
  end(0, 0, a.up[0], first), end(n - 1, n - 2, a.low[n - 1], last);
  solve_tridiagonal(a, m);
  return m;
}

std::vector<double> monotone_slopes(const std::vector<double>& t, const std::vector<double>& value) {
  const size_t n = t.size();
  std::vector<double> m(n, 0.0);
  if (n < 2) return m;
  const auto h = [&](size_t i) { return t[i + 1] - t[i]; };
  const auto chord = [&](size_t i) { return (value[i + 1] - value[i]) / h(i); };
  for (size_t i = 1; i + 1 < n; ++i) {
    const double a = chord(i - 1), b = chord(i), u = 2 * h(i) + h(i - 1), v = h(i) + 2 * h(i - 1);
    if (a * b > 0) m[i] = (u + v) / (u / a + v / b);
  }
  // a parabola through three points, kept to the way that the end goes
  const auto end = [&](double near, double far, double h0, double h1) {
    const double slope = ((2 * h0 + h1) * near - h0 * far) / (h0 + h1);
    if (slope * near <= 0) return 0.0;
    return near * far <= 0 && std::abs(slope) > 3 * std::abs(near) ? 3 * near : slope;
  };
  m[0] = n == 2 ? chord(0) : end(chord(0), chord(1), h(0), h(1));
  m[n - 1] = n == 2 ? chord(0) : end(chord(n - 2), chord(n - 3), h(n - 2), h(n - 3));
  return m;
}

}  // namespace hilo
