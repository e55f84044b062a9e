// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/linear_regions.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "linear/lapack.hpp"
#include "system/collocation.hpp"
#include "system/mode_forces.hpp"
#include "system/strain_rates.hpp"

namespace hilo {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // of Q, or of what is like it

/// A B, or A^T B, by BLAS as in linear/products.
Rows times(const Eigen::MatrixXd& A, const Rows& B, char transposed = 'N') {
  const auto m = static_cast<int>(A.rows()), n = static_cast<int>(A.cols());
  Rows out(transposed == 'T' ? n : m, 3);
  lapack::multiply(transposed, m, n, 1., A.data(), m, B.data(), static_cast<int>(B.rows()), 0., out.data(), static_cast<int>(out.rows()),
                   3);
  return out;
}

/// The coordinates of a region: centre, directors, products of its modes.
Rows rows_of(const Modes& m, const Config& q) {
  Rows out(4 + 3 * m.n_modes, 3);
  out.row(0) = q.c[m.body].transpose();
  out.middleRows(1, 3) = q.R[m.body].transpose();
  for (int j = 0; j < m.n_modes; ++j) out.middleRows(4 + 3 * j, 3) = q.Y[3 * m.first + j].transpose();
  return out;
}

double amplitude(const Modes& m, const Config& q, int j) { return q.eta[m.first + j / 3][j % 3]; }
Eigen::VectorXd amplitudes(const Modes& m, const Config& q) {
  Eigen::VectorXd out(m.n_modes);
  for (int j = 0; j < m.n_modes; ++j) out[j] = amplitude(m, q, j);
  return out;
}

Vec3 row(const Rows& rows, Eigen::Index i) { return rows.row(i).transpose(); }

/// What the forces F add to the tangent, dF/dQ1 = A.
void add_inertia_tangent(const Eigen::MatrixXd& A, const Modes& m, const Stage& s, const Rows& F, ModeForces::Matrix& K) {
  const Mat3 &R = s.end->R[m.body], left = left_turn(s, m.body);
  const Rows Ql = rows_of(m, *s.left);
  Rows Q1 = rows_of(m, *s.end);
  Q1.row(0).setZero();  // turns leave the centre
  const Rows W = times(A, Q1);
  const auto n = static_cast<Eigen::Index>(F.rows());
  K.topLeftCorner<3, 3>().diagonal().array() += A(0, 0);
  K.block<3, 3>(0, 3) -= skew(row(W, 0));
  Vec3 arm = Vec3::Zero();
  for (Eigen::Index i = 1; i < n; ++i) {
    arm += A(i, 0) * row(Ql, i);
    K.block<3, 3>(3, 3) += s.slope * skew(row(F, i)) * skew(row(Q1, i)) - skew(row(Ql, i)) * skew(row(W, i));
  }
  K.block<3, 3>(3, 0) += skew(arm);
  // A seen through directors: B_rj = sum_l A_r,(j l) R e_l, a vector for every row and mode
  const Rows AQl = times(A, Ql, 'T');
  for (int j = 0; j < m.n_modes; ++j) {
    const Eigen::Index at = 6 + j;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Index jk = 4 + 3 * j + k;
      const Vec3 Rk = R.col(k), lk = left.col(k), Fk = row(F, jk);
      K.block<3, 1>(0, at) += A(0, jk) * Rk;
      K.block<1, 3>(at, 0) += A(jk, 0) * lk.transpose();
      // moment: sum_r Q_r x A_r,jk R e_k, less what turns with the centre alone; and the turn of the left rows
      K.block<3, 1>(3, at) += (row(AQl, jk) - A(0, jk) * row(Ql, 0)).cross(Rk) + s.slope * Rk.cross(Fk);
      K.block<1, 3>(at, 3) += (row(W, jk).cross(lk) + s.slope * lk.cross(R * (left.transpose() * Fk))).transpose();
    }
  }
  const Mat3 D = left.transpose() * R;
  for (int j = 0; j < m.n_modes; ++j)
    for (int i = 0; i < m.n_modes; ++i) K(6 + j, 6 + i) += D.cwiseProduct(A.block<3, 3>(4 + 3 * j, 4 + 3 * i)).sum();
}

