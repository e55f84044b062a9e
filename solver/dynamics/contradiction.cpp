#include "dynamics/contradiction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

constexpr int samples = 1000;  // instants of a run that are looked at

std::string place_of_joint(const Scene& scene, const std::string& joint) {
  for (const Entry& e : scene.entries("joint"))
    if (e.name == joint) return e.place.text();
  return scene.path;
}

}  // namespace

void refuse_contradictions(const Scene& scene, const System& system, const Redundancy& redundancy, double end) {
  const double open = 1e-9 * system.length;
  for (const auto& [j, by] : redundancy.held) {
    const Joint& joint = system.joints[j];
    const double start = joint.drive.law.at(0).value;
    for (int k = 1; k <= samples; ++k) {
      const double t = end * k / samples;
      if (std::abs(joint.drive.law.at(t).value - start) <= open) continue;
      throw Error(place_of_joint(scene, joint.name),
                  fmt::format("joint \"{}\" is to be driven, but {} at t = {:.3g} s", joint.name,
                              by.empty() ? "its own rows hold it" : fmt::format("joint \"{}\" holds it still", by), t),
                  "take away the drive, or what holds the same motion");
    }
  }
  const auto prescribed = [&](const Carrier& end_of) {
    return end_of.body >= 0 ? system.body_block[end_of.body] < 0 : system.node_block[end_of.node] < 0;
  };
  Config q = system.start;
  std::vector<const Joint*> fixed_ends;  // without angles, which would have to be unwrapped
  for (const Joint& joint : system.joints) {
    const auto ends = joint.ends();
    if (!joint.rows && std::all_of(ends.begin(), ends.end(), prescribed)) fixed_ends.push_back(&joint);
  }
  for (int k = 0; k <= samples && !fixed_ends.empty(); ++k) {
    const double t = end * k / samples;
    system.prescribe(q, t);
    for (const Joint* joint : fixed_ends) {
      double g[max_rows];
      gaps(*joint, q, t, 1, g);
      const double worst =
          std::abs(*std::max_element(g, g + joint->n_rows(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
      if (worst <= open) continue;
      std::string moves;
      for (const Carrier& end_of : joint->ends())
        if (end_of.body >= 0 && system.bodies[end_of.body].held) moves = system.bodies[end_of.body].motion;
      throw Error(
          place_of_joint(scene, joint->name),
          fmt::format("joint \"{}\" holds what motion \"{}\" moves: it would open by {:.3g} at t = {:.3g} s", joint->name, moves, worst, t),
          "take away the joint or the motion");
    }
  }
}

std::string contradicted_joint(const System& system, const Config& q, const Config& v, double t) {
  double driven = 0, worst = 0;
  for (const Joint& j : system.joints)
    if (j.drive.row >= 0) driven = std::max(driven, std::abs(j.drive.law.at(t, system.beside(t, Side::right)).rate));
  if (driven == 0) return "";
  std::vector<double> rate;
  system.row_rates(q, v, nullptr, t, rate, nullptr);
  std::string name;
  for (size_t j = 0; j < system.joints.size(); ++j)
    for (int m = 0; m < system.joints[j].n_rows(); ++m) {
      const double r = std::abs(rate[system.joints.row(j) + m]);
      if (!system.joints[j].active[m] && r > worst) worst = r, name = system.joints[j].name;
    }
  return worst > 1e-8 * driven ? name : "";
}

}  // namespace hilo
