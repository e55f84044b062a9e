// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/linear_beams.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "system/mode_forces.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Strains = Eigen::Matrix<double, 6, 12>;

Vec3 vec3(const BeamVector& v) { return Vec3(v[0], v[1], v[2]); }

arc::BodyPose<double> pose(const Vec3& c, const Mat3& R) {
  arc::BodyPose<double> out;
  std::copy_n(c.data(), 3, out.c.v);
  for (int i = 0; i < 3; ++i) std::copy_n(R.data() + 3 * i, 3, out.R[i].v);
  return out;
}

/// As it is drawn: `at` are the places of its sections.
arc::SectionPoints<double> drawn(const BeamCell& cell, const Vec3& a, const Vec3& b) {
  const arc::BodyPose<double> poses[2] = {pose(a, Mat3::Identity()), pose(b, Mat3::Identity())};
  arc::SectionPoints<double> out;
  arc::points_of(cell.arc, poses, out);
  return out;
}

/// Slopes of the strains of a cell without stress by the motion of both sections, scaled so that their squares sum to twice its energy.
Strains strains_of(const BeamCell& cell, const arc::SectionPoints<double>& at) {
  const arc::Measures<double> m = arc::measures_of(at.y);
  const ArcStrain drawn = arc_strain(m);
  arc::Gradient<double> g;
  arc::gradient(at, at, g);
  Strains slopes;
  for (int c = 0; c < 12; ++c) {
    const int end = c / 6, k = c % 3;
    arc::Measures<double> dm{};
    for (int i = 0; i < 3; ++i) {
      if (c % 6 < 3) dm.p[i] = (end == 0 ? -1 : 1) * g.way[i][k];
      if (c % 6 >= 3) dm.a[i] = g.turn[i][end][k], dm.p[i] = g.turn[4 + i][end][k];
    }
    if (c % 6 >= 3) dm.t = g.turn[3][end][k];
    ArcStrain x;
    arc::strain_ahead(m, dm, x.data());
    slopes.col(c) = x - drawn;
  }
  return arc_tangent(cell.arc.law, drawn).llt().matrixU() * slopes / std::sqrt(cell.arc.law.length);
}

/// Motions of sections of those of their nodes.
Eigen::Matrix<double, 12, 24> sections_of_nodes(double arm) {
  Eigen::Matrix<double, 12, 24> out = Eigen::Matrix<double, 12, 24>::Zero();
  for (int e = 0; e < 2; ++e) {
    out.block<3, 3>(6 * e, 12 * e).setIdentity();
    for (int k = 0; k < 3; ++k) {
      const Mat3 turn = skew(Vec3::Unit(k)) / (2 * arm);
      out.block<3, 3>(6 * e + 3, 12 * e + 3 + 3 * k) += turn, out.block<3, 3>(6 * e + 3, 12 * e) -= turn;
    }
  }
  return out;
}

Eigen::VectorXd amplitudes(const Modes& m, const Config& q) {
  Eigen::VectorXd out(3 * m.n_blocks);
  for (Index j = 0; j < out.size(); ++j) out[j] = q.eta[m.first + static_cast<int>(j) / 3][j % 3];
  return out;
}

/// The amplitudes that strain forces act by at a stage: the elastic ones with what dissipation takes, and their rates.
std::array<Eigen::VectorXd, 2> acting(const Modes& m, const Stage& s) {
  const Eigen::VectorXd from = amplitudes(m, *s.e0), to = amplitudes(m, *s.e1);
  Eigen::VectorXd elastic = (1 - s.weight) * from + s.weight * to, rate = Eigen::VectorXd::Zero(from.size());
  if (const Dissipation* d = s.dissipation) {
    const Eigen::VectorXd one = amplitudes(m, *d->one), two = amplitudes(m, *d->two);
    elastic += d->kappa * (to - from - d->last() * (from - one) - d->before() * (one - two));
  }
  if (s.h > 0) rate = (amplitudes(m, *s.w1) - amplitudes(m, *s.w0)) / s.h;
  return {elastic, rate};
}

/// A point or direction of a section, as the unknowns of its region move it (3 x 6 + 3 n_blocks).
Eigen::Matrix<double, 3, Eigen::Dynamic> map_of(bool is_point, const Vec3& lever, const Mat3& turn, const std::vector<Vec3>& shapes) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> out(3, 6 + static_cast<Index>(shapes.size()));
  out.leftCols<3>() = is_point ? Mat3(Mat3::Identity()) : Mat3(Mat3::Zero());
  out.middleCols<3>(3) = -skew(lever);
  for (size_t j = 0; j < shapes.size(); ++j) out.col(6 + static_cast<Index>(j)) = turn * shapes[j];
  return out;
}

}  // namespace

