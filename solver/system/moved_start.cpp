// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/moved_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/joined.hpp"
#include "system/beams.hpp"
#include "system/motions.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
constexpr double same = 1e-12;  // of the scene

/// Away from the drawing as a rigid body, x = R X + d.
struct Pose {
  Mat3 R = Mat3::Identity();
  Vec3 d = Vec3::Zero();
  Vec3 of(const Vec3& x) const { return R * x + d; }
};

class Begin {
 public:
  Begin(const System& system, const Config& q) : system_(system), n_(system.X.size()), hangs_(n_ + system.bodies.size()) {
    pose_of_body_.assign(system.bodies.size(), none);
    for (size_t b = 0; b < system.bodies.size(); ++b) {
      if (system.bodies[b].free()) continue;
      const Mat3 R = q.R[b] * system.start.R[b].transpose();
      pose_of_body_[b] = number({R, q.c[b] - R * system.start.c[b]});
    }
  }

  /// The number of a pose, 0 that of the drawing.
  std::int64_t number(const Pose& pose) {
    for (size_t k = 0; k < poses_.size(); ++k)
      if ((poses_[k].d - pose.d).norm() + (poses_[k].R - pose.R).norm() * system_.length <= same * system_.length)
        return static_cast<std::int64_t>(k);
    poses_.push_back(pose);
    return static_cast<std::int64_t>(poses_.size()) - 1;
  }
  std::int64_t of_body(int b) const { return pose_of_body_[static_cast<size_t>(b)]; }
  bool are_all_drawn() const { return poses_.size() == 1; }
  const Pose& pose(std::int64_t k) const { return poses_[static_cast<size_t>(k)]; }

  /// Members of a cell, bodies and nodes: those that are free hang together, and on what holds the others.
  void cell(std::span<const int> nodes, std::span<const int> bodies) {
    int first = -1;
    std::vector<std::int64_t> held;
    const auto take = [&](int item, int body) {
      if (body >= 0 && of_body(body) != none) return held.push_back(of_body(body));
      if (first < 0) first = item;
      hangs_.join(first, item);
    };
    const auto of = [&](int body) { return static_cast<int>(n_) + body; };
    for (const int i : nodes) take(system_.follower[i] < 0 ? i : of(system_.follower[i]), system_.follower[i]);
    for (const int b : bodies) take(of(b), b);
    for (const std::int64_t pose : held)
      if (first >= 0) hold(first, pose);
  }
  void hold(int item, std::int64_t pose) { seeds_.emplace_back(static_cast<size_t>(item), pose); }

  /// The lowest pose, or the highest one, of all that holds what each item hangs together with.
  std::vector<std::int64_t> lowest() { return spread(seeds_, 1); }
  std::vector<std::int64_t> highest() { return spread(seeds_, -1); }
  std::vector<std::int64_t> marked(const std::vector<std::pair<size_t, std::int64_t>>& items) { return spread(items, 1); }

 private:
  std::vector<std::int64_t> spread(const std::vector<std::pair<size_t, std::int64_t>>& seeds, int sign) {
    std::vector<std::int64_t> value(hangs_.size(), none);
    for (const auto& [item, x] : seeds) value[item] = std::min(value[item], sign * x);
    for (bool changes = true; changes;) {
      for (size_t k = 0; k < value.size(); ++k) {
        std::int64_t& low = value[static_cast<size_t>(hangs_.root(static_cast<int>(k)))];
        low = std::min(low, value[k]);
      }
      for (size_t k = 0; k < value.size(); ++k) value[k] = value[static_cast<size_t>(hangs_.root(static_cast<int>(k)))];
      const std::vector<std::int64_t> before = value;
      over_ranks(value);
      changes = system_.comm->max(value == before ? 0 : 1) > 0;
    }
    for (std::int64_t& x : value)
      if (x != none) x *= sign;
    return value;
  }
  void over_ranks(std::vector<std::int64_t>& value) const {
    if (system_.comm->size == 1) return;
    const auto nodes = static_cast<std::ptrdiff_t>(n_);
    std::vector<std::int64_t> of_nodes(value.begin(), value.begin() + nodes);
    system_.lowest_over_ranks(of_nodes);
    std::ranges::copy(of_nodes, value.begin());
    std::vector<double> of_bodies;  // negative, with none below all
    for (size_t k = n_; k < value.size(); ++k) of_bodies.push_back(value[k] == none ? -HUGE_VAL : -static_cast<double>(value[k]));
    system_.comm->max(of_bodies);
    for (size_t k = n_; k < value.size(); ++k)
      value[k] = std::isinf(of_bodies[k - n_]) ? none : static_cast<std::int64_t>(-of_bodies[k - n_]);
  }

