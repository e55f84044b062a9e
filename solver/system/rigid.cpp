// Rigid bodies and connectors within an evaluation.
#include "system/pass.hpp"

namespace hilo {

using RowMatrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Inertia of a body in its natural coordinates: m (a_c - g) at the centre, and as moment sum_i d_i x (A J)_i with A the second derivative
/// of the directors.
void System::add_bodies(Pass& p) const {
  const Stage& s = p.s;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    if (body.mass == 0 && body.J.isZero(0)) continue;
    if (static_cast<int>(b) % comm->size != comm->rank) continue;
    const Vec3 force = body.mass * (s.a->c[b] - gravity * s.load_factor);
    const Mat3 AJ = s.a->R[b] * body.J;
    Vec3 moment = Vec3::Zero();
    for (int i = 0; i < 3; ++i) moment += s.left->R[b].col(i).cross(AJ.col(i));
    p.body[b].head<3>() += force;
    p.body[b].tail<3>() += moment;
    p.scale(std::max({body.mass * s.a->c[b].norm(), body.mass * gravity.norm(), AJ.norm() / body.size}));
    if (!p.K || body_block[b] < 0) continue;
    RowMatrix6 K = RowMatrix6::Zero();
    K.topLeftCorner<3, 3>().diagonal().setConstant(s.mass_slope * body.mass);
    Mat3 Kr = Mat3::Zero();
    for (int i = 0; i < 3; ++i) {
      Kr += s.slope * skew(AJ.col(i)) * skew(s.end->R[b].col(i));
      const Mat3 left = skew(s.left->R[b].col(i));
      for (int j = 0; j < 3; ++j)
        if (body.J(i, j) != 0) Kr -= s.mass_slope * body.J(i, j) * left * skew(s.end->R[b].col(j));
    }
    K.bottomRightCorner<3, 3>() = Kr;
    p.K->add(body_clique(static_cast<int>(b)), K.data());
  }
  for (const auto& [node, m] : point_masses) {
    const Vec3 f = m * (s.a->x[node] - gravity * s.load_factor);
    p.node[node] += f;
    p.scale(f.norm());
  }
}

namespace {

/// Unknown blocks of the two ends within a connector's clique: how many, and the rows of the 12 generalised directions they take.
struct Ends {
  int n = 0;
  int row[4];  // first of the 12 directions, in clique order
};

Ends ends_of(const Connector& c, const std::vector<int>& node_block, const std::vector<int>& body_block) {
  Ends e;
  for (int k = 0; k < 2; ++k) {
    const Carrier& carrier = c.end[k];
    if (carrier.body >= 0) {
      if (body_block[carrier.body] < 0) continue;
      for (int i = 0; i < 2; ++i) e.row[e.n] = 6 * k + 3 * i, ++e.n;
    } else if (node_block[carrier.node] >= 0) {
      e.row[e.n] = 6 * k, ++e.n;
    }
  }
  return e;
}

}  // namespace

void spring_elastic(const Connector& c, const Stage& s, Response& out) {
  SpringLaw::Values e0{}, e1{};
  for (size_t m = 0; m < c.measures.size(); ++m) e0[m] = c.value(static_cast<int>(m), *s.e0), e1[m] = c.value(static_cast<int>(m), *s.e1);
  if (s.conserving()) return c.law->elastic(e0, e1, out);
  for (size_t m = 0; m < c.measures.size(); ++m) e0[m] = e1[m] = (1 - s.weight) * e0[m] + s.weight * e1[m];
  c.law->elastic(e0, e1, out);
  for (auto& row : out.D)  // so far the derivative by the second argument alone
    for (double& d : row) d *= 2 * s.weight;
}

