#include "dynamics/clock.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hilo {

std::vector<std::vector<int>> mechanisms_of_one_freedom(const System& s) {
  const auto n = static_cast<int>(s.bodies.size());
  std::vector<int> parent(n), freedoms(n, 0);
  std::vector<double> no(n, 0);  // something flexible, or moved from outside
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  const auto free = [&](int b) { return b >= 0 && s.body_block[b] >= 0; };
  const auto connect = [&](const Connector& c) {
    int first = -1;
    for (const Carrier& end : c.ends())
      if (free(end.body)) {
        if (first < 0) first = end.body;
        parent[root(end.body)] = root(first);
      }
    for (const Carrier& end : c.ends()) {
      const bool moved = end.body > 0 && !free(end.body) && !s.bodies[end.body].ground &&
                         std::any_of(s.motions.begin(), s.motions.end(), [&](const Motion& m) { return m.body == end.body && m.moving; });
      if (first >= 0 && (moved || (end.body < 0 && end.node >= 0))) no[first] = 1;
    }
    return first;
  };
  for (const Connector& spring : s.springs) connect(spring);
  for (const Connector& joint : s.joints) {
    const int first = connect(joint);
    if (first < 0) continue;
    for (int r = 0; r < joint.n_rows(); ++r) freedoms[first] -= joint.active[r];
    if (joint.drive.row >= 0 && joint.drive.law.top_rate() != 0) no[first] = 1;
  }
  for (const SolidBatch& b : s.batches)
    for (const int node : b.nodes)
      if (const int body = s.follower[node]; free(body)) no[body] = 1;
  s.comm->sum(no);  // cells are on their ranks alone
  std::vector<std::vector<int>> parts(n);
  for (int b = 0; b < n; ++b)
    if (free(b)) parts[root(b)].push_back(b);
  std::erase_if(parts, [&](const std::vector<int>& part) {
    int sum = 0;
    bool out = part.empty();
    for (const int b : part) sum += 6 + freedoms[b], out = out || no[b] > 0;
    return out || sum != 1;
  });
  return parts;
}

Clocks::Clocks(const System& system) : system_(system), tempo_(system.bodies.size(), 1.0) {
  std::vector<int> mechanism_of(system.bodies.size(), -1);
  for (auto& part : mechanisms_of_one_freedom(system)) {
    for (const int b : part) mechanism_of[b] = static_cast<int>(mechanisms_.size());
    mechanisms_.emplace_back().bodies = std::move(part);
  }
  const auto of = [&](int b) { return b >= 0 && mechanism_of[b] >= 0 ? &mechanisms_[mechanism_of[b]] : nullptr; };
  for (const Load& l : system.loads) {
    if (l.ramped || mechanisms_.empty()) continue;
    std::vector<double> square(mechanisms_.size(), 0.0);  // f.M^-1 f
    const auto add = [&](int b, double force) {           // or the force that a torque is at the body's size
      if (b >= 0 && mechanism_of[b] >= 0) square[mechanism_of[b]] += force * force / std::max(system.bodies[b].mass, 1e-300);
    };
    if (l.body >= 0 && system.comm->rank == 0)
      add(l.body, l.value.norm() / (l.kind == Load::Kind::body_torque ? system.bodies[l.body].size : 1));
    for (size_t i = 0; i < l.nodes.size(); ++i) add(system.follower[l.nodes[i]], l.weight[i] * l.value.norm());
    for (const auto& facet : l.facets)
      for (const int node : facet) add(system.follower[node], 1e100);
    system.comm->sum(square);
    for (size_t i = 0; i < square.size(); ++i)
      if (square[i] > 0) mechanisms_[i].loads.push_back({&l, square[i]});
  }
  for (const Connector& c : system.springs)
    for (const Carrier& end : c.ends())
      if (Mechanism* m = of(end.body); m && !c.law->conserves()) {
        m->factored = m->factored || c.factor;
        if (m->dampers.empty() || m->dampers.back() != &c) m->dampers.push_back(&c);
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

/// v.M w
double Clocks::inner(const Mechanism& m, const Config& v, const Config& w) const {
  double sum = 0, masses = 0;
  for (const int b : m.bodies) sum += system_.bodies[b].inertia(v.c[b], v.R[b], w.c[b], w.R[b]);
  for (const auto& [node, mass] : system_.point_masses)
    if (std::find(m.bodies.begin(), m.bodies.end(), system_.follower[node]) != m.bodies.end()) masses += mass * v.x[node].dot(w.x[node]);
  return sum + system_.comm->sum(masses);
}

/// What loads do differently in the step from t than in the one before, by the time alone: sum of f.M^-1 f [N^2/kg].
double Clocks::change(const Mechanism& m, double t) const {
  double sum = m.factored ? 1e300 : 0;
  for (const Timed& l : m.loads)
    if (const double df = l.load->factor(t, t + T_, 1) - l.load->factor(t - T_, t, 1); df != 0) sum += df * df * l.square;
  return std::min(sum, 1e300);
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
  for (Mechanism& m : mechanisms_) {
    if (m.nodes.empty()) v_ = v, m.nodes.push_front({inner(m, v, v), 0});
    m.tau = T, m.changed = change(m, t);
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
  if (known) combine(jerk_, {{1, &a}, {-1, &a_}});  // times T
  for (Mechanism& m : mechanisms_) {
    auto& n = m.nodes;
    double taken = 0;
    for (const Connector* c : m.dampers) {
      Response response;
      c->law->viscous(c->values(*step.stage.w0), c->values(*step.stage.w1), system_.interval(*c, step.stage, step.lambda), response);
      taken += std::abs(response.dissipated) + std::abs(response.supplied);
    }
    if (known) {
      n[0].vMj = inner(m, v_, jerk_) / T_;
      m.all = inner(m, jerk_, jerk_);
      const double swing = T_ * std::sqrt(n[0].vMv * std::abs(n[0].vMj)), damped = (m.taken + taken) / 2;  // v.Mv omega T
      n[0].share = own_share(m) * (damped > 0 ? swing * swing / (swing * swing + 2500 * damped * damped) : 1);
    }
    if (n.size() < 4) m.owed = 0;
    if (n.size() == 4) {  // jerk at the start by the parabola, and all three steps between known ones at once
      n[3].vMj = 3 * n[2].vMj - 3 * n[1].vMj + n[0].vMj;
      for (int k = 0; k < 3; ++k) m.owed += excess(n[k + 1], n[k]);
    } else if (n.size() > 4) {
      m.owed += excess(n[1], n[0]);
    }
    m.owed -= m.tau - T_, m.taken = taken;
    n.push_front({inner(m, v, v), 0});
    if (n.size() > 5) n.pop_back();
  }
  v_ = v, a_ = a;
}

void Clocks::restart() {
  for (Mechanism& m : mechanisms_) m.nodes.clear();
  a_ = {};
}

}  // namespace hilo