/// Elastic force of a region that stiffens at a stage that shares its step with others (system/collocation).
Eigen::VectorXd force_along(const LinearRegion& r, const Modes& m, const Stage& s, Eigen::MatrixXd* slope) {
  const Collocation& step = *s.step;
  std::array<Eigen::VectorXd, Collocation::n> slopes, ways;
  Eigen::VectorXd eta0 = amplitudes(m, *step.start), eta1 = eta0, out = eta0;
  for (int j = 0; j < Collocation::n; ++j) {
    const Eigen::VectorXd before = amplitudes(m, *step.before[j]), after = amplitudes(m, *step.after[j]), at = (before + after) / 2;
    slopes[j] = r.strain.force(at, at, 1, j == s.member ? slope : nullptr);
    ways[j] = after - before;
    eta1 += step.b[j] * ways[j];
  }
  out = slopes[s.member];
  complete(r.strain.force(eta0, eta1, 0.5, nullptr), slopes, ways, r.stiffness, step, s.member, out);
  return out;
}

/// Changes of the amplitudes over the steps before that dissipation recalls.
Eigen::VectorXd recalled(const Modes& m, const Dissipation& d, const Config& from, double last, double before) {
  const Eigen::VectorXd one = amplitudes(m, *d.one);
  return last * (amplitudes(m, from) - one) + before * (one - amplitudes(m, *d.two));
}

/// Times h: of the rate terms on the amplitudes.  `slope`, where it is wanted: its derivative by those of the end.
Eigen::VectorXd viscous_force(const LinearRegion& r, const Modes& m, const Stage& s, Eigen::MatrixXd* slope = nullptr) {
  if (!(s.h > 0)) return Eigen::VectorXd::Zero(m.n_modes);
  const Eigen::VectorXd eta0 = amplitudes(m, *s.w0), eta1 = amplitudes(m, *s.w1);
  if (r.strain.used() && r.viscous.size() > 0) return rate_force(r.viscous, eta0, eta1, s.slope0(), s.slope1(), slope);
  if (r.viscous.size() == 0) return Eigen::VectorXd::Zero(m.n_modes);
  if (slope) *slope = (s.slope1() - s.slope0()) * r.viscous;
  return r.viscous * (eta1 - eta0);
}

}  // namespace

Traits LinearRegions::traits() const { return {.deforms = !regions.empty(), .has_rates = !regions.empty()}; }

std::string LinearRegions::count() const {
  int modes = 0;
  for (const Modes& m : points_.modes) modes += m.n_modes;
  return regions.empty() ? "" : fmt::format("{} linear regions with {} modes", regions.size(), modes);
}

std::string LinearRegions::owner(int block) const {
  for (const Modes& m : points_.modes)
    if (block >= m.block && block < m.block + m.n_blocks)
      return fmt::format("mode {} of region \"{}\"", 3 * (block - m.block) + 1, points_.bodies[m.body].name);
  return "";
}

void LinearRegions::evaluate(Pass& p) const {
  const Stage& s = p.s;
  for (const LinearRegion& r : regions) {
    const Modes& m = points_.modes[r.modes];
    if (!points_.counts(m.body)) continue;
    Rows a = rows_of(m, *s.a);
    a.row(0) -= (points_.gravity * s.load_factor).transpose();
    Rows F = times(r.A, a);
    const Rows Ql = rows_of(m, *s.left);
    const bool brakes = r.A_damped.size() > 0 && s.v;
    if (brakes) F += times(r.A_damped, rows_of(m, *s.v));
    const Mat3 left = left_turn(s, m.body);
    p.body[m.body].head<3>() += row(F, 0);
    for (Eigen::Index i = 1; i < F.rows(); ++i) p.body[m.body].tail<3>() += row(Ql, i).cross(row(F, i));
    p.scale(std::max(row(F, 0).norm(), r.A(0, 0) * points_.gravity.norm()));
    const double rate = s.h > 0 ? 1 / s.h : 0;
    Eigen::MatrixXd slope_of_viscous;
    const Eigen::VectorXd viscous = rate * viscous_force(r, m, s, p.K ? &slope_of_viscous : nullptr), eta0 = amplitudes(m, *s.e0),
                          eta1 = amplitudes(m, *s.e1);
    Eigen::VectorXd elastic = Eigen::VectorXd::Zero(m.n_modes);
    Eigen::MatrixXd slope_of_elastic;
    if (!s.rates_alone) {
      if (p.K) slope_of_elastic.setZero(m.n_modes, m.n_modes);
      if (r.strain.used() && s.step) {
        elastic = force_along(r, m, s, p.K ? &slope_of_elastic : nullptr);
      } else if (r.strain.used()) {
        elastic = r.strain.force(eta0, eta1, s.weight, p.K ? &slope_of_elastic : nullptr);
      } else {
        elastic = r.stiffness.cwiseProduct((1 - s.weight) * eta0 + s.weight * eta1);
        if (p.K) slope_of_elastic.diagonal() = s.weight * r.stiffness;
      }
      if (const Dissipation* d = s.dissipation) {
        elastic += d->kappa * r.stiffness.cwiseProduct(eta1 - eta0 - recalled(m, *d, *s.e0, d->last(), d->before()));
        if (p.K) slope_of_elastic.diagonal() += d->kappa * r.stiffness;
      }
    }
    for (int j = 0; j < m.n_modes; ++j) {
      double f = 0;
      for (int k = 0; k < 3; ++k) f += left.col(k).dot(row(F, 4 + 3 * j + k));
      p.out.r[3 * m.block + j] += f + elastic[j] + viscous[j];
      p.scale(std::abs(elastic[j]) / m.lever[j / 3]);
    }
    for (int j = m.n_modes; j < 3 * m.n_blocks && !s.rates_alone; ++j)  // of blocks that are not full
      p.out.r[3 * m.block + j] += p.sigma * amplitude(m, *s.end, j);
    if (!p.K) continue;
    ModeForces tangent(m, p);
    auto& K = tangent.tangent();
    Eigen::MatrixXd slope = s.mass_slope * r.A;
    if (brakes) slope += s.alpha_slope * r.A_damped;
    add_inertia_tangent(slope, m, s, F, K);
    if (!s.rates_alone) K.block(6, 6, m.n_modes, m.n_modes) += s.chain * slope_of_elastic;
    if (slope_of_viscous.size() > 0) K.block(6, 6, m.n_modes, m.n_modes) += rate * slope_of_viscous;
    for (Eigen::Index j = 6 + m.n_modes; j < K.rows() && !s.rates_alone; ++j) K(j, j) = p.sigma;
    tangent.finish();
  }
}

