// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "physics/rolling.hpp"
#include "system/collocation.hpp"

namespace hilo {
namespace {

/// d (rows x measures) times G (measures x directions).
void rows_over_directions(const Joint& c, const RowLaw::Gradient& g, const DirectionRows& G, DirectionRows& out) {
  const int n = c.n_position_rows(), width = c.n_directions();
  out.topRows(n).setZero();
  for (int r = 0; r < n; ++r)
    for (size_t m = 0; m < c.measures.size(); ++m)
      if (g.d[r][m] != 0) out.row(r).head(width) += g.d[r][m] * G.row(m).head(width);
}

/// What the unit increment `i` of a connector's directions does to its ends at a stage.
Slip::Move move_of(const Joint& c, const Stage& s, int end, int i) {
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

/// Rows that hold velocities, scaled to lengths by the slope of the velocities: (A v)/alpha_slope.  Where a stage has no velocities of its
/// own (statics, projections), increments slip as little: the rows are A, their value 0.  Adds the derivative of A^T lambda to K.
void add_velocity_rows(const Joint& c, const Stage& s, const Slip& slip, const double* lambda, DirectionRows& left, DirectionRows& right,
                       ConnectorMatrix& K) {
  const int first = c.n_position_rows(), width = c.n_directions();
  for (int r = 0; r < slip.n; ++r) left.row(first + r).head(width) = slip.A.row(r), right.row(first + r).head(width) = slip.A.row(r);
  for (int i = 0; i < width; ++i) {
    const Slip::Change d = slip.change(move_of(c, s, 0, i), move_of(c, s, 1, i));
    for (int r = 0; r < slip.n; ++r) {
      if (s.step || s.alpha_slope != 0) right(first + r, i) = d.value[r] * (s.step ? s.h : 1 / s.alpha_slope);
      K.col(i) += lambda[first + r] * d.A.row(r).transpose();
    }
  }
}

/// Position rows of a stage that shares its step with others: their increments over it, of which the sum over the stages is
/// g(q1) - law(t1).
void increments_of_rows(const Joint& c, const Stage& s, const MeasurePath::Values& way, const RowLaw::Gradient* d, double* g) {
  const Collocation& step = *s.step;
  double open[max_rows];
  gaps(c, *step.start, step.t, s.load_factor, open);
  for (int r = 0; r < c.n_position_rows(); ++r) {
    double sum = way[r];
    if (d) sum = std::inner_product(way.begin(), way.end(), d->d[r].begin(), 0.0);
    g[r] = open[r] + sum;
  }
  if (const int r = c.drive.row; r >= 0) {
    const MotionLaw& law = c.drive.law;
    const double mid = step.t + step.h / 2, t1 = step.t + step.h;
    double missing = law.at(t1, mid, s.load_factor).value - law.at(step.t, mid, s.load_factor).value;
    const auto rate = [&](int j) { return step.h * law.at(step.t + step.c[j] * step.h, mid, s.load_factor).rate; };
    for (int j = 0; j < Collocation::n; ++j) missing -= step.b[j] * rate(j);
    g[r] -= rate(s.member) + missing;
  }
}

/// Their gradients by the increments of `end`.
void gradients_of_increments(const Joint& c, const Stage& s, const MeasurePath::Values& way, const RowLaw::Gradient* d,
                             const DirectionRows& left, DirectionRows& out) {
  ConnectorGradient before, after;
  gradient(c, *s.w0, *s.end, before), gradient(c, *s.w1, *s.end, after);
  DirectionRows ways = s.slope1() * after.G - s.slope0() * before.G;
  out = ways;
  if (!d) return;
  rows_over_directions(c, *d, ways, out);
  for (int r = 0; r < c.n_position_rows(); ++r)
    for (size_t m = 0; m < c.measures.size(); ++m)
      for (size_t k = 0; k < c.measures.size(); ++k)
        if (const double x = 2 * s.slope * d->D[r][m][k] * way[m]; x != 0) out.row(r) += x * left.row(k);
}

/// Work of a joint's drive over the step of a stage, for the multiplier of its row.
double drive_work(const Joint& c, const Stage& s, double lambda) {
  ConnectorGradient left, start, end;
  gradient(c, *s.left, left), gradient(c, s.from(), start), gradient(c, *s.end, end);
  RowLaw::Gradient g;
  row_gradient(c, s, left, g);
  double along = 0;  // points move linearly in q, so their differences need no angles
  for (size_t m = 0; m < c.measures.size(); ++m)
    for (size_t e = 0; e < c.entities.size(); ++e) along += g.d[c.drive.row][m] * left.dy[m][e].dot(end.y[e] - start.y[e]);
  return -lambda * along;
}

}  // namespace

void row_gradient(const Joint& c, const Stage& s, const ConnectorGradient& left, RowLaw::Gradient& out) {
  if (s.step)
    gradient_along(*c.rows, MeasurePath(c, *s.step), *s.step, s.member, out);
  else if (s.conserving())
    c.rows->gradient(c.values(*s.e0), c.values(*s.e1), out);
  else
    c.rows->gradient(left.e, left.e, out);
}

void joint_forces(const Joint& c, const Stage& s, const ConnectorGradient& left, const double* lambda, double* force) {
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

void Joints::evaluate(Pass& p) const {
  thread_local ConnectorGradient left, right, mixed;
  thread_local DirectionRows left_rows, right_rows;
  thread_local RowLaw::Gradient at_stage, at_end;
  const Stage& s = p.s;
  for (size_t j = 0; j < list.size(); ++j) {
    if (!owned_[j]) continue;
    const Joint& c = list[j];
    if (s.rates_alone && (s.alpha_slope == 0 || !(c.velocity_rows || s.step))) continue;
    gradient(c, *s.left, left);
    if (p.K)
      gradient(c, *s.end, right);
    else
      right.e = c.values(*s.end);
    double g[max_rows], lambda[max_rows], force[max_measures];
    c.row_values(right.e, g);
    if (c.drive.row >= 0) g[c.drive.row] -= c.drive.law.at(s.t_end, s.t_end, s.load_factor).value;
    const int base = row(j), n = c.n_rows(), n_position = c.n_position_rows();
    MeasurePath::Values way{};  // of a stage that shares its step
    if (s.step) {
      way = MeasurePath::way_of(c, *s.step, s.member);
      if (c.rows) gradient_along(*c.rows, MeasurePath(c, *s.step), *s.step, s.member, at_stage);
      increments_of_rows(c, s, way, c.rows ? &at_stage : nullptr, g);
    }
    std::optional<Slip> slip;
    if (c.velocity_rows) slip.emplace(c, *s.left, s.v);
    for (int r = n_position; r < n && (s.step || s.alpha_slope != 0); ++r)
      g[r] = slip->value[r - n_position] * (s.step ? s.h : 1 / s.alpha_slope);
    for (int r = 0; r < n; ++r) {
      lambda[r] = c.active[r] ? p.lambda[base + r] : 0;
      if (c.active[r]) p.out.r[3 * block_[j] + r] = p.sigma * g[r];
    }
    joint_forces(c, s, left, lambda, force);
    add_force(p, c, left, force);
    if (slip) {
      const Eigen::Matrix<double, 12, 1> f =
          slip->A.topRows(slip->n).transpose() * Eigen::Map<const Eigen::VectorXd>(lambda + n_position, slip->n);
      for (int k = 0; k < 2; ++k) p.body[c.end[k].body] += f.segment<6>(6 * k), p.scale(f.segment<3>(6 * k).norm());
    }
    if (!p.K) continue;
    ConnectorMatrix K = ConnectorMatrix::Zero(c.n_directions(), c.n_directions());
    add_geometric(c, left, right, force, s.slope, K);
    if (!c.rows && !slip && !s.step) {
      add_clique(p, points_, c, clique_[j], K, {(n + 2) / 3, &left.G, &right.G, c.active.data(), n});
      continue;
    }
    if (!c.rows) {
      left_rows = left.G, right_rows = right.G;
      if (s.step) gradients_of_increments(c, s, way, nullptr, left.G, right_rows);
      if (slip) add_velocity_rows(c, s, *slip, lambda, left_rows, right_rows, K);
      add_clique(p, points_, c, clique_[j], K, {(n + 2) / 3, &left_rows, &right_rows, c.active.data(), n});
      continue;
    }
    if (!s.step) row_gradient(c, s, left, at_stage);
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
    if (s.step)
      gradients_of_increments(c, s, way, &at_stage, mixed.G, right_rows);
    else
      rows_over_directions(c, at_end, right.G, right_rows);
    if (slip) add_velocity_rows(c, s, *slip, lambda, left_rows, right_rows, K);
    add_clique(p, points_, c, clique_[j], K, {(n + 2) / 3, &left_rows, &right_rows, c.active.data(), n});
  }
}

void Joints::add_work(const Moment& m, Work& sum) const {
  for (size_t j = 0; j < list.size(); ++j)
    if (const int r = list[j].drive.row; owned_[j] && r >= 0 && list[j].active[r])
      sum.external += drive_work(list[j], m.s, m.lambda[row(j) + r]);
}

}  // namespace hilo
