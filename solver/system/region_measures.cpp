// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/region_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "base/table.hpp"
#include "system/welds.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr Index most_motions = 8;                        // that are looked at for buckling, softest first
constexpr double least_share = 0.02, without_end = 1e3;  // below and at a buckling load
constexpr double same_pose = 0.1;                        // in which supports are taken as they were [rad, 1]
enum class Told { at_end, when_it_was };

Vector amplitudes(const Modes& m, const Config& q) {
  Vector out(m.n_modes);
  for (int j = 0; j < m.n_modes; ++j) out[j] = q.eta[m.first + j / 3][j % 3];
  return out;
}

/// Where the other bodies are, as a region sees them.
std::vector<double> pose_of(const System& system, int body, const Config& q) {
  std::vector<double> out;
  for (size_t b = 1; b < system.bodies.size(); ++b) {
    const Mat3 R = q.R[body].transpose() * q.R[b];
    const Vec3 c = q.R[body].transpose() * (q.c[b] - q.c[body]) / system.length;
    out.insert(out.end(), R.data(), R.data() + 9), out.insert(out.end(), c.data(), c.data() + 3);
  }
  return out;
}

/// Largest u at which the unit matrix and K_sigma u are singular together, and the same of the opposite stress   (n n x m)
std::array<double, 2> largest_shares(const Matrix& stress, const Vector& eta) {
  const auto n = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(stress.rows()))));
  if (n == 0) return {0, 0};
  const Vector entries = -stress * eta;
  const Matrix K = entries.reshaped(n, n);
  const Vector u = Eigen::SelfAdjointEigenSolver<Matrix>((K + K.transpose()) / 2, Eigen::EigenvaluesOnly).eigenvalues();
  return {std::max(0.0, u[n - 1]), std::max(0.0, -u[0])};
}

/// The symmetric matrix whose entries i <= j are those of a row of pairs.
Matrix square(const Eigen::Ref<const Vector>& pairs, Index n) {
  Matrix out(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i <= j; ++i) out(i, j) = out(j, i) = pairs[QuadraticStrain::pair(i, j)];
  return out;
}

}  // namespace

RegionMeasures::Region& RegionMeasures::region(size_t k, const Config& q) {
  Region& out = regions_[k];
  const LinearRegion& r = system_.part<LinearRegions>().regions[k];
  const Modes& m = system_.modes[r.modes];
  std::vector<double> pose = pose_of(system_, m.body, q);
  const auto moved = [&] {
    if (pose.size() != out.pose.size()) return true;
    for (size_t i = 0; i < pose.size(); ++i)
      if (!(std::abs(pose[i] - out.pose[i]) < same_pose)) return true;
    return false;
  };
  if (!moved()) return out;
  out.pose = std::move(pose);
  const RegionSupport support = support_of(system_, r, q);
  const Index S = r.soft.cols(), n = 3 + S, modes = m.n_modes;
  out.held = Matrix(r.soft.transpose() * r.stiffness.asDiagonal() * r.soft).inverse() - support.compliance;
  out.compliance = support.compliance;
  if (out.second_order.size() == 0) {
    const Matrix forces = r.soft.transpose() * r.second_order.topRows(modes);
    out.second_order.resize(S, S * (S + 1) / 2);
    for (Index j = 0; j < S; ++j)
      for (Index i = 0; i <= j; ++i)
        out.second_order.col(QuadraticStrain::pair(i, j)) = (i == j ? 0.5 : 1) * forces.col(QuadraticStrain::pair(3 + i, 3 + j));
  }
  // the motions that a stress alike in all directions would soften most
  if (support.free.cols() == 0) {  // nothing of it can give way
    out.stress.setZero(0, modes), out.axes.setZero(0, modes);
    return out;
  }
  const Matrix unit = support.free.transpose() * square(r.second_order.row(modes).transpose(), n) * support.free;
  const Eigen::SelfAdjointEigenSolver<Matrix> softness(unit);
  const Index motions = std::min(most_motions, unit.cols());
  const Matrix softest = support.free * softness.eigenvectors().rightCols(motions);
  out.stress.resize(motions * motions, modes), out.axes = out.stress;
  for (Index j = 0; j < modes; ++j) {
    Matrix K = square(r.second_order.row(j).transpose(), n);
    const Matrix all = softest.transpose() * K * softest;
    K.bottomRightCorner(S, S).setZero();
    const Matrix axes = softest.transpose() * K * softest;
    out.stress.col(j) = all.reshaped(), out.axes.col(j) = axes.reshaped();
  }
  return out;
}

