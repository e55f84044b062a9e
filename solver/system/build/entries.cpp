// SPDX-License-Identifier: GPL-3.0-or-later
// Entries of the scene to point masses and stations.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "system/build/builder.hpp"
#include "system/point_masses.hpp"
#include "system/stations.hpp"

namespace hilo {
namespace {

/// A point that is farther from the node it is taken for than half of the largest cell there.  Collective.
void warn_of_distance(const Entry& e, int nearest, const LocalMesh& mesh, const std::vector<Vec3>& X_of, const Comm& comm) {
  double far[4] = {-1e300, -1e300, -1e300, 0}, size = 0;  // of the rank that owns the node; the last is half of the cell
  if (nearest >= 0) {
    const Vec3& X = X_of[nearest];
    for (std::int64_t c = 0; c < mesh.mesh.n_cells(); ++c) {
      const auto nodes = mesh.mesh.cell(c);
      if (std::ranges::find(nodes, std::int64_t{nearest}) == nodes.end()) continue;
      for (const std::int64_t n : nodes) size = std::max(size, (X_of[n] - X).norm());
    }
    std::copy_n(X.data(), 3, far), far[3] = size / 2;
  }
  comm.max(far);
  const Vec3 X(far);
  const double d = (X - e.vector3("at")).norm();
  if (d > far[3] * (1 + 1e-9) && d > 1e-9 * mesh.length)
    warn(e.where("at"), fmt::format("{}: the nearest node of \"{}\" is {:.3g} m away, at ({:.4g}, {:.4g}, {:.4g}): that is what is told",
                                    e.label(), e.text("on"), d, X[0], X[1], X[2]));
}

}  // namespace

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

/// Mass at points of a body: its sum, centre and inertia with theirs.
void Builder::add_mass(Body& body, const std::vector<std::pair<Vec3, double>>& points) {
  double m = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // about the centre of the body, sum m d d^T
  for (const auto& [at, mass] : points) {
    const Vec3 d = at - body.Xc;
    m += mass, first += mass * d, second += mass * d * d.transpose();
  }
  m = comm_.sum(m), comm_.sum(std::span<double>(first.data(), 3)), comm_.sum(std::span<double>(second.data(), 9));
  const double total = body.mass + m;
  const Vec3 shift = first / total;
  body.J += second - total * shift * shift.transpose();
  body.mass = total;
  body.Xc += shift;
}

void Builder::add_point_masses() {
  for (const Entry& e : scene_.entries("point_mass")) {
    const Found found = find(e.text("on"), e.where("on"));
    const double m = e.number("mass");
    out_->mass += m;
    if (found.body == 0) throw Error(e.where("on"), e.label() + ": the ground has no mass");
    if (found.body < 0 && e.has("at"))
      throw Error(e.where("at"), fmt::format("{}: \"{}\" is flexible, its nodes share the mass", e.label(), e.text("on")),
                  "name a set of nodes there");
    const bool has_nodes = found.n_global > 0 && !e.has("at");
    std::vector<std::pair<int, double>> shares;
    if (has_nodes) shares = found.body > 0 ? shares_of(found) : positive_shares_of(found);
    if (found.body > 0) {
      Body& body = out_->bodies[found.body];
      std::vector<std::pair<Vec3, double>> points;
      for (const auto& [node, share] : shares) points.emplace_back(out_->X[node], m * share);
      if (!has_nodes && comm_.rank == 0) points.emplace_back(e.has("at") ? e.vector3("at") : point_of(found.body), m);
      add_mass(body, points);
      out_->start.c[found.body] = body.Xc;
    } else {
      const Vec3 centre = centre_of(shares);
      for (auto& [node, share] : shares) share *= m;
      out_->part<PointMasses>().add(shares, centre);
    }
  }
}

/// Whether nodes are spread so that axes can turn with them: off a line by a hundredth of its length.  Collective.
bool Builder::has_axes(const std::vector<std::pair<int, double>>& shares, const Vec3& centre) const {
  Mat3 spread = Mat3::Zero();
  for (const auto& [n, share] : shares) spread += share * (out_->X[n] - centre) * (out_->X[n] - centre).transpose();
  comm_.sum(std::span<double>(spread.data(), 9));
  const Vec3 along = Eigen::SelfAdjointEigenSolver<Mat3>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return along[1] > 1e-4 * along[2];
}

void Builder::add_stations() {
  for (const char* section : {"sensor", "probe"})
    for (const Entry& e : scene_.entries(section)) {
      Station s;
      s.name = e.name;
      s.sensor = std::string_view(section) == "sensor";
      const Found found = find(e.text("on"), e.where("on"), Asks::looks);
      if (s.sensor) {
        const Vec3 z = direction(e, "z"), x = direction(e, "x");
        if (std::abs(x.dot(z)) > 1 - 1e-9) throw Error(e.where("x"), e.label() + ": x is parallel to z");
        s.axes = frame_of_axis(z, x);
        if (const double tilt = std::asin(std::clamp(x.dot(z), -1.0, 1.0)) * 180 / std::numbers::pi; std::abs(tilt) > 1)
          warn(e.where(e.given("x") ? "x" : "z"),
               fmt::format(
                   "{}: x is {:.3g} degrees off the plane normal to z, and is taken as its part in that plane (give both, at a right "
                   "angle, for a sensor that is tilted)",
                   e.label(), std::abs(tilt)));
      }
      if (found.body >= 0) {
        s.body = found.body;
        const Body& body = out_->bodies[s.body];
        const Vec3 at = e.has("at") ? e.vector3("at") : found.n_global == 0 ? point_of(s.body) : centre_of(shares_of(found));
        s.arm = at - body.Xc;
      } else if (e.has("at")) {
        if (s.sensor)
          throw Error(e.where("at"), fmt::format("{}: \"{}\" is flexible, and a single point of it has no axes", e.label(), e.text("on")),
                      found.is_region ? "name a set of nodes there" : "without at it is the mean of the set, whose axes turn with it");
        const int nearest = nearest_owned(found.nodes, e.vector3("at"));
        if (nearest >= 0) s.nodes.emplace_back(nearest, 1);
        warn_of_distance(e, nearest, *mesh_, out_->X, comm_);
        s.mean = e.vector3("at");
      } else {
        s.nodes = shares_of(found);
        s.mean = centre_of(s.nodes);
        s.turns = has_axes(s.nodes, s.mean);
        if (s.sensor && !s.turns)
          warn(e.where("on"),
               fmt::format("{}: the nodes of \"{}\" lie on a line, so its axes stay as drawn where the part turns (name a face)", e.label(),
                           e.text("on")));
      }
      out_->part<Stations>().list.push_back(std::move(s));
    }
}

}  // namespace hilo
