// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/beam_cells.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace hilo {
namespace {

/// Shares of c, d1, d2, d3 of both ends in points of the axis of an element by itself: use(k, t, shares, ds) at its places along_arc.
template <class Use>
void each_share(const BeamSection& mean, double L, const Use& use) {
  const double phi = 12 / (L * L) * std::max(mean.C(3, 3) / mean.C(1, 1), mean.C(4, 4) / mean.C(0, 0));
  for (size_t k = 0; k < along_arc.size(); ++k) {
    const double t = along_arc[k].t, g = (2 * t * t * t - 3 * t * t + t) / (1 + phi), bow = (t - t * t) / 2;
    Eigen::Matrix<double, 8, 1> u = Eigen::Matrix<double, 8, 1>::Zero();
    u[0] = 1 - t + g, u[4] = t - g, u[3] = L * (g / 2 + bow), u[7] = L * (g / 2 - bow);
    use(k, t, u, along_arc[k].weight * L);
  }
}

/// Linked mass of an element by itself, on c, d1, d2, d3 of both ends.
void set_linked_mass(const SectionsAlong& sections, const BeamSection& mean, double L, arc::ArcCell<double>& cell) {
  for (auto& row : cell.linked)
    for (double& m : row) m = 0;
  each_share(mean, L, [&](size_t k, double, const Eigen::Matrix<double, 8, 1>& u, double ds) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) cell.linked[i][j] += ds * sections[k].mass * u[arc::linked_points[i]] * u[arc::linked_points[j]];
  });
  cell.across[0] = mean.J11 * L / 12, cell.across[1] = mean.J22 * L / 12, cell.across[2] = mean.J12 * L / 12;
}

/// int u (1 - t)^2 ds, int u t (1 - t) ds, int u t^2 ds of the shares u of an element by itself.
BeamCell::Shares shares_across(const BeamSection& mean, double L) {
  BeamCell::Shares out;
  for (auto& column : out) column.setZero();
  each_share(mean, L, [&](size_t, double t, const Eigen::Matrix<double, 8, 1>& u, double ds) {
    out[0] += ds * (1 - t) * (1 - t) * u, out[1] += ds * t * (1 - t) * u, out[2] += ds * t * t * u;
  });
  return out;
}

/// The same of u = 1 - t and t at the origins.
BeamCell::Shares shares_along(double L) {
  BeamCell::Shares out;
  for (auto& column : out) column.setZero();
  out[0][0] = out[2][4] = L / 4;
  out[0][4] = out[1][0] = out[1][4] = out[2][0] = L / 12;
  return out;
}

/// Fibres at r from the axis take half the square of r times a twist; r^2 over the section is what a stretch and bending make of it, and a
/// rest that adds to the stiffness alone.
TwistedFibres twisted_fibres(const BeamSection& s) {
  if (!s.has_fibres) return {};
  const Vec3 on_r2(s.C(3, 3) + s.C(4, 4), s.H2, -s.H1);
  const Mat3 C = s.C.block<3, 3>(2, 2);
  TwistedFibres out{.known = true};
  out.counts_as = C.ldlt().solve(on_r2);
  out.stiffness = std::max(0., s.I4 - on_r2.dot(out.counts_as));
  return out;
}

}  // namespace

BeamSection mean_section(const SectionsAlong& sections) {
  BeamSection out;
  for (size_t k = 0; k < sections.size(); ++k) {
    const double w = along_arc[k].weight;
    const BeamSection& s = sections[k];
    out.C += w * s.C, out.mass += w * s.mass, out.J11 += w * s.J11, out.J22 += w * s.J22, out.J12 += w * s.J12, out.size += w * s.size;
    out.H1 += w * s.H1, out.H2 += w * s.H2, out.I4 += w * s.I4;
    out.has_fibres = s.has_fibres;
  }
  return out;
}