void LinearRegions::add_energy(const Config& q, const Config& v, Energy& sum) const {
  for (const LinearRegion& r : regions) {
    const Modes& m = points_.modes[r.modes];
    if (!points_.counts(m.body)) continue;
    const Rows Q = rows_of(m, q), V = rows_of(m, v), P = times(r.A, V);
    sum.kinetic += V.cwiseProduct(P).sum() / 2;
    sum.momentum += row(P, 0);
    for (Eigen::Index i = 0; i < P.rows(); ++i) sum.angular += row(Q, i).cross(row(P, i));
    sum.gravity -= points_.gravity.dot(row(Rows(r.A.row(0) * Q), 0));
    const Eigen::VectorXd eta = amplitudes(m, q);
    sum.elastic += r.strain.used() ? r.strain.energy(eta) : r.stiffness.dot(eta.cwiseAbs2()) / 2;
  }
}

void LinearRegions::add_work(const Moment& moment, Work& sum) const {
  const Stage& s = moment.s;
  for (const LinearRegion& r : regions) {
    const Modes& m = points_.modes[r.modes];
    if (!points_.counts(m.body)) continue;
    sum.add(s, [&](const Config& from, const Config& to, double last, double before) {
      const Eigen::VectorXd step = amplitudes(m, to) - amplitudes(m, from);
      return r.stiffness.cwiseProduct(step).dot(step - recalled(m, *s.dissipation, from, last, before));
    });
    const Eigen::VectorXd viscous = viscous_force(r, m, s);
    for (int j = 0; j < m.n_modes && s.h > 0; ++j)
      sum.dissipated += s.share() * viscous[j] * (amplitude(m, *s.w1, j) - amplitude(m, *s.w0, j)) / s.h;
    if (r.A_damped.size() > 0 && s.v)
      sum.dissipated += times(r.A_damped, rows_of(m, *s.v)).cwiseProduct(rows_of(m, *s.end) - rows_of(m, s.from())).sum();
  }
}

