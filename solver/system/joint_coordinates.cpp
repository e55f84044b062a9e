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

double JointCoordinates::Coordinates::angle(const Config& q) const {
  const int sine = slides ? 1 : 0;
  return turns ? turn.unwrap(geometry.value(sine, q), geometry.value(sine + 1, q)) : 0;
}

void JointCoordinates::commit(const Config& q, const Config*) {
  for (Coordinates& c : list) c.turn.committed = c.angle(q);
}

void JointCoordinates::observe(const Sight& at) {
  for (const Coordinates& c : list) {
    at.end.push_back(c.slides ? c.geometry.value(0, at.q) : 0);
    at.end.push_back(c.angle(at.q));
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