BeamCell beam_cell(const SectionPlace& a, const SectionPlace& b, const Config& q, const SectionsAlong& sections, double beta,
                   double alpha) {
  BeamCell cell;
  cell.body = {a.body, b.body};
  std::array<arc::BodyPose<double>, 2> poses;
  for (int e = 0; e < 2; ++e) {
    const SectionPlace& place = e == 0 ? a : b;
    const Mat3 to_body = q.R[place.body].transpose(), axes = to_body * place.frame;
    const Vec3 arm = to_body * (place.at - q.c[place.body]);
    std::copy_n(arm.data(), 3, cell.arc.arm[e].v);
    std::copy_n(q.c[place.body].data(), 3, poses[e].c.v);
    for (int i = 0; i < 3; ++i) {
      std::copy_n(axes.data() + 3 * i, 3, cell.arc.axis[e][i].v);
      std::copy_n(q.R[place.body].data() + 3 * i, 3, poses[e].R[i].v);
    }
  }
  arc::SectionPoints<double> points;
  arc::points_of(cell.arc, poses.data(), points);
  const BeamSection mean = mean_section(sections);
  std::array<Mat6, 4> C;
  for (size_t k = 0; k < C.size(); ++k) C[k] = sections[k].C;
  cell.arc.law = arc_stiffness(arc::measures_of(points.y), C, twisted_fibres(mean));
  cell.arc.alpha = alpha, cell.arc.beta = beta, cell.size = mean.size;
  set_linked_mass(sections, mean, cell.arc.law.length, cell.arc);
  cell.across = shares_across(mean, cell.arc.law.length), cell.along = shares_along(cell.arc.law.length);
  cell.axis = (b.at - a.at).normalized();
  return cell;
}

std::array<BeamVector, 8> momenta_of(const BeamCell& cell, const arc::SectionPoints<double>& rates) {
  std::array<BeamVector, 8> out{};
  arc::add_inertia(cell.arc, rates.y, out.data());
  return out;
}

double work(const std::array<BeamVector, 8>& F, const arc::SectionPoints<double>& from, const arc::SectionPoints<double>& to) {
  double sum = 0;
  for (int i = 0; i < 8; ++i) sum += arc::dot(F[i], to.y[i] - from.y[i]);
  return sum;
}

std::array<BeamVector, 8> LineForces::at(const arc::SectionPoints<double>& y) const {
  std::array<BeamVector, 8> out;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 3; ++j) out[i][j] = F(i, j);
    for (int j = 0; j < 8; ++j) arc::add_to(out[i], K(i, j), y.y[j]);
  }
  return out;
}

/// Of cell k of the load.
void LineForces::add(const LineLoad& l, size_t k, const BeamCell& cell, double factor) {
  const auto& [a, b] = l.at[k];
  if (!l.load.follower) {
    const auto add = [&](const BeamCell::Shares& of, const Mat3& part) {
      F += factor * ((of[0] + of[1]) * (part * a).transpose() + (of[1] + of[2]) * (part * b).transpose());
    };
    const Mat3 on_axis = cell.axis * cell.axis.transpose();
    add(cell.across, Mat3::Identity() - on_axis), add(cell.along, on_axis);
    return;
  }
  for (int i = 0; i < 3; ++i) {  // (p_A (1 - t) + p_B t) along directors that are linear between the ends
    const BeamCell::Shares& of = i == 2 ? cell.along : cell.across;
    K.col(1 + i) += factor * (a[i] * of[0] + b[i] * of[1]);
    K.col(5 + i) += factor * (a[i] * of[1] + b[i] * of[2]);
  }
}

std::vector<LineForces> line_forces(const std::vector<LineLoad>& lines, const std::vector<BeamCell>& cells, const Stage& s) {
  if (lines.empty()) return {};
  std::vector<LineForces> out(cells.size());
  for (const LineLoad& l : lines) {
    const double factor = l.load.factor(s.t0, s.t1, s.load_factor);
    for (size_t k = 0; k < l.at.size(); ++k) out[l.first + k].add(l, k, cells[l.first + k], factor);
  }
  return out;
}

}  // namespace hilo
