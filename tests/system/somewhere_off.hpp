// SPDX-License-Identifier: GPL-3.0-or-later
// A state of a system in which nothing vanishes by symmetry, for tests of tangents.
#pragma once
#include <algorithm>

#include "dynamics/integrator.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {

/// What a kick of an unknown is divided by: the stiffest modes would drown differences in round-off.
inline double small(const System& system, int i) {
  const auto is_its = [&](const Modes& m) { return i / 3 >= m.block && i / 3 < m.block + m.n_blocks; };
  return std::any_of(system.modes.begin(), system.modes.end(), is_its) ? 0.1 : 1;
}

/// A start somewhere off, with velocities, so that nothing vanishes by symmetry.
inline State state_of(const System& system) {
  const int n = 3 * system.n_blocks();
  State s;
  s.t = 0.3;
  s.q = system.start, s.v = system.start_velocity;
  std::vector<double> kick(n);
  for (int i = 0; i < n; ++i) kick[i] = 0.03 * small(system, i) * scatter(i);
  system.move(s.q, kick);
  s.v.resize_like(s.q);
  for (size_t i = 0; i < s.v.x.size(); ++i) s.v.x[i] = Vec3(scatter(i), scatter(3 * i + 1), scatter(7 * i + 2));
  for (size_t b = 1; b < s.v.c.size(); ++b)
    if (system.bodies[b].free()) s.v.c[b] = Vec3(scatter(b), 1, -1), s.v.R[b] = skew(Vec3(1, scatter(b + 5), -2)) * s.q.R[b];
  for (const Modes& m : system.modes)  // d(eta R)/dt
    for (int j = 3 * m.first; j < 3 * (m.first + m.n_blocks); ++j) {
      const double rate = scatter(70 + j);
      s.v.eta[j / 3][j % 3] = rate;
      s.v.Y[j] = rate * s.q.R[m.body] + s.q.eta[j / 3][j % 3] * s.v.R[m.body];
    }
  system.follow(s.v);
  system.prescribe(s.q, s.t);
  s.a = s.jerk = s.v;
  s.lambda.assign(3 * system.n_joint_blocks(), 0.0);
  for (size_t i = 0; i < s.lambda.size(); ++i) s.lambda[i] = 20 * scatter(900 + static_cast<int>(i));
  return s;
}

/// Numbers of unknowns that stand for something: not prescribed, not padding of joint rows, not dropped.
inline std::vector<char> in_use(const System& system) {
  std::vector<char> used(3 * system.n_blocks(), 1);
  for (size_t i = 0; i < system.X.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (system.node_block[i] >= 0 && system.fixed[i][k]) used[3 * system.node_block[i] + k] = 0;
  const int first = 3 * system.first_joint_block();
  for (const auto& c : system.constraints())
    for (int r = c->n_rows(); r < c->n_padded(); ++r) used[first + c->row() + r] = 0;
  return used;
}

/// A word of the scene as the name of a test.
inline std::string as_name(std::string word) {
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return word;
}

}  // namespace hilo::test
