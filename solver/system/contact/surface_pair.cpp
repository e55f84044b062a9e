// SPDX-License-Identifier: GPL-3.0-or-later
// What points of two surfaces remember from step to step, and what the run is told.
#include "system/contact/surface_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

namespace hilo {

void ContactSums::add(double pressing, double slid) {
  if (pressing > 0) {
    slip += slid / pressing, ++steps;
  } else if (steps > 0) {
    shortest = impacts++ == 0 ? steps : std::min(shortest, steps), steps = 0;
  }
}

void ContactSums::add_work(double work, double friction, double pressing, double slid, bool on_the_way) {
  if (on_the_way) {
    if (pressing > 0) way += slid / pressing;
  } else {
    dissipated += work + friction * std::max(pressing, 0.) * way, way = 0;
  }
}

void SurfacePair::prepare() {
  for (int s = 0; s < 2; ++s) {
    side[s].find_borders();
    for (const ContactSurface::Face& face : side[s].faces) nodes_[s].insert(nodes_[s].end(), face.node.begin(), face.node.begin() + face.n);
    std::sort(nodes_[s].begin(), nodes_[s].end());
    nodes_[s].erase(std::unique(nodes_[s].begin(), nodes_[s].end()), nodes_[s].end());
  }
  double size = 0;
  for (const ContactSurface& surface : side)
    for (const ContactSurface::Face& face : surface.faces)
      size += (points_.X[face.node[0]] - points_.X[face.node[2]]).norm() / static_cast<double>(side[0].faces.size() + side[1].faces.size());
  margin = 0.5 * size;
  list_partners();
}

/// Facets of linear and rigid regions have the same unknowns: they share a clique.
void SurfacePair::number(Layout& layout) {
  clique_.clear();
  std::map<std::vector<int>, int> known;
  for (const auto& [a, b] : near_) {
    std::vector<int> nodes;
    for (const ContactSurface::Face* face : {&side[0].faces[a], &side[1].faces[b]})
      nodes.insert(nodes.end(), face->node.begin(), face->node.begin() + face->n);
    const std::vector<int> blocks = points_.blocks_of(nodes);
    const auto [at, fresh] = known.try_emplace(blocks, 0);
    if (fresh) at->second = layout.cliques.add(blocks);
    clique_.push_back(at->second);
  }
}

OverTriangle<double> SurfacePair::over(int s, const SurfacePoint& point, const FacetState& at, Positions x) const {
  const auto v = side[1 - s].triangle(at.face, at.triangle, x);
  return {triple<double>(side[s].at(point, x) - v[0]), triple<double>(v[1] - v[0]), triple<double>(v[2] - v[0])};
}

std::string SurfacePair::advance(const Stage& s) {
  next = sums;
  const bool settles = this->settles(s);  // then nothing is summed up
  if (is_static == s.conserving() && !settles) return "";
  const Positions x0 = begin(s), x1 = s.e1->x;
  std::string why;
  const auto is_foreseen = [&](int i) {
    const double room = margin / 4;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(x0[i][k], foreseen_[i][k]);
      if (!(x1[i][k] >= low - room && x1[i][k] <= high + room)) return false;
    }
    return true;
  };
  if (!std::all_of(nodes_[0].begin(), nodes_[0].end(), is_foreseen) || !std::all_of(nodes_[1].begin(), nodes_[1].end(), is_foreseen)) {
    const auto met = near(x0, x1, 0);
    std::vector<std::pair<int, int>> unlisted;
    std::ranges::set_difference(met, near_, std::back_inserter(unlisted));
    if (std::ranges::any_of(unlisted, [&](const auto& pair) { return meets_unlisted(pair, x0, x1); }))
      why = fmt::format("contact \"{}\": facets meet that were not foreseen", name);
  }
  double pressing = 0, slid = 0, work = 0, friction = 0;
  look(x0, x1);
  each_listed([&](int k, SurfacePoint& point) {
    point.next = point.now;
    const bool held = point.state.past.gap < 0;
    if (point.now.face >= 0) {
      const FacetForce<double> f = force_of(k, point, s);
      point.next.past.gap = f.gap, point.next.past.bent = f.bent;
      point.next.past.approach = Approach{s.h, point.now.past.approach}.after(point.now.past.gap, f.gap);
      point.next.past.offset = at_end_alone() ? 0 : gap_of(over(k, point, point.now, x1)) - f.gap;
      work += f.dissipated, friction = point.law.friction, pressing += f.pressing, slid += f.pressing * f.slid;
      if (f.acts) return;
    }
    work += released(point);
    if (held) return;
    const Vec3 p0 = side[k].at(point, x0), p1 = side[k].at(point, x1), middle = at_end_alone() ? p1 : Vec3((p0 + p1) / 2);
    const double way = (p1 - p0).norm() / 2;
    if (std::ranges::all_of(partners_[k][point.face], [&](const Partner& partner) {  // too far off to be crossed
          const Ball& ball = ball_[1 - k][partner.face];
          return (middle - ball.centre).norm() - ball.radius > way;
        }))
      return;
    if (target_of(k, point, x0, x1).crossed) why = fmt::format("contact \"{}\": a point goes through a facet within one step", name);
  });
  if (settles) return why;
  next.add_work(work, friction, pressing, slid, is_static && s.mass_slope > 0), next.add(pressing, slid);
  return why;
}

