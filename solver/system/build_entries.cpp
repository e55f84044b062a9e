// SPDX-License-Identifier: GPL-3.0-or-later
// Entries of the scene to point masses and stations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "system/builder.hpp"
#include "system/point_masses.hpp"
#include "system/stations.hpp"

namespace hilo {
const History& Builder::use_history(const Entry& e, Acts acts) {
  const History& h = e.history("history");
  const bool is_static = this->is_static();
  for (const History::Break& b : h.breaks())
    if (b.order == 0 && acts == Acts::as_position && !is_static)
      throw Error(e.where("history"),
                  fmt::format("{}: the history jumps at t = {:.6g}, so the position it prescribes would jump too", e.label(), b.t),
                  "let the values rise gradually, with interpolation = \"smooth\"");
  out_->histories.push_back({e.label(), h, acts});
  return h;
}

void Builder::add_point_masses() {
  for (const Entry& e : scene_.entries("point_mass")) {
    const Found found = find(e.text("on"), e.where("on"));
    const double m = e.number("mass");
    out_->mass += m;
    if (found.body > 0) {
      Body& body = out_->bodies[found.body];
      const Vec3 at = e.has("at") ? e.vector3("at") : found.n_global == 0 || found.is_region ? body.Xc : mean_of(found.nodes);
      const double total = body.mass + m;
      const Vec3 d = at - body.Xc, shift = m / total * d;
      // about the new centre: J + mu d d^T with the reduced mass mu
      body.J += body.mass * m / total * d * d.transpose();
      body.mass = total;
      body.Xc += shift;
      out_->start.c[found.body] = body.Xc;
    } else if (found.body == 0) {
      throw Error(e.where("on"), e.label() + ": the ground has no mass");
    } else {
      const double share = m / static_cast<double>(std::max<std::int64_t>(1, found.n_global));
      for (int i : found.nodes)
        if (out_->node_owned[i]) out_->part<PointMasses>().add(i, share);
    }
  }
}

void Builder::add_stations() {
  for (const char* section : {"sensor", "probe"})
    for (const Entry& e : scene_.entries(section)) {
      Station s;
      s.name = e.name;
      s.sensor = std::string_view(section) == "sensor";
      const Found found = find(e.text("on"), e.where("on"));
      if (s.sensor) {
        const Vec3 z = direction(e, "z"), x = direction(e, "x");
        if (std::abs(x.dot(z)) > 1 - 1e-9) throw Error(e.where("x"), e.label() + ": x is parallel to z");
        s.axes = frame_of_axis(z, x);
      }
      if (found.body >= 0) {
        s.body = found.body;
        const Body& body = out_->bodies[s.body];
        const Vec3 at = e.has("at") ? e.vector3("at") : found.n_global == 0 || found.is_region ? body.Xc : mean_of(found.nodes);
        s.arm = at - body.Xc;
      } else if (e.has("at") && !s.sensor) {
        if (const int nearest = nearest_owned(found.nodes, e.vector3("at")); nearest >= 0) s.nodes.push_back(nearest);
        s.n_nodes = 1;
        s.mean = e.vector3("at");
      } else {
        for (int i : found.nodes)
          if (out_->node_owned[i]) s.nodes.push_back(i);
        s.n_nodes = static_cast<double>(found.n_global);
        s.mean = mean_of(found.nodes);
      }
      out_->part<Stations>().list.push_back(std::move(s));
    }
}

}  // namespace hilo
