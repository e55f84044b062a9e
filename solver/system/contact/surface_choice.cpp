// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangle a point meets in a step, and what it begins with there.
#include <algorithm>
#include <array>
#include <cmath>

#include "system/contact/surface_pair.hpp"

namespace hilo {
namespace {

/// Where a point stands beside a triangle: its distance, the gap to the plane, and the side that is nearest, or -1; beside a corner both.
struct Beside {
  double distance, gap;
  int edge, second = -1;
};
Beside beside(const Vec3& x, const std::array<Vec3, 3>& v) {
  const Vec3 t1 = v[1] - v[0], t2 = v[2] - v[0], r = x - v[0], n = t1.cross(t2);
  const double area = n.norm(), a = r.cross(t2).dot(n) / (area * area), b = t1.cross(r).dot(n) / (area * area), gap = r.dot(n) / area;
  if (a >= 0 && b >= 0 && a + b <= 1) return {std::abs(gap), gap, -1};
  Beside out{1e300, gap, -1};
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = v[(k + 1) % 3] - v[k], from = x - v[k];
    const double d = (from - std::clamp(from.dot(e) / e.squaredNorm(), 0., 1.) * e).norm();
    const bool both = std::abs(d - out.distance) <= 1e-9 * d;
    out.second = both ? k : d < out.distance ? -1 : out.second;
    if (d < out.distance && !both) out.distance = d, out.edge = k;
  }
  return out;
}

/// When a point that goes from x0 to x1 comes through a moving triangle from outside, as a share of the step; 2: it does not.
double crossing(const Vec3& x0, const Vec3& x1, const std::array<Vec3, 3>& v0, const std::array<Vec3, 3>& v1) {
  struct At {
    Vec3 r, t1, t2;
    double height() const { return t1.cross(t2).dot(r); }
  };
  const auto at = [&](double s) {
    const Vec3 x = x0 + s * (x1 - x0), a = v0[0] + s * (v1[0] - v0[0]), b = v0[1] + s * (v1[1] - v0[1]), c = v0[2] + s * (v1[2] - v0[2]);
    return At{x - a, b - a, c - a};
  };
  const At begin = at(0), end = at(1);
  const double size = begin.t1.cross(begin.t2).norm() * (begin.t1.norm() + begin.t2.norm());
  if (begin.height() < -1e-12 * size || end.height() >= 0) return 2;
  double low = 0, high = 1;
  for (int k = 0; k < 50; ++k) {
    const double s = (low + high) / 2;
    (at(s).height() >= 0 ? low : high) = s;
  }
  const At there = at(high);
  const Vec3 n = there.t1.cross(there.t2);
  const double a = there.r.cross(there.t2).dot(n) / n.squaredNorm(), b = there.t1.cross(there.r).dot(n) / n.squaredNorm();
  constexpr double edge = -1e-9;
  return a >= edge && b >= edge && a + b <= 1 - edge ? high : 2;
}

}  // namespace

/// About a facet and its way, and its normal.
SurfacePair::Ball SurfacePair::ball_of(int s, int f, Positions x0, Positions x1) const {
  const ContactSurface::Face& face = side[s].faces[f];
  Vec3 c = Vec3::Zero();
  for (int a = 0; a < face.n; ++a) c += (x0[face.node[a]] + x1[face.node[a]]) / (2 * face.n);
  double r = 0;
  for (int a = 0; a < face.n; ++a) r = std::max({r, (x0[face.node[a]] - c).squaredNorm(), (x1[face.node[a]] - c).squaredNorm()});
  Vec3 n = Vec3::Zero();
  for (int t = 0; t < static_cast<int>(cut_of(face.n).triangle.size()); ++t)
    for (const Positions x : {x0, x1}) {
      const auto v = side[s].triangle(f, t, x);
      n += (v[1] - v[0]).cross(v[2] - v[0]);
    }
  return {c, n.normalized(), 1.1 * std::sqrt(r)};
}

void SurfacePair::look(Positions x0, Positions x1) {
  for (int s = 0; s < 2; ++s) {
    ball_[s].resize(side[s].faces.size());
    for (size_t f = 0; f < side[s].faces.size(); ++f)
      if (!partners_[s][f].empty()) ball_[s][f] = ball_of(s, static_cast<int>(f), x0, x1);
  }
}

