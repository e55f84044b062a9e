// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that meets itself, and surfaces of what hangs together: which of their facets can meet.
//
// Facets with a node in common never meet, nor do those whose nodes a fold moves as one.  Neither do facets that look the same way, nor
// those that lie back to back with material between them: what is open meets only what it is in front of, or behind by no more than a
// share of the cell there, and only where it is over it.  So bending, crushing and shear of a part press nothing on itself.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "system/contact/surface_pair.hpp"

namespace hilo {
/// The same facet as f of side s, or a neighbour: the other side's g.
bool SurfacePair::is_beside(int s, int f, int g) const {
  const ContactSurface::Face &mine = side[s].faces[f], &its = side[1 - s].faces[g];
  for (int a = 0; a < mine.n; ++a)
    for (int b = 0; b < its.n; ++b)
      if (mine.joint[a] == its.joint[b]) return true;
  return false;
}

bool SurfacePair::may_meet(int s, const SurfacePoint& point, int face) const {
  if (point.state.past.gap < 0 && point.state.face == face) return true;
  return ball_[s][point.face].normal.dot(ball_[1 - s][face].normal) <= aside;
}

/// What is held keeps its facet.  The share is of the shallower cell of both: behind the edge of a thin part lies a deep cell.
bool SurfacePair::may_meet_there(int s, const SurfacePoint& point, int face, double distance, double gap) const {
  const bool held = point.state.past.gap < 0;
  if (held && point.state.face == face) return true;
  const double cell = std::min(side[1 - s].faces[face].cell, side[s].faces[point.face].cell), radius = ball_[1 - s][face].radius;
  if (gap < -std::max(shallow * cell, held ? -2 * point.state.past.gap : 0.)) return false;
  if (held) return true;
  if (gap < -1e-3 * cell && ball_[s][point.face].normal.dot(ball_[1 - s][face].normal) > -aside) return false;
  return distance * distance - gap * gap <= 1e-12 * radius * radius;
}

/// Pairs of facets of which neither is wholly behind the other, and which do not look the same way, at the beginning, in the middle or at
/// the end of the way from x0 to x1.
void SurfacePair::leave_out_what_cannot_meet(std::vector<std::pair<int, int>>& list, Positions x0, Positions x1, bool loosely) const {
  struct Plane {
    Vec3 at, normal;
    double bump;  // how far its nodes are off it
  };
  const auto place = [&](int i, int k) { return Vec3(x0[i] + k / 2. * (x1[i] - x0[i])); };
  const auto plane = [&](const ContactSurface::Face& face, int k) {
    Plane out{Vec3::Zero(), Vec3::Zero(), 0};
    const int corners = face.n == 3 || face.n == 6 ? 3 : 4;
    for (int a = 0; a < corners; ++a) out.at += place(face.node[a], k) / corners;
    for (int a = 0; a < corners; ++a)
      out.normal += (place(face.node[a], k) - out.at).cross(place(face.node[(a + 1) % corners], k) - out.at);
    out.normal.normalize();
    for (int a = 0; a < face.n; ++a) out.bump = std::max(out.bump, std::abs(out.normal.dot(place(face.node[a], k) - out.at)));
    return out;
  };
  std::vector<Plane> planes[2][3];
  for (int s = 0; s < (itself ? 1 : 2); ++s)
    for (int k = 0; k < 3; ++k)
      for (const ContactSurface::Face& face : side[s].faces) planes[s][k].push_back(plane(face, k));
  const int second = itself ? 0 : 1;
  const double more = loosely ? 1.5 : 1, most = loosely ? aside + 0.1 : aside;
  const auto reaches = [&](const ContactSurface::Face& face, const Plane& other, double cell, int k) {
    for (int a = 0; a < face.n; ++a)
      if (other.normal.dot(place(face.node[a], k) - other.at) > -more * shallow * cell - other.bump) return true;
    return false;
  };
  std::erase_if(list, [&](const std::pair<int, int>& pair) {
    const auto& [f, g] = pair;
    if (is_beside(0, f, g) || std::ranges::binary_search(never_, pair)) return true;
    const ContactSurface::Face &mine = side[0].faces[f], &its = side[1].faces[g];
    for (int k = 0; k < 3; ++k) {
      const Plane &P = planes[0][k][f], &Q = planes[second][k][g];
      if (P.normal.dot(Q.normal) <= most && reaches(mine, Q, its.cell, k) && reaches(its, P, mine.cell, k)) return false;
    }
    return true;
  });
}

/// Facets that have the material between them: a point of one is behind the other in the reference, deeper than what meets may be, or
/// outside of all parts if it is moved out of its own by a little.
void SurfacePair::find_back_to_back(Positions x) {
  never_.clear();
  std::vector<std::pair<int, int>> found;
  const bool closed[2] = {is_closed(0), is_closed(1)};
  const auto list = near_by_boxes(x, x, margin);
  near_ = list;
  list_partners();
  look(x, x);
  for (int s = 0; s < 2; ++s) {
    std::map<std::pair<int, int>, bool> covered;  // what is a little behind: by the other side, not by its own material
    for (const SurfacePoint& point : side[s].points) {
      const Vec3 at = side[s].at(point, x);
      for (const Partner& partner : partners_[s][point.face]) {
        if (is_beside(s, point.face, partner.face) || !may_meet(s, point, partner.face)) continue;
        const ContactSurface::Face& face = side[1 - s].faces[partner.face];
        for (int t = 0; t < static_cast<int>(cut_of(face.n).triangle.size()); ++t) {
          const auto v = side[1 - s].triangle(partner.face, t, x);
          const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]).normalized(), foot = at - n.dot(at - v[0]) * n;
          const double gap = n.dot(at - v[0]);
          if (gap > -1e-6 * face.cell || gap < -2 * std::max(face.cell, point.cell)) continue;
          const auto outward = [&](int a, int b) { return (v[b] - v[a]).cross(n).dot(foot - v[a]); };
          if (outward(0, 1) > 0 || outward(1, 2) > 0 || outward(2, 0) > 0) continue;
          const Vec3 out = at + 0.01 * point.cell * ball_[s][point.face].normal;
          if (gap > -shallow * face.cell) {
            const auto [known, fresh] = covered.try_emplace({point.face, partner.face}, true);
            if (fresh && closed[1 - s]) known->second = solid_angle(1 - s, out, x) > 2 * std::numbers::pi;
            if (known->second) continue;
          }
          found.emplace_back(s == 0 ? point.face : partner.face, s == 0 ? partner.face : point.face);
          if (itself) found.emplace_back(partner.face, point.face);
        }
      }
    }
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  never_ = std::move(found);
  near_.clear();
  list_partners();
}

