// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/joint_coordinates.hpp"

#include "system/build/builder.hpp"

namespace hilo {

void JointCoordinates::archive(Archive& a) {
  for (Coordinates& c : list) {
    a("coordinates of joint " + c.name);
    c.turn.archive(a);
  }
}

std::vector<Output> JointCoordinates::outputs() const {
  std::vector<Output> out;
  for (const Coordinates& c : list) out.push_back({.group = "coordinate", .name = c.name, .n_end = 2});
  return out;
}

/// The angle goes on through whole turns, as long as a step turns the joint by less than half a turn.
void JointCoordinates::observe(const Sight& at) {
  for (Coordinates& c : list) {
    const int sine = c.slides ? 1 : 0;
    if (c.turns) c.turn.committed = c.turn.unwrap(c.geometry.value(sine, at.q), c.geometry.value(sine + 1, at.q));
    at.end.push_back(c.slides ? c.geometry.value(0, at.q) : 0);
    at.end.push_back(c.turns ? c.turn.committed : 0);
  }
}

void Builder::add_joint_coordinates() {
  for (const JointHost& host : joint_hosts())
    if (!host.kind.freedoms.empty() && host.geometry.end[0].body >= 0 && host.geometry.end[1].body >= 0)
      out_->part<JointCoordinates>().list.push_back({.name = host.geometry.name,
                                                     .geometry = coordinates_of(host.geometry, host.kind, out_->start),
                                                     .slides = host.kind.frees(Freedom::slide),
                                                     .turns = host.kind.frees(Freedom::angle)});
}

}  // namespace hilo
