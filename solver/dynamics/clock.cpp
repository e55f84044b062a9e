// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/clock.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {

std::vector<std::vector<int>> mechanisms_of_one_freedom(const System& s) {
  const auto n = static_cast<int>(s.bodies.size());
  Ties ties(s.bodies.size());
  for (const Equations* part : s.all<Equations>()) part->tie(ties);
  s.comm->sum(ties.excluded());  // cells are on their ranks alone
  std::vector<std::vector<int>> groups(n);
  for (int b = 0; b < n; ++b)
    if (s.body_block[b] >= 0) groups[ties.root(b)].push_back(b);
  std::erase_if(groups, [&](const std::vector<int>& group) {
    int sum = 0;
    bool out = group.empty();
    for (const int b : group) sum += 6 + ties.freedoms(b), out = out || ties.is_excluded(b);
    return out || sum != 1;
  });
  return groups;
}

Clocks::Clocks(const System& system) : system_(system), group_(system.bodies.size(), -1), tempo_(system.bodies.size(), 1.0) {
  for (auto& bodies : mechanisms_of_one_freedom(system)) {
    for (const int b : bodies) group_[b] = static_cast<int>(mechanisms_.size());
    mechanisms_.emplace_back().bodies = std::move(bodies);
  }
}

std::vector<std::string> Clocks::names() const {
  std::vector<std::string> out;
  for (const Mechanism& m : mechanisms_) {
    std::string name;
    for (const int b : m.bodies) name += (name.empty() ? "" : ", ") + system_.bodies[b].name;
    out.push_back(std::move(name));
  }
  return out;
}

/// v.M w of each mechanism.
void Clocks::inner(const Config& v, const Config& w, std::vector<double>& out) const {
  out.assign(mechanisms_.size(), 0.0);
  for (const Clocked* part : system_.all<Clocked>()) part->add_inertia(group_, v, w, out);
  system_.comm->sum(out);
}

/// tau - T of the step between two instants [s], in full up to a few hundredths of T; beyond, the step does not resolve the motion, and
/// the formula nothing.
double Clocks::excess(const Node& from, const Node& to) const {
  const double vMv = from.vMv + to.vMv;  // of both ends: it does not vanish where the motion turns back
  if (!(vMv > 0)) return 0;
  const double x = -T_ * T_ / 12 * (from.vMj + to.vMj) / vMv, far = x / 0.1;
  return std::min(from.share, to.share) * T_ * x / (1 + far * far * far * far);
}

/// Up to a hundredth of the change of M a may be by the time.
double Clocks::own_share(const Mechanism& m) {
  if (m.changed == 0) return 1;
  return m.all > 0 ? std::max(0.0, 1 - 1e4 * m.changed / m.all) : 0;
}

void Clocks::plan(const Config& v, double t, double T) {
  if (std::abs(T - T_) > 1e-9 * T) restart();
  T_ = T;
  if (mechanisms_.front().nodes.empty()) {  // all of them begin together
    v_ = v;
    inner(v, v, vMv_);
    for (size_t k = 0; k < mechanisms_.size(); ++k) mechanisms_[k].nodes.push_front({vMv_[k], 0});
  }
  changed_.assign(mechanisms_.size(), 0.0);
  for (const Clocked* part : system_.all<Clocked>()) part->add_timed(group_, t, T, changed_);
  system_.comm->sum(changed_);
  for (size_t k = 0; k < mechanisms_.size(); ++k) {
    Mechanism& m = mechanisms_[k];
    m.tau = T, m.changed = std::min(changed_[k], 1e300);
    if (const auto& n = m.nodes; n.size() >= 5) {
      // parabolas through the last three that are known: nodes 0, 1, 2 of the speed, 1, 2, 3 of the jerk
      const double share = std::min({own_share(m), n[1].share, n[2].share, n[3].share});
      const Node now{n[0].vMv, 3 * n[1].vMj - 3 * n[2].vMj + n[3].vMj, share};
      const Node next{std::max(0.0, 3 * n[0].vMv - 3 * n[1].vMv + n[2].vMv), 6 * n[1].vMj - 8 * n[2].vMj + 3 * n[3].vMj, share};
      m.tau += std::clamp(m.owed + excess(n[1], now) + excess(now, next), -T / 5, T / 5);
    }
    for (const int b : m.bodies) tempo_[b] = T / m.tau;
  }
}

void Clocks::accept(const Config& v, const Config& a, const Taken& step) {
  const bool known = !a_.c.empty();
  inner(v, v, vMv_);
  if (known) {
    combine(jerk_, {{1, &a}, {-1, &a_}});  // times T
    inner(v_, jerk_, vMj_), inner(jerk_, jerk_, jMj_);
  }
  taken_.assign(mechanisms_.size(), 0.0);  // the same on all ranks
  for (const Clocked* part : system_.all<Clocked>()) part->add_taken(group_, step.stage, step.lambda, taken_);
  for (size_t k = 0; k < mechanisms_.size(); ++k) {
    Mechanism& m = mechanisms_[k];
    auto& n = m.nodes;
    const double taken = taken_[k];
    if (known) {
      n[0].vMj = vMj_[k] / T_;
      m.all = jMj_[k];
      const double swing = T_ * std::sqrt(n[0].vMv * std::abs(n[0].vMj)), damped = (m.taken + taken) / 2;  // v.Mv omega T
      n[0].share = own_share(m) * (damped > 0 ? swing * swing / (swing * swing + 2500 * damped * damped) : 1);
    }
    if (n.size() < 4) m.owed = 0;
    if (n.size() == 4) {  // jerk at the start by the parabola, and all three steps between known ones at once
      n[3].vMj = 3 * n[2].vMj - 3 * n[1].vMj + n[0].vMj;
      for (int i = 0; i < 3; ++i) m.owed += excess(n[i + 1], n[i]);
    } else if (n.size() > 4) {
      m.owed += excess(n[1], n[0]);
    }
    m.owed -= m.tau - T_, m.taken = taken;
    n.push_front({vMv_[k], 0});
    if (n.size() > 5) n.pop_back();
  }
  v_ = v, a_ = a;
}

void Clocks::restart() {
  for (Mechanism& m : mechanisms_) m.nodes.clear();
  a_ = {};
}

}  // namespace hilo
