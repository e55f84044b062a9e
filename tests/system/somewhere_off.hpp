// A state of a system in which nothing vanishes by symmetry, for tests of tangents.
#pragma once
#include <algorithm>

#include "dynamics/integrator.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {

/// A start somewhere off, with velocities, so that nothing vanishes by symmetry.
inline State state_of(const System& system) {
  const int n = 3 * system.n_blocks();
  State s;
  s.t = 0.3;
  s.q = system.start, s.v = system.start_velocity;
  std::vector<double> kick(n);
  for (int i = 0; i < n; ++i) kick[i] = 0.03 * scatter(i);
  system.move(s.q, kick);
  s.v.resize(s.q.x.size(), s.q.c.size());
  for (size_t i = 0; i < s.v.x.size(); ++i) s.v.x[i] = Vec3(scatter(i), scatter(3 * i + 1), scatter(7 * i + 2));
  for (size_t b = 1; b < s.v.c.size(); ++b)
    if (system.bodies[b].free()) s.v.c[b] = Vec3(scatter(b), 1, -1), s.v.R[b] = skew(Vec3(1, scatter(b + 5), -2)) * s.q.R[b];
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
