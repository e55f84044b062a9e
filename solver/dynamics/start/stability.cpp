// SPDX-License-Identifier: GPL-3.0-or-later
// A tangent K with eigenvalues below zero: K + s M has none from s = rate^2 of the fastest motion on, which is found by halving, and all
// but singular there, which gives the motion.  The way down adds to K as much of M as leaves no eigenvalue below zero, so that every move
// follows the forces [the Levenberg-Marquardt method]; it takes no energy, so it serves follower forces too.
#include "dynamics/start/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/linear_step.hpp"
#include "dynamics/start/start.hpp"

namespace hilo {

Stage Stability::stage(const Config& q, double mass) {
  combine(zero_, {{0, &q}});
  Stage s = stage_at(q, t_);
  s.a = &zero_, s.load_factor = ramp_, s.elapsed = slow, s.mass_slope = mass, s.fixed_friction = true;
  return s;
}

std::optional<int> Stability::below(const Config& q, const std::vector<double>& lambda, double mass) {
  assemble(system_, solver_, stage(q, mass), lambda, r_, true);
  return solver_.eigenvalues_below_zero(system_.first_joint_block());
}

/// a.b of increments without multipliers, over all ranks.
double Stability::dot(std::span<const double> a, std::span<const double> b) const {
  double sum = 0;
  for (int block = 0; block < system_.first_joint_block(); ++block)
    for (int i = 3 * block; system_.owns(block) && i < 3 * block + 3; ++i) sum += a[i] * b[i];
  return system_.comm->sum(sum);
}

/// z.K z by differences, and how much of it may be round-off.
double Stability::curvature(const Config& q, const std::vector<double>& lambda, const std::vector<double>& z, double* noise) {
  const double step = 1e-5 * system_.length;
  double sum = 0;
  for (const double by : {step, -step}) {
    Config there = q;
    std::vector<double> way = z;
    for (double& x : way) x *= by;
    system_.move(there, way);
    Residual r;
    assemble(system_, solver_, stage(there, 0), lambda, r, false);
    sum += dot(r.r, z) / (2 * by);
    *noise = 1e-9 * r.force_scale / system_.length;
  }
  return sum;
}

std::string Stability::told(const Unstable& u) const {
  std::string text = u.motions == 1 ? "an eigenvalue of the tangent is below zero"
                                    : fmt::format("{} eigenvalues of the tangent are below zero", u.motions);
  if (u.z.empty()) return text;
  double most = 0;
  for (const UnknownField& f : system_.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const Vec3 way = Eigen::Map<const Vec3>(u.z.data() + 3 * f.block(k));
      if (!(way.norm() * f.scale(k) > most)) continue;
      most = way.norm() * f.scale(k);
      const std::string who = system_.owner(f.block(k));
      const Vec3 d = way.normalized();
      text = fmt::format(
          "{}; left alone it grows like exp(t/{:.3g} s), most "
          "of it {} {} ({:.2g}, {:.2g}, {:.2g})",
          text.substr(0, text.find(';')), 1 / std::sqrt(u.rate2), who.empty() ? "a part" : who,
          f.turns() ? "turning about" : "moving along", d[0], d[1], d[2]);
    }
  const Comm& comm = *system_.comm;  // all say what the first rank says that has it
  const double first = -comm.max(most == comm.max(most) ? -comm.rank : -comm.size);
  const std::vector<char> all = comm.gather(comm.rank == first ? std::vector<char>(text.begin(), text.end()) : std::vector<char>());
  return std::string(all.begin(), all.end());
}

std::optional<Unstable> Stability::look(const Config& q, const std::vector<double>& lambda) {
  const std::optional<int> found = below(q, lambda, 0);
  known_ = found.has_value(), factored_ = found == 0 && !system_.traits().slides;
  if (!found || *found == 0) return {};
  Unstable out;
  out.motions = *found;
  const auto resists = [&](double mass) { return below(q, lambda, mass).value_or(1) == 0; };
  if (resists(1e-12)) return {};  // slower than a million seconds
  double low = 1, high = 1;       // [1/s^2]
  if (resists(1)) {
    while (resists(low)) low /= 16;
    high = 16 * low;
  } else {
    while (high < 1e24 && !resists(high)) high *= 16;
    low = high / 16;
  }
  if (high >= 1e24) return out.text = told(out), out;  // what has no mass
  std::vector<double> b(r_.r.size()), z;
  const int n = 3 * system_.first_joint_block();
  const auto find_motion = [&] {  // by the factors of K + high M
    resists(high);
    std::fill(b.begin(), b.end(), 0.0), z.assign(b.size(), 0.0);
    for (int i = 0; i < n; ++i)  // any vector with something of everything
      b[i] = std::cos(static_cast<double>(3 * system_.layout.map.global[i / 3] + i % 3));
    system_.mask_fixed(b);
    for (int pass = 0; pass < 3; ++pass) {
      if (!solver_.solve(b, z).ok) return false;
      double size = 0;
      for (const UnknownField& f : system_.unknowns)
        for (size_t k = 0; k < f.size(); ++k) size = std::max(size, Eigen::Map<const Vec3>(z.data() + 3 * f.block(k)).norm() * f.scale(k));
      size = system_.comm->max(size);
      for (int i = 0; i < n; ++i) z[i] /= size;
      std::fill(z.begin() + n, z.end(), 0.0);
      for (const UnknownField& f : system_.unknowns)  // forces that go with it
        for (size_t k = 0; k < f.size(); ++k)
          for (int i = 3 * f.block(k); i < 3 * f.block(k) + 3; ++i) b[i] = z[i] * f.scale(k) * f.scale(k);
    }
    return true;
  };
  double noise = 0;
  const auto grows = [&] { return curvature(q, lambda, z, &noise) < -noise; };
  const auto enclose = [&](double within) {
    while (high > within * low) {
      const double mid = std::sqrt(low * high);
      (resists(mid) ? high : low) = mid;
    }
  };
  enclose(1.2);
  // What slides has no stiffness along its way, and holds where it turns back: a first look at the motion tells.
  if (system_.traits().slides && find_motion() && !grows()) return {};
  enclose(1 + 1e-4);
  if (!find_motion()) return out.text = told(out), out;
  if (!grows()) return {};
  out.z = z, out.rate2 = high, out.text = told(out);
  return out;
}

void Stability::tell_unknown(const std::string& solver) {
  fmt::print(
      stderr,
      "stability was not examined: the eigenvalues of the tangent are not counted by solver {} here (\"light\" and \"direct\" count them, "
      "unless a motion has no stiffness at all)\n",
      solver);
}

std::optional<Stability::Way> Stability::descend(const Unstable& from, double side, const Config& q, const std::vector<double>& lambda,
                                                 bool mechanism, const NewtonOptions& options) {
  Way at{q, lambda, 0, {}};
  std::vector<double> z = from.z;
  for (double& x : z) x *= side * 1e-2 * system_.length;
  const int n = 3 * system_.first_joint_block();
  const auto work = [&](std::span<const double> way) { return dot(r_.r, way) / 2; };
  double mass = 2 * from.rate2;
  for (int it = 0; it < 300; ++it) {
    system_.move(at.q, z);
    system_.commit(at.q);
    const std::optional<int> wrong = below(at.q, at.lambda, 0);
    if (!std::isfinite(r_.force_scale) || r_.least_det.det <= 0) return {};
    at.work += work(z);
    if (wrong == 0 && it % 4 == 0) {
      Way end = at;
      if (equilibrium(system_, solver_, end.q, end.lambda, t_, ramp_, mechanism, options).converged) {
        assemble(system_, solver_, stage(at.q, 0), at.lambda, r_, false);
        end.work += work(Unknown(system_, at.q, end.q).increments(system_));
        if (system_.largest_difference(end.q, q) > 1e-4 * system_.length && !look(end.q, end.lambda)) return end;
      }
      system_.commit(at.q);
    }
    while (below(at.q, at.lambda, mass).value_or(0) > 0) mass *= 4;
    std::vector<double> b(r_.r.size());
    for (size_t i = 0; i < b.size(); ++i) b[i] = -r_.r[i];
    z.assign(b.size(), 0.0);
    if (!solver_.solve(b, z).ok) return {};
    const double size = system_.comm->max(relative_correction(system_, z)), share = std::min(1.0, 0.1 / size);
    for (double& x : z) x *= share;
    for (size_t i = 0; i < at.lambda.size(); ++i) at.lambda[i] += r_.sigma * z[n + i];
    at.work += work(z);
    mass = std::max(mass / 2, 1e-6 * from.rate2);
  }
  return {};
}

bool Stability::leave(const Unstable& from, Config& q, std::vector<double>& lambda, bool mechanism, const NewtonOptions& options) {
  if (from.z.empty()) return false;
  system_.commit(q);
  const Kept before = system_.memory();
  std::optional<Way> best;
  for (const double side : {1.0, -1.0}) {
    std::optional<Way> way = descend(from, side, q, lambda, mechanism, options);
    if (way && (!best || way->work < best->work)) best = std::move(way), best->memory = system_.memory();
    system_.recall(before);
  }
  if (best) q = best->q, lambda = best->lambda, system_.recall(best->memory);
  system_.commit(q);
  return best.has_value();
}

}  // namespace hilo