void RegionMeasures::archive(Archive& a) {
  if (a.is_aside) return;
  a("region measures");
  std::vector<std::vector<double>> kept(regions_.size());
  for (size_t k = 0; k < regions_.size(); ++k) {
    Region& r = regions_[k];
    for (const Peak* p : r.peaks()) kept[k].push_back(p->value), kept[k].push_back(p->t);
    kept[k].push_back(r.t);
    kept[k].insert(kept[k].end(), r.rate.begin(), r.rate.end());
    r.pose.clear();  // supports are found anew on either side
  }
  a("peaks", kept);
  if (!a.restores()) return;
  regions_.assign(kept.size(), {});
  for (size_t k = 0; k < regions_.size(); ++k) {
    const double* at = kept[k].data();
    for (Peak* p : regions_[k].peaks()) p->value = *at++, p->t = *at++;
    regions_[k].t = *at++;
    regions_[k].rate.assign(at, static_cast<const double*>(kept[k].data() + kept[k].size()));
  }
}

/// The acceleration of C f, in the norm of mass [m kg^0.5/s^2], by the change of df/dt over the step; 0 where there is no step before.
double RegionMeasures::shortening(Region& at, double t, const Vector& s, const Vector& speed) {
  Vector pairs(at.second_order.cols());
  for (Index j = 0; j < s.size(); ++j)
    for (Index i = 0; i <= j; ++i) pairs[QuadraticStrain::pair(i, j)] = s[i] * speed[j] + s[j] * speed[i];
  const Vector rate = at.second_order * pairs;
  const bool goes_on = t > at.t && at.rate.size() == static_cast<size_t>(rate.size());
  const double out = goes_on ? (at.compliance * (rate - Eigen::Map<const Vector>(at.rate.data(), rate.size()))).norm() / (t - at.t) : 0;
  at.rate.assign(rate.begin(), rate.end()), at.t = t;
  return out;
}

std::vector<Output> RegionMeasures::outputs() const {
  std::vector<Output> out;
  for (const LinearRegion& r : system_.part<LinearRegions>().regions)
    out.push_back({.group = "second_order", .name = system_.bodies[system_.modes[r.modes].body].name, .n_end = 3});
  return out;
}

/// On all ranks the same.
void RegionMeasures::look_at_stress(const Sight& seen) {
  if (of_shapes_) return;
  if (!stress_) stress_.emplace(system_);
  if (!stress_->has_metal()) return;
  std::vector<double> most(regions_.size(), 0.0);
  for (size_t k = 0; k < regions_.size(); ++k)
    most[k] = stress_->largest(k, seen.q, amplitudes(system_.modes[system_.part<LinearRegions>().regions[k].modes], seen.q),
                               regions_[k].over_yield.value);
  system_.comm->max(most);
  for (size_t k = 0; k < regions_.size(); ++k) regions_[k].over_yield.look(most[k], seen.t);
}

