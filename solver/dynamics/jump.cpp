// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/jump.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/linear_step.hpp"
#include "dynamics/start/start.hpp"
#include "system/revising.hpp"

namespace hilo {
namespace {

constexpr double out_of_line = 3;   // times what tangents foresee
constexpr double of_largest = 0.1;  // of the largest way foreseen, and
constexpr double backwards = -0.3;  // cosine between the way and what a tangent foresees
constexpr double of_length = 1e-5;  // of the scene: shorter ways are nothing
constexpr double of_force = 1e-3;   // of the largest force: a residual below it is balance
constexpr double of_rows = 1e-6;    // of the scene: rows that are open farther hold nothing yet

/// How far points of a configuration go by a change of it, one after the other: nodes, centres, and directors at the sizes of their bodies.
template <class Visit>
void each_way(const System& system, const Config& change, const Visit& visit) {
  size_t i = 0;
  for (const Vec3& x : change.x) visit(i++, x.norm());
  for (size_t b = 0; b < change.c.size(); ++b) {
    visit(i++, change.c[b].norm());
    visit(i++, system.bodies[b].size * change.R[b].colwise().norm().maxCoeff());
  }
}

/// Of the angle between two ways of all points together, each counted on one rank.
double cosine(const System& system, const Config& a, const Config& b) {
  double sums[3] = {0, 0, 0};
  const auto add = [&](const auto& x, const auto& y, double weight) {
    sums[0] += weight * x.cwiseProduct(y).sum(), sums[1] += weight * x.squaredNorm(), sums[2] += weight * y.squaredNorm();
  };
  for (size_t i = 0; i < a.x.size(); ++i)
    if (system.node_owned[i]) add(a.x[i], b.x[i], 1);
  for (size_t i = 0; i < a.c.size(); ++i)
    if (system.counts(static_cast<int>(i))) add(a.c[i], b.c[i], 1), add(a.R[i], b.R[i], system.bodies[i].size * system.bodies[i].size);
  system.comm->sum(sums);
  return sums[1] > 0 && sums[2] > 0 ? sums[0] / std::sqrt(sums[1] * sums[2]) : 1;
}

}  // namespace

/// A state, or one near to it, under the loads of another.
Residual BranchJump::evaluate(const Config& q, const Loaded& state, const Loaded& loads, bool tangent) {
  Stage s = stage_at(q, loads.t);
  s.a = &zero_, s.load_factor = loads.ramp, s.elapsed = slow;
  Residual r;
  assemble(system_, solver_, s, state.lambda, r, tangent);
  return r;
}

/// Whether a state is in balance under its own loads, at the forces of another, its rows closed: those of a linear region are open where a
/// motion begins away from the drawing.
bool BranchJump::balanced(const Loaded& at, const Loaded& other) {
  if (system_.violation(at.q, at.t, at.ramp).kept > of_rows * system_.length) return false;
  system_.commit(at.q);
  Residual r = evaluate(at.q, at, at, false);
  r.force_scale = std::max(r.force_scale, evaluate(other.q, other, other, false).force_scale);
  return system_.comm->max(relative_residual(system_, r)) < of_force;
}

/// How all moves from a state to the loads of another, to first order: what moves by a law takes the rest along.  None of a tangent that is
/// singular.
std::optional<Config> BranchJump::foreseen(const Loaded& at, const Loaded& other, bool factored) {
  constexpr double little = 1e-3;  // of the way of what moves by a law
  system_.commit(at.q);
  std::vector<double> base;
  if (!factored || system_.moves()) base = evaluate(at.q, at, at, !factored).r;
  std::vector<double> r = evaluate(at.q, at, other, false).r, z;
  Config way;
  combine(way, {{0, &at.q}});
  if (system_.moves()) {
    Config to = at.q, nudged;
    system_.prescribe(to, other.t, other.ramp);
    combine(nudged, {{1 - little, &at.q}, {little, &to}});
    system_.place(nudged);
    combine(way, {{1 / little, &nudged}, {-1 / little, &at.q}});
    const std::vector<double> moved = evaluate(nudged, at, at, false).r;
    for (size_t i = 0; i < r.size(); ++i) r[i] += (moved[i] - base[i]) / little;
  }
  if (!correct(solver_, r, z, 1e-6).ok) return std::nullopt;
  system_.add_rates(way, at.q, z);
  return way;
}

double BranchJump::between(const Loaded& from, const Loaded& to, std::optional<Config> at_start, bool factored) {
  combine(zero_, {{0, &to.q}});
  Config way;
  combine(way, {{1, &to.q}, {-1, &from.q}});
  std::vector<double> gone, most;
  each_way(system_, way, [&](size_t, double x) { gone.push_back(x); });
  most.assign(gone.size(), 0.0);
  const auto surprise = [&](const std::optional<Config>& foreseen) {
    double largest = 0, worst = 0;
    if (!foreseen) return std::fill(most.begin(), most.end(), 1e300), 0.0;  // a tangent that is singular foresees any way
    each_way(system_, *foreseen, [&](size_t i, double x) { most[i] = std::max(most[i], x), largest = std::max(largest, most[i]); });
    const double least = std::max(of_largest * system_.comm->max(largest), of_length * system_.length);
    for (size_t i = 0; i < gone.size(); ++i)
      if (gone[i] > std::max(out_of_line * most[i], least)) worst = std::max(worst, gone[i]);
    return system_.comm->max(worst);
  };
  const double longest = system_.comm->max(gone.empty() ? 0 : *std::max_element(gone.begin(), gone.end()));
  if (longest < of_length * system_.length || !balanced(from, to)) return system_.commit(to.q), 0;
  const std::optional<Config> at_end = foreseen(to, from, factored);
  if (!at_start) at_start = foreseen(from, to, false);
  const double behind = surprise(at_end);
  double jump = surprise(at_start);
  if (jump == 0 && ((at_start && cosine(system_, *at_start, way) < backwards) || (at_end && -cosine(system_, *at_end, way) < backwards)))
    jump = longest;
  if (jump == 0 && behind > 0) {  // back by what is remembered at the start
    Config q = to.q;
    std::vector<double> lambda = to.lambda;
    system_.commit(q);
    if (equilibrium(system_, solver_, q, lambda, from.t, from.ramp, false, options_).converged &&
        system_.largest_difference(q, from.q) > out_of_line * of_largest * behind)
      jump = behind;
    system_.commit(to.q);
    Stage s = stage_at(to.q, to.t);
    s.a = &zero_, s.load_factor = to.ramp, s.elapsed = slow;
    revise(system_, s);
  }
  system_.commit(to.q);
  return jump;
}

bool UnforeseenWays::shorten(double begin, double end, double way) {
  constexpr double alike = 1.3;
  const double now = way / (end - begin);
  const bool beside_longer = from == begin && end < to && now <= alike * rate;
  from = begin, to = end, rate = now;
  if (!beside_longer && now > alike * last) return false;
  last = now;
  return true;
}

}  // namespace hilo
