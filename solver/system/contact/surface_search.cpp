// SPDX-License-Identifier: GPL-3.0-or-later
// Which facets of two surfaces are near each other.
#include <algorithm>

#include "system/contact/near_boxes.hpp"
#include "system/contact/surface_pair.hpp"

namespace hilo {

/// Pairs of facets whose boxes over the way from x0 to x1 come within a distance of each other, of those that the other side can meet at
/// all.
std::vector<std::pair<int, int>> SurfacePair::near(Positions x0, Positions x1, double within) const {
  std::vector<std::pair<int, int>> out = near_by_boxes(x0, x1, within);
  if (hangs) leave_out_what_cannot_meet(out, x0, x1, within >= margin);
  return out;
}

std::vector<std::pair<int, int>> SurfacePair::near_by_boxes(Positions x0, Positions x1, double within) const {
  std::vector<AxisBox> box[2];
  AxisBox all[2];
  for (int s = 0; s < 2; ++s)
    for (const ContactSurface::Face& face : side[s].faces) {
      AxisBox& b = box[s].emplace_back();
      for (int a = 0; a < face.n; ++a) b.take(x0[face.node[a]]), b.take(x1[face.node[a]]);
      b.widen(within / 2);
      all[s].take(b);
    }
  if (!all[0].meets(all[1])) return {};
  std::vector<int> face[2];
  for (int s = 0; s < 2; ++s) {
    size_t n = 0;
    for (size_t f = 0; f < box[s].size(); ++f)
      if (box[s][f].meets(all[1 - s])) face[s].push_back(static_cast<int>(f)), box[s][n++] = box[s][f];
    box[s].resize(n);
  }
  std::vector<std::pair<int, int>> out = near_boxes(box[0], box[1]);
  for (auto& [f, g] : out) f = face[0][f], g = face[1][g];
  return out;
}

void SurfacePair::list_partners() {
  for (int s = 0; s < 2; ++s) partners_[s].assign(side[s].faces.size(), {});
  for (size_t k = 0; k < near_.size(); ++k) {
    partners_[0][near_[k].first].push_back({near_[k].second, static_cast<int>(k)});
    partners_[1][near_[k].second].push_back({near_[k].first, static_cast<int>(k)});
  }
  for (int s = 0; s < 2; ++s) {
    listed_[s].clear();
    for (size_t i = 0; i < side[s].points.size(); ++i) {
      SurfacePoint& point = side[s].points[i];
      if (!partners_[s][point.face].empty())
        listed_[s].push_back(static_cast<int>(i));
      else
        point.state = point.now = point.next = {}, point.left = {-2, -2};  // it is open
    }
  }
}

bool SurfacePair::search(const Config& q, const Config* v, double h) {
  if (n_points() == 0) return false;  // of another rank
  begin_ = foreseen_ = q.x, settles_ = false;
  if (v && h > 0)
    for (const auto& nodes : nodes_)
      for (const int i : nodes) foreseen_[i] += h * v->x[i];
  const auto with_held = [&](std::vector<std::pair<int, int>> list) {
    each_listed([&](int s, const SurfacePoint& point) {
      const auto& [u1, u2] = point.state.past.bent;  // of what has opened in the last step: to be let go in this one
      if (point.state.face >= 0 && (point.state.past.gap < 0 || u1 != 0 || u2 != 0))
        list.emplace_back(s == 0 ? point.face : point.state.face, s == 0 ? point.state.face : point.face);
    });
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  };
  bool changes = false;
  const auto needed = with_held(near(q.x, foreseen_, margin / 2));
  if (!std::includes(near_.begin(), near_.end(), needed.begin(), needed.end()) || near_.size() > 4 * needed.size() + 64) {
    auto wide = with_held(near(q.x, foreseen_, margin));
    changes = wide != near_;
    near_ = std::move(wide);
    list_partners();
  }
  each_listed([](int, SurfacePoint& point) { point.now = point.next = point.state, point.left = {-2, -2}, point.parts = false; });
  look(q.x, foreseen_);
  each_listed([&](int s, SurfacePoint& point) { point.now = begun(s, point, target_of(s, point, q.x, foreseen_), q.x); });
  return changes;
}

}  // namespace hilo