/// An edge of a facet that goes through one of the other side, deeper than what meets may be.
std::optional<Vec3> SurfacePair::starts_crossed(const Config& q) const {
  const auto through = [&](int s, int f, int g) -> std::optional<Vec3> {
    const ContactSurface::Face &mine = side[s].faces[f], &its = side[1 - s].faces[g];
    const FacetCut& cut = cut_of(its.n);
    const int corners = mine.n == 3 || mine.n == 6 ? 3 : 4;
    for (int e = 0; e < corners; ++e) {
      const Vec3 from = q.x[mine.node[e]], to = q.x[mine.node[(e + 1) % corners]];
      for (int t = 0; t < static_cast<int>(cut.triangle.size()); ++t) {
        const auto v = side[1 - s].triangle(g, t, q.x);
        const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
        const double a = n.dot(from - v[0]), b = n.dot(to - v[0]);
        if (std::max(a, b) <= 1e-6 * its.cell || std::min(a, b) >= -shallow * std::min(its.cell, mine.cell)) continue;
        const Vec3 at = from + a / (a - b) * (to - from);
        bool within = true;  // what touches the border of the facet does not cross it
        for (int k = 0; k < 3; ++k) {
          const Vec3 along = v[(k + 1) % 3] - v[k];
          within = within && n.dot(along.cross(at - v[k])) > (cut.on_edge[t][k] >= 0 ? 1e-6 : -1e-9) * along.squaredNorm();
        }
        if (within) return at;
      }
    }
    return std::nullopt;
  };
  for (const auto& [f, g] : near_by_boxes(q.x, q.x, 0)) {
    if (is_beside(0, f, g)) continue;
    if (const auto at = through(0, f, g)) return at;
    if (itself) continue;
    if (const auto at = through(1, g, f)) return at;
  }
  return std::nullopt;
}

/// Of as many points as a fraction of a second allows, moved into the material by a little: the solid angle is 4 pi, and 8 pi where another
/// part of it covers them.  At folds of shells plates overlap by half their thickness, as they are meant to.
std::optional<Vec3> SurfacePair::starts_inside_itself(const Config& q) const {
  if (!itself || !is_closed(0)) return std::nullopt;
  const std::vector<SurfacePoint>& points = side[0].points;
  const size_t n = std::max<size_t>(64, 1'000'000 / side[0].faces.size());
  const size_t stride = points.size() <= n ? 1 : points.size() / n | 1;  // odd: of all places within facets
  for (size_t i = 0; i < points.size(); i += stride) {
    const ContactSurface::Face& face = side[0].faces[points[i].face];
    if (std::any_of(face.joint.begin(), face.joint.begin() + face.n, [](int joint) { return joint < 0; })) continue;
    const auto v = side[0].triangle(points[i].face, 0, q.x);
    const Vec3 at = side[0].at(points[i], q.x), n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    if (solid_angle(0, at - 0.05 * points[i].cell * n, q.x) > 6 * std::numbers::pi) return at;
  }
  return std::nullopt;
}

}  // namespace hilo
