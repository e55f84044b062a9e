// SPDX-License-Identifier: GPL-3.0-or-later
// Entries of the scene to springs, stops, motors and friction.
#include "system/springs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "system/build/builder.hpp"
#include "system/joints.hpp"

namespace hilo {

void Builder::add_springs() {
  for (const Entry& e : scene_.entries("spring")) {
    const SpringKind& kind = spring_kinds().at(e.kind, e.place.text());
    const Carrier a = carrier(e, "a", kind.turns_a), b = carrier(e, "b", kind.turns_b);
    if (a.body == b.body && a.node == b.node) e.refuse("b", "both ends are the same body");
    Spring c = kind.make({e, a, b}, out_->start);
    out_->stiffness = std::max(out_->stiffness, c.stiffness);
    c.name = e.name;
    out_->part<Springs>().list.push_back(std::move(c));
  }
}

std::vector<JointHost> Builder::joint_hosts() const {
  std::vector<JointHost> out;
  const std::vector<Joint>& joints = out_->part<Joints>().list;
  for (size_t j = 0; j < joints.size(); ++j) out.push_back({joints[j], *joints[j].kind, static_cast<int>(j)});
  for (const Spring& c : out_->part<Springs>().list)
    if (c.gives_way) out.push_back({c, *c.gives_way, -1});
  return out;
}

JointHost Builder::joint_of(const Entry& e) const {
  const std::string& name = e.text("joint");
  std::vector<std::string> names;
  for (const JointHost& host : joint_hosts()) {
    if (host.geometry.name == name) return host;
    names.push_back(host.geometry.name);
  }
  throw Error(e.where("joint"), fmt::format("{}: no joint \"{}\"", e.label(), name), suggest(name, names));
}

/// Stops, motors and friction act along the free directions of a joint.
void Builder::add_joint_forces() {
  for (const char* section : {"stop", "motor", "friction"})
    for (const Entry& e : scene_.entries(section)) {
      Spring c = joint_force_kinds().at(e.kind, e.place.text()).make(e, joint_of(e), out_->start);
      if (e.given("history")) c.history = use_history(e, Acts::as_force);
      c.name = e.name, c.group = e.section;
      out_->part<Springs>().list.push_back(std::move(c));
    }
}

}  // namespace hilo