void RegionMeasures::observe(const Sight& seen) {
  const auto& linear = system_.part<LinearRegions>();
  const double t = seen.t;
  std::vector<double>& out = seen.end;
  regions_.resize(linear.regions.size());
  look_at_stress(seen);
  for (size_t k = 0; k < regions_.size(); ++k) {
    const LinearRegion& r = linear.regions[k];
    const Modes& m = system_.modes[r.modes];
    if (seen.step) regions_[k].inertia.look(linear.inertia(k, *seen.step), t);
    if (m.n_modes == 0 || system_.body_block[m.body] < 0) {
      out.insert(out.end(), {0.0, 0.0, 1.0});
      continue;
    }
    Region& at = region(k, seen.q);
    const Vector eta = amplitudes(m, seen.q), s = r.soft.transpose() * eta;
    Vector pairs(at.second_order.cols());
    for (Index j = 0; j < s.size(); ++j) pairs.segment(QuadraticStrain::pair(0, j), j + 1) = s[j] * s.head(j + 1);
    const Vector f = at.second_order * pairs;
    const double quadratic = std::max(0.0, f.dot(at.held * f) / 2), energy = r.stiffness.dot(eta.cwiseAbs2()) / 2;
    const auto [share, pull] = largest_shares(at.stress, eta);
    const auto [share_axes, pull_axes] =
        share < least_share && pull < least_share ? std::array<double, 2>{0, 0} : largest_shares(at.axes, eta);
    const double growth = share < least_share ? 1 : share < 1 ? (1 - std::min(share, share_axes)) / (1 - share) : without_end;
    at.energy.look(energy, t), at.quadratic.look(quadratic, t), at.share.look(share, t);
    at.growth.look(growth, t);
    at.tension.look(pull < least_share ? 1 : (1 + pull) / (1 + std::min(pull, pull_axes)), t);
    at.shortening.look(2 * std::numbers::sqrt3 * shortening(at, t, s, r.soft.transpose() * amplitudes(m, seen.v)) / std::sqrt(r.A(0, 0)),
                       t);
    out.push_back(quadratic), out.push_back(share), out.push_back(growth);
  }
}

