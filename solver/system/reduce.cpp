// From nodes to unknowns: followers pass forces and increments on to their bodies.
#include <array>
#include <vector>

#include "system/pass.hpp"

namespace hilo {

void add_reduced(KktSolver& solver, int clique, int n, const double* K, const NodeMap* maps, int m, const std::array<bool, 3>* fixed) {
  thread_local std::vector<double> reduced;
  const int n3 = 3 * n, m3 = 3 * m;
  reduced.assign(static_cast<size_t>(m3) * m3, 0.0);
  const auto add = [&](int row, int col, const Mat3& A) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) reduced[(3 * row + i) * m3 + 3 * col + j] += A(i, j);
  };
  for (int a = 0; a < n; ++a) {
    if (maps[a].slot < 0) continue;
    for (int b = 0; b < n; ++b) {
      if (maps[b].slot < 0) continue;
      Mat3 A;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          A(i, j) = !maps[a].follower && fixed[a][i] ? 0 : !maps[b].follower && fixed[b][j] ? 0 : K[(3 * a + i) * n3 + 3 * b + j];
      add(maps[a].slot, maps[b].slot, A);
      const Mat3 AR = maps[b].follower ? Mat3(-A * skew(maps[b].right)) : Mat3::Zero();
      if (maps[b].follower) add(maps[a].slot, maps[b].slot + 1, AR);
      if (maps[a].follower) {
        const Mat3 L = skew(maps[a].left);
        add(maps[a].slot + 1, maps[b].slot, L * A);
        if (maps[b].follower) add(maps[a].slot + 1, maps[b].slot + 1, L * AR);
      }
    }
  }
  solver.add(clique, reduced.data());
}

void System::reduce(Pass& p) const {
  std::vector<Mat3> geometric;  // of followers: slope (dtheta x arm1) x r
  if (p.K) geometric.assign(bodies.size(), Mat3::Zero());
  for (size_t i = 0; i < X.size(); ++i) {
    const int b = follower[i];
    if (b < 0) {
      for (int k = 0; k < 3; ++k) p.out.r[3 * node_block[i] + k] += p.node[i][k];
      continue;
    }
    const Vec3& r = p.node[i];
    if (r.isZero(0)) continue;
    p.body[b].head<3>() += r;
    p.body[b].tail<3>() += (p.s.left->x[i] - p.s.left->c[b]).cross(r);
    if (p.K && body_block[b] >= 0) geometric[b] += p.s.slope * skew(r) * skew(p.s.end->x[i] - p.s.end->c[b]);
  }
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (body_block[b] < 0) continue;
    for (int k = 0; k < 6; ++k) p.out.r[3 * body_block[b] + k] += p.body[b][k];
    if (p.K && !geometric[b].isZero(0)) {
      Eigen::Matrix<double, 6, 6, Eigen::RowMajor> K6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>::Zero();
      K6.bottomRightCorner<3, 3>() = geometric[b];
      p.K->add(body_clique(static_cast<int>(b)), K6.data());
    }
  }
}

}  // namespace hilo