/// Whether points of two facets that are not on the list meet: one comes through a triangle of the other, or ends over one and behind it,
/// by no more than what meets may be.
bool SurfacePair::meets_unlisted(const std::pair<int, int>& pair, Positions x0, Positions x1) const {
  const int f[2] = {pair.first, pair.second};
  const Ball ball[2] = {ball_of(0, f[0], x0, x1), ball_of(1, f[1], x0, x1)};
  if (hangs && ball[0].normal.dot(ball[1].normal) > aside) return false;
  for (int s = 0; s < 2; ++s) {
    const ContactSurface::Face &own = side[s].faces[f[s]], &other = side[1 - s].faces[f[1 - s]];
    const double cell = std::min(own.cell, other.cell), deep = hangs ? shallow * cell : margin / 2;
    for (int i = own.first; i < own.first + own.n_points; ++i) {
      const SurfacePoint& point = side[s].points[i];
      const Vec3 p0 = side[s].at(point, x0), p1 = side[s].at(point, x1);
      for (int t = 0; t < static_cast<int>(cut_of(other.n).triangle.size()); ++t) {
        const auto v1 = side[1 - s].triangle(f[1 - s], t, x1);
        if (const Beside at = beside(p1, v1); at.edge < 0 && at.gap < touch(point) && at.gap > -deep) return true;
        if (crossing(p0, p1, side[1 - s].triangle(f[1 - s], t, x0), v1) <= 1) return true;
      }
    }
  }
  return false;
}

/// The triangle that a point which is open crosses first on its straight way; else the nearest one in the mean, of load steps at the end,
/// where those that are equally near are told apart by the larger gap.  Either gives way to one that faces the point (`faced`).  What is
/// open does not meet the border of a surface, and what is held leaves it where it is farther outside than deep.
SurfacePair::Target SurfacePair::target_of(int s, const SurfacePoint& point, Positions x0, Positions x1) const {
  const bool held = point.state.past.gap < 0;
  const ContactSurface& own = side[s];
  const ContactSurface& other = side[1 - s];
  const double f = at_end_alone() ? 1 : 0.5;
  const Vec3 p0 = own.at(point, x0), p1 = own.at(point, x1), middle = (1 - f) * p0 + f * p1;
  const double way = (p1 - p0).norm() / 2;
  Target nearest, first;
  double least = 1e300, gap = 0, soonest = 2;
  bool at_border = false;
  const auto between = [&](int face, int t) {
    const auto v0 = other.triangle(face, t, x0), v1 = other.triangle(face, t, x1);
    return std::array<Vec3, 3>{(1 - f) * v0[0] + f * v1[0], (1 - f) * v0[1] + f * v1[1], (1 - f) * v0[2] + f * v1[2]};
  };
  const auto is_border = [&](int number, int t, int side) {
    const ContactSurface::Face& face = other.faces[number];
    const int edge = side < 0 ? -1 : cut_of(face.n).on_edge[t][side];
    return edge >= 0 && (face.border[edge] || (hangs && is_beside(s, point.face, face.across[edge])));
  };
  double bound = 1e300;  // of what need be looked at: the distance of the partner whose middle is nearest
  int closest = -1;
  std::array<Beside, most_triangles> known;  // of its triangles
  if (!hangs) {
    double near = 1e300;
    for (const Partner& partner : partners_[s][point.face])
      if (const double d = (middle - ball_[1 - s][partner.face].centre).squaredNorm(); d < near) near = d, closest = partner.face;
    for (int t = 0; closest >= 0 && t < static_cast<int>(cut_of(other.faces[closest].n).triangle.size()); ++t)
      known[t] = beside(middle, between(closest, t)), bound = std::min(bound, (1 + 1e-6) * known[t].distance);
  }
  for (const Partner& partner : partners_[s][point.face]) {
    if (hangs && !may_meet(s, point, partner.face)) continue;
    const Ball& ball = ball_[1 - s][partner.face];
    const double away = (middle - ball.centre).norm() - ball.radius;
    if (away > std::min(least, bound) && away > way) continue;
    for (int t = 0; t < static_cast<int>(cut_of(other.faces[partner.face].n).triangle.size()); ++t) {
      if (!held && away <= way)
        if (const double when = crossing(p0, p1, other.triangle(partner.face, t, x0), other.triangle(partner.face, t, x1)); when < soonest)
          soonest = when, first = {partner.face, t, true, true};
      const Beside at = partner.face == closest ? known[t] : beside(middle, between(partner.face, t));
      if (hangs && !may_meet_there(s, point, partner.face, at.distance, at.gap)) continue;
      const double slack = 1e-9 * least + 1e-12 * ball.radius;
      if (at.distance > least + slack) continue;
      const bool as_near = at.distance > least - slack;  // a corner of the border is one of all triangles that have it
      at_border = (as_near && at_border) || is_border(partner.face, t, at.edge) || is_border(partner.face, t, at.second);
      if (as_near && std::abs(at.gap) <= std::abs(gap) + slack) continue;
      least = std::min(least, at.distance), gap = at.gap;
      nearest = {partner.face, t, false, at.edge < 0 && gap < 0 && -gap < margin / 2};
    }
  }
  if (soonest <= 1) return faced(s, point, first, p1, x1);
  const double deep = at_end_alone() ? 0 : point.state.past.gap, outside = least * least - gap * gap;
  if (at_border && (!held || outside > deep * deep)) return {};
  if (at_end_alone() && outside > margin * margin / 16) return {};  // far from all: the edge of a corner may be within
  return nearest.inside ? faced(s, point, nearest, p1, x1) : nearest;
}

