// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/predictor.hpp"

#include <Eigen/LU>

namespace hilo {
namespace {

/// Mean position and velocity and the spin of a cloud of nodes, each of unit mass.
struct Spin {
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), omega = Vec3::Zero();
};

Spin spin_of(const System& s, const State& state, const std::vector<int>& nodes) {
  double sum[7] = {};
  for (int n : nodes)
    if (s.node_owned[n]) {
      for (int i = 0; i < 3; ++i) sum[i] += state.q.x[n][i], sum[3 + i] += state.v.x[n][i];
      sum[6] += 1;
    }
  s.comm->sum(sum);
  Spin out;
  if (sum[6] < 3) return out;
  out.centre = Vec3(sum[0], sum[1], sum[2]) / sum[6];
  out.velocity = Vec3(sum[3], sum[4], sum[5]) / sum[6];
  Mat3 I = Mat3::Zero();
  Vec3 L = Vec3::Zero();
  for (int n : nodes)
    if (s.node_owned[n]) {
      const Vec3 d = state.q.x[n] - out.centre;
      I += d.squaredNorm() * Mat3::Identity() - d * d.transpose();
      L += d.cross(state.v.x[n] - out.velocity);
    }
  double all[12];
  Eigen::Map<Mat3>(all, 3, 3) = I;
  Eigen::Map<Vec3>(all + 9, 3) = L;
  s.comm->sum(all);
  I = Eigen::Map<Mat3>(all, 3, 3), L = Eigen::Map<Vec3>(all + 9, 3);
  if (I.determinant() > 1e-12 * std::pow(I.trace(), 3)) out.omega = I.inverse() * L;
  return out;
}

}  // namespace

void predict(const System& s, const State& state, double h, Predictor kind, const Config& of_step, Config& q) {
  q = state.q;
  const bool accelerated = kind == Predictor::accelerated;
  const Config& a = accelerated ? state.a : of_step;
  const bool rigid = s.layout.map.first_dense == 0;  // no flexible nodes, which would be left behind and strained
  const bool bent = a.c.size() == q.c.size() && (accelerated || (rigid && kind == Predictor::rigid_rotation));
  if (kind == Predictor::hold) return;
  for (const UnknownField& f : s.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const int i = f.item[k];
      if (!f.turns()) {
        (q.*f.array)[i] += h * (state.v.*f.array)[i];
        if (bent) (q.*f.array)[i] += h * h / 2 * (a.*f.array)[i];
        continue;
      }
      if (kind == Predictor::velocity) continue;
      // R1 - R0 = skew(w) R_mid with R1 - R0 = h V_mid, R_mid = R0 + h/2 V_mid
      const Mat3 V = bent ? Mat3(state.v.R[i] + h / 2 * a.R[i]) : state.v.R[i], W = h * V * (state.q.R[i] + h / 2 * V).inverse();
      const Vec3 w = Vec3(W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1)) / 2;
      if (w.squaredNorm() < 4) q.R[i] = cayley(w) * q.R[i];
    }
  if (kind == Predictor::rigid_rotation)
    for (const auto& nodes : s.region_nodes) {
      const Spin spin = spin_of(s, state, nodes);
      if ((h * spin.omega).norm() < 1e-4) continue;
      const Mat3 turn = cayley(h * spin.omega) - Mat3::Identity() - h * skew(spin.omega);  // what q + h v misses
      for (int n : nodes) {
        const Vec3 missed = turn * (state.q.x[n] - spin.centre);
        for (int i = 0; i < 3; ++i)
          if (!s.fixed[n][i]) q.x[n][i] += missed[i];
      }
    }
  s.place(q);
}

}  // namespace hilo
