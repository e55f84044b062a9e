// SPDX-License-Identifier: GPL-3.0-or-later
// Cubic splines through points: systems of three diagonals, and slopes at the points of piecewise cubics of one variable.
#pragma once
#include <cstddef>
#include <vector>

namespace hilo {

/// Three diagonals, the first and last entries of `low` and `up` beside them: low[i] x[i-1] + mid[i] x[i] + up[i] x[i+1] = rhs[i].
struct Tridiagonal {
  std::vector<double> low, mid, up;
  explicit Tridiagonal(std::size_t n) : low(n), mid(n), up(n) {}
};

/// x: the right hand sides, then the solution; T: a number or a vector.
template <class T>
void solve_tridiagonal(Tridiagonal a, std::vector<T>& x) {
  const size_t n = x.size();
  for (size_t i = 1; i < n; ++i) {
    const double f = a.low[i] / a.mid[i - 1];
    a.mid[i] -= f * a.up[i - 1];
    x[i] -= f * x[i - 1];
  }
  for (size_t i = n; i-- > 0;) {
    if (i + 1 < n) x[i] -= a.up[i] * x[i + 1];
    x[i] /= a.mid[i];
  }
}

/// The same where low[0] stands in the last column and up[n-1] in the first one, n > 1: these are taken off by one more solve
/// (Sherman-Morrison).
template <class T>
void solve_cyclic(Tridiagonal a, std::vector<T>& x) {
  const size_t last = x.size() - 1;
  const double gamma = -a.mid[0], ratio = a.low[0] / gamma;
  a.mid[0] -= gamma, a.mid[last] -= a.up[last] * ratio;
  std::vector<double> corner(x.size(), 0.0);
  corner[0] = gamma, corner[last] = a.up[last];
  solve_tridiagonal(a, x), solve_tridiagonal(a, corner);
  const T factor = (x[0] + ratio * x[last]) / (1 + corner[0] + ratio * corner[last]);
  for (size_t i = 0; i <= last; ++i) x[i] -= factor * corner[i];
}

/// How a spline ends: without curvature; with slopes that are given; as it begins, one period.
enum class SplineEnds { natural, clamped, periodic };

/// Slopes at the points of the cubic spline of two continuous derivatives [de-boor-1978]; t rises, `first` and `last` are those of a
/// clamped one.  A periodic one needs three points, the last with the value of the first.
std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& value, SplineEnds ends, double first = 0,
                                  double last = 0);
/// Slopes of a piecewise cubic that rises and falls only where the points do [fritsch-butland-1984]: their harmonic mean, zero at tops.
std::vector<double> monotone_slopes(const std::vector<double>& t, const std::vector<double>& value);

}  // namespace hilo