void LinearBeams::add_cell(const SectionPlace& a, const SectionPlace& b, const SectionsAlong& sections, double beta, double alpha) {
  Config rest;
  rest.c = {a.at, b.at}, rest.R.assign(2, Mat3::Identity());
  BeamCell cell = beam_cell({a.at, a.frame, 0}, {b.at, b.frame, 1}, rest, sections, beta, alpha);
  cell.body = {a.body, b.body};
  strains_.push_back(strains_of(cell, drawn(cell, a.at, b.at)));
  cells.push_back(std::move(cell));
}

Eigen::Matrix<double, 8, 8> LinearBeams::points_of_nodes(size_t k, double arm) const {
  Eigen::Matrix<double, 8, 8> out = Eigen::Matrix<double, 8, 8>::Zero();
  for (int e = 0; e < 2; ++e) {
    out(4 * e, 4 * e) = 1;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double share = cells[k].arc.axis[e][i][j] / arm;
        out(4 * e + 1 + i, 4 * e + 1 + j) = share, out(4 * e + 1 + i, 4 * e) -= share;
      }
  }
  return out;
}

PointCell LinearBeams::point_cell(size_t k, double arm) const {
  const BeamCell& cell = cells[k];
  const LinearSection &a = sections[cell.body[0]], &b = sections[cell.body[1]];
  PointCell out;
  for (int i = 0; i < 4; ++i) out.nodes[i] = a.node + i, out.nodes[4 + i] = b.node + i;
  const auto ends = sections_of_nodes(arm);
  out.strains = strains_[k] * ends;
  double M[8][8] = {};
  arc::add_mass(cell.arc, 1., M);
  const Eigen::Matrix<double, 8, 8> T = points_of_nodes(k, arm);
  out.mass = T.transpose() * Eigen::Map<const Eigen::Matrix<double, 8, 8>>(&M[0][0]) * T;
  out.beta = cell.arc.beta, out.alpha = cell.arc.alpha, out.length = cell.arc.law.length;
  const Vec3 along = (b.at - a.at).normalized();
  const double way = (b.at - a.at).norm();
  const Eigen::Matrix<double, 3, 24> n = strains_[k].middleCols<3>(6).transpose() * out.strains,
                                     moved = ends.middleRows(6, 3) - ends.topRows(3),
                                     turn = (ends.middleRows(3, 3) + ends.middleRows(9, 3)) / 2;
  const Eigen::Matrix<double, 1, 24> pull = along.transpose() * n;
  for (int c = 0; c < 3; ++c) {  // n e + e n - (n.e) e e
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    out.stress.row(c) = way * (2 * along[c] * n.row(c) - along[c] * along[c] * pull);
    out.stress.row(3 + c) = way * (along[j] * n.row(i) + along[i] * n.row(j) - along[i] * along[j] * pull);
  }
  const Mat3 across = Mat3::Identity() - along * along.transpose();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)  // u_i,j: along the way, and w x of what is across
      out.gradient.row(3 * i + j) = moved.row(i) * along[j] / way - skew(Vec3(across.col(j))).row(i) * turn;
  return out;
}

arc::SectionPoints<double> LinearBeams::points_of(const BeamCell& cell, const Config& q) const {
  arc::BodyPose<double> poses[2];
  for (int e = 0; e < 2; ++e) {
    const LinearSection& s = sections[cell.body[e]];
    const Modes& m = points_.modes[s.modes];
    Vec3 c = q.c[m.body] + q.R[m.body] * (s.at - points_.bodies[m.body].Xc);
    Mat3 R = q.R[m.body];
    for (size_t j = 0; j < s.moves.size(); ++j) {
      const Mat3& Y = q.Y[3 * m.first + j];
      c += Y * s.moves[j], R += Y * skew(s.turns[j]);
    }
    poses[e] = pose(c, R);
  }
  arc::SectionPoints<double> out;
  arc::points_of(cell.arc, poses, out);
  return out;
}

Eigen::Matrix<double, 12, 1> LinearBeams::ends_of(const BeamCell& cell, const Eigen::VectorXd& eta) const {
  Eigen::Matrix<double, 12, 1> out = Eigen::Matrix<double, 12, 1>::Zero();
  for (int e = 0; e < 2; ++e) {
    const LinearSection& s = sections[cell.body[e]];
    for (size_t j = 0; j < s.moves.size(); ++j) {
      out.segment<3>(6 * e) += eta[static_cast<Index>(j)] * s.moves[j];
      out.segment<3>(6 * e + 3) += eta[static_cast<Index>(j)] * s.turns[j];
    }
  }
  return out;
}

