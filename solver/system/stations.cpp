// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/stations.hpp"

#include <Eigen/SVD>

namespace hilo {

Vec3 Stations::mean(const Station& s, const Config& of) const {
  if (s.body >= 0) return of.c[s.body] + of.R[s.body] * s.arm;
  Vec3 sum = Vec3::Zero();
  for (const auto& [n, share] : s.nodes) sum += share * of.x[n];
  points_.comm->sum(std::span<double>(sum.data(), 3));
  return sum;
}

/// Of a patch of nodes, by the polar fit of its motion.
Mat3 Stations::axes(const Station& s, const Config& q, const Vec3& centre) const {
  if (s.body >= 0) return q.R[s.body] * s.axes;
  if (!s.turns) return s.axes;
  Mat3 F = Mat3::Zero();
  for (const auto& [n, share] : s.nodes) F += share * (q.x[n] - centre) * (points_.X[n] - s.mean).transpose();
  points_.comm->sum(std::span<double>(F.data(), 9));
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 D = Mat3::Identity();
  D(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * D * svd.matrixV().transpose() * s.axes;
}

std::vector<Output> Stations::outputs() const {
  std::vector<Output> out;
  for (const Station& s : list) {
    if (!s.sensor) {  // position, velocity; acceleration
      out.push_back({.group = "probe", .name = s.name, .n_end = 6, .n_mid = 3});
      continue;
    }
    const Vec3 gravity = points_.gravity;  // axes; acceleration
    out.push_back({.group = "sensor",
                   .name = s.name,
                   .n_end = 9,
                   .n_mid = 3,
                   .row = [gravity](const double* axes, const double* a, std::vector<double>& row) {
                     const Vec3 felt = Eigen::Map<const Mat3>(axes).transpose() * (Eigen::Map<const Vec3>(a) - gravity) / g0;
                     row.assign(felt.begin(), felt.end());
                   }});
  }
  return out;
}

void Stations::observe(const Sight& at) {
  const auto put = [](const auto& x, std::vector<double>& to) { to.insert(to.end(), x.data(), x.data() + x.size()); };
  for (const Station& s : list) {
    const Vec3 x = mean(s, at.q);
    if (s.sensor)
      put(axes(s, at.q, x), at.end);
    else
      put(x, at.end), put(mean(s, at.v), at.end);
    if (at.step) put(mean(s, *at.step->a), at.mid);
  }
}

}  // namespace hilo
