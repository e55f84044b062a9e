// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact/ball_heap.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/comm.hpp"
#include "system/contact/near_boxes.hpp"

namespace hilo {

std::vector<Vec3> BallHeap::centres(const Config& q) const {
  std::vector<Vec3> out;
  for (const Ball& ball : balls) out.push_back(q.c[ball.body] + q.R[ball.body] * ball.arm);
  return out;
}

/// How far apart are pairs that are listed ahead [m].
double BallHeap::margin() const {
  double sum = 0;
  for (const Ball& ball : balls) sum += ball.radius;
  return 0.25 * sum / static_cast<double>(balls.size());
}

/// Pairs that come within a distance of each other as all go straight.
std::vector<std::pair<int, int>> BallHeap::find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double within) const {
  std::vector<AxisBox> box(balls.size());
  for (size_t i = 0; i < balls.size(); ++i) box[i].take(from[i]), box[i].take(to[i]), box[i].widen(balls[i].radius + within / 2);
  std::vector<std::pair<int, int>> out = near_boxes(box, box);
  std::erase_if(out, [&](const std::pair<int, int>& pair) {
    const auto& [i, j] = pair;
    if (i >= j || std::binary_search(never.begin(), never.end(), pair)) return true;
    const Vec3 d = from[j] - from[i], way = to[j] - to[i] - d;
    const double square = way.squaredNorm(), at = square > 0 ? std::clamp(-d.dot(way) / square, 0., 1.) : 0;
    return !((d + at * way).norm() <= balls[i].radius + balls[j].radius + within);
  });
  return out;
}

ContactPair BallHeap::pair_of(int i, int j) const {
  const Ball &a = balls[i], &b = balls[j];
  ContactPair pair;
  pair.name = name, pair.friction = law.friction, pair.loses = loses, pair.n_points = 1, pair.number = {0};
  pair.shape.kind = Distance::Kind::sphere, pair.shape.radius = a.radius, pair.shape.reach = b.radius;
  pair.carrier = a.body, pair.at = a.arm, pair.body = b.body;
  ContactPoint& point = pair.points.emplace_back();
  point.law = law, point.law.radius = b.radius, point.arm = b.arm, point.cell = 0.1 * b.radius;
  if (modulus > 0) point.law.take_hertz(modulus, 1 / (1 / a.radius + 1 / b.radius));
  return pair;
}

/// The pairs to evaluate from now on; those that go on keep their state.
void BallHeap::list(std::vector<std::pair<int, int>> pairs) {
  std::vector<ContactPair> out;
  size_t old = 0;
  const auto drop = [&] {  // an impact that has ended
    if (const int steps = near[old].sums.steps; steps > 0) sums.shortest = sums.impacts++ == 0 ? steps : std::min(sums.shortest, steps);
    ++old;
  };
  for (const auto& pair : pairs) {
    while (old < which.size() && which[old] < pair) drop();
    if (old < which.size() && which[old] == pair)
      out.push_back(std::move(near[old++]));
    else
      out.push_back(pair_of(pair.first, pair.second));
  }
  while (old < which.size()) drop();
  near = std::move(out), which = std::move(pairs);
}

bool BallHeap::search(const Config& q, const Config* v, double h) {
  if (!is_mine) return false;
  from_ = to_ = centres(q);
  if (v && h > 0) {
    const std::vector<Vec3> rate = centres(*v);
    for (size_t i = 0; i < balls.size(); ++i) to_[i] += h * rate[i];
  }
  const auto with_bent = [&](std::vector<std::pair<int, int>> pairs) {
    for (size_t k = 0; k < near.size(); ++k)
      if (!near[k].points[0].u.isZero(0)) pairs.push_back(which[k]);
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  };
  const auto needed = with_bent(find(from_, to_, margin() / 2));
  if (std::includes(which.begin(), which.end(), needed.begin(), needed.end()) && which.size() <= 4 * needed.size() + 64) return false;
  auto wide = with_bent(find(from_, to_, margin()));
  if (wide == which) return false;
  list(std::move(wide));
  return true;
}

std::string BallHeap::unforeseen(const Config& q0, const Config& q1) const {
  if (!is_mine) return "";
  const std::vector<Vec3> from = centres(q0), to = centres(q1);
  const double room = margin() / 4;
  const auto is_foreseen = [&](size_t i) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(from_[i][k], to_[i][k]);
      if (!(to[i][k] >= low - room && to[i][k] <= high + room)) return false;
    }
    return true;
  };
  for (size_t i = 0; i < balls.size(); ++i)
    if (!is_foreseen(i)) {
      const auto met = find(from, to, 0);
      return std::includes(which.begin(), which.end(), met.begin(), met.end())
                 ? ""
                 : fmt::format("contact \"{}\": balls meet that were not foreseen", name);
    }
  return "";
}

std::vector<std::pair<int, int>> BallHeap::overlaps(const Config& q) const {
  const std::vector<Vec3> at = centres(q);
  return find(at, at, 0);
}

void BallHeap::archive(Archive& a, const Comm& comm) {
  std::vector<int> pairs;
  std::vector<double> states;
  std::vector<ContactSums> account{sums};
  for (size_t k = 0; k < near.size(); ++k) {
    const ContactPoint& point = near[k].points[0];
    pairs.push_back(which[k].first), pairs.push_back(which[k].second);
    states.insert(states.end(), {point.u[0], point.u[1], point.u[2], point.approach});
    account.push_back(near[k].sums);
  }
  if (!a.restores()) pairs = comm.of_first(pairs), states = comm.of_first(states), account = comm.of_first(account);
  a("heap " + name, account, pairs, states);
  if (!is_mine || !a.restores()) return;  // what is numbered stays
  near.clear(), which.clear();
  sums = account.front();
  for (size_t k = 0; 2 * k + 1 < pairs.size(); ++k) {
    which.emplace_back(pairs[2 * k], pairs[2 * k + 1]);
    ContactPair& pair = near.emplace_back(pair_of(which[k].first, which[k].second));
    pair.points[0].u = Eigen::Map<const Vec3>(states.data() + 4 * k), pair.points[0].approach = states[4 * k + 3];
    pair.sums = account[k + 1];
  }
}

}  // namespace hilo
