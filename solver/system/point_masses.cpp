// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/point_masses.hpp"

namespace hilo {

void PointMasses::add(const std::vector<std::pair<int, double>>& masses, const Vec3& centre) {
  masses_.insert(masses_.end(), masses.begin(), masses.end());
  entries_.push_back({masses_.size(), centre});
}

void PointMasses::add_reference_forces(std::vector<NodalForces>& list) const {
  size_t first = 0;
  for (const OfEntry& e : entries_) {
    for (int k = 0; k < 6; ++k) {
      NodalForces& forces = list.emplace_back();
      for (size_t i = first; i < e.end; ++i) {
        const auto& [n, m] = masses_[i];
        const Vec3 axis = Vec3::Unit(k % 3), f = m * (k < 3 ? axis : Vec3(axis.cross(points_.X[n] - e.centre)));
        if (!f.isZero(0)) forces.emplace_back(n, f);
      }
    }
    first = e.end;
  }
}

void PointMasses::evaluate(Pass& p) const {
  const Stage& s = p.s;
  for (const auto& [n, m] : masses_) {
    const Vec3 force = m * (s.a->x[n] - points_.gravity * s.load_factor);
    p.node[n] += force;
    p.scale(force.norm());
    if (!p.K) continue;
    if (points_.node_block[n] >= 0) {
      const auto& fixed = points_.fixed[n];
      const double f = m * s.mass_slope, d[3] = {fixed[0] ? 0 : f, fixed[1] ? 0 : f, fixed[2] ? 0 : f};
      p.K->add_diagonal(points_.node_block[n], d);
    } else if (!points_.shapes_at(n).empty()) {
      const Modes& modes = points_.modes[points_.modes_of[points_.follower[n]]];
      const auto blocks = points_.layout.cliques[modes.clique];
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> M = m * s.mass_slope * Mat3::Identity();
      std::vector<NodeMap> maps;
      std::vector<std::array<bool, 3>> masks;
      points_.make_maps({&n, 1}, blocks, s, maps, masks);
      add_reduced(*p.K, modes.clique, 1, M.data(), maps.data(), static_cast<int>(blocks.size()), masks.data());
    } else if (const int b = points_.follower[n]; points_.body_block[b] >= 0) {
      const double f = m * s.mass_slope * (s.tempo ? s.tempo[b] * s.tempo[b] : 1);
      const Mat3 left = skew(s.left->x[n] - s.left->c[b]), right = skew(s.end->x[n] - s.end->c[b]);
      Eigen::Matrix<double, 6, 6, Eigen::RowMajor> M;
      M << f * Mat3::Identity(), -f * right, f * left, -f * left * right;
      p.K->add(points_.body_clique[b], M.data());
    }
  }
}

void PointMasses::add_energy(const Config& q, const Config& v, Energy& sum) const {
  for (const auto& [n, m] : masses_) {
    sum.kinetic += m * v.x[n].squaredNorm() / 2;
    sum.momentum += m * v.x[n];
    sum.angular += m * q.x[n].cross(v.x[n]);
    sum.gravity -= m * points_.gravity.dot(q.x[n]);
  }
}

void PointMasses::add_inertia(std::span<const int> group, const Config& v, const Config& w, std::span<double> sum) const {
  for (const auto& [n, m] : masses_)
    if (const int b = points_.follower[n]; b >= 0 && group[b] >= 0) sum[group[b]] += m * v.x[n].dot(w.x[n]);
}

}  // namespace hilo