std::vector<double> LinearBeams::momenta(int modes, const std::vector<Vec3>& velocity, const std::vector<Vec3>& spin) const {
  const Modes& m = points_.modes[modes];
  std::vector<double> sum(6 + 3 * static_cast<size_t>(m.n_blocks), 0.0);
  const auto add = [&](size_t at, const Vec3& v) {
    for (int i = 0; i < 3; ++i) sum[at + i] += v[i];
  };
  for (const BeamCell& cell : cells) {
    if (sections[cell.body[0]].modes != modes) continue;
    arc::BodyPose<double> rates[2];
    for (int e = 0; e < 2; ++e) rates[e] = pose(velocity[cell.body[e]], skew(spin[cell.body[e]]));
    arc::SectionPoints<double> V;
    arc::points_of(cell.arc, rates, V);
    const auto P = momenta_of(cell, V);
    const arc::SectionPoints<double> x = drawn(cell, sections[cell.body[0]].at, sections[cell.body[1]].at);
    for (int i = 0; i < 8; ++i) {
      const LinearSection& s = sections[cell.body[i / 4]];
      const Vec3 p = vec3(P[i]), at = vec3(x.y[i]);
      if (i % 4 == 0) add(0, p);
      add(3, (i % 4 == 0 ? Vec3(at - points_.bodies[m.body].Xc) : at).cross(p));
      for (size_t j = 0; j < s.moves.size(); ++j) sum[6 + j] += (i % 4 == 0 ? s.moves[j] : Vec3(s.turns[j].cross(at))).dot(p);
    }
  }
  return sum;
}

void LinearBeams::carry(Config& q) const {
  for (const CarriedBodies& of : carried) {
    const Modes& m = points_.modes[of.modes];
    Eigen::Matrix<double, Eigen::Dynamic, 3> Y(of.motions.cols(), 3);
    for (Index j = 0; j < Y.rows(); j += 3) Y.middleRows<3>(j) = q.Y[static_cast<size_t>(3 * m.first + j / 3)].transpose();
    Eigen::Matrix<double, Eigen::Dynamic, 3> moved(of.motions.rows(), 3);
    for (int i = 0; i < 3; ++i) moved.col(i).noalias() = of.motions * Y.col(i);  // a product of matrices would copy the motions each time
    for (size_t k = 0; k < of.bodies.size(); ++k) {
      const int b = of.bodies[k];
      const auto own = moved.middleRows<4>(4 * static_cast<Index>(k));
      q.c[b] = q.c[m.body] + q.R[m.body] * (points_.bodies[b].Xc - points_.bodies[m.body].Xc) + own.row(0).transpose();
      q.R[b] = q.R[m.body] + own.bottomRows<3>().transpose();
    }
  }
}

std::string LinearBeams::count() const {
  return beams.empty() ? "" : fmt::format("{} linear or rigid beams with {} cells", beams.size(), cells.size());
}

/// Loads by length alone: all else is the region's.
void LinearBeams::evaluate(Pass& p) const {
  if (lines.empty() || !p.loads) return;
  const Stage& s = p.s;
  const std::vector<LineForces> line = line_forces(lines, cells, s);
  std::vector<ModeForces> of_modes;
  for (const Modes& m : points_.modes) of_modes.emplace_back(m, p);
  for (size_t k = 0; k < cells.size(); ++k) {
    const BeamCell& cell = cells[k];
    const int modes = sections[cell.body[0]].modes, body = points_.modes[modes].body;
    if (!points_.counts(body) || (line[k].F.isZero(0) && line[k].K.isZero(0))) continue;
    const Mat3 hat = left_turn(s, body);
    const arc::SectionPoints<double> left = points_of(cell, *s.left), end = points_of(cell, *s.end);
    const auto F = line[k].at(left);
    std::vector<Vec3> shapes[8];
    Vec3 lever[8], lever_end[8];
    for (int i = 0; i < 8; ++i) {
      const LinearSection& section = sections[cell.body[i / 4]];
      const bool is_point = i % 4 == 0;
      const Vec3 f = -vec3(F[i]);
      shapes[i] = section.moves;
      for (size_t j = 0; j < section.turns.size() && !is_point; ++j)
        shapes[i][j] = section.turns[j].cross(vec3(cell.arc.axis[i / 4][i % 4 - 1]));
      lever[i] = vec3(left.y[i]), lever_end[i] = vec3(end.y[i]);
      if (is_point) lever[i] -= s.left->c[body], lever_end[i] -= s.end->c[body], p.body[body].head<3>() += f;
      p.body[body].tail<3>() += lever[i].cross(f);
      p.scale(f.norm());
      of_modes[modes].add(shapes[i], f);
      if (p.K) of_modes[modes].tangent().block<3, 3>(3, 3) += s.slope * skew(f) * skew(lever_end[i]);
    }
    if (!p.K || line[k].K.isZero(0)) continue;
    const Mat3& R = s.end->R[body];
    for (int i = 0; i < 8; ++i) {
      const auto L = map_of(i % 4 == 0, lever[i], hat, shapes[i]);
      for (int j = 0; j < 8; ++j)
        if (line[k].K(i, j) != 0)
          of_modes[modes].tangent() -= s.slope * line[k].K(i, j) * L.transpose() * map_of(j % 4 == 0, lever_end[j], R, shapes[j]);
    }
  }
  for (ModeForces& m : of_modes) m.finish();
}

