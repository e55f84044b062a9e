// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/unknown.hpp"

#include "system/facet.hpp"

namespace hilo {

void Unknown::start(const System& system, const Config& from, const Config& guess) {
  q0 = from, q = guess;
  turn.assign(from.c.size(), Vec3::Zero());
  combine(dq, {{1, &q}, {-1, &q0}});
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size() && f.turns(); ++k) {
      const int b = f.item[k];
      turn[b] = rotation_increment(q0.R[b], q.R[b]), turn_body(b);
    }
  multiply(system);
  system.follow(q), system.follow(dq);
}

/// Products of amplitudes and directors, and their increments: eta1 R1 - eta0 R0 = (eta1 - eta0)(R0 + R1)/2 + (eta0 + eta1)/2 (R1 - R0).
void Unknown::multiply(const System& system) {
  for (const Modes& m : system.modes) {
    const Mat3 mean = (q0.R[m.body] + q.R[m.body]) / 2;
    for (int j = 3 * m.first; j < 3 * (m.first + m.n_blocks); ++j) {
      const double before = q0.eta[j / 3][j % 3], after = q.eta[j / 3][j % 3], step = dq.eta[j / 3][j % 3];
      q.Y[j] = after * q.R[m.body];
      dq.Y[j] = step * mean + (before + after) / 2 * dq.R[m.body];
    }
  }
}

/// R = cay(w) R0 = R0 + (w x R0 + w x (w x R0)/2)/(1 + w^2/4),  R - R0 = w x (R + R0)/2.  Towards half a turn the latter loses its digits:
/// a step that turns so far is refused.
void Unknown::turn_body(size_t b) {
  const Vec3& w = turn[b];
  const double scale = 1 / (1 + w.squaredNorm() / 4);
  for (int i = 0; i < 3; ++i) {
    const Vec3 before = q0.R[b].col(i), once = w.cross(before), after = before + scale * (once + w.cross(once) / 2);
    q.R[b].col(i) = after;
    dq.R[b].col(i) = w.cross(after + before) / 2;
  }
}

template <class Turned>
void Unknown::add(const System& system, std::span<const double> z, Turned turned) {
  const auto of = [&](int k) { return Eigen::Map<const Vec3>(z.data() + 3 * k); };
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const int i = f.item[k];
      if (f.turns()) {
        turn[i] = turned(Vec3(of(f.block(k))), turn[i]), turn_body(i);
      } else {
        Vec3& d = (dq.*f.array)[i];
        d += of(f.block(k));
        (q.*f.array)[i] = (q0.*f.array)[i] + d;
      }
    }
  multiply(system);
  system.follow(q), system.follow(dq);
}

void Unknown::move(const System& system, std::span<const double> z) {  // cay(w) cay(t)
  add(system, z, [](const Vec3& w, const Vec3& t) -> Vec3 { return (w + t + w.cross(t) / 2) / (1 - w.dot(t) / 4); });
}

void Unknown::shift(const System& system, std::span<const double> z) {
  add(system, z, [](const Vec3& w, const Vec3& t) -> Vec3 { return t + w; });
}

std::vector<double> Unknown::increments(const System& system) const {
  std::vector<double> out;
  increments(system, out);
  return out;
}

void Unknown::increments(const System& system, std::vector<double>& out) const {
  out.assign(3 * static_cast<size_t>(system.first_joint_block()), 0.0);
  const auto at = [&](int k) { return Eigen::Map<Vec3>(out.data() + 3 * k); };
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k) at(f.block(k)) = f.turns() ? turn[f.item[k]] : (dq.*f.array)[f.item[k]];
}

}  // namespace hilo