/// Linear strains know no stiffening by axial force: beyond the first frequency a region that spins would run away.  What turns sections is
/// exact to the first power of the turn without stiffening, to the third with it.
void LinearRegions::commit(const Config& q, const Config* v) {
  told_.resize(regions.size(), 0);
  of_run_.resize(regions.size());
  for (size_t k = 0; k < regions.size(); ++k) {
    const LinearRegion& r = regions[k];
    const Modes& m = points_.modes[r.modes];
    if (m.n_modes == 0) continue;
    const std::string& name = points_.bodies[m.body].name;
    const auto tell = [&](int what, const std::string& text) {
      constexpr std::ptrdiff_t named = 3;  // regions
      if (!(told_[k] & what) && points_.comm->rank == 0) {
        const auto before = std::ranges::count_if(told_, [&](char t) { return (t & what) != 0; });
        if (before < named) warn(name, text);
        if (before == named)
          warn("", "more linear regions leave the range of their strains: beyond_linear of run.json lists them at the end");
      }
      told_[k] = static_cast<char>(told_[k] | what);
    };
    const Eigen::VectorXd u = r.sites * amplitudes(m, q);
    double most = 0;
    for (Eigen::Index i = 0; i < u.size(); i += 3) most = std::max(most, u.segment<3>(i).norm());
    of_run_[k].bend = std::max(of_run_[k].bend, most);
    if (most > bend_limit(k))
      tell(2, fmt::format("bends by {:.2g} of its length: {}", most,
                          m.stiffens ? "beyond 0.05 modes with stiffening are off by more than a few per cent (tag it nonlinear)"
                                     : fmt::format("beyond 0.0125 linear modes are off by more than a few per cent ({}{})",
                                                   m.of_beams ? "" : "stiffening is good for four times as much: ", m.better())));
    if (m.stiffens || !v) continue;
    const Mat3 S = v->R[m.body] * q.R[m.body].transpose();
    const double spin = Vec3(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1)).norm() / 2, first = std::sqrt(r.stiffness[0]);
    of_run_[k].spin = std::max(of_run_[k].spin, spin / first);
    if (spin >= first)
      too_fast_ = fmt::format("linear region \"{}\" spins with {:.3g} rad/s, its first frequency is {:.3g} rad/s: {}", name, spin, first,
                              m.better());
    if (spin >= spin_limit * first)
      tell(1, fmt::format("spins with {:.3g} rad/s, a share of {:.2g} of its first frequency: linear strains do not stiffen ({})", spin,
                          spin / first, m.better()));
  }
}

std::string LinearRegions::fault(const Config&) const { return too_fast_; }

void LinearRegions::tie(Ties& ties) const {
  for (const LinearRegion& r : regions)
    if (const int body = points_.modes[r.modes].body; points_.body_block[body] >= 0) ties.exclude(body);
}

std::vector<Output> LinearRegions::outputs() const {
  std::vector<Output> out;
  for (const LinearRegion& r : regions) {
    const Modes& m = points_.modes[r.modes];
    if (m.n_modes > 0)  // a rigid beam has none
      out.push_back({.group = "modes", .name = points_.bodies[m.body].name, .n_end = m.n_modes});
    out.push_back({.group = "left_out", .name = points_.bodies[m.body].name, .n_mid = 2});
  }
  return out;
}

void LinearRegions::observe(const Sight& at) {
  of_run_.resize(regions.size());
  for (size_t k = 0; k < regions.size(); ++k) {
    const LinearRegion& r = regions[k];
    const Modes& m = points_.modes[r.modes];
    for (int j = 0; j < m.n_modes; ++j) at.end.push_back(amplitude(m, at.q, j));
    if (!at.step) continue;
    const Moment& moment = *at.step;
    const Eigen::VectorXd eta = amplitudes(m, *moment.s.end);
    const Eigen::VectorXd a = moment.a ? amplitudes(m, *moment.a) : Eigen::VectorXd(Eigen::VectorXd::Zero(m.n_modes));
    const double energy = r.strain.used() ? r.strain.energy(eta) : r.stiffness.dot(eta.cwiseAbs2()) / 2;
    const double left_out = std::max(0.0, a.dot(r.left_out * a) / 2);
    OfRun& run = of_run_[k];
    run.energy = std::max(run.energy, energy), run.left_out = std::max(run.left_out, left_out);
    if (const double h = moment.s.t_end - run.t; h > 0 && run.a.size() == static_cast<size_t>(a.size())) {
      const Eigen::VectorXd change = a - Eigen::Map<const Eigen::VectorXd>(run.a.data(), a.size());
      run.loads += h * left_out, run.rates += std::max(0.0, change.dot(r.left_out * change) / 2) / h;
    }
    run.a.assign(a.begin(), a.end()), run.t = moment.s.t_end;
    at.mid.push_back(energy), at.mid.push_back(left_out);
  }
}

double LinearRegions::lacking(size_t k) const {
  return k < of_run_.size() && of_run_[k].energy > 0 ? std::sqrt(of_run_[k].left_out / of_run_[k].energy) : 0;
}

double LinearRegions::inertia(size_t k, const Moment& moment) const {
  const LinearRegion& r = regions[k];
  Rows a = Rows::Zero(r.A.rows(), 3);
  if (moment.a) a = rows_of(points_.modes[r.modes], *moment.a);
  a.row(0) -= (points_.gravity * moment.s.load_factor).transpose();
  return std::sqrt(a.cwiseProduct(times(r.A, a)).sum() / r.A(0, 0));
}

double LinearRegions::load_band(size_t k) const {
  if (k >= of_run_.size() || !(of_run_[k].loads > 0) || !(regions[k].held_frequency > 0)) return 0;
  return std::sqrt(of_run_[k].rates / of_run_[k].loads) / (2 * std::numbers::pi * regions[k].held_frequency);
}

}  // namespace hilo