void SurfacePair::hold(const Config& q) {
  if (n_points() == 0) return;
  about_ = q.x;
  for (int k = 0; k < 2; ++k)
    for (SurfacePoint& point : side[k].points) {
      point.now = point.state, point.held = {};
      if (point.now.face < 0 || !(point.state.past.gap < 0)) continue;
      point.held = HeldPoint::at(point.law, gap_of(over(k, point, point.now, q.x)) - point.state.past.offset);
    }
}

void SurfacePair::settle(bool accepted) {
  begin_ = committed_;
  (accepted ? sums : next) = accepted ? next : sums;
  each_listed([&](int, SurfacePoint& point) {
    if (accepted) point.state = point.next;
    point.now = point.next = point.state, point.parts = false;
  });
}

void SurfacePair::archive(Archive& a) {
  std::vector<int> list;
  std::vector<FacetState> states;
  std::vector<ContactSums> account{sums};
  for (const auto& [i, j] : near_) list.push_back(i), list.push_back(j);
  for (const ContactSurface& surface : side)
    for (const SurfacePoint& point : surface.points) states.push_back(point.state);
  if (!a.restores()) {  // what rank 0 has, all keep
    const Comm& comm = *points_.comm;
    list = comm.of_first(list), states = comm.of_first(states), account = comm.of_first(account);
  }
  a("surfaces " + name, account, list, states);
  if (n_points() > 0) {
    near_.clear();
    for (size_t k = 0; k + 1 < list.size(); k += 2) near_.emplace_back(list[k], list[k + 1]);
    sums = account.front();
    auto state = states.begin();
    for (ContactSurface& surface : side)
      for (SurfacePoint& point : surface.points) point.state = *state++;
  }
  list_partners();
  settle(false);
}

std::pair<double, double> SurfacePair::depth() const {
  double depth = 0, share = 0;
  each_listed([&](int, const SurfacePoint& point) {
    depth = std::max(depth, -point.next.past.gap), share = std::max(share, -point.next.past.gap / point.cell);
  });
  return {depth, share};
}

bool SurfacePair::is_closed(int s) const {
  return std::ranges::none_of(side[s].faces,
                              [](const ContactSurface::Face& face) { return std::ranges::find(face.border, true) != face.border.end(); });
}

/// Of side s, seen from a point: 4 pi from within, 0 from without (Van Oosterom and Strackee 1983).
double SurfacePair::solid_angle(int s, const Vec3& at, Positions positions) const {
  double angle = 0;
  for (size_t f = 0; f < side[s].faces.size(); ++f)
    for (size_t t = 0; t < cut_of(static_cast<size_t>(side[s].faces[f].n)).triangle.size(); ++t) {
      auto x = side[s].triangle(static_cast<int>(f), static_cast<int>(t), positions);
      double l[3];
      for (int k = 0; k < 3; ++k) x[k] -= at, l[k] = x[k].norm();
      const double volume = x[0].dot(x[1].cross(x[2]));
      if (std::abs(volume) < 1e-9 * l[0] * l[1] * l[2]) continue;  // in its plane: what touches has 2 pi
      angle += 2 * std::atan2(volume, l[0] * l[1] * l[2] + x[0].dot(x[1]) * l[2] + x[0].dot(x[2]) * l[1] + x[1].dot(x[2]) * l[0]);
    }
  return angle;
}

