// SPDX-License-Identifier: GPL-3.0-or-later
// Which facets are near, which triangle a point meets, and what it remembers.
#include "system/surface_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace hilo {
namespace {

struct Box {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  void take(const Vec3& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); }
  void widen(double by) { low.array() -= by, high.array() += by; }
  bool meets(const Box& other) const { return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all(); }
};

/// Where a point stands beside a triangle: its distance, the gap to the plane, and the side that is nearest, or -1.
struct Beside {
  double distance, gap;
  int edge;
};
Beside beside(const Vec3& x, const std::array<Vec3, 3>& v) {
  const Vec3 t1 = v[1] - v[0], t2 = v[2] - v[0], r = x - v[0], n = t1.cross(t2);
  const double area = n.norm(), a = r.cross(t2).dot(n) / (area * area), b = t1.cross(r).dot(n) / (area * area), gap = r.dot(n) / area;
  if (a >= 0 && b >= 0 && a + b <= 1) return {std::abs(gap), gap, -1};
  Beside out{1e300, gap, -1};
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = v[(k + 1) % 3] - v[k], from = x - v[k];
    const double d = (from - std::clamp(from.dot(e) / e.squaredNorm(), 0., 1.) * e).norm();
    if (d < out.distance) out.distance = d, out.edge = k;
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

void ContactSums::add(double pressing, double slid) {
  if (pressing > 0) {
    slip += slid / pressing, ++steps;
  } else if (steps > 0) {
    shortest = impacts++ == 0 ? steps : std::min(shortest, steps), steps = 0;
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

/// Pairs of facets whose boxes over the way from x0 to x1 come within a distance of each other: sorted along the longest axis of where both
/// sides can meet at all.
std::vector<std::pair<int, int>> SurfacePair::near(Positions x0, Positions x1, double within) const {
  std::vector<Box> box[2];
  Box all[2];
  for (int s = 0; s < 2; ++s)
    for (const ContactSurface::Face& face : side[s].faces) {
      Box& b = box[s].emplace_back();
      for (int a = 0; a < face.n; ++a) b.take(x0[face.node[a]]), b.take(x1[face.node[a]]);
      b.widen(within / 2);
      all[s].take(b.low), all[s].take(b.high);
    }
  std::vector<std::pair<int, int>> out;
  const Vec3 extent = all[0].high.cwiseMin(all[1].high) - all[0].low.cwiseMax(all[1].low);
  if (!(extent.minCoeff() >= 0)) return out;
  int axis = 0;
  extent.maxCoeff(&axis);
  struct Entry {
    double low;
    int side, face;
  };
  std::vector<Entry> order;
  for (int s = 0; s < 2; ++s)
    for (size_t f = 0; f < box[s].size(); ++f)
      if (box[s][f].meets(all[1 - s])) order.push_back({box[s][f].low[axis], s, static_cast<int>(f)});
  std::sort(order.begin(), order.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.low, a.side, a.face) < std::tie(b.low, b.side, b.face); });
  std::vector<int> open[2];
  for (const Entry& e : order) {
    const Box& own = box[e.side][e.face];
    std::vector<int>& others = open[1 - e.side];
    std::erase_if(others, [&](int f) { return box[1 - e.side][f].high[axis] < e.low; });
    for (const int f : others)
      if (own.meets(box[1 - e.side][f])) out.emplace_back(e.side == 0 ? e.face : f, e.side == 0 ? f : e.face);
    open[e.side].push_back(e.face);
  }
  std::sort(out.begin(), out.end());
  return out;
}

void SurfacePair::list_partners() {
  for (int s = 0; s < 2; ++s) partners_[s].assign(side[s].faces.size(), {});
  for (size_t k = 0; k < near_.size(); ++k) {
    partners_[0][near_[k].first].push_back({near_[k].second, static_cast<int>(k)});
    partners_[1][near_[k].second].push_back({near_[k].first, static_cast<int>(k)});
  }
}

bool SurfacePair::search(const Config& q, const Config* v, double h) {
  begin_ = foreseen_ = q.x;
  if (v && h > 0)
    for (const auto& nodes : nodes_)
      for (const int i : nodes) foreseen_[i] += h * v->x[i];
  const auto with_held = [&](std::vector<std::pair<int, int>> list) {
    for (int s = 0; s < 2; ++s)
      for (const SurfacePoint& point : side[s].points)
        if (point.state.past.gap < 0) list.emplace_back(s == 0 ? point.face : point.state.face, s == 0 ? point.state.face : point.face);
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
  for (int s = 0; s < 2; ++s)
    for (SurfacePoint& point : side[s].points) point.now = point.next = point.state, point.left = {-2, -2};
  look(q.x, foreseen_);
  for (int s = 0; s < 2; ++s)
    for (SurfacePoint& point : side[s].points) {
      const bool alone = partners_[s][point.face].empty();
      point.now = begun(s, point, alone ? Target{} : target_of(s, point, q.x, foreseen_), q.x);
    }
  return changes;
}

/// Balls about the facets and their way, and their normals.
void SurfacePair::look(Positions x0, Positions x1) {
  for (int s = 0; s < 2; ++s) {
    ball_[s].resize(side[s].faces.size());
    for (size_t f = 0; f < side[s].faces.size(); ++f) {
      if (partners_[s][f].empty()) continue;
      const ContactSurface::Face& face = side[s].faces[f];
      Vec3 c = Vec3::Zero();
      for (int a = 0; a < face.n; ++a) c += (x0[face.node[a]] + x1[face.node[a]]) / (2 * face.n);
      double r = 0;
      for (int a = 0; a < face.n; ++a) r = std::max({r, (x0[face.node[a]] - c).squaredNorm(), (x1[face.node[a]] - c).squaredNorm()});
      Vec3 n = Vec3::Zero();
      for (int t = 0; t < static_cast<int>(cut_of(face.n).triangle.size()); ++t)
        for (const Positions x : {x0, x1}) {
          const auto v = side[s].triangle(static_cast<int>(f), t, x);
          n += (v[1] - v[0]).cross(v[2] - v[0]);
        }
      ball_[s][f] = {c, n.normalized(), 1.1 * std::sqrt(r)};
    }
  }
}

/// The triangle that a point which is open crosses first on its straight way; else the nearest one in the mean, of load steps at the end,
/// where those that are equally near are told apart by the larger gap.  Either gives way to one that faces the point (`faced`).  What is
/// open does not meet the border of a surface, and what is held leaves it where it is farther outside than deep.
SurfacePair::Target SurfacePair::target_of(int s, const SurfacePoint& point, Positions x0, Positions x1) const {
  const bool held = point.state.past.gap < 0;
  const ContactSurface& own = side[s];
  const ContactSurface& other = side[1 - s];
  const double f = is_static ? 1 : 0.5;
  const Vec3 p0 = own.at(point, x0), p1 = own.at(point, x1), middle = (1 - f) * p0 + f * p1;
  const double way = (p1 - p0).norm() / 2;
  Target nearest, first;
  double least = 1e300, gap = 0, soonest = 2;
  bool at_border = false;
  for (const Partner& partner : partners_[s][point.face]) {
    const Ball& ball = ball_[1 - s][partner.face];
    const double away = (middle - ball.centre).norm() - ball.radius;
    if (away > least && away > way) continue;
    const ContactSurface::Face& face = other.faces[partner.face];
    const FacetCut& cut = cut_of(face.n);
    for (int t = 0; t < static_cast<int>(cut.triangle.size()); ++t) {
      const auto v0 = other.triangle(partner.face, t, x0), v1 = other.triangle(partner.face, t, x1);
      if (!held && away <= way)
        if (const double when = crossing(p0, p1, v0, v1); when < soonest) soonest = when, first = {partner.face, t, true, true};
      const Beside at = beside(middle, {(1 - f) * v0[0] + f * v1[0], (1 - f) * v0[1] + f * v1[1], (1 - f) * v0[2] + f * v1[2]});
      const double slack = 1e-9 * least + 1e-12 * ball.radius;
      if (at.distance > least + slack || (at.distance > least - slack && std::abs(at.gap) <= std::abs(gap))) continue;
      least = std::min(least, at.distance), gap = at.gap;
      nearest = {partner.face, t, false, at.edge < 0 && gap < 0 && -gap < margin / 2};
      const int edge = at.edge < 0 ? -1 : cut.on_edge[t][at.edge];
      at_border = edge >= 0 && face.border[edge];
    }
  }
  if (soonest <= 1) return faced(s, point, first, p1, x1);
  const double deep = is_static ? 0 : point.state.past.gap, outside = least * least - gap * gap;
  if (at_border && (!held || outside > deep * deep)) return {};
  if (is_static && outside > margin * margin / 16) return {};  // far from all: the edge of a corner may be within
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
    for (int t = 0; t < static_cast<int>(cut_of(side[1 - s].faces[partner.face].n).triangle.size()); ++t)
      if (const Beside at = beside(p1, side[1 - s].triangle(partner.face, t, x1)); at.edge < 0 && at.gap < 0 && at.distance < least)
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
  out.past.offset = is_static || !(held || comes_in) ? 0 : gap - out.past.gap;
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

OverTriangle<double> SurfacePair::over(int s, const SurfacePoint& point, const FacetState& at, Positions x) const {
  const auto v = side[1 - s].triangle(at.face, at.triangle, x);
  return {triple<double>(side[s].at(point, x) - v[0]), triple<double>(v[1] - v[0]), triple<double>(v[2] - v[0])};
}

bool SurfacePair::would_act(int s, const SurfacePoint& point, const FacetState& now, Positions x0, Positions x1) const {
  if (now.face < 0) return false;
  if (is_static) return gap_of(over(s, point, now, x1)) < touch(point);
  if (now.past.gap < 0 || now.past.offset < 0) return true;
  return now.past.gap + gap_of(over(s, point, now, x1)) - gap_of(over(s, point, now, x0)) < 0;
}

bool SurfacePair::revise(const Stage& s) {
  if (is_static == s.conserving()) return false;  // a start, whose choice is that of the step to come
  const Positions x0 = begin(s), x1 = s.e1->x;
  look(x0, x1);
  bool changes = false;
  for (int k = 0; k < 2; ++k)
    for (SurfacePoint& point : side[k].points) {
      if (partners_[k][point.face].empty()) continue;
      const FacetState now = begun(k, point, target_of(k, point, x0, x1), x0);
      const std::pair to{now.face, now.triangle}, from{point.now.face, point.now.triangle};
      if (to == from || (to == point.left && from.first >= 0)) continue;  // on the edge between two either will do
      point.left = from;
      changes = changes || would_act(k, point, point.now, x0, x1) || would_act(k, point, now, x0, x1);
      point.now = now;
    }
  return changes;
}

std::string SurfacePair::advance(const Stage& s) {
  next = sums;
  if (is_static == s.conserving()) return "";
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
    if (!std::includes(near_.begin(), near_.end(), met.begin(), met.end()))
      why = fmt::format("contact \"{}\": facets meet that were not foreseen", name);
  }
  double pressing = 0, slid = 0;
  look(x0, x1);
  for (int k = 0; k < 2; ++k)
    for (SurfacePoint& point : side[k].points) {
      point.next = point.now;
      const bool held = point.state.past.gap < 0;
      if (point.now.face >= 0) {
        const FacetForce<double> f = force_of(k, point, s);
        point.next.past.gap = f.gap, point.next.past.bent = f.bent;
        point.next.past.offset = is_static ? 0 : gap_of(over(k, point, point.now, x1)) - f.gap;
        next.dissipated += f.dissipated, pressing += f.pressing, slid += f.pressing * f.slid;
        if (f.acts) continue;
      }
      next.dissipated += released(point);
      if (held || partners_[k][point.face].empty()) continue;
      if (target_of(k, point, x0, x1).crossed) why = fmt::format("contact \"{}\": a point goes through a facet within one step", name);
    }
  next.add(pressing, slid);
  return why;
}

void SurfacePair::settle(bool accepted) {
  begin_ = committed_;
  (accepted ? sums : next) = accepted ? next : sums;
  for (ContactSurface& surface : side)
    for (SurfacePoint& point : surface.points) {
      if (accepted) point.state = point.next;
      point.now = point.next = point.state;
    }
}

void SurfacePair::archive(Archive& a) {
  std::vector<int> list;
  for (const auto& [i, j] : near_) list.push_back(i), list.push_back(j);
  a("surfaces " + name, sums, list);
  near_.clear();
  for (size_t k = 0; k + 1 < list.size(); k += 2) near_.emplace_back(list[k], list[k + 1]);
  list_partners();
  for (ContactSurface& surface : side)
    for (SurfacePoint& point : surface.points) a("point", point.state);
  settle(false);
}

std::pair<double, double> SurfacePair::depth() const {
  double depth = 0, share = 0;
  for (const ContactSurface& surface : side)
    for (const SurfacePoint& point : surface.points)
      depth = std::max(depth, -point.next.past.gap), share = std::max(share, -point.next.past.gap / point.cell);
  return {depth, share};
}

/// Of 64 points by the solid angle of the other side: 4 pi from within, 0 from without (Van Oosterom and Strackee 1983).
std::optional<Vec3> SurfacePair::starts_inside(int s, const Config& q) const {
  const ContactSurface& other = side[1 - s];
  for (const ContactSurface::Face& face : other.faces)
    if (std::find(face.border.begin(), face.border.end(), true) != face.border.end()) return std::nullopt;
  const size_t n = side[s].points.size(), stride = std::max<size_t>(1, n / 64);
  for (size_t i = 0; i < n; i += stride) {
    const Vec3 at = side[s].at(side[s].points[i], q.x);
    double angle = 0;
    for (size_t f = 0; f < other.faces.size(); ++f)
      for (size_t t = 0; t < cut_of(static_cast<size_t>(other.faces[f].n)).triangle.size(); ++t) {
        auto x = other.triangle(static_cast<int>(f), static_cast<int>(t), q.x);
        double l[3];
        for (int k = 0; k < 3; ++k) x[k] -= at, l[k] = x[k].norm();
        const double volume = x[0].dot(x[1].cross(x[2]));
        if (std::abs(volume) < 1e-9 * l[0] * l[1] * l[2]) continue;  // in its plane: what touches has 2 pi
        angle += 2 * std::atan2(volume, l[0] * l[1] * l[2] + x[0].dot(x[1]) * l[2] + x[0].dot(x[2]) * l[1] + x[1].dot(x[2]) * l[0]);
      }
    if (angle > 3.5 * std::numbers::pi) return at;
  }
  return std::nullopt;
}

std::optional<SurfacePair::Deep> SurfacePair::deepest_start(const Config& q) {
  search(q, nullptr, 0);
  std::optional<Deep> out;
  for (int s = 0; s < 2; ++s)
    for (const SurfacePoint& point : side[s].points)
      if (point.now.face >= 0)
        if (const double depth = -gap_of(over(s, point, point.now, q.x)); depth > (out ? out->depth : 0))
          out = Deep{depth, point.cell, side[s].at(point, q.x)};
  near_.clear();
  list_partners();
  return out;
}

}  // namespace hilo
