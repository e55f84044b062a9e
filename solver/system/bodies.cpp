// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/bodies.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

namespace hilo {

using RowMatrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

std::string Bodies::count() const {
  int patches = 0, free = 0;
  for (const Body& b : points_.bodies)
    patches += b.patch && !b.block, free += b.free() && !b.patch && !b.linear && b.mass > 0;  // sections of beams have none of their own
  const auto blocks = std::ranges::count_if(points_.bodies, [](const Body& b) { return b.block; });
  return fmt::format("{} rigid bodies, {} patches{}", free, patches, blocks > 0 ? fmt::format(", {} blocks of nodes", blocks) : "");
}

std::string Bodies::owner(int block) const {
  for (size_t b = 0; b < points_.bodies.size(); ++b)
    if (const int first = points_.body_block[b]; first >= 0 && (block == first || block == first + 1))
      return fmt::format("{} \"{}\"", points_.bodies[b].patch ? "set" : "body", points_.bodies[b].name);
  return "";
}

/// Inertia of a body in its natural coordinates: m (a_c - g) at the centre, and as moment sum_i d_i x (A J)_i with A the second derivative
/// of the directors.
void Bodies::evaluate(Pass& p) const {
  const Stage& s = p.s;
  const Vec3& gravity = points_.gravity;
  for (size_t b = 0; b < points_.bodies.size(); ++b) {
    const Body& body = points_.bodies[b];
    if (body.linear || !points_.counts(static_cast<int>(b))) continue;
    if (p.K && !body.line.isZero(0)) stiffen_line(p, b);
    if (body.mass == 0 && body.J.isZero(0)) continue;
    const Vec3 force = body.mass * (s.a->c[b] - gravity * s.load_factor);
    const Mat3 AJ = s.a->R[b] * body.J;
    Vec3 moment = Vec3::Zero();
    for (int i = 0; i < 3; ++i) moment += s.left->R[b].col(i).cross(AJ.col(i));
    p.body[b].head<3>() += force;
    p.body[b].tail<3>() += moment;
    if (s.v && brakes(b)) add_drag(p, b);
    p.scale(std::max({body.mass * s.a->c[b].norm(), body.mass * gravity.norm(), AJ.norm() / body.size}));
    if (!p.K || points_.body_block[b] < 0) continue;
    const double mass_slope = s.mass_slope * (s.tempo ? s.tempo[b] * s.tempo[b] : 1);
    RowMatrix6 K = RowMatrix6::Zero();
    K.topLeftCorner<3, 3>().diagonal().setConstant(mass_slope * body.mass);
    Mat3 Kr = Mat3::Zero();
    for (int i = 0; i < 3; ++i) {
      Kr += s.slope * skew(AJ.col(i)) * skew(s.end->R[b].col(i));
      const Mat3 left = skew(s.left->R[b].col(i));
      for (int j = 0; j < 3; ++j)
        if (body.J(i, j) != 0) Kr -= mass_slope * body.J(i, j) * left * skew(s.end->R[b].col(j));
    }
    K.bottomRightCorner<3, 3>() = Kr;
    p.K->add(points_.body_clique[b], K.data());
  }
}

namespace {

using Rows = Eigen::Matrix<double, 4, 3>;

/// Centre and directors.
Rows rows_of(const Config& q, int b) {
  Rows out;
  out << q.c[b].transpose(), q.R[b].transpose();
  return out;
}

/// What mass-proportional damping D takes from centre and directors over the step, by the body's own clock.
double drag_work(const Eigen::Matrix4d& D, const Stage& s, int b) {
  return (s.tempo ? s.tempo[b] : 1) * (D * rows_of(*s.v, b)).cwiseProduct(rows_of(*s.end, b) - rows_of(s.from(), b)).sum();
}

}  // namespace

/// F = D V on centre and directors, as inertia acts by A a.
void Bodies::add_drag(Pass& p, size_t number) const {
  const auto b = static_cast<int>(number);
  const Stage& s = p.s;
  const Eigen::Matrix4d D = (s.tempo ? s.tempo[b] : 1) * drag[number];
  const Rows F = D * rows_of(*s.v, b), left = rows_of(*s.left, b);
  const auto row = [](const Rows& rows, int i) { return Vec3(rows.row(i).transpose()); };
  p.body[b].head<3>() += row(F, 0);
  for (int i = 1; i < 4; ++i) p.body[b].tail<3>() += row(left, i).cross(row(F, i));
  if (!p.K || points_.body_block[b] < 0) return;
  Rows end = rows_of(*s.end, b);
  end.row(0).setZero();  // turns leave the centre
  const Rows W = s.alpha_slope * D * end;
  RowMatrix6 K = RowMatrix6::Zero();
  K.topLeftCorner<3, 3>().diagonal().setConstant(s.alpha_slope * D(0, 0));
  K.topRightCorner<3, 3>() = -skew(row(W, 0));
  Vec3 arm = Vec3::Zero();
  for (int i = 1; i < 4; ++i) {
    arm += s.alpha_slope * D(i, 0) * row(left, i);
    K.bottomRightCorner<3, 3>() += s.slope * skew(row(F, i)) * skew(row(end, i)) - skew(row(left, i)) * skew(row(W, i));
  }
  K.bottomLeftCorner<3, 3>() = skew(arm);
  p.K->add(points_.body_clique[b], K.data());
}

Traits Bodies::traits() const {
  Traits out;
  for (size_t b = 0; b < drag.size(); ++b) out.has_rates = out.has_rates || brakes(b);
  return out;
}

void Bodies::add_work(const Moment& m, Work& sum) const {
  for (size_t b = 0; b < drag.size() && m.s.v; ++b)
    if (brakes(b) && points_.counts(static_cast<int>(b))) sum.dissipated += drag_work(drag[b], m.s, static_cast<int>(b));
}

void Bodies::add_taken(std::span<const int> group, const Stage& s, std::span<const double>, std::span<double> sum) const {
  for (size_t b = 0; b < drag.size() && s.v; ++b)
    if (group[b] >= 0 && brakes(b)) sum[group[b]] += std::abs(drag_work(drag[b], s, static_cast<int>(b)));
}

void Bodies::add_energy(const Config& q, const Config& v, Energy& sum) const {
  for (size_t b = 0; b < points_.bodies.size(); ++b) {
    const Body& body = points_.bodies[b];
    if (!points_.counts(static_cast<int>(b)) || body.linear || (body.mass == 0 && body.J.isZero(0))) continue;
    sum.kinetic += body.inertia(v.c[b], v.R[b], v.c[b], v.R[b]) / 2;
    sum.momentum += body.mass * v.c[b];
    sum.angular += body.mass * q.c[b].cross(v.c[b]);
    const Mat3 RJ = q.R[b] * body.J;
    for (int i = 0; i < 3; ++i) sum.angular += RJ.col(i).cross(v.R[b].col(i));
    sum.gravity -= body.mass * points_.gravity.dot(q.c[b]);
  }
}

/// R0^T R1 has the trace 1 + 2 cos(angle).
void Bodies::look_at_turn(const Config& q0, const Config& q1, int part, Turned& most) const {
  for (size_t b = 0; b < points_.bodies.size(); ++b)
    if (!points_.bodies[b].ground) most.look((q0.R[b].cwiseProduct(q1.R[b]).sum() + 1) / 4, part, static_cast<int>(b));
}

void Bodies::add_inertia(std::span<const int> group, const Config& v, const Config& w, std::span<double> sum) const {
  for (size_t b = 0; b < group.size(); ++b)
    if (group[b] >= 0 && points_.counts(static_cast<int>(b))) sum[group[b]] += points_.bodies[b].inertia(v.c[b], v.R[b], w.c[b], w.R[b]);
}

namespace {

/// Axes of falling moments J, whose signs and, in a plane or space of equal moments, whose directions rounding does not choose: they are
/// near those of the frame.
Mat3 principal_axes(const Mat3& J) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(J);
  const Vec3 m = eigen.eigenvalues().reverse();
  Mat3 axes = eigen.eigenvectors().rowwise().reverse();
  const double equal = 1e-6 * m[0];
  const bool first = m[0] - m[1] <= equal, last = m[1] - m[2] <= equal;
  if (first && last) return Mat3::Identity();
  const auto along = [](const Vec3& axis) {  // the first of the frame's axes that is as near as any
    for (int k = 0; k < 3; ++k)
      if (std::abs(axis[k]) > 0.99 * axis.cwiseAbs().maxCoeff()) return k;
    return 0;
  };
  const auto turned = [&](const Vec3& axis) -> Vec3 { return axis[along(axis)] < 0 ? -axis : axis; };
  if (first || last) {
    const int own = first ? 2 : 0, one = (own + 1) % 3, other = (own + 2) % 3;
    const Vec3 n = axes.col(own) = turned(axes.col(own));
    axes.col(one) = turned((Mat3::Identity() - n * n.transpose()).col(along(Vec3::Ones() - n.cwiseAbs2())).normalized());
    axes.col(other) = n.cross(axes.col(one));
    return axes;
  }
  for (int i = 0; i < 2; ++i) axes.col(i) = turned(axes.col(i));
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

std::array<Vec3, 4> body_arms(const Body& b) {
  std::array<Vec3, 4> arms{Vec3::Zero(), Vec3(b.size, 0, 0), Vec3(0, b.size, 0), Vec3(0, 0, b.size)};
  if (b.mass > 0 && !b.J.isZero(0)) {
    const Mat3 axes = principal_axes(b.J);
    for (int i = 0; i < 3; ++i) arms[1 + i] = b.size * axes.col(i);
  }
  return arms;
}

std::vector<Output> Bodies::outputs() const {
  std::vector<Output> out;
  for (size_t b = 1; b < points_.bodies.size(); ++b)
    if (!points_.bodies[b].block) out.push_back({.group = "body", .name = points_.bodies[b].name, .n_end = 12});
  return out;
}

void Bodies::observe(const Sight& at) {
  if (arms_.empty())
    for (const Body& b : points_.bodies) arms_.push_back(body_arms(b));
  for (size_t b = 1; b < points_.bodies.size(); ++b)
    for (const Vec3& arm : arms_[b]) {
      if (points_.bodies[b].block) continue;
      const Vec3 x = at.q.c[b] + at.q.R[b] * arm;
      at.end.insert(at.end.end(), x.data(), x.data() + 3);
    }
}

}  // namespace hilo
