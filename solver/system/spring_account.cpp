// SPDX-License-Identifier: GPL-3.0-or-later
// What springs remember, take, give and show.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "system/brake.hpp"
#include "system/springs.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

/// The group that a spring without a potential alone acts in, or -1: its ends are of one.
int group_of(const Spring& c, std::span<const int> group) {
  if (c.law->conserves()) return -1;
  for (const Carrier& end : c.ends())
    if (end.body >= 0 && group[end.body] >= 0) return group[end.body];
  return -1;
}

}  // namespace

Traits Springs::traits() const {
  return {.has_rates = !list.empty(),
          .is_pressed = std::any_of(list.begin(), list.end(), [](const Spring& c) { return c.pressing.joint >= 0; })};
}

std::string Springs::count() const { return fmt::format("{} springs", list.size()); }

void Springs::number(Layout& layout) {
  clique_.clear(), owned_.clear();
  for (size_t i = 0; i < list.size(); ++i) {
    std::vector<int> blocks = blocks_of_ends(points_, list[i]);
    if (const int j = list[i].pressing.joint; j >= 0)
      for (int k = 0; k < (joints_[j].n_rows() + 2) / 3; ++k) blocks.push_back(joints_.block(j) + k);
    clique_.push_back(layout.cliques.add(blocks));
    owned_.push_back(is_owned(points_, list[i], i));
  }
}

void Springs::viscous(const Spring& c, const Stage& s, std::span<const double> lambda, Response& out) const {
  const auto [r0, r1] = rate_pair(c, s);
  c.law->viscous(r0, r1, interval(c, s, lambda), out);
}

void Springs::add_energy(const Config& q, const Config&, Energy& sum) const {
  for (size_t i = 0; i < list.size(); ++i) {
    if (!owned_[i]) continue;
    const SpringLaw::Values e = list[i].values(q);
    Response r;
    list[i].law->elastic(e, e, r);
    sum.elastic += r.energy;
  }
}

void Springs::add_work(const Moment& m, Work& sum) const {
  for (size_t i = 0; i < list.size(); ++i) {
    if (!owned_[i] || m.s.h <= 0) continue;
    Response r;
    viscous(list[i], m.s, m.lambda, r);
    sum.dissipated += m.s.share() * r.dissipated, sum.external += m.s.share() * r.supplied;
  }
}

/// Laws of angles have bodies at both ends, which all ranks know.
void Springs::advance(const Stage& stage) {
  passed_.clear(), told_.resize(list.size(), 0);
  for (size_t i = 0; i < list.size(); ++i) {
    if (told_[i] || list[i].end[0].body < 0 || list[i].end[1].body < 0) continue;
    if (const std::string what = list[i].law->beyond(list[i].values(*stage.end)); !what.empty())
      passed_.emplace_back(static_cast<int>(i), fmt::format("passes {} at t = {:.4g} s: its law does not hold beyond", what, stage.t_end));
  }
}

void Springs::settle(bool accepted) {
  for (const auto& [i, text] : passed_)
    if (accepted) {
      told_[i] = 1;
      if (points_.comm->rank == 0) warn(fmt::format("{} \"{}\"", list[i].group, list[i].name), text);
    }
  passed_.clear();
}

void Springs::commit(const Config& q, const Config* v) {
  Config ahead, behind;
  const double tau = 1e-3;  // [s]; measures are of degree two, any tau gives the exact rate
  if (v && std::any_of(list.begin(), list.end(), [](const Spring& s) { return s.law->needs_rate(); })) {
    ahead = behind = q;
    for (size_t i = 0; i < q.x.size(); ++i) ahead.x[i] += tau * v->x[i], behind.x[i] -= tau * v->x[i];
    for (size_t b = 0; b < q.c.size(); ++b) {
      ahead.c[b] += tau * v->c[b], behind.c[b] -= tau * v->c[b];
      ahead.R[b] += tau * v->R[b], behind.R[b] -= tau * v->R[b];
    }
  }
  for (Spring& s : list) {
    SpringLaw::Values rate{};
    if (!ahead.c.empty() && s.law->needs_rate()) {
      const auto e1 = s.values(ahead), e0 = s.values(behind);
      for (size_t m = 0; m < s.measures.size(); ++m) rate[m] = (e1[m] - e0[m]) / (2 * tau);
    }
    s.law->commit(s.values(q), rate);
  }
}

