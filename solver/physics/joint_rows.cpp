// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/joint_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hilo {

SumRows::SumRows(int n_plain, std::vector<std::vector<Part>> sums) : n_plain_(n_plain), sums_(std::move(sums)) {}

double SumRows::value(const Part& p, const Values& e) const {
  const double* m = &e[p.measure];
  switch (p.of) {
    case itself:
      return *m;
    case angle:
      return turn_[p.measure].unwrap(m[0], m[1]);
    case arcsine:
      return std::asin(std::clamp(*m, -1.0, 1.0));
    case tilt:
      return arc(tilted(m), p.axis).value;
    case rotation:
      return 2 * arc(attitude_.quaternion(m), p.axis).value;
  }
  return 0;
}

void SumRows::values(const Values& e, double* g) const {
  for (int r = 0; r < n_plain_; ++r) g[r] = e[r];
  for (size_t k = 0; k < sums_.size(); ++k) {
    double& sum = g[n_plain_ + k];
    sum = 0;
    for (const Part& p : sums_[k]) sum += p.weight * value(p, e);
  }
}

void SumRows::gradient(const Values& e0, const Values& e1, Gradient& out) const {
  out.clear(n_rows());
  for (int r = 0; r < n_plain_; ++r) out.d[r][r] = 1;
  for (size_t k = 0; k < sums_.size(); ++k) {
    auto& d = out.d[n_plain_ + k];
    auto& D = out.D[n_plain_ + k];
    for (const Part& p : sums_[k]) {
      const int at = p.measure;
      const double *m0 = &e0[at], *m1 = &e1[at];
      switch (p.of) {
        case itself:
          d[at] += p.weight;
          break;
        case angle: {
          const Turn::Gradient g = turn_[at].gradient(m0, m1);
          for (int i = 0; i < 2; ++i) {
            d[at + i] += p.weight * g.d[i];
            for (int j = 0; j < 2; ++j) D[at + i][at + j] += p.weight * g.D[i][j];
          }
          break;
        }
        case arcsine: {
          const auto [slope, curvature] = arcsine_gradient(*m0, *m1);
          d[at] += p.weight * slope, D[at][at] += p.weight * curvature;
          break;
        }
        case tilt: {
          const ArcGradient g = arc_gradient(tilted(m0), tilted(m1), p.axis);
          const Eigen::Vector3d along = tilted_slopes().transpose() * g.d;
          const Eigen::Matrix3d by = tilted_slopes().transpose() * g.D * tilted_slopes();
          for (int i = 0; i < 3; ++i) {
            d[at + i] += p.weight * along[i];
            for (int j = 0; j < 3; ++j) D[at + i][at + j] += p.weight * by(i, j);
          }
          break;
        }
        case rotation: {
          const ArcGradient g = arc_gradient(attitude_.quaternion(m0), attitude_.quaternion(m1), p.axis);
          const Attitude::Slopes slopes = attitude_.slopes();
          const Eigen::Matrix<double, 9, 1> along = 2 * slopes.transpose() * g.d;
          const Eigen::Matrix<double, 9, 9> by = 2 * slopes.transpose() * g.D * slopes;
          for (int i = 0; i < 9; ++i) {
            d[at + i] += p.weight * along[i];
            for (int j = 0; j < 9; ++j) D[at + i][at + j] += p.weight * by(i, j);
          }
          break;
        }
      }
    }
  }
}

void SumRows::commit(const Values& e) {
  for (const auto& sum : sums_)
    for (const Part& p : sum) {
      if (p.of == angle) turn_[p.measure].committed = turn_[p.measure].unwrap(e[p.measure], e[p.measure + 1]);
      if (p.of == rotation && p.axis == 0) attitude_.accept(&e[p.measure]);
    }
}

