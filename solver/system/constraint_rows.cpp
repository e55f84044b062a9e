// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint rows of joints: their blocks, values, rates and reactions.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "physics/rolling.hpp"
#include "system/joints.hpp"

namespace hilo {
namespace {

int n_blocks(const Joint& joint) { return (joint.n_rows() + 2) / 3; }

}  // namespace

void gaps(const Joint& joint, const Config& q, double t, double factor, double* g) {
  joint.row_values(joint.values(q), g);
  if (joint.drive.row >= 0) g[joint.drive.row] -= joint.drive.law.at(t, t, factor).value;
}

Traits Joints::traits() const {
  return {.constrains = !list.empty(), .is_driven = std::any_of(begin(), end(), [](const Joint& j) { return j.drive.row >= 0; })};
}

std::string Joints::count() const { return fmt::format("{} joints", n_told()); }

void Joints::number(Layout& layout) {
  block_.clear(), clique_.clear(), owned_.clear();
  for (size_t j = 0; j < list.size(); ++j) {
    block_.push_back(layout.add_rows(static_cast<int>(j), n_blocks(list[j])));
    std::vector<int> blocks = blocks_of_ends(points_, list[j]);
    for (int k = 0; k < n_blocks(list[j]); ++k) blocks.push_back(block_[j] + k);
    clique_.push_back(layout.cliques.add(blocks));
    owned_.push_back(is_owned(points_, list[j], j));
  }
}

std::string Joints::owner(int block) const {
  if (block_.empty() || block < block_.front() || block >= block_.back() + n_blocks(list.back())) return "";
  const auto after = std::upper_bound(block_.begin(), block_.end(), block);
  const auto j = static_cast<size_t>(after - block_.begin()) - 1;
  return fmt::format("{} \"{}\"", j < n_told() ? "joint" : "the bond of", list[j].name);
}

void Joints::look_at_rows(const Config& q, double t, double factor, Violation& out) const {
  double g[max_rows];
  for (size_t j = 0; j < list.size(); ++j) {
    gaps(list[j], q, t, factor, g);
    for (int r = 0; r < list[j].n_rows(); ++r) {
      const bool on = list[j].active[r];
      double& worst = on ? out.kept : out.dropped;
      if (const double x = std::isnan(g[r]) ? 1e300 : std::abs(g[r]); x > worst)
        worst = x, (on ? out.kept_block : out.dropped_block) = block_[j] - points_.first_joint_block();
    }
  }
}

/// The measures are of degree two, so differences along q + tau v and q + tau a are exact; rows that are functions of them follow by the
/// chain rule.
void Joints::add_row_rates(const Rates& at, std::vector<double>& rate, std::vector<double>* acceleration) const {
  RowLaw::Gradient g;
  for (size_t j = 0; j < list.size(); ++j) {
    if (!owned_[j]) continue;
    const Joint& c = list[j];
    const int n = static_cast<int>(c.measures.size()), base = row(j);
    const auto e = c.values(at.q), ep = c.values(at.forward), em = c.values(at.backward);
    std::array<double, max_measures> de{}, dde{};
    for (int m = 0; m < n; ++m) de[m] = (ep[m] - em[m]) / (2 * at.tau);
    if (acceleration) {
      const auto eu = c.values(at.up), ed = c.values(at.down);
      for (int m = 0; m < n; ++m) dde[m] = (ep[m] + em[m] - 2 * e[m]) / (at.tau * at.tau) + (eu[m] - ed[m]) / (2 * at.sigma);
    }
    if (c.rows) c.rows->gradient(e, e, g);
    if (c.velocity_rows) {
      const Slip slip(c, at.q, &at.v);
      const auto along = [&](int body) {
        return Slip::Move{at.v.c[body], at.a ? at.a->c[body] : Vec3::Zero(), at.v.R[body], at.a ? at.a->R[body] : Mat3::Zero()};
      };
      const Slip::Change change = slip.change(along(c.end[0].body), along(c.end[1].body));
      for (int r = 0; r < slip.n; ++r) {
        rate[base + c.n_position_rows() + r] = slip.value[r];
        if (acceleration) (*acceleration)[base + c.n_position_rows() + r] = change.value[r];
      }
    }
    for (int r = 0; r < c.n_position_rows(); ++r) {
      double first = c.rows ? 0 : de[r], second = c.rows ? 0 : dde[r];
      for (int m = 0; m < n && c.rows; ++m) {
        first += g.d[r][m] * de[m], second += g.d[r][m] * dde[m];
        for (int k = 0; k < n; ++k) second += 2 * g.D[r][m][k] * de[m] * de[k];
      }
      if (r == c.drive.row) {
        const Course course = c.drive.law.at(at.t, points_.beside(at.t, Side::right));
        first -= course.rate, second -= course.acceleration;
      }
      rate[base + r] = first;
      if (acceleration) (*acceleration)[base + r] = second;
    }
  }
}

void Joints::add_jumps(double t, const Config&, const Config&, std::span<const double> slack, std::vector<Jump>& jumps) const {
  for (size_t j = 0; j < list.size(); ++j) {
    const Drive& d = list[j].drive;
    if (d.row < 0) continue;
    const double by = t > 0 ? d.law.jump(t, points_.same_time) : std::abs(slack[row(j) + d.row]);
    jumps.push_back({by, d.law.top_rate(), fmt::format("joint \"{}\"", list[j].name), by, d.unit});
  }
}

/// Joints are on all ranks, but q may differ by rounding where they meet.
std::string Joints::fault(const Config& q) const {
  double found = -1;
  for (size_t j = 0; j < list.size(); ++j)
    if (list[j].rows && !list[j].rows->fault(list[j].values(q)).empty()) found = static_cast<double>(j);
  found = points_.comm->max(found);
  if (found < 0) return "";
  const Joint& c = list[static_cast<size_t>(found)];
  return "joint \"" + c.name + "\" " + c.rows->fault(c.values(q));
}

/// Rows of velocities hold at the middle of a step, and err by a twelfth of the square of its turn.
std::string Joints::too_far(const Config& q0, const Config& q1) const {
  constexpr double most = 0.1;  // [rad]
  for (const Joint& j : list) {
    if (!j.velocity_rows) continue;
    const auto turned = [&](const Config& q) { return Mat3(q.R[j.end[0].body].transpose() * q.R[j.end[1].body]); };
    const double turn = std::abs(Eigen::AngleAxisd(Mat3(turned(q0).transpose() * turned(q1))).angle());
    if (turn > most) return fmt::format("joint \"{}\" rolls by {:.2g} rad in one step", j.name, turn);
    // whole turns are seen by the way of the centre
    const auto apart = [&](const Config& q) { return Vec3(q.R[j.end[0].body].transpose() * (q.c[j.end[1].body] - q.c[j.end[0].body])); };
    const double arm = j.velocity_rows->contact(q0.R[j.end[0].body], q0.R[j.end[1].body]).arm.norm(), way = (apart(q1) - apart(q0)).norm();
    if (j.velocity_rows->n_rows() == 2 && way > 2 * most * arm)
      return fmt::format("joint \"{}\" rolls by {:.2g} m in one step", j.name, way);
  }
  return {};
}

void Joints::commit(const Config& q, const Config*) {
  for (Joint& j : list)
    if (j.rows) j.rows->commit(j.values(q));
}

void Joints::archive(Archive& a) {
  for (Joint& j : list) {
    a("joint " + j.name, j.active);
    if (j.rows) j.rows->archive(a);
  }
}

std::vector<Output> Joints::outputs() const {
  std::vector<Output> out;
  for (size_t j = 0; j < n_told(); ++j) out.push_back({.group = "joint", .name = list[j].name, .n_mid = 6});
  return out;
}

/// Reactions: force and moment on b at the joint point, in the joint frame carried by a, or in the axes asked for.
std::vector<std::array<Vec3, 2>> Joints::held_points(const Moment& at, int j) const {
  std::vector<std::array<Vec3, 2>> out;
  const Joint& c = list[static_cast<size_t>(j)];
  const Config& q = *at.s.left;
  const int body = c.end[1].body;
  for (size_t k = 0; k < c.measures.size(); ++k) {
    const Term& term = c.measures[k].terms.front();
    const Vec3& arm = c.entities[static_cast<size_t>(term.j)].r;
    out.push_back({q.c[body] + q.R[body] * arm, -at.lambda[static_cast<size_t>(row(static_cast<size_t>(j))) + k] * term.unit});
  }
  return out;
}

void Joints::observe(const Sight& at) {
  if (!at.step) return;
  const Moment& m = *at.step;
  const Config& q = *m.s.left;
  ConnectorGradient left;
  double force[max_measures];
  for (size_t j = 0; j < n_told(); ++j) {
    const Joint& c = list[j];
    const double* lambda = m.shared.data() + row(j);
    gradient(c, q, left);
    joint_forces(c, m.s, left, lambda, force);
    Vec6 f = force_on_b(c, left, force, q);
    if (c.velocity_rows) {
      Vec6 slip = Slip(c, q, m.s.v).force(lambda + c.n_position_rows());
      slip.tail<3>() -= (q.R[c.end[1].body] * c.point_b).cross(slip.head<3>());
      f += slip;
    }
    if (const auto axes = told_in.find(j); axes != told_in.end()) {
      const Mat3 frame = axes->second.body >= 0 ? Mat3(q.R[axes->second.body] * axes->second.in) : axes->second.in;
      const Vec3 force = frame.transpose() * f.head<3>(), moment = frame.transpose() * f.tail<3>();
      at.mid.insert(at.mid.end(), force.data(), force.data() + 3);
      at.mid.insert(at.mid.end(), moment.data(), moment.data() + 3);
      continue;
    }
    append_in_frame(c, f, q, at.mid);
  }
}

void Joints::tie(Ties& ties) const {
  for (const Joint& joint : list) {
    const int first = tie_ends(points_, joint, ties);
    if (first < 0) continue;
    ties.hold(first, static_cast<int>(std::count(joint.active.begin(), joint.active.begin() + joint.n_rows(), true)));
    if (joint.drive.row >= 0 && joint.drive.law.top_rate() != 0) ties.exclude(first);
  }
}

}  // namespace hilo