/// Of a point that is behind a triangle: another that it is over and behind, less deep than half the margin, and that faces it far better,
/// as where a part that slides comes over it with a side first; else the same.
SurfacePair::Target SurfacePair::faced(int s, const SurfacePoint& point, const Target& met, const Vec3& p1, Positions x1) const {
  constexpr double better = 0.5;
  const Vec3& own = ball_[s][point.face].normal;
  const double facing = own.dot(ball_[1 - s][met.face].normal);
  Target out = met;
  double least = margin / 2;
  for (const Partner& partner : partners_[s][point.face]) {
    if (own.dot(ball_[1 - s][partner.face].normal) > facing - better) continue;
    if (hangs && !may_meet(s, point, partner.face)) continue;
    for (int t = 0; t < static_cast<int>(cut_of(side[1 - s].faces[partner.face].n).triangle.size()); ++t)
      if (const Beside at = beside(p1, side[1 - s].triangle(partner.face, t, x1));
          at.edge < 0 && at.gap < 0 && at.distance < least && (!hangs || may_meet_there(s, point, partner.face, at.distance, at.gap)))
        least = at.distance, out = {partner.face, t, false, true};
  }
  return out;
}

/// What a point begins a step with against a triangle: an open one at the gap, or at zero where a plane says less, which slip pays if the
/// point is over the triangle; the bristle goes with the frame, through space to another triangle.
FacetState SurfacePair::begun(int s, const SurfacePoint& point, const Target& target, Positions x0) const {
  FacetState out = point.state;
  const bool held = out.past.gap < 0;
  if (target.face < 0) return {};  // what it stored, gap or bristle, is let go (`released`)
  out.face = target.face, out.triangle = target.triangle;
  const OverTriangle<double> z = over(s, point, out, x0);
  const double gap = gap_of(z);
  if (!held) out.past.gap = std::max(gap, 0.0);
  const bool comes_in = target.inside && gap < -1e-12 * point.cell;
  out.past.offset = at_end_alone() || !(held || comes_in) ? 0 : gap - out.past.gap;
  // what is next to nothing beside the depth, or round-off, waits: paid by a slip as small, it would be as stiff as the inverse of both
  if (std::abs(out.past.offset) < std::max(1e-3 * -out.past.gap, 1e-9 * point.cell)) out.past.offset = 0;
  const auto& [u1, u2] = point.state.past.bent;
  if ((u1 != 0 || u2 != 0) && point.state.face >= 0 && (out.face != point.state.face || out.triangle != point.state.triangle)) {
    const TriangleAxes old(over(s, point, point.state, x0)), now(z);
    const Vec3 w = u1 * old.along + u2 * old.across;
    const Eigen::Vector2d flat(w.dot(now.along), w.dot(now.across));
    const double f = flat.norm() > 0 ? std::hypot(u1, u2) / flat.norm() : 0;
    out.past.bent = {f * flat[0], f * flat[1]};
  }
  return out;
}

bool SurfacePair::would_act(int s, const SurfacePoint& point, const FacetState& now, Positions x0, Positions x1) const {
  if (now.face < 0) return false;
  if (at_end_alone()) return gap_of(over(s, point, now, x1)) < touch(point);
  if (now.past.gap < 0 || now.past.offset < 0) return true;
  return now.past.gap + gap_of(over(s, point, now, x1)) - gap_of(over(s, point, now, x0)) < 0;
}

bool SurfacePair::revise(const Stage& s) {
  if (!about_.empty()) return false;
  const bool anew = settles(s) && !settles_;  // chosen so far as for a step in time
  settles_ = settles(s);
  if (is_static == s.conserving() && !settles_) return false;  // a start, whose choice is that of the step to come
  const Positions x0 = begin(s), x1 = s.e1->x;
  look(x0, x1);
  bool changes = false;
  each_listed([&](int k, SurfacePoint& point) {
    const auto gap = [&](Positions x) { return gap_of(over(k, point, point.now, x)); };
    if (at_end_alone() && point.now.face >= 0 && is_pulled(gap(x1), gap(x0), touch(point))) point.parts = changes = true;
    const FacetState now = begun(k, point, target_of(k, point, x0, x1), x0);
    const std::pair to{now.face, now.triangle}, from{point.now.face, point.now.triangle};
    if (!anew && (to == from || (to == point.left && from.first >= 0))) return;  // on the edge between two either will do
    point.left = from;
    changes = changes || would_act(k, point, point.now, x0, x1) || would_act(k, point, now, x0, x1);
    point.now = now;
  });
  return changes;
}

}  // namespace hilo