  const System& system_;
  size_t n_;           // nodes; bodies follow
  Joined<int> hangs_;  // what free members of cells hang together with
  std::vector<Pose> poses_{Pose{}};
  std::vector<std::int64_t> pose_of_body_;
  std::vector<std::pair<size_t, std::int64_t>> seeds_;  // item, pose
};

}  // namespace

MovedStart begin_moved(const System& system, Config& q, double factor) {
  MovedStart out;
  if (!system.moves()) return out;
  Begin at(system, q);
  const auto& motions = system.part<Motions>().list;
  std::vector<std::int64_t> pose_of(motions.size(), 0);
  for (size_t k = 0; k < motions.size(); ++k) {
    const Motion& m = motions[k];
    if (!m.moving) continue;
    Vec3 way = m.law.at(0, 0, factor).value * m.displacement;
    for (int i = 0; i < 3; ++i)
      if (!m.component[i]) way[i] = 0;
    pose_of[k] = m.body >= 0 ? at.of_body(m.body) : at.number({Mat3::Identity(), way});
    for (const int i : m.nodes)
      if (m.body < 0 && pose_of[k] > 0 && system.follower[i] < 0) at.hold(i, pose_of[k]);
  }
  if (at.are_all_drawn()) return out;
  for (const SolidBatch& b : system.part<Solids>().batches) {
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t e = 0; e < b.cells.size(); ++e) at.cell({b.nodes.data() + e * n, n}, {});
  }
  each_cell_of_beams(system, [&](const std::array<int, 2>& bodies) { at.cell({}, bodies); });

  const std::vector<std::int64_t> low = at.lowest(), high = at.highest();
  const size_t n = system.X.size();
  const auto moves = [&](size_t item) { return low[item] == high[item] && low[item] != none && low[item] > 0; };
  std::vector<std::pair<size_t, std::int64_t>> held;  // nodes of which a motion holds components elsewhere
  for (size_t i = 0; i < std::min(n, q.x.size()); ++i)
    for (int c = 0; c < 3 && moves(i); ++c)
      if (system.fixed[i][c] && std::abs(at.pose(low[i]).of(system.start.x[i])[c] - q.x[i][c]) > same * system.length)
        held.emplace_back(i, 0);
  const std::vector<std::int64_t> torn = at.marked(held);
  std::vector<double> is_torn(motions.size(), 0.0);
  const auto goes = [&](size_t item) {
    if (moves(item) && torn[item] == none) return true;
    if (low[item] != none && high[item] > 0)
      for (size_t k = 0; k < motions.size(); ++k)
        if (pose_of[k] > 0 && (pose_of[k] == low[item] || pose_of[k] == high[item])) is_torn[k] = 1;
    return false;
  };
  for (size_t i = 0; i < std::min(n, q.x.size()); ++i) {
    if (system.follower[i] >= 0 || !goes(i)) continue;
    const Vec3 to = at.pose(low[i]).of(system.start.x[i]);
    out.way = std::max(out.way, (to - q.x[i]).norm());
    q.x[i] = to;
  }
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    if (!system.bodies[b].free() || !goes(n + b)) continue;
    const Pose& pose = at.pose(low[n + b]);
    const Vec3 to = pose.of(system.start.c[b]);
    out.way = std::max(out.way, (to - q.c[b]).norm());
    q.c[b] = to, q.R[b] = pose.R * system.start.R[b];
  }
  system.place(q);
  out.way = system.comm->max(out.way);
  system.comm->max(is_torn);
  for (size_t k = 0; k < motions.size(); ++k)
    if (is_torn[k] > 0) out.torn.push_back(motions[k].name);
  return out;
}

}  // namespace hilo
