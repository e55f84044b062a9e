// Joints and springs within an evaluation.
#include <algorithm>
#include <cmath>
#include <optional>

#include "physics/rolling.hpp"
#include "system/pass.hpp"

namespace hilo {
namespace {

using DirectionRows = decltype(ConnectorGradient::G);

/// Unknown blocks of the ends within a connector's clique: how many, and the first direction each of them stands for.
struct Ends {
  int n = 0;
  int row[2 * max_ends];  // in clique order
};

Ends ends_of(const Connector& c, const std::vector<int>& node_block, const std::vector<int>& body_block) {
  Ends e;
  for (int k = 0; k < c.n_ends; ++k) {
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

/// d (rows x measures) times G (measures x directions).
void rows_over_directions(const Connector& c, const RowLaw::Gradient& g, const DirectionRows& G, DirectionRows& out) {
  const int n = c.n_position_rows(), width = c.n_directions();
  out.topRows(n).setZero();
  for (int r = 0; r < n; ++r)
    for (size_t m = 0; m < c.measures.size(); ++m)
      if (g.d[r][m] != 0) out.row(r).head(width) += g.d[r][m] * G.row(m).head(width);
}

/// What the unit increment `i` of a connector's directions does to its ends at a stage.
Slip::Move move_of(const Connector& c, const Stage& s, int end, int i) {
  Slip::Move m{Vec3::Zero(), Vec3::Zero(), Mat3::Zero(), Mat3::Zero()};
  if (i / 6 != end) return m;
  if (i % 6 < 3) {
    m.c[i % 3] = s.slope, m.v[i % 3] = s.alpha_slope;
  } else {
    const Mat3 turn = skew(Vec3::Unit(i % 3)) * s.end->R[c.end[end].body];
    m.R = s.slope * turn, m.V = s.alpha_slope * turn;
  }
  return m;
}

/// Rate forces of a spring, D by its measures at w1, and `D0` by those at w0.  All laws of rates are symmetric in their ends when the time
/// between them changes its sign too, so the former of the exchanged pair is the latter.
void spring_viscous(const Connector& c, const Stage& s, const Interval& step, Response& out, Response& exchanged) {
  const auto r0 = c.values(*s.w0), r1 = c.values(*s.w1);
  c.law->viscous(r0, r1, step, out);
  Interval back = step;
  back.h = -step.h;
  if (s.slope0() != 0) c.law->viscous(r1, r0, back, exchanged);
}

/// Rows that hold velocities, scaled to lengths by the slope of the velocities: (A v)/alpha_slope.  Where a stage has no velocities of its
/// own (statics, projections), increments slip as little: the rows are A, their value 0.  Adds the derivative of A^T lambda to K.
void add_velocity_rows(const Connector& c, const Stage& s, const Slip& slip, const double* lambda, DirectionRows& left,
                       DirectionRows& right, ConnectorMatrix& K) {
  const int first = c.n_position_rows(), width = c.n_directions();
  for (int r = 0; r < slip.n; ++r) left.row(first + r).head(width) = slip.A.row(r), right.row(first + r).head(width) = slip.A.row(r);
  for (int i = 0; i < width; ++i) {
    const Slip::Change d = slip.change(move_of(c, s, 0, i), move_of(c, s, 1, i));
    for (int r = 0; r < slip.n; ++r) {
      if (s.alpha_slope != 0) right(first + r, i) = d.value[r] / s.alpha_slope;
      K.col(i) += lambda[first + r] * d.A.row(r).transpose();
    }
  }
}

}  // namespace

void spring_elastic(const Connector& c, const Stage& s, Response& out) {
  SpringLaw::Values e0 = c.values(*s.e0), e1 = c.values(*s.e1);
  if (s.conserving()) return c.law->elastic(e0, e1, out);
  for (size_t m = 0; m < c.measures.size(); ++m) e0[m] = e1[m] = (1 - s.weight) * e0[m] + s.weight * e1[m];
  c.law->elastic(e0, e1, out);
  for (auto& row : out.D)  // so far the derivative by the second argument alone
    for (double& d : row) d *= 2 * s.weight;
}

void row_gradient(const Connector& c, const Stage& s, const ConnectorGradient& left, RowLaw::Gradient& out) {
  if (s.conserving())
    c.rows->gradient(c.values(*s.e0), c.values(*s.e1), out);
  else
    c.rows->gradient(left.e, left.e, out);
}

void joint_forces(const Connector& c, const Stage& s, const ConnectorGradient& left, const double* lambda, double* force) {
  const int n_measures = static_cast<int>(c.measures.size());
  if (!c.rows) {
    std::copy(lambda, lambda + n_measures, force);
    return;
  }
  thread_local RowLaw::Gradient g;
  row_gradient(c, s, left, g);
  std::fill(force, force + n_measures, 0.0);
  for (int r = 0; r < c.n_position_rows(); ++r)
    for (int m = 0; m < n_measures; ++m) force[m] += lambda[r] * g.d[r][m];
}

double drive_work(const Connector& c, const Stage& s, const Config& from, double lambda) {
  ConnectorGradient left, start, end;
  gradient(c, *s.left, left), gradient(c, from, start), gradient(c, *s.end, end);
  RowLaw::Gradient g;
  row_gradient(c, s, left, g);
  double along = 0;  // points move linearly in q, so their differences need no angles
  for (size_t m = 0; m < c.measures.size(); ++m)
    for (size_t e = 0; e < c.entities.size(); ++e) along += g.d[c.drive.row][m] * left.dy[m][e].dot(end.y[e] - start.y[e]);
  return -lambda * along;
}

Interval System::interval(const Connector& c, const Stage& s, std::span<const double> lambda, double* slope) const {
  Interval step{s.h};
  for (const Carrier& end : c.ends())
    if (s.tempo && end.body >= 0 && body_block[end.body] >= 0) step.h = s.h / s.tempo[end.body];
  if (c.factor) step.factor = c.factor(s.t0, s.t1);
  if (c.load_joint < 0) return step;
  const double* multiplier = lambda.data() + 3 * (joint_block[c.load_joint] - first_joint_block());
  for (const int r : c.load_rows) step.load += multiplier[r] * multiplier[r];
  step.load = std::sqrt(step.load);
  for (const int r : c.load_rows)
    if (slope) slope[r] = step.load > 0 ? multiplier[r] / step.load : 0;
  return step;
}

void System::add_connectors(Pass& p) const {
  thread_local ConnectorGradient left, right, mixed;
  thread_local DirectionRows left_rows, right_rows;
  thread_local RowLaw::Gradient at_stage, at_end;
  const Stage& s = p.s;
  const auto add_force = [&](const Connector& c, const double* force) {
    for (int k = 0; k < c.n_ends; ++k) {
      Vec6 f = Vec6::Zero();
      for (size_t m = 0; m < c.measures.size(); ++m) f += force[m] * left.G.block<1, 6>(m, 6 * k).transpose();
      if (c.end[k].body >= 0)
        p.body[c.end[k].body] += f;
      else
        p.node[c.end[k].node] += f.head<3>();
      p.scale(f.head<3>().norm());
    }
  };
  // rows_left, rows_right: gradients of the rows in the equations and in the increments
  const auto add_clique = [&](const Connector& c, int clique, const ConnectorMatrix& K, int n_multiplier_blocks,
                              const DirectionRows& rows_left, const DirectionRows& rows_right) {
    const Ends e = ends_of(c, node_block, body_block);
    const int m = e.n + n_multiplier_blocks, width = 3 * m;
    constexpr int most = 3 * (2 * max_ends + (max_rows + 2) / 3);
    double dense[most * most];
    std::fill(dense, dense + width * width, 0.0);
    for (int i = 0; i < e.n; ++i)
      for (int j = 0; j < e.n; ++j)
        for (int r = 0; r < 3; ++r)
          for (int q = 0; q < 3; ++q) dense[(3 * i + r) * width + 3 * j + q] = K(e.row[i] + r, e.row[j] + q);
    for (int row = 0; row < 3 * n_multiplier_blocks; ++row) {
      if (!c.law && (row >= c.n_rows() || !c.active[row])) {
        dense[(3 * e.n + row) * width + 3 * e.n + row] = p.sigma;
        continue;
      }
      for (int i = 0; i < e.n; ++i)
        for (int r = 0; r < 3; ++r) {
          dense[(3 * i + r) * width + 3 * e.n + row] = p.sigma * rows_left(row, e.row[i] + r);
          dense[(3 * e.n + row) * width + 3 * i + r] = p.sigma * rows_right(row, e.row[i] + r);
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
    if (s.rates_alone && !c.velocity_rows) continue;
    gradient(c, *s.left, left);
    if (p.K)
      gradient(c, *s.end, right);
    else
      right.e = c.values(*s.end);
    double g[max_rows], lambda[max_rows], force[max_measures];
    c.row_values(right.e, g);
    if (c.drive.row >= 0) g[c.drive.row] -= c.drive.law.at(s.t_end, s.t_end, s.load_factor).value;
    const int base = 3 * (joint_block[j] - first_joint_block()), n = c.n_rows(), n_position = c.n_position_rows();
    std::optional<Slip> slip;
    if (c.velocity_rows) slip.emplace(c, *s.left, s.v);
    for (int r = n_position; r < n && s.alpha_slope != 0; ++r) g[r] = slip->value[r - n_position] / s.alpha_slope;
    for (int r = 0; r < n; ++r) {
      lambda[r] = c.active[r] ? p.lambda[base + r] : 0;
      if (c.active[r]) p.out.r[3 * joint_block[j] + r] = p.sigma * g[r];
    }
    joint_forces(c, s, left, lambda, force);
    add_force(c, force);
    if (slip) {
      const Eigen::Matrix<double, 12, 1> f =
          slip->A.topRows(slip->n).transpose() * Eigen::Map<const Eigen::VectorXd>(lambda + n_position, slip->n);
      for (int k = 0; k < 2; ++k) p.body[c.end[k].body] += f.segment<6>(6 * k), p.scale(f.segment<3>(6 * k).norm());
    }
    if (!p.K) continue;
    ConnectorMatrix K = ConnectorMatrix::Zero(c.n_directions(), c.n_directions());
    add_geometric(c, left, right, force, s.slope, K);
    if (!c.rows && !slip) {
      add_clique(c, joint_clique_[j], K, (n + 2) / 3, left.G, right.G);
      continue;
    }
    if (!c.rows) {
      left_rows = left.G, right_rows = right.G;
      add_velocity_rows(c, s, *slip, lambda, left_rows, right_rows, K);
      add_clique(c, joint_clique_[j], K, (n + 2) / 3, left_rows, right_rows);
      continue;
    }
    row_gradient(c, s, left, at_stage);
    c.rows->gradient(right.e, right.e, at_end);
    const bool pair = s.conserving();  // the rows' gradient depends on e1, else on the left configuration
    gradient(c, pair ? *s.e1 : *s.left, *s.end, mixed);
    const int width = c.n_directions(), n_measures = static_cast<int>(c.measures.size());
    for (int m = 0; m < n_measures; ++m)
      for (int k = 0; k < n_measures; ++k) {
        double D = 0;
        for (int r = 0; r < n_position; ++r) D += lambda[r] * at_stage.D[r][m][k];
        if (D != 0) K += (pair ? s.chain : 2 * s.slope) * D * left.G.row(m).head(width).transpose() * mixed.G.row(k).head(width);
      }
    rows_over_directions(c, at_stage, left.G, left_rows);
    rows_over_directions(c, at_end, right.G, right_rows);
    if (slip) add_velocity_rows(c, s, *slip, lambda, left_rows, right_rows, K);
    add_clique(c, joint_clique_[j], K, (n + 2) / 3, left_rows, right_rows);
  }
  for (size_t j = 0; j < springs.size(); ++j) {
    if (!owns_spring_[j] || (s.rates_alone && s.h <= 0)) continue;
    const Connector& c = springs[j];
    const int n = static_cast<int>(c.measures.size()), width = c.n_directions();
    gradient(c, *s.left, left);
    Response elastic, viscous, before;  // `before`: by the measures at w0
    double slope[max_rows] = {};
    spring_elastic(c, s, elastic);
    double force[max_measures];
    for (int m = 0; m < n; ++m) force[m] = elastic.s[m];
    if (s.h > 0) {
      spring_viscous(c, s, interval(c, s, p.lambda, slope), viscous, before);
      for (int m = 0; m < n; ++m) force[m] += viscous.s[m];
    }
    add_force(c, force);
    if (!p.K) continue;
    ConnectorMatrix K = ConnectorMatrix::Zero(width, width);
    const auto add_slope = [&](const Config& at, double f, const Response& response) {
      if (f == 0) return;
      gradient(c, at, *s.end, right);
      for (int m = 0; m < n; ++m)
        for (int k = 0; k < n; ++k)
          if (const double D = f * response.D[m][k]; D != 0) K += D * left.G.row(m).head(width).transpose() * right.G.row(k).head(width);
    };
    if (s.h > 0) add_slope(*s.w0, s.slope0(), before), add_slope(*s.w1, s.slope1(), viscous);
    add_slope(*s.e1, s.chain, elastic);
    add_geometric(c, left, right, force, s.slope, K);
    int blocks = 0;
    if (c.load_joint >= 0) {  // columns of the multipliers its load is made of; its own rows are none
      const Connector& joint = joints[c.load_joint];
      blocks = (joint.n_rows() + 2) / 3;
      left_rows.setZero(), right_rows.setZero();
      for (const int r : c.load_rows)
        for (int m = 0; m < n && joint.active[r]; ++m)
          left_rows.row(r).head(width) += slope[r] * viscous.by_load[m] * left.G.row(m).head(width);
    }
    add_clique(c, spring_clique_[j], K, blocks, left_rows, right_rows);
  }
}

}  // namespace hilo
