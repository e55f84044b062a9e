// SPDX-License-Identifier: GPL-3.0-or-later
// What contacts remember, take and show.
#include <fmt/format.h>

#include <algorithm>

#include "base/table.hpp"
#include "system/contact/contacts.hpp"

namespace hilo {
namespace {

constexpr double too_deep = 0.25;  // share of a cell or layer, above which it is

}  // namespace

void Contacts::add_energy(const Config& q, const Config&, Energy& sum) const {
  each_pair([&](const ContactPair& pair) {
    for (const ContactPoint& point : pair.points)
      sum.elastic += point.law.potential(gap(pair, point, q)) + point.law.kt / 2 * point.next.squaredNorm();
  });
  for (const SurfacePair& pair : surfaces) sum.elastic += pair.energy();
}

void Contacts::add_work(const Moment& m, Work& sum) const {
  if (is_start(m.s)) return;
  each_pair([&](const ContactPair& pair) {
    for (const ContactPoint& point : pair.points)
      if (point.law.friction > 0 || point.law.loss.any()) sum.dissipated += place(pair, point, m.s).force.dissipated;
  });
  for (const SurfacePair& pair : surfaces) sum.dissipated += pair.dissipated(m.s);
}

int Contacts::outside(const ContactPair& pair, const Config& q) const {
  if (!pair.shape.field) return 0;
  return static_cast<int>(std::ranges::count_if(pair.points, [&](const ContactPoint& point) {
    return pair.shape.field->outside(measures(pair, position(pair, point, q), q)).distance > 0;
  }));
}

/// A step must not carry a point through an obstacle that it neither begins nor ends in.
std::string Contacts::fault(const Config&) const { return jumped_; }

Contacts::Did Contacts::advance(ContactPair& pair, const Stage& s) {
  Did out;
  for (ContactPoint& point : pair.points) {
    const Place at = place(pair, point, s);
    point.next = values(at.force.u);
    if (const std::string why = gone_through(pair, point, at.x0, at.x1); !why.empty()) out.why = why;
    if (settles(s)) continue;
    if (point.law.loss.any())
      point.next_approach = Approach{s.h, point.approach}.after(pair.met_by(point).at(at.x0) - point.law.radius,
                                                                pair.met_by(point).at(at.x1) - point.law.radius);
    out.dissipated += at.force.dissipated;
    out.pressing += at.force.pressing, out.slid += at.force.pressing * at.force.slid;
  }
  return out;
}

/// On the straight way of the step: deep within the obstacle, of a point that is open at both ends; of one that touches, deeper than at
/// either end and out towards another side.  Distances are searched in strides by which they cannot fall to the level.
std::string Contacts::gone_through(const ContactPair& pair, const ContactPoint& point, const Vec3& x0, const Vec3& x1) const {
  const double within = pair.shape.least_extent(), way = (x1 - x0).norm();
  if (!(within > 0)) return "";
  double phi[2];
  Triple<double> n[2];
  for (const int k : {0, 1}) pair.shape(triple<double>(k == 0 ? x0 : x1), phi[k], n[k]);
  const double least = std::min({phi[0], phi[1], point.law.radius});
  const bool open = least >= point.law.radius;
  if (!open && dot(n[0], n[1]) >= 0.5) return "";
  const double deep = (open ? 0.1 : 2e-3) * (within + point.law.radius), level = least - deep;
  for (double at = 0; at < way;) {
    const double above = pair.shape.at(x0 + at / way * (x1 - x0)) - level;
    if (above < 0) return fmt::format("contact \"{}\": a point goes through the obstacle within one step", pair.name);
    at += std::max({above, deep / 4, way / 4000});
  }
  return "";
}

/// Where forces are those at an instant: of the end of the step.
Contacts::Did Contacts::look_at_way(const ContactPair& pair, const Stage& s) const {
  Did out;
  for (const ContactPoint& point : pair.points) {
    const Vec3 &x0 = point.last, x1 = measures(pair, position(pair, point, *s.end), *s.end);
    if (const Place at = place(pair, point, s); at.force.acts) out.pressing += at.force.pressing;
    if (const std::string why = gone_through(pair, point, x0, x1); !why.empty()) out.why = why;
  }
  return out;
}

void Contacts::advance(const Stage& s) {
  if (!touches()) return;
  const bool on_the_way = is_static_ && s.mass_slope > 0;  // of a load step, from rest
  std::string why;
  for (SurfacePair& pair : surfaces)
    if (const std::string told = pair.advance(s); !told.empty()) why = told;
  std::vector<double> sums;  // of each pair: pressing, pressing times slip, dissipated, points past the border
  const auto tell = [&](const std::string& reason) {
    if (!reason.empty()) why = reason;
  };
  for (BallHeap& heap : heaps) {
    if (is_start(s)) break;
    tell(heap.unforeseen(begin(s), *s.e1));
    heap.next = heap.sums;
    double pressing = 0, slid = 0, work = 0;
    for (ContactPair& pair : heap.near) {
      const Did did = advance(pair, s);
      tell(did.why);
      if (settles(s)) continue;
      pressing += did.pressing, slid += did.slid, work += did.dissipated;
      pair.next = pair.sums, pair.next.add(did.pressing, did.slid);
      if (pair.next.impacts == pair.sums.impacts) continue;
      heap.next.shortest = heap.next.impacts++ == 0 ? pair.sums.steps : std::min(heap.next.shortest, pair.sums.steps);
    }
    heap.next.add_work(work, heap.law.friction, pressing, slid, on_the_way);
    if (pressing > 0) heap.next.slip += slid / pressing;
  }
  const bool at_instant = plain && is_start(s) && !is_static_;
  for (ContactPair& pair : list) {
    if (is_start(s) && !at_instant) break;
    const Did did = at_instant ? look_at_way(pair, s) : advance(pair, s);
    tell(did.why);
    if (settles(s)) continue;
    sums.insert(sums.end(), {did.pressing, did.slid, did.dissipated, double(outside(pair, *s.e1))});
  }
  const Comm& comm = *points_.comm;
  comm.sum(sums);
  for (size_t k = 0; 4 * k < sums.size(); ++k) {
    list[k].next = list[k].sums;
    list[k].next.add_work(sums[4 * k + 2], list[k].friction, sums[4 * k], sums[4 * k + 1], on_the_way);
    list[k].next.outside = std::max(list[k].sums.outside, static_cast<int>(sums[4 * k + 3]));
    list[k].next.add(sums[4 * k], sums[4 * k + 1]);
  }
  const double lowest = -comm.max(why.empty() ? -1e300 : -comm.rank);  // of the ranks that have something to say
  if (lowest != comm.rank) why.clear();
  jumped_.clear();
  if (lowest < comm.size)
    for (const char c : comm.gather(std::vector<char>(why.begin(), why.end()))) jumped_ += c;
}

void Contacts::commit(const Config& q, const Config*) {
  if (touches()) committed_ = q;
  if (plain)
    each_pair([&](ContactPair& pair) {
      for (ContactPoint& point : pair.points) point.last = measures(pair, position(pair, point, q), q);
    });
  for (SurfacePair& pair : surfaces) pair.commit(q);
}

void Contacts::settle(bool accepted) {
  jumped_.clear(), begin_ = committed_;
  each_pair([&](ContactPair& pair) {
    (accepted ? pair.sums : pair.next) = accepted ? pair.next : pair.sums;
    for (ContactPoint& point : pair.points) {
      point.parts = false;
      (accepted ? point.u : point.next) = accepted ? point.next : point.u;
      (accepted ? point.approach : point.next_approach) = accepted ? point.next_approach : point.approach;
    }
  });
  for (BallHeap& heap : heaps) (accepted ? heap.sums : heap.next) = accepted ? heap.next : heap.sums;
  for (SurfacePair& pair : surfaces) pair.settle(accepted);
}

void Contacts::archive(Archive& a) {
  for (ContactPair& pair : list) {
    a("contact " + pair.name, pair.sums);
    std::vector<double> bristles;
    for (const ContactPoint& point : pair.points) {
      const Vec3 &u = point.u, &x = point.last;
      bristles.insert(bristles.end(), {u[0], u[1], u[2], point.approach, x[0], x[1], x[2]});
    }
    a.spread({*points_.comm, pair.number}, bristles, 7);
    for (size_t k = 0; k < pair.points.size(); ++k) {
      const double* its = bristles.data() + 7 * k;
      pair.points[k].u = Eigen::Map<const Vec3>(its), pair.points[k].approach = its[3],
      pair.points[k].last = Eigen::Map<const Vec3>(its + 4);
    }
  }
  for (SurfacePair& pair : surfaces) pair.archive(a);
  for (BallHeap& heap : heaps) heap.archive(a, *points_.comm);
  settle(false);
}

std::vector<Output> Contacts::outputs() const {
  std::vector<Output> out;
  const auto add = [&](const std::string& name) {
    out.push_back({"contact", name, 4, 4,
                   [](const double* end, const double* mid, std::vector<double>& row) {
                     row.assign(mid, mid + 3);
                     row.insert(row.end(), end, end + 4);
                     row.push_back(mid[3]);
                   },
                   true});
  };
  for (const ContactPair& pair : list) add(pair.name);
  for (const SurfacePair& pair : surfaces) add(pair.name);
  for (const BallHeap& heap : heaps) out.push_back({"heap", heap.name, 5, 1, nullptr, true});
  return out;
}

/// Largest depth [m], as a share of the cell, slip so far [m] and what friction took [J].
/// At the end: depths, slip and dissipation; inside: the force on b and the sum of the normal forces of points.
void Contacts::observe(const Sight& at) {
  if (!touches()) return;
  std::vector<double> end, mid;  // of this rank
  for (const ContactPair& pair : list) {
    double deepest = 0, share = 0;
    for (const ContactPoint& point : pair.points) {
      const double depth = -gap(pair, point, at.q);
      deepest = std::max(deepest, depth), share = std::max(share, depth / point.cell);
    }
    end.insert(end.end(), {deepest, share, pair.next.slip, pair.next.dissipated});
    if (!at.step) continue;
    Vec3 F = Vec3::Zero();
    double pressing = 0;
    for (const ContactPoint& point : pair.points)
      if (const Place here = place(pair, point, at.step->s); here.force.acts)
        F -= here.normal + here.tangential, pressing += std::max(here.force.pressing, 0.);
    mid.insert(mid.end(), {F[0], F[1], F[2], pressing});
  }
  for (const SurfacePair& pair : surfaces) {
    const auto [deepest, share] = pair.depth();
    end.insert(end.end(), {deepest, share, pair.next.slip, pair.next.dissipated});
    if (!at.step) continue;
    const SurfacePair::Pressing f = pair.force(at.step->s);
    mid.insert(mid.end(), {f.on_b[0], f.on_b[1], f.on_b[2], f.sum});
  }
  for (const BallHeap& heap :
       heaps) {  // pairs that are pressed, the deepest one, slip and dissipation; inside: the largest force of a pair
    double pressed = 0, deepest = 0, share = 0, force = 0;
    for (const ContactPair& pair : heap.near) {
      const double depth = -gap(pair, pair.points[0], at.q);
      pressed += depth > 0, deepest = std::max(deepest, depth), share = std::max(share, depth / pair.points[0].cell);
      if (!at.step) continue;
      if (const Place here = place(pair, pair.points[0], at.step->s); here.force.acts)
        force = std::max(force, (here.normal + here.tangential).norm());
    }
    end.insert(end.end(), {pressed, deepest, share, heap.next.slip, heap.next.dissipated});
    if (at.step) mid.push_back(force);
  }
  points_.comm->max(end), points_.comm->sum(mid);
  size_t first = 0;
  const auto keep = [&](ContactSums& next) {
    if (at.step) next.share = std::max(next.share, end[first + 1]);
    first += 4;
  };
  for (ContactPair& pair : list) keep(pair.next);
  for (SurfacePair& pair : surfaces) keep(pair.next);
  at.end.insert(at.end.end(), end.begin(), end.end()), at.mid.insert(at.mid.end(), mid.begin(), mid.end());
}

bool Contacts::has_facets() const {
  return !surfaces.empty() || std::ranges::any_of(list, [](const ContactPair& pair) { return pair.has_facets; });
}

std::string Contacts::apart(const Config& q) const {
  std::vector<double> gaps;
  for (const ContactPair& pair : list) {
    gaps.push_back(1e300);
    for (const ContactPoint& point : pair.points) gaps.back() = std::min(gaps.back(), gap(pair, point, q) - touch(point));
  }
  for (const SurfacePair& pair : surfaces) gaps.push_back(pair.least_gap(q));
  for (const BallHeap& heap : heaps) {
    gaps.push_back(1e300);
    for (const ContactPair& pair : heap.near) gaps.back() = std::min(gaps.back(), gap(pair, pair.points[0], q) - touch(pair.points[0]));
  }
  const auto name = [&](size_t k) {
    if (k < list.size()) return list[k].name;
    return (k -= list.size()) < surfaces.size() ? surfaces[k].name : heaps[k - surfaces.size()].name;
  };
  for (double& g : gaps) g = -g;
  points_.comm->max(gaps);
  std::string out;
  for (size_t k = 0; k < gaps.size(); ++k)
    if (const double g = -gaps[k]; g > 0 && g < 1e299)
      out += fmt::format("{}contact \"{}\" begins {:.3g} m apart", out.empty() ? "" : ", ", name(k), g);
  return out;
}

void Contacts::each_facet(const Config& q, const std::function<void(const Pressed&)>& visit) const {
  const auto of_facet = [&](std::span<const int> nodes, const auto& points, const auto& pressing) {
    const auto n = static_cast<Eigen::Index>(points.size()), m = static_cast<Eigen::Index>(nodes.size());
    Pressed facet{nodes, Eigen::MatrixXd(n, m), Eigen::VectorXd(n), Eigen::VectorXd(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto& point = points[static_cast<size_t>(k)];
      facet.share.row(k) = Eigen::Map<const Eigen::RowVectorXd>(point.share.data(), m);
      facet.area[k] = point.area, facet.pressure[k] = pressing(point) / point.area;
    }
    visit(facet);
  };
  for (const ContactPair& pair : list)
    for (size_t first = 0, last; first < pair.points.size() && pair.has_facets; first = last) {
      for (last = first; last < pair.points.size() && pair.points[last].facet == pair.points[first].facet;) ++last;
      of_facet(pair.points[first].facet, std::span(pair.points).subspan(first, last - first),
               [&](const ContactPoint& point) { return point.law.k * std::max(-gap(pair, point, q), 0.); });
    }
  for (const SurfacePair& pair : surfaces)
    for (const ContactSurface& side : pair.side)
      for (const ContactSurface::Face& face : side.faces)
        if (face.n_points > 0)
          of_facet({face.node.data(), static_cast<size_t>(face.n)}, std::span(side.points).subspan(face.first, face.n_points),
                   [](const SurfacePoint& point) {
                     return 2 * point.law.k * std::max(-point.next.past.gap, 0.);
                   });  // the other half: of the other side
}

void Contacts::add_to_report(Json& run) const {
  Json contacts = Json::object(Json::In::lines);
  const auto tell = [&](const std::string& name, size_t points, const std::string& told, const ContactSums& sums, bool loses, bool facets) {
    if (!is_static_ && sums.impacts > 0 && sums.shortest < ContactSums::resolved)
      warn(fmt::format("contact \"{}\"", name), fmt::format("the shortest of {} impacts lasted {} steps: {}", sums.impacts, sums.shortest,
                                                            plain   ? "neither its force nor its energy is resolved"
                                                            : loses ? "its force and its restitution are not resolved"
                                                                    : "it gave its energy back, but its force is not resolved"));
    if (sums.share > too_deep && facets)
      warn(fmt::format("contact \"{}\"", name),
           fmt::format(
               "a depth of {:.2g} of a cell or layer: beyond {:g} the pressure is none of a contact, and thin parts may go through each "
               "other (`factor` makes it stiffer)",
               sums.share, too_deep));
    contacts.add(name, {{"points", points},
                        {"stiffness", told},
                        {"slip", {sums.slip, 6}},
                        {"dissipated", {sums.dissipated, 6}},
                        {"impacts", sums.impacts},
                        {"shortest", sums.shortest}});
  };
  for (const ContactPair& pair : list)
    if (pair.sums.outside > pair.outside)
      warn(fmt::format("contact \"{}\"", pair.name),
           fmt::format("{} of {} points have gone past the border of the height field, where nothing holds them", pair.sums.outside,
                       pair.n_points));
  for (const ContactPair& pair : list)
    tell(pair.name, static_cast<size_t>(pair.n_points), pair.told, pair.sums, pair.loses, pair.has_facets);
  for (const SurfacePair& pair : surfaces) tell(pair.name, pair.n_points(), pair.told, pair.sums, pair.loses, true);
  for (const BallHeap& heap : heaps) tell(heap.name, heap.balls.size(), heap.told, heap.sums, heap.loses, false);
  if (!contacts.members().empty()) run.add("contacts", std::move(contacts));
}

void Contacts::tie(Ties& ties) const {
  for (const ContactPair& pair : list)
    for (const int b : {pair.body, pair.carrier})
      if (b > 0) ties.exclude(b);
  for (const BallHeap& heap : heaps)
    for (const BallHeap::Ball& ball : heap.balls) ties.exclude(ball.body);
  for (const SurfacePair& pair : surfaces)
    for (const ContactSurface& surface : pair.side)
      for (const ContactSurface::Face& face : surface.faces)
        if (const int b = points_.follower[face.node[0]]; b > 0) ties.exclude(b);
}

}  // namespace hilo