/// What is told at the end, with what to do; a region that stiffens has strains of the second degree.
void RegionMeasures::add_to_report(Json& run) const {
  constexpr double much_lacking = 0.05, wide_band = 0.5, much_with_band = 0.02, much_quadratic = 0.1, much_growth = 1.1,
                   much_shortening = 0.012, much_for_modes = 1.02;
  const double much = of_modes_ ? much_for_modes : much_growth;
  const auto of_vibrations = [&](const char* shift) {
    return of_modes_ ? fmt::format(", and its frequencies are too {}", shift) : std::string();
  };
  const auto& linear = system_.part<LinearRegions>();
  Table table;
  table.header = {"linear region", "modes lack", "load band", "quadratic strain", "buckling", "tension",
                  "shortening",    "bend",       "spin",      "stress/yield"};
  const char* names[] = {"modes_left_out", "load_band", "quadratic_strain", "buckling", "tension", "shortening",
                         "bend",           "spin",      "stress_over_yield"};
  std::vector<Json> lists(std::size(names), Json::object());
  Json beyond = Json::list();
  struct Beyond {
    double times;  // the limit
    std::string region, text;
  };
  std::map<std::string, std::vector<Beyond>> warnings;  // by measure
  for (size_t k = 0; k < regions_.size(); ++k) {
    const Modes& m = system_.modes[linear.regions[k].modes];
    if (m.n_modes == 0) continue;
    const std::string& name = system_.bodies[m.body].name;
    const Region& r = regions_[k];
    const double lacking = linear.lacking(k), band = linear.load_band(k),
                 quadratic = r.energy.value > 0 ? std::sqrt(r.quadratic.value / r.energy.value) : 0, share = r.share.value,
                 shortening = r.inertia.value > 0 ? r.shortening.value / r.inertia.value : 0;
    auto& row = table.rows.emplace_back(std::vector{name});
    int column = 0;
    for (const double x : {lacking, band, quadratic, share, std::max(1.0, r.tension.value), shortening, linear.bend(k), linear.spin(k),
                           r.over_yield.value}) {
      lists[column++].add(name, {x, 3});
      row.push_back(fmt::format("{:.2g}", x));
    }
    const auto leaves = [&](const char* measure, double value, double limit, double t, const std::string& text, Told told = Told::at_end) {
      if (told == Told::at_end) warnings[measure].push_back({value / limit, name, text});
      beyond.append({{"region", name},
                     {"measure", measure},
                     {"value", {value, 3}},
                     {"limit", {limit, 3}},
                     {"t", t < 0 ? Json(nullptr) : Json(t, 6)},
                     {"said", text}});
    };
    if (lacking > much_lacking)
      leaves("modes_left_out", lacking, much_lacking, -1,
             fmt::format("its modes lack {:.2g} of its largest strain (norm of energy): more modes, up_to a higher frequency, or tag it "
                         "nonlinear",
                         lacking));
    if (band > wide_band && lacking > much_with_band)
      leaves("load_band", band, wide_band, -1,
             fmt::format("what its modes lack is driven at {:.2g} of the first frequency left out, {:.4g} Hz, where it swings along: more "
                         "modes, or up_to a higher frequency",
                         band, linear.regions[k].held_frequency));
    if (linear.bend(k) > linear.bend_limit(k))
      leaves("bend", linear.bend(k), linear.bend_limit(k), -1,
             fmt::format("bends by {:.2g} of its length: more than its modes are good for", linear.bend(k)), Told::when_it_was);
    if (r.over_yield.value > 1)
      leaves("stress_over_yield", r.over_yield.value, 1, r.over_yield.t,
             fmt::format("its von Mises stress is {:.3g} of the yield stress at t = {:.4g} s: a linear region does not yield (tag it "
                         "nonlinear)",
                         r.over_yield.value, r.over_yield.t));
    if (m.stiffens) continue;
    if (linear.spin(k) >= LinearRegions::spin_limit)
      leaves("spin", linear.spin(k), LinearRegions::spin_limit, -1,
             fmt::format("spins with a share of {:.2g} of its first frequency: linear strains do not stiffen", linear.spin(k)),
             Told::when_it_was);
    if (quadratic > much_quadratic)
      leaves("quadratic_strain", quadratic, much_quadratic, r.quadratic.t,
             fmt::format("its supports stretch it as it bends: strains of the second degree are {:.2g} of its strain (norm of energy) at t "
                         "= {:.4g} s, and linear ones leave them out ({})",
                         quadratic, r.quadratic.t, m.better()));
    if (r.growth.value > much)
      leaves("buckling", r.growth.value, much, r.share.t,
             fmt::format("bears {:.2g} of its buckling load at t = {:.4g} s: linear strains leave out that it gives way {}{} ({})", share,
                         r.share.t, share < 1 ? fmt::format("{:.3g} times as far", r.growth.value) : "without end", of_vibrations("high"),
                         m.better()));
    if (r.tension.value > much)
      leaves("tension", r.tension.value, much, r.tension.t,
             fmt::format("is pulled: linear strains leave out that this stiffens it, so that it bends {:.3g} times as far, at t = "
                         "{:.4g} s{} ({})",
                         r.tension.value, r.tension.t, of_vibrations("low"), m.better()));
    if (shortening > much_shortening)
      leaves("shortening", shortening, much_shortening, r.shortening.t,
             fmt::format("bends so fast that its ends come nearer with {:.3g} m/s^2 at t = {:.4g} s, {:.2g} of its largest acceleration: "
                         "linear strains leave this out, and the forces along it that this asks for ({})",
                         r.shortening.value, r.shortening.t, shortening, m.better()));
  }
  if (regions_.empty()) return;
  constexpr size_t shown = 3;  // regions of one measure, the worst ones
  for (auto& [measure, of] : warnings) {
    std::ranges::stable_sort(of, std::greater{}, &Beyond::times);
    for (size_t i = 0; i < std::min(of.size(), shown); ++i) warn(of[i].region, of[i].text);
    if (of.size() > shown)
      warn("", fmt::format("{} linear regions more are beyond the limit of {}: beyond_linear of run.json lists them", of.size() - shown,
                           measure));
  }
  for (size_t i = 0; i < lists.size(); ++i) run.add(names[i], std::move(lists[i]));
  run.add("beyond_linear", std::move(beyond));
  if (!is_quiet()) fmt::print(stderr, "{}", table.text());
}

}  // namespace hilo