void System::add_connectors(Pass& p) const {
  thread_local ConnectorGradient left, right;
  const Stage& s = p.s;
  const auto add_force = [&](const Connector& c, const double* force) {
    for (int k = 0; k < 2; ++k) {
      Vec6 f = Vec6::Zero();
      for (size_t m = 0; m < c.measures.size(); ++m) f += force[m] * left.G.block<1, 6>(m, 6 * k).transpose();
      if (c.end[k].body >= 0)
        p.body[c.end[k].body] += f;
      else
        p.node[c.end[k].node] += f.head<3>();
      p.scale(f.head<3>().norm());
    }
  };
  const auto add_clique = [&](const Connector& c, int clique, const Eigen::Matrix<double, 12, 12>& K, int n_multiplier_blocks) {
    const Ends e = ends_of(c, node_block, body_block);
    const int m = e.n + n_multiplier_blocks;
    double dense[15 * 15 * 4] = {};
    const int width = 3 * m;
    for (int i = 0; i < e.n; ++i)
      for (int j = 0; j < e.n; ++j)
        for (int r = 0; r < 3; ++r)
          for (int q = 0; q < 3; ++q) dense[(3 * i + r) * width + 3 * j + q] = K(e.row[i] + r, e.row[j] + q);
    for (int row = 0; row < 3 * n_multiplier_blocks; ++row) {
      if (row >= c.n_rows() || !c.active[row]) {
        dense[(3 * e.n + row) * width + 3 * e.n + row] = p.sigma;
        continue;
      }
      for (int i = 0; i < e.n; ++i)
        for (int r = 0; r < 3; ++r) {
          dense[(3 * i + r) * width + 3 * e.n + row] = p.sigma * left.G(row, e.row[i] + r);
          dense[(3 * e.n + row) * width + 3 * i + r] = p.sigma * right.G(row, e.row[i] + r);
        }
    }
    for (int i = 0; i < e.n; ++i) {  // prescribed components of a node that carries an end
      const Carrier& carrier = c.end[e.row[i] / 6];
      for (int r = 0; r < 3 && carrier.body < 0; ++r)
        if (fixed[carrier.node][r])
          for (int j = 0; j < width; ++j) dense[(3 * i + r) * width + j] = dense[j * width + 3 * i + r] = 0;
    }
    p.K->add(clique, dense);
  };
  for (size_t j = 0; j < joints.size(); ++j) {
    if (!owns_joint_[j]) continue;
    const Connector& c = joints[j];
    gradient(c, *s.left, *s.left, left);
    gradient(c, *s.end, *s.end, right);
    double force[max_measures];
    const int base = 3 * (joint_block[j] - first_joint_block());
    for (int m = 0; m < c.n_rows(); ++m) {
      force[m] = c.active[m] ? p.lambda[base + m] : 0;
      if (c.active[m]) p.out.r[3 * joint_block[j] + m] = p.sigma * right.e[m];
    }
    add_force(c, force);
    if (!p.K) continue;
    Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();
    add_geometric(c, left, right, force, s.slope, K);
    add_clique(c, joint_clique_[j], K, (c.n_rows() + 2) / 3);
  }
  for (size_t j = 0; j < springs.size(); ++j) {
    if (!owns_spring_[j]) continue;
    const Connector& c = springs[j];
    const int n = static_cast<int>(c.measures.size());
    gradient(c, *s.left, *s.left, left);
    gradient(c, *s.e1, *s.end, right);
    Response elastic, viscous;
    spring_elastic(c, s, elastic);
    double force[max_measures];
    for (int m = 0; m < n; ++m) force[m] = elastic.s[m];
    if (s.h > 0) {
      SpringLaw::Values r0{}, r1{};
      for (int m = 0; m < n; ++m) r0[m] = c.value(m, *s.w0), r1[m] = c.value(m, *s.w1);
      c.law->viscous(r0, r1, s.h, viscous);
      for (int m = 0; m < n; ++m) force[m] += viscous.s[m];
    }
    add_force(c, force);
    if (!p.K) continue;
    Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();
    for (int m = 0; m < n; ++m)
      for (int k = 0; k < n; ++k) {
        const double D = s.chain * elastic.D[m][k] + s.h * s.alpha_slope * viscous.D[m][k];
        if (D != 0) K += D * left.G.row(m).transpose() * right.G.row(k);
      }
    add_geometric(c, left, right, force, s.slope, K);
    add_clique(c, spring_clique_[j], K, 0);
  }
}

}  // namespace hilo