/// Of 64 points, by the solid angle of the other side.
std::optional<Vec3> SurfacePair::starts_inside(int s, const Config& q) const {
  if (!is_closed(1 - s)) return std::nullopt;
  const size_t n = side[s].points.size(), stride = std::max<size_t>(1, n / 64);
  for (size_t i = 0; i < n; i += stride) {
    const Vec3 at = side[s].at(side[s].points[i], q.x);
    if (solid_angle(1 - s, at, q.x) > 3.5 * std::numbers::pi) return at;
  }
  return std::nullopt;
}

double SurfacePair::depth(const Config& q) const {
  double deepest = 0;
  for (int s = 0; s < 2; ++s)
    for (const SurfacePoint& point : side[s].points)
      if (point.now.face >= 0) deepest = std::max(deepest, -gap_of(over(s, point, point.now, q.x)) / point.cell);
  return deepest;
}

double SurfacePair::least_gap(const Config& q) const {
  double least = 1e300;
  for (int s = 0; s < 2; ++s)
    for (const SurfacePoint& point : side[s].points)
      if (point.now.face >= 0) least = std::min(least, gap_of(over(s, point, point.now, q.x)) - touch(point));
  return least;
}

/// Within a facet that starts in the other side, how far the depth of its points differs, as far as the sag of flat facets explains it:
/// length times turn over eight, of a curve that its neighbours follow; of quadratic ones what their triangles leave.  The largest [m].
double SurfacePair::unevenness(const Config& q) const {
  std::vector<double> sag[2];
  for (int s = 0; s < 2; ++s) {
    const auto& faces = side[s].faces;
    std::vector<Vec3> normal, centre;
    for (const ContactSurface::Face& face : faces) {
      const auto x = [&](int a) -> const Vec3& { return q.x[face.node[a]]; };
      const bool three = face.n % 3 == 0;
      normal.push_back((three ? Vec3((x(1) - x(0)).cross(x(2) - x(0))) : Vec3((x(2) - x(0)).cross(x(3) - x(1)))).normalized());
      centre.push_back(three ? Vec3((x(0) + x(1) + x(2)) / 3) : Vec3((x(0) + x(1) + x(2) + x(3)) / 4));
    }
    for (size_t f = 0; f < faces.size(); ++f) {
      double& largest = sag[s].emplace_back(0);
      for (int e = 0; e < (faces[f].n % 3 == 0 ? 3 : 4); ++e) {
        const int g = faces[f].across[e];
        if (g < 0) continue;
        const double turn = std::acos(std::clamp(normal[f].dot(normal[g]), -1., 1.));
        if (turn > std::numbers::pi / 4) continue;  // an edge
        const double of_curve = (centre[g] - centre[f]).norm() * turn / 8;
        largest = std::max(largest, faces[f].n > 4 ? of_curve / (facet_pieces * facet_pieces) : of_curve);
      }
    }
  }
  double out = 0;
  for (int s = 0; s < 2; ++s)
    for (size_t f = 0; f < side[s].faces.size(); ++f) {
      const ContactSurface::Face& face = side[s].faces[f];
      double low = 1e300, high = -1e300, explained = sag[s][f];
      for (int k = face.first; k < face.first + face.n_points; ++k) {
        const SurfacePoint& point = side[s].points[k];
        if (point.now.face < 0) continue;
        const double gap = gap_of(over(s, point, point.now, q.x));
        low = std::min(low, gap), high = std::max(high, gap), explained = std::max(explained, sag[1 - s][point.now.face]);
      }
      if (low < 0) out = std::max(out, std::min(high - low, explained));
    }
  return out;
}

std::optional<SurfacePair::Deep> SurfacePair::deepest_start(const Config& q) {
  if (hangs) find_back_to_back(q.x);
  search(q, nullptr, 0);
  std::optional<Deep> out;
  for (int s = 0; s < 2; ++s)
    for (const SurfacePoint& point : side[s].points)
      if (point.now.face >= 0)
        if (const double depth = -gap_of(over(s, point, point.now, q.x)); depth > (out ? out->depth : 0))
          out = Deep{depth, point.cell, side[s].at(point, q.x)};
  if (out && !itself) out->sag = unevenness(q);
  near_.clear();
  list_partners();
  for (ContactSurface& surface : side)  // nothing acts before there are pairs of facets in the matrix
    for (SurfacePoint& point : surface.points) point.now = point.state;
  return out;
}

}  // namespace hilo