/// Where an angle, or the axis about which it turns, is about to lose its meaning.
std::string SumRows::beyond(const Values& e) const {
  for (const auto& sum : sums_)
    for (const Part& p : sum) {
      const double* m = &e[p.measure];
      if (p.of == angle && std::hypot(m[0], m[1]) < 0.5) return "a tilt of 60 degrees of its axis";
      if (p.of == arcsine && std::abs(*m) > std::sin(80 * std::numbers::pi / 180)) return "80 degrees";
      if (p.of == tilt && m[2] < std::cos(170 * std::numbers::pi / 180)) return "a tilt of 170 degrees";
      if (p.of == rotation && attitude_.quaternion(m)[3] < -1e-9) return "half a turn";
    }
  return {};
}

namespace {

Vec3 point_of(const RowLaw::Values& e) { return {e[0], e[1], e[2]}; }

}  // namespace

CurveRows::CurveRows(Curve curve) : curve_(std::move(curve)), s_(curve_.nearest(Vec3::Zero())) {
  t_ = curve_.at(s_).dx.normalized();
  const Mat3 frame = frame_of_axis(t_);
  b_[0] = frame.col(0), b_[1] = frame.col(1);
}

double CurveRows::parameter(const Vec3& e) const {
  double s = s_;
  for (int it = 0; it < 30; ++it) {
    const Curve::Point p = curve_.at(s);
    double step = -t_.dot(p.x - e) / std::max(t_.dot(p.dx), 0.1 * p.dx.norm());
    step = std::clamp(step, -curve_.length() / 4, curve_.length() / 4);
    s += step;
    if (std::abs(step) < 1e-15 * curve_.length()) break;
  }
  return s;
}

CurveRows::Local CurveRows::local(const Vec3& e) const {
  const Curve::Point p = curve_.at(parameter(e));
  const double along = t_.dot(p.dx);
  Local out;
  for (int r = 0; r < 2; ++r) {
    const double across = b_[r].dot(p.dx);
    out.g[r] = b_[r].dot(e - p.x);
    out.d[r] = b_[r] - across / along * t_;
    out.H[r] = -(b_[r].dot(p.ddx) - across / along * t_.dot(p.ddx)) / (along * along) * t_ * t_.transpose();
  }
  return out;
}

void CurveRows::values(const Values& e, double* g) const {
  const Local l = local(point_of(e));
  g[0] = l.g[0], g[1] = l.g[1];
}

void CurveRows::gradient(const Values& e0, const Values& e1, Gradient& out) const {
  out.clear(n_rows());
  const Vec3 a = point_of(e0), b = point_of(e1), step = b - a;
  const Local mid = local((a + b) / 2);
  // below this step the correction is smaller than the round-off it is made of
  const double square = step.squaredNorm(), least = 1e-5 * curve_.length();
  const bool corrected = square > least * least;
  const Local start = corrected ? local(a) : Local{}, end = corrected ? local(b) : Local{};
  for (int r = 0; r < 2; ++r) {
    Vec3 d = mid.d[r];
    Mat3 D = mid.H[r] / 2;
    if (corrected) {
      const double missing = end.g[r] - start.g[r] - mid.d[r].dot(step);
      D += step * (end.d[r] - mid.d[r] - mid.H[r] * step / 2).transpose() / square;
      D -= 2 * missing / (square * square) * step * step.transpose();
      D.diagonal().array() += missing / square;
      d += missing / square * step;
    }
    for (int i = 0; i < 3; ++i) {
      out.d[r][i] = d[i];
      for (int k = 0; k < 3; ++k) out.D[r][i][k] = D(i, k);
    }
  }
}

void CurveRows::commit(const Values& e) {
  s_ = parameter(point_of(e));
  if (curve_.closed()) s_ -= curve_.length() * std::floor(s_ / curve_.length());
  t_ = curve_.at(s_).dx.normalized();
  b_[0] = (b_[0] - t_.dot(b_[0]) * t_).normalized();
  b_[1] = t_.cross(b_[0]);
}

std::string CurveRows::fault(const Values& e) const {
  const double s = parameter(point_of(e)), slack = 1e-9 * curve_.length();
  return !curve_.closed() && (s < -slack || s > curve_.length() + slack) ? "ran off the end of its curve" : "";
}

}  // namespace hilo
