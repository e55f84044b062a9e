// SPDX-License-Identifier: GPL-3.0-or-later
// What contacts remember, take and show.
#include <fmt/format.h>

#include <algorithm>

#include "base/table.hpp"
#include "system/contacts.hpp"

namespace hilo {
namespace {

constexpr int resolved = 5;  // steps of an impact, below which it is told

}  // namespace

void Contacts::add_energy(const Config& q, const Config&, Energy& sum) const {
  for (const ContactPair& pair : list)
    for (const ContactPoint& point : pair.points)
      sum.elastic += point.law.potential(gap(pair, point, q)) + point.law.kt / 2 * point.next.squaredNorm();
}

void Contacts::add_work(const Moment& m, Work& sum) const {
  if (!m.s.conserving()) return;
  for (const ContactPair& pair : list)
    for (const ContactPoint& point : pair.points)
      if (point.law.friction > 0) sum.dissipated += place(pair, point, m.s).force.dissipated;
}

/// A step must not carry a point through an obstacle that it neither begins nor ends in.
std::string Contacts::fault(const Config&) const { return jumped_; }

void Contacts::advance(const Stage& s) {
  jumped_.clear();
  if (!s.conserving()) return;
  for (ContactPair& pair : list) {
    pair.next = pair.sums;
    double pressing = 0, slid = 0;
    const double within = pair.shape.least_extent();
    for (ContactPoint& point : pair.points) {
      const Place at = place(pair, point, s);
      point.next = values(at.force.u);
      pair.next.dissipated += at.force.dissipated;
      pressing += at.force.pressing, slid += at.force.pressing * at.force.slid;
      if (at.force.acts || within == 0) continue;
      for (const double part : {0.25, 0.5, 0.75})
        if (pair.shape.at((1 - part) * at.x0 + part * at.x1) < point.law.radius - 0.1 * (within + point.law.radius))
          jumped_ = fmt::format("contact \"{}\": a point goes through the obstacle within one step", pair.name);
    }
    ContactPair::Sums& now = pair.next;
    if (pressing > 0) {
      now.slip += slid / pressing, ++now.steps;
    } else if (now.steps > 0) {
      now.shortest = now.impacts++ == 0 ? now.steps : std::min(now.shortest, now.steps), now.steps = 0;
    }
  }
}

void Contacts::settle(bool accepted) {
  jumped_.clear();
  for (ContactPair& pair : list) {
    (accepted ? pair.sums : pair.next) = accepted ? pair.next : pair.sums;
    for (ContactPoint& point : pair.points) (accepted ? point.u : point.next) = accepted ? point.next : point.u;
  }
}

void Contacts::archive(Archive& a) {
  for (ContactPair& pair : list) {
    a("contact " + pair.name, pair.sums);
    for (ContactPoint& point : pair.points) a("bristle", point.u);
  }
  settle(false);
}

std::vector<Output> Contacts::outputs() const {
  std::vector<Output> out;
  for (const ContactPair& pair : list)
    out.push_back({"contact", pair.name, 4, 3, [](const double* end, const double* mid, std::vector<double>& row) {
                     row.assign(mid, mid + 3);
                     row.insert(row.end(), end, end + 4);
                   }});
  return out;
}

/// Largest depth [m], as a share of the cell, slip so far [m] and what friction took [J].
/// At the end: depths, slip and dissipation; inside: the force on b.
void Contacts::observe(const Sight& at) {
  for (const ContactPair& pair : list) {
    double deepest = 0, share = 0;
    for (const ContactPoint& point : pair.points) {
      const double depth = -gap(pair, point, at.q);
      deepest = std::max(deepest, depth), share = std::max(share, depth / point.cell);
    }
    at.end.insert(at.end.end(), {deepest, share, pair.next.slip, pair.next.dissipated});
    if (!at.step) continue;
    Vec3 F = Vec3::Zero();
    for (const ContactPoint& point : pair.points)
      if (const Place here = place(pair, point, at.step->s); here.force.acts) F -= here.normal + here.tangential;
    at.mid.insert(at.mid.end(), F.begin(), F.end());
  }
}

void Contacts::add_to_report(std::vector<std::pair<std::string, std::string>>& report) const {
  if (list.empty()) return;
  std::string text;
  for (const ContactPair& pair : list) {
    const ContactPair::Sums& sums = pair.sums;
    if (sums.impacts > 0 && sums.shortest < resolved)
      warn(fmt::format("contact \"{}\"", pair.name),
           fmt::format("the shortest of {} impacts lasted {} steps: it gave its energy back, but its force is not resolved", sums.impacts,
                       sums.shortest));
    text += fmt::format(
        "{}\n    {}: {{\"points\": {}, \"stiffness\": {}, \"slip\": {:.6g}, \"dissipated\": {:.6g}, \"impacts\": {}, \"shortest\": {}}}",
        text.empty() ? "" : ",", json_text(pair.name), pair.points.size(), json_text(pair.told), sums.slip, sums.dissipated, sums.impacts,
        sums.shortest);
  }
  report.emplace_back("contacts", "{" + text + "\n  }");
}

void Contacts::tie(Ties& ties) const {
  for (const ContactPair& pair : list)
    for (const int b : {pair.body, pair.carrier})
      if (b > 0) ties.exclude(b);
}

}  // namespace hilo