void Springs::archive(Archive& a) {
  for (Spring& c : list) {
    a("spring " + c.name);
    c.law->archive(a);
  }
  a("passed", told_), a("impacts of stops", impacts_);
}

std::vector<Output> Springs::outputs() const {
  std::vector<Output> out;
  for (const Spring& c : list) out.push_back({.group = c.group, .name = c.name, .n_mid = 6, .only_presses = c.law->only_presses()});
  return out;
}

/// Force and moment on b: at the point, in inertial axes, or for what acts along or in a joint, in its frame.
void Springs::observe(const Sight& at) {
  if (!at.step) return;
  const Moment& m = *at.step;
  std::vector<double>& out = at.mid;
  ConnectorGradient left;
  impacts_.resize(list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const Spring& c = list[i];
    gradient(c, *m.s.left, left);
    Response r;
    spring_elastic(c, m.s, r);
    const size_t of_gap = c.group == "stop" ? c.measures.size() : 1;  // a support has springs in its plane behind it
    if (m.s.h > 0 && c.law->needs_rate())
      impacts_[i].add(std::any_of(r.s.begin(), r.s.begin() + of_gap, [](double s) { return s != 0; }) ? 1 : 0, 0);
    if (m.s.h > 0) viscous(c, m.s, m.lambda, r);
    const Vec6 f = force_on_b(c, left, r.s.data(), *m.s.left);
    if (c.axes == Spring::Axes::inertial)
      out.insert(out.end(), f.data(), f.data() + 6);
    else
      append_in_frame(c, f, *m.s.left, out);
  }
}

void Springs::add_to_report(Json&) const {
  for (size_t i = 0; i < impacts_.size(); ++i)
    if (const ContactSums& sums = impacts_[i]; sums.impacts > 0 && sums.shortest < ContactSums::resolved)
      warn(fmt::format("{} \"{}\"", list[i].group, list[i].name),
           fmt::format("the shortest of {} impacts lasted {} steps: its force and its restitution are not resolved", sums.impacts,
                       sums.shortest));
}

void Springs::tie(Ties& ties) const {
  for (const Spring& c : list) tie_ends(points_, c, ties);
}

/// A motor with a history: how much is not asked.
void Springs::add_timed(std::span<const int> group, double, double, std::span<double> sum) const {
  for (const Spring& c : list)
    if (const int g = c.history ? group_of(c, group) : -1; g >= 0) sum[g] += 1e300;
}

void Springs::add_taken(std::span<const int> group, const Stage& s, std::span<const double> lambda, std::span<double> sum) const {
  for (const Spring& c : list)
    if (const int g = group_of(c, group); g >= 0) {
      Response r;
      viscous(c, s, lambda, r);
      sum[g] += std::abs(r.dissipated) + std::abs(r.supplied);
    }
}

std::pair<std::string, std::string> Springs::takes_most(const Stage& s, std::span<const double> lambda) const {
  std::pair<std::string, std::string> out;
  double most = 0;
  for (const Spring& c : list) {
    Response r;
    viscous(c, s, lambda, r);
    if (r.dissipated > most) most = r.dissipated, out = {c.group, c.name};
  }
  return out;
}

std::pair<std::string, std::string> takes_most(const System& system, const Stage& stage, std::span<const double> lambda) {
  return system.part<Springs>().takes_most(stage, lambda);
}

bool springs_are_smooth(const System& system) {
  return std::ranges::all_of(system.part<Springs>().list, [](const Spring& c) { return c.law->is_smooth(); });
}

std::vector<std::string> pressed_by(const System& system, std::span<const int> places) {
  const Joints& joints = system.part<Joints>();
  std::vector<std::string> out;
  for (const Spring& c : system.part<Springs>().list) {
    if (c.pressing.joint < 0) continue;
    const int first = joints.row(static_cast<size_t>(c.pressing.joint));
    if (std::ranges::any_of(c.pressing.rows, [&](int r) { return std::ranges::binary_search(places, first + r); }))
      out.push_back(joints.list[c.pressing.joint].name);
  }
  return out;
}

}  // namespace hilo