void LinearBeams::add_work(const Moment& m, Work& sum) const {
  const Stage& s = m.s;
  const std::vector<LineForces> line = line_forces(lines, cells, s);
  for (size_t k = 0; k < line.size(); ++k) {
    const BeamCell& cell = cells[k];
    if (!points_.counts(points_.modes[sections[cell.body[0]].modes].body)) continue;
    sum.external += work(line[k].at(points_of(cell, *s.left)), points_of(cell, s.from()), points_of(cell, *s.end));
  }
}

void LinearBeams::tie(Ties& ties) const {
  for (const CarriedBodies& of : carried)
    for (const int b : of.bodies) ties.exclude(b);
}

std::vector<Output> LinearBeams::outputs() const {
  std::vector<Output> out;
  for (const Beam& beam : beams)
    if (!beam.rigid) out.push_back({.group = "beam", .name = beam.name, .n_mid = 12 * beam.n_cells});
  return out;
}

void LinearBeams::observe(const Sight& sight) {
  if (!sight.step) return;
  const Stage& s = sight.step->s;
  const std::vector<LineForces> line = line_forces(lines, cells, s);
  std::vector<std::array<Eigen::VectorXd, 2>> by_modes;
  for (const Modes& m : points_.modes) by_modes.push_back(acting(m, s));
  for (size_t k = 0; k < cells.size(); ++k) {
    const BeamCell& cell = cells[k];
    const int modes = sections[cell.body[0]].modes;
    if (points_.modes[modes].n_modes == 0) continue;  // rigid
    const auto& [elastic, rate] = by_modes[modes];
    Eigen::Matrix<double, 12, 1> f = strains_[k].transpose() * (strains_[k] * ends_of(cell, elastic + cell.arc.beta * rate));
    arc::SectionPoints<double> rates = points_of(cell, *s.a);
    for (const int c : {0, 4})
      for (int i = 0; i < 3; ++i) rates.y[c][i] -= s.load_factor * points_.gravity[i];
    if (s.v && cell.arc.alpha > 0) {
      const arc::SectionPoints<double> v = points_of(cell, *s.v);
      for (int i = 0; i < 8; ++i) arc::add_to(rates.y[i], cell.arc.alpha, v.y[i]);
    }
    auto of_points = momenta_of(cell, rates);
    if (!line.empty()) {
      const auto loads = line[k].at(points_of(cell, *s.left));
      for (int i = 0; i < 8; ++i) of_points[i] = of_points[i] - loads[i];
    }
    const Mat3 to_axes = s.left->R[points_.modes[modes].body].transpose();
    for (int i = 0; i < 8; ++i) {
      const Vec3 F = to_axes * vec3(of_points[i]);
      if (i % 4 == 0)
        f.segment<3>(6 * (i / 4)) += F;
      else
        f.segment<3>(6 * (i / 4) + 3) += vec3(cell.arc.axis[i / 4][i % 4 - 1]).cross(F);
    }
    for (int e = 0; e < 2; ++e)
      for (int part = 0; part < 2; ++part)
        for (int i = 0; i < 3; ++i) sight.mid.push_back((e == 0 ? -1 : 1) * vec3(cell.arc.axis[e][i]).dot(f.segment<3>(6 * e + 3 * part)));
  }
}

}  // namespace hilo
