#include "dynamics/clock.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {

bool goes_by_itself(const System& s, const Redundancy& rows) {
  const auto none = [](const auto& list, auto&& bad) { return std::none_of(list.begin(), list.end(), bad); };
  int unknowns = 0;
  for (int block : s.body_block) unknowns += block >= 0 ? 6 : 0;
  return !s.flexible && unknowns - rows.rank == 1 && s.map.first_dense == 0 &&  // no free nodes on any rank
         none(s.springs, [](const Connector& c) { return !c.law->conserves(); }) &&
         none(s.loads, [](const Load& l) { return l.kind != Load::Kind::body_force || l.follower || !l.ramped; }) &&
         none(s.motions, [](const Motion& m) { return m.moving; }) && none(s.joints, [](const Connector& j) { return j.drive.row >= 0; });
}

/// v.M w
double Clock::inner(const Config& v, const Config& w) const {
  double sum = 0;
  for (size_t b = 0; b < system_.bodies.size(); ++b) sum += system_.bodies[b].inertia(v.c[b], v.R[b], w.c[b], w.R[b]);
  return sum;
}

/// tau - T of the step between two instants [s].
double Clock::excess(const Node& from, const Node& to) const {
  const double vMv = from.vMv + to.vMv;  // of both ends: it does not vanish where the motion turns back
  return vMv > 0 ? -T_ * T_ * T_ / 12 * (from.vMj + to.vMj) / vMv : 0;
}

double Clock::length(const Config& v, double T) {
  if (std::abs(T - T_) > 1e-9 * T) restart();
  if (nodes_.empty()) v_ = v, nodes_.push_front({inner(v, v), 0});
  T_ = tau_ = T;
  if (nodes_.size() < 5) return T;
  // parabolas through the last three that are known: nodes 0, 1, 2 of the speed, 1, 2, 3 of the jerk
  const auto& n = nodes_;
  const Node now{n[0].vMv, 3 * n[1].vMj - 3 * n[2].vMj + n[3].vMj};
  const Node next{std::max(0.0, 3 * n[0].vMv - 3 * n[1].vMv + n[2].vMv), 6 * n[1].vMj - 8 * n[2].vMj + 3 * n[3].vMj};
  const double wish = owed_ + excess(n[1], now) + excess(now, next);
  return tau_ = T + std::clamp(wish, -T / 5, T / 5);
}

void Clock::accept(const Config& v, const Config& a) {
  if (!a_.c.empty()) {
    combine(a_, {{-1, &a_}, {1, &a}});
    nodes_[0].vMj = inner(v_, a_) / T_;
  }
  if (nodes_.size() < 4) owed_ = 0;
  if (nodes_.size() == 4) {  // jerk at the start by the parabola, and all three steps between known ones at once
    nodes_[3].vMj = 3 * nodes_[2].vMj - 3 * nodes_[1].vMj + nodes_[0].vMj;
    for (int k = 0; k < 3; ++k) owed_ += excess(nodes_[k + 1], nodes_[k]);
  } else if (nodes_.size() > 4) {
    owed_ += excess(nodes_[1], nodes_[0]);
  }
  owed_ -= tau_ - T_;
  v_ = v, a_ = a;
  nodes_.push_front({inner(v, v), 0});
  if (nodes_.size() > 5) nodes_.pop_back();
}

}  // namespace hilo
