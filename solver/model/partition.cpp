// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/partition.hpp"

#include <algorithm>
#include <array>

namespace hilo {
namespace {

/// A box that still has several parts to be cut into.
struct Group {
  int kind = 0, first = 0, n = 0;  // parts first .. first + n - 1
  Vec3 direction = Vec3::Zero();   // of the cut
  double low = 0, high = 0;        // bounds of direction . x, closing in on the cut
  double wanted = 0;               // weight to the left of the cut
  Group(int k, int f, int parts) : kind(k), first(f), n(parts) {}
};

}  // namespace

std::vector<int> bisect(const Cloud& cloud, int n_parts, const Comm& comm) {
  const size_t n = cloud.x.size();
  std::vector<int> part(n, 0), group(n);
  int n_kinds = 0;
  for (const int k : cloud.kind) n_kinds = std::max(n_kinds, k + 1);
  n_kinds = static_cast<int>(comm.max(n_kinds));
  std::vector<Group> groups;
  for (int k = 0; k < n_kinds && n_parts > 1; ++k) groups.emplace_back(k, 0, n_parts);
  for (size_t i = 0; i < n; ++i) group[i] = n_parts > 1 ? cloud.kind[i] : -1;
  while (!groups.empty()) {
    const size_t m = groups.size();
    std::vector<std::array<double, 6>> box(m, {-1e300, -1e300, -1e300, -1e300, -1e300, -1e300});  // -low, high
    std::vector<double> work(m, 0.0);
    for (size_t i = 0; i < n; ++i) {
      if (group[i] < 0) continue;
      auto& b = box[group[i]];
      for (int k = 0; k < 3; ++k) b[k] = std::max(b[k], -cloud.x[i][k]), b[3 + k] = std::max(b[3 + k], cloud.x[i][k]);
      work[group[i]] += cloud.work[i];
    }
    comm.sum(work);
    for (size_t g = 0; g < m; ++g) {
      for (auto& b : box[g]) b = comm.max(b);
      Group& c = groups[g];
      Vec3 side;
      for (int k = 0; k < 3; ++k) side[k] = box[g][k] + box[g][3 + k];
      int axis;
      side.maxCoeff(&axis);
      // a slightly tilted cut divides layers of equal coordinates too
      c.direction = Vec3::Constant(1e-4);
      c.direction[axis] = 1, c.direction[(axis + 1) % 3] = 1.7e-4;
      c.low = c.high = 0;
      for (int k = 0; k < 3; ++k) c.low -= c.direction[k] * box[g][k], c.high += c.direction[k] * box[g][3 + k];
      c.wanted = work[g] * (c.n / 2) / c.n;
    }
    std::vector<double> left(m);
    for (int pass = 0; pass < 52; ++pass) {
      std::fill(left.begin(), left.end(), 0.0);
      for (size_t i = 0; i < n; ++i)
        if (group[i] >= 0) {
          const Group& c = groups[group[i]];
          if (c.direction.dot(cloud.x[i]) < (c.low + c.high) / 2) left[group[i]] += cloud.work[i];
        }
      comm.sum(left);
      for (size_t g = 0; g < m; ++g) (left[g] < groups[g].wanted ? groups[g].low : groups[g].high) = (groups[g].low + groups[g].high) / 2;
    }
    // two halves each, of which those with one part are finished
    std::vector<Group> halves;
    std::vector<std::array<int, 2>> half(m);
    for (size_t g = 0; g < m; ++g) {
      const Group& c = groups[g];
      const int n_left = c.n / 2;
      const std::array<Group, 2> both{Group(c.kind, c.first, n_left), Group(c.kind, c.first + n_left, c.n - n_left)};
      for (int s = 0; s < 2; ++s) {
        half[g][s] = both[s].n > 1 ? static_cast<int>(halves.size()) : -1;
        if (both[s].n > 1) halves.push_back(both[s]);
      }
    }
    for (size_t i = 0; i < n; ++i) {
      if (group[i] < 0) continue;
      const size_t g = group[i];
      const int s = groups[g].direction.dot(cloud.x[i]) < groups[g].high ? 0 : 1;
      part[i] = groups[g].first + s * (groups[g].n / 2);
      group[i] = half[g][s];
    }
    groups = std::move(halves);
  }
  return part;
}

}  // namespace hilo
