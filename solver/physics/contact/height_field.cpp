// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/contact/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "base/spline.hpp"

namespace hilo {
namespace {

/// Slope at t[0] of the polynomial through n points, the next ones at `step` = 1, or before it at -1.
double end_slope(const double* t, const double* f, int n, int step) {
  double slope = 0;
  for (int k = 1; k < n; ++k) {  // Lagrange: f_k - f_0 times the derivative of its polynomial at t_0
    double weight = 1 / (t[k * step] - t[0]);
    for (int j = 1; j < n; ++j)
      if (j != k) weight *= (t[0] - t[j * step]) / (t[k * step] - t[j * step]);
    slope += (f[k * step] - f[0]) * weight;
  }
  return slope;
}

std::vector<double> slopes(const std::vector<double>& t, const std::vector<double>& f) {
  const auto n = static_cast<int>(t.size()), of_end = std::min(n, 4);
  return spline_slopes(t, f, SplineEnds::clamped, end_slope(t.data(), f.data(), of_end, 1), end_slope(&t.back(), &f.back(), of_end, -1));
}

/// The four basis functions of a piece (height and slope at its beginning, then at its end), with two derivatives; straight on beyond it.
struct Basis {
  size_t piece;
  std::array<double, 4> value, first, second;
  Basis(const std::vector<double>& t, double at) {
    const double c = std::clamp(at, t.front(), t.back()), beyond = at - c;
    piece = static_cast<size_t>(std::upper_bound(t.begin() + 1, t.end() - 1, c) - t.begin()) - 1;
    const double l = t[piece + 1] - t[piece], s = (c - t[piece]) / l;
    value = {(1 + 2 * s) * (1 - s) * (1 - s), l * s * (1 - s) * (1 - s), s * s * (3 - 2 * s), -l * s * s * (1 - s)};
    first = {6 * s * (s - 1) / l, (1 - s) * (1 - 3 * s), 6 * s * (1 - s) / l, s * (3 * s - 2)};
    second = {(12 * s - 6) / (l * l), (6 * s - 4) / l, (6 - 12 * s) / (l * l), (6 * s - 2) / l};
    if (beyond == 0) return;
    for (size_t k = 0; k < 4; ++k) value[k] += beyond * first[k], second[k] = 0;
  }
};

}  // namespace

HeightField::HeightField(std::vector<double> x, std::vector<double> y, const std::vector<double>& heights)
    : x_(std::move(x)), y_(std::move(y)), node_(heights.size()) {
  const size_t nx = x_.size(), ny = y_.size();
  const auto along_x = [&](int from, int to) {
    std::vector<double> line(nx);
    for (size_t j = 0; j < ny; ++j) {
      for (size_t i = 0; i < nx; ++i) line[i] = node_[j * nx + i][from];
      line = slopes(x_, line);
      for (size_t i = 0; i < nx; ++i) node_[j * nx + i][to] = line[i];
    }
  };
  const auto along_y = [&](int from, int to) {
    std::vector<double> line(ny);
    for (size_t i = 0; i < nx; ++i) {
      for (size_t j = 0; j < ny; ++j) line[j] = node_[j * nx + i][from];
      line = slopes(y_, line);
      for (size_t j = 0; j < ny; ++j) node_[j * nx + i][to] = line[j];
    }
  };
  for (size_t k = 0; k < node_.size(); ++k) node_[k][0] = heights[k];
  along_x(0, 1), along_y(0, 2), along_y(1, 3);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  low_ = *low, high_ = *high;
  extent_ =
      std::max({std::abs(x_.front()), std::abs(x_.back()), std::abs(y_.front()), std::abs(y_.back()), std::abs(low_), std::abs(high_)});
  spacing_ = extent_;
  piece_ = std::max((x_.back() - x_.front()) / double(nx - 1), (y_.back() - y_.front()) / double(ny - 1));
  for (const std::vector<double>* t : {&x_, &y_})
    for (size_t k = 1; k < t->size(); ++k) spacing_ = std::min(spacing_, (*t)[k] - (*t)[k - 1]);
  for (const double u : x_)
    for (const double v : y_) {
      const Height at = this->at(u, v);
      // the larger root of det(second - curvature metric) = 0, second of the surface over sqrt(1 + slope^2)
      const double E = 1 + at.hx * at.hx, F = at.hx * at.hy, G = 1 + at.hy * at.hy, s = std::sqrt(1 + at.hx * at.hx + at.hy * at.hy);
      const double a = E * G - F * F, b = (at.hxx * G + at.hyy * E - 2 * at.hxy * F) / s, c = (at.hxx * at.hyy - at.hxy * at.hxy) / (s * s);
      steep_ = std::max(steep_, 1.1 * s);
      const double curvature = (b + std::sqrt(std::max(b * b - 4 * a * c, 0.))) / (2 * a);
      if (curvature > 0) hollow_ = std::min(hollow_, 1 / curvature);
    }
}

bool HeightField::is_finite() const {
  return std::isfinite(extent_) && std::ranges::all_of(node_, [](const auto& node) {
           return std::ranges::all_of(node, [](double x) { return std::abs(x) < 1e150; });
         });
}

bool HeightField::is_beyond(const Vec3& p, double distance) const {
  const double least = steep_ * (distance + 2 * piece_);
  return p[2] > low_ + least && (p[2] > high_ + least || p[2] > at(p[0], p[1]).h + least);
}

HeightField::Height HeightField::at(double u, double v) const {
  const Basis a(x_, u), b(y_, v);
  const size_t nx = x_.size();
  Height out{0, 0, 0, 0, 0, 0};
  for (size_t j = 0; j < 2; ++j)
    for (size_t i = 0; i < 2; ++i) {
      const std::array<double, 4>& f = node_[(b.piece + j) * nx + a.piece + i];
      for (size_t n = 0; n < 4; ++n) {  // bit 0: slope along x, bit 1: along y
        const size_t p = 2 * i + (n & 1), q = 2 * j + (n >> 1);
        out.h += f[n] * a.value[p] * b.value[q];
        out.hx += f[n] * a.first[p] * b.value[q], out.hy += f[n] * a.value[p] * b.first[q];
        out.hxx += f[n] * a.second[p] * b.value[q], out.hyy += f[n] * a.value[p] * b.second[q];
        out.hxy += f[n] * a.first[p] * b.first[q];
      }
    }
  return out;
}

/// Newton's method on half the squared distance, from below the point or from the nearest of some points of the grid around.
std::array<double, 2> HeightField::nearest(const Vec3& p) const {
  double u = p[0], v = p[1];
  Height at = this->at(u, v);
  const double way = std::abs(p[2] - at.h);
  double best = way * way / 2;
  const auto range = [&](const std::vector<double>& t, double centre) {
    const auto first = std::lower_bound(t.begin(), t.end(), centre - way) - t.begin();
    const auto last = std::upper_bound(t.begin(), t.end(), centre + way) - t.begin();
    return std::array{static_cast<size_t>(first), static_cast<size_t>(last), static_cast<size_t>(1 + (last - first) / 16)};
  };
  const auto [i0, i1, di] = range(x_, p[0]);
  const auto [j0, j1, dj] = range(y_, p[1]);
  for (size_t j = j0; j < j1; j += dj)
    for (size_t i = i0; i < i1; i += di) {
      const double d = (Vec3(x_[i], y_[j], node_[j * x_.size() + i][0]) - p).squaredNorm() / 2;
      if (d < best) best = d, u = x_[i], v = y_[j];
    }
  at = this->at(u, v);
  const double small = 1e-15 * (extent_ + p.norm());
  for (int pass = 0; pass < 60; ++pass) {
    const double up = p[2] - at.h, gu = u - p[0] - up * at.hx, gv = v - p[1] - up * at.hy;
    double a = 1 + at.hx * at.hx - up * at.hxx, b = at.hx * at.hy - up * at.hxy, d = 1 + at.hy * at.hy - up * at.hyy;
    if (!(a > 0 && a * d - b * b > 1e-3 * a * d)) a = 1 + at.hx * at.hx, b = at.hx * at.hy, d = 1 + at.hy * at.hy;
    const double det = a * d - b * b, du = -(d * gu - b * gv) / det, dv = -(a * gv - b * gu) / det, size = std::hypot(du, dv);
    if (!(size > small)) break;
    const double now = (Vec3(u, v, at.h) - p).squaredNorm();
    const bool last = size < 1e-6 * spacing_;  // rounding would say which is nearer
    double share = 1;
    Height next = this->at(u + du, v + dv);
    for (int cut = 0; cut < 40 && !last && (Vec3(u + share * du, v + share * dv, next.h) - p).squaredNorm() > now * (1 + 1e-15); ++cut)
      share /= 2, next = this->at(u + share * du, v + share * dv);
    u += share * du, v += share * dv, at = next;
  }
  return {u, v};
}

HeightField::Outside HeightField::outside(const Vec3& p) const {
  Outside out{p[0] - x_.back(), 0, 1};
  const auto take = [&](double distance, int axis, double sign) {
    if (distance > out.distance) out = {distance, axis, sign};
  };
  take(x_.front() - p[0], 0, -1), take(p[1] - y_.back(), 1, 1), take(y_.front() - p[1], 1, -1);
  return out;
}

}  // namespace hilo
