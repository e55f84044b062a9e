// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/redundancy/contradiction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

constexpr int samples = 1000;  // instants of a run that are looked at

std::string line_of(const Scene& scene, const Constraint& c) {
  for (const Entry& e : scene.entries(c.section()))
    if (e.name == c.name()) return e.place.text();
  return scene.path;
}

}  // namespace

void refuse_contradictions(const Scene& scene, const System& system, const Redundancy& redundancy, double end) {
  const double open = 1e-9 * system.length;
  for (const auto& [j, by] : redundancy.held) {
    const Constraint& c = *system.constraints()[j];
    const MotionLaw& law = c.drive()->law;
    const double start = law.at(0).value;
    for (int k = 1; k <= samples; ++k) {
      const double t = end * k / samples;
      if (std::abs(law.at(t).value - start) <= open) continue;
      throw Error(line_of(scene, c),
                  fmt::format("{} is to be driven, but {} at t = {:.3g} s", c.label(),
                              by.empty() ? "the joint does not leave this motion free" : fmt::format("joint \"{}\" holds it still", by), t),
                  "remove the drive, or what holds the same motion");
    }
  }
  Config q = system.start;
  std::vector<const Constraint*> prescribed;  // nothing that they hold is free
  for (const auto& c : system.constraints())
    if (c->has_no_past() && c->blocks().empty()) prescribed.push_back(c.get());
  for (int k = 0; k <= samples && !prescribed.empty(); ++k) {
    const double t = end * k / samples;
    system.prescribe(q, t);
    for (const Constraint* c : prescribed) {
      double g[max_rows];
      c->gaps(q, t, 1, g);
      const double worst = std::abs(*std::max_element(g, g + c->n_rows(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
      if (worst <= open) continue;
      throw Error(
          line_of(scene, *c),
          fmt::format("{} holds what motion \"{}\" moves: it would open by {:.3g} at t = {:.3g} s", c->label(), c->moved_by(), worst, t),
          fmt::format("remove the {} or the motion", c->section()));
    }
  }
}

std::string contradicted_joint(const System& system, const Config& q, const Config& v, double t) {
  double driven = 0, worst = 0;
  for (const auto& c : system.constraints())
    if (c->drive()) driven = std::max(driven, std::abs(c->drive()->law.at(t, system.beside(t, Side::right)).rate));
  if (driven == 0) return "";
  std::vector<double> rate;
  system.row_rates(q, v, nullptr, t, rate, nullptr);
  std::string name;
  for (const auto& c : system.constraints())
    for (int m = 0; m < c->n_rows(); ++m) {
      const double r = std::abs(rate[c->row() + m]);
      if (!c->active()[m] && r > worst) worst = r, name = c->name();
    }
  return worst > 1e-8 * driven ? name : "";
}

}  // namespace hilo
