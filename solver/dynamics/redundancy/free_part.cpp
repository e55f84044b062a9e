// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/redundancy/free_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

/// What the unknowns of a local block belong to.
std::string owner_of(const System& s, int block) {
  const std::string who = s.owner(block);
  if (who.empty()) return "";
  return block >= s.first_joint_block() ? fmt::format(": {} holds what is held already", who)
                                        : fmt::format(": {} is not held, or has no mass", who);
}

}  // namespace

std::string free_part(const System& s, KktSolver& solver, double sigma) {
  const Comm& comm = *s.comm;
  const int n = s.n_blocks();
  const auto shift = [&](int block, double length) {
    const double x = 1e-9 * sigma * length * length, d[3] = {x, x, x};
    solver.add_diagonal(block, d);
  };
  for (const UnknownField& f : s.unknowns)
    for (size_t k = 0; k < f.size(); ++k)
      if (s.owns(f.block(k))) shift(f.block(k), f.scale(k));
  for (int k = s.first_joint_block(); k < n; ++k)
    if (s.owns(k)) shift(k, 1);
  std::vector<double> b(3 * n), x(3 * n, 0.0);
  for (int k = 0; k < n; ++k)  // any vector with something of everything
    for (int c = 0; c < 3; ++c) b[3 * k + c] = std::cos(static_cast<double>(3 * s.layout.map.global[k] + c));
  int block = -1;
  double mine = 0, most = 0;
  for (int pass = 0; pass < 4; ++pass) {
    solver.solve(b, x);
    mine = 0, block = -1;
    for (int i = 0; i < 3 * n; ++i)
      if (!(std::abs(x[i]) <= mine)) mine = std::abs(x[i]), block = i / 3;
    most = comm.max(mine);
    if (!std::isfinite(most) || most == 0) return "";
    for (int i = 0; i < 3 * n; ++i) b[i] = x[i] / most;
  }
  const std::string text = mine == most ? owner_of(s, block) : "";
  for (const auto& said : comm.exchange(std::vector(comm.size, std::vector<char>(text.begin(), text.end()))))
    if (!said.empty()) return {said.begin(), said.end()};
  return "";
}

}  // namespace hilo
