// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/springs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "system/collocation.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

/// Rate forces of a spring, D by its measures at r1, and `D0` by those at r0.  All laws of rates are symmetric in their ends when the time
/// between them changes its sign too, so the former of the exchanged pair is the latter.
void spring_viscous(const Spring& c, const Stage& s, const Interval& step, Response& out, Response& exchanged) {
  const auto [r0, r1] = rate_pair(c, s);
  c.law->viscous(r0, r1, step, out);
  Interval back = step;
  back.h = -step.h;
  if (step.is_instant || s.slope0() != 0) c.law->viscous(r1, r0, back, exchanged);
}

}  // namespace

std::array<SpringLaw::Values, 2> rate_pair(const Spring& c, const Stage& s) {
  std::array<SpringLaw::Values, 2> r{c.values(*s.w0), c.values(*s.w1)};
  if (s.conserving()) return r;
  const SpringLaw::Values at = c.values(*s.left);
  for (size_t m = 0; m < c.measures.size(); ++m) {
    const double way = r[1][m] - r[0][m];  // the exact rate, since measures are of degree two
    r[0][m] = at[m] - way / 2, r[1][m] = at[m] + way / 2;
  }
  return r;
}

void spring_elastic(const Spring& c, const Stage& s, Response& out) {
  if (s.step) return elastic_along(*c.law, MeasurePath(c, *s.step), *s.step, s.member, out);
  SpringLaw::Values e0 = c.values(*s.e0), e1 = c.values(*s.e1);
  if (s.conserving()) return c.law->elastic(e0, e1, out);
  for (size_t m = 0; m < c.measures.size(); ++m) {
    const double mean = (1 - s.weight) * e0[m] + s.weight * e1[m];
    e0[m] = s.slopes_of_end ? 2 * mean - e1[m] : mean;
    if (!s.slopes_of_end) e1[m] = mean;
  }
  c.law->elastic(e0, e1, out);
  for (auto& row : out.D)  // so far the derivative by the second argument alone
    for (double& d : row) d *= 2 * s.weight;
}

Interval Springs::interval(const Spring& c, const Stage& s, std::span<const double> lambda, double* slope) const {
  Interval step{s.h};
  for (const Carrier& end : c.ends())
    if (s.tempo && end.body >= 0 && points_.body_block[end.body] >= 0) step.h = s.h / s.tempo[end.body];
  if (c.history) step.factor = s.t1 > s.t0 ? c.history->mean(s.t0, s.t1) : (*c.history)(s.t0);
  step.is_instant = !s.conserving(), step.no_impacts = s.no_impacts;
  if (c.pressing.joint < 0) return step;
  const double* multiplier = lambda.data() + joints_.row(c.pressing.joint);
  for (const int r : c.pressing.rows) step.load += multiplier[r] * multiplier[r];
  step.load = std::sqrt(step.load);
  for (const int r : c.pressing.rows)
    if (slope) slope[r] = step.load > 0 ? multiplier[r] / step.load : 0;
  return step;
}

void Springs::evaluate(Pass& p) const {
  thread_local ConnectorGradient left, right;
  thread_local DirectionRows left_rows, right_rows;
  const Stage& s = p.s;
  for (size_t j = 0; j < list.size(); ++j) {
    if (!owned_[j] || (s.rates_alone && s.h <= 0)) continue;
    const Spring& c = list[j];
    const int n = static_cast<int>(c.measures.size()), width = c.n_directions();
    gradient(c, *s.left, left);
    Response elastic, viscous, before;  // `before`: by the measures at r0
    double slope[max_rows] = {};
    if (!s.rates_alone) spring_elastic(c, s, elastic);
    double force[max_measures];
    for (int m = 0; m < n; ++m) force[m] = elastic.s[m];
    if (s.h > 0) {
      spring_viscous(c, s, interval(c, s, p.lambda, slope), viscous, before);
      for (int m = 0; m < n; ++m) force[m] += viscous.s[m];
    }
    add_force(p, c, left, force);
    if (!p.K) continue;
    ConnectorMatrix K = ConnectorMatrix::Zero(width, width);
    const auto add_slope = [&](const Config& at, double f, const Response& response, double by_before = 0) {
      if (f == 0) return;
      gradient(c, at, *s.end, right);
      for (int m = 0; m < n; ++m)
        for (int k = 0; k < n; ++k)
          if (const double D = f * (response.D[m][k] + by_before * before.D[m][k]); D != 0)
            K += D * left.G.row(m).head(width).transpose() * right.G.row(k).head(width);
    };
    if (s.h > 0 && s.conserving()) {
      add_slope(*s.w0, s.slope0(), before), add_slope(*s.w1, s.slope1(), viscous);
    } else if (s.h > 0) {  // by the middle of r0 and r1, and by their distance
      add_slope(*s.w0, -s.slope0() / 2, viscous, -1), add_slope(*s.w1, s.slope1() / 2, viscous, -1);
      add_slope(*s.left, s.slope, viscous, 1);
    }
    add_slope(*s.e1, s.chain, elastic);
    add_geometric(c, left, right, force, s.slope, K);
    CliqueRows rows{0, &left_rows, &right_rows};
    if (c.pressing.joint >= 0) {  // columns of the multipliers its load is made of; its own rows are none
      const Joint& joint = joints_[c.pressing.joint];
      rows.blocks = (joint.n_rows() + 2) / 3;
      left_rows.setZero(), right_rows.setZero();
      for (const int r : c.pressing.rows)
        for (int m = 0; m < n && joint.active[r]; ++m)
          left_rows.row(r).head(width) += slope[r] * viscous.by_load[m] * left.G.row(m).head(width);
    }
    add_clique(p, points_, c, clique_[j], K, rows);
  }
}

bool is_sprung(const System& system) { return !system.part<Springs>().list.empty(); }

}  // namespace hilo
