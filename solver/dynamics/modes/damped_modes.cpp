// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/damped_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "dynamics/modes/quadratic_span.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Complex = std::complex<double>;

/// Poles that are one mode: one that swings, two that creep, or one that creeps and has no other.
using Mode = std::vector<size_t>;
/// Product of the two poles, or minus the square of the one that grows; ratio to the critical damping.  Of one that creeps alone its square
/// and 1.
std::pair<double, double> figures_of(const Poles& poles, const Mode& mode) {
  const Complex a = poles.value[mode.front()];
  if (mode.size() == 1 && !poles.swings(mode.front())) return {-a.real() * std::abs(a.real()), a.real() < 0 ? 1 : 0};
  const Complex b = mode.size() == 2 ? poles.value[mode.back()] : std::conj(a);
  const double product = (a * b).real(), sum = (a + b).real();
  if (product > 0) return {product, -sum / (2 * std::sqrt(product))};
  const double grows = std::max(a.real(), b.real());
  return {-grows * grows, 0};
}
double stiffness_of(const Poles& poles, const Mode& mode) { return figures_of(poles, mode).first; }

/// All modes by rising frequency, and the poles that are left: of motions without mass, and how a drift dies away.
struct Listed {
  std::vector<Mode> modes;
  std::vector<size_t> alone;
};
/// A real pole s is the slower or the faster root of its own m s^2 + c s + k, m = x.M x and so on: one of each is a pair, those with the
/// most alike shapes first.  Poles up to `zero` are left out.
Listed listed(const Poles& poles, double zero) {
  const Matrix &M = poles.M, &C = poles.C;
  Listed out;
  std::vector<size_t> slow, fast;
  for (size_t i = 0; i < poles.value.size(); ++i) {
    if (std::abs(poles.value[i]) <= zero) continue;
    const Vector x = poles.shape.col(static_cast<Index>(i)).real();
    if (poles.swings(i))
      out.modes.push_back({i});
    else
      (2 * poles.value[i].real() * x.dot(M * x) + x.dot(C * x) > 0 ? slow : fast).push_back(i);
  }
  std::vector<std::tuple<double, size_t, size_t>> order;
  for (const size_t i : slow)
    for (const size_t j : fast) {
      const Vector x = poles.shape.col(static_cast<Index>(i)).real(), y = poles.shape.col(static_cast<Index>(j)).real();
      order.emplace_back(-std::abs(x.dot(M * y)) / std::sqrt(x.dot(M * x) * y.dot(M * y)), i, j);
    }
  std::ranges::sort(order);
  std::vector<char> taken(poles.value.size(), 0);
  for (const auto& [share, i, j] : order)
    if (!taken[i] && !taken[j]) out.modes.push_back({i, j}), taken[i] = taken[j] = 1;
  for (const auto& of : {slow, fast})
    for (const size_t i : of)
      if (!taken[i]) out.alone.push_back(i);
  std::ranges::sort(out.modes, {}, [&](const Mode& m) { return stiffness_of(poles, m); });
  std::ranges::sort(out.alone, {}, [&](size_t i) { return std::abs(poles.value[i]); });
  return out;
}

/// Of the `rows` that are asked for, the one that has most of each mode.
std::vector<const Mode*> beside(const std::vector<size_t>& rows, const Poles& poles, const std::vector<Mode>& modes) {
  std::vector<std::tuple<double, size_t, size_t>> order;
  for (size_t k = 0; k < rows.size(); ++k)
    for (size_t i = 0; i < modes.size(); ++i)
      order.emplace_back(-std::abs(poles.shape(static_cast<Index>(rows[k]), static_cast<Index>(modes[i].front()))), k, i);
  std::ranges::sort(order);
  std::vector<const Mode*> out(rows.size(), nullptr);
  std::vector<char> taken(modes.size(), 0);
  for (const auto& [share, k, i] : order)
    if (!out[k] && !taken[i]) out[k] = &modes[i], taken[i] = 1;
  return out;
}

}  // namespace

std::vector<std::string> add_damping(std::vector<FoundMode>& modes, const Linearized& at, double shift, size_t wanted) {
  const auto asked = static_cast<Index>(wanted);
  double fastest = 0, zero = 0;
  std::vector<size_t> rows;  // no rigid motions
  for (size_t j = 0; j < modes.size(); ++j) {
    fastest = std::max(fastest, std::abs(modes[j].figures.omega2));
    if (modes[j].is_rigid)
      zero = 1e-6 * std::sqrt(shift);
    else if (j < wanted)
      rows.push_back(j);
  }
  QuadraticSpan span(at, shift, modes, [&](const Vector& x) { return std::pair{at.damping(x), Vector()}; });
  const Vector scale = span.mass().diagonal().cwiseSqrt().cwiseInverse();
  const Matrix C = scale.asDiagonal() * span.damping() * scale.asDiagonal();  // on modes of unit mass
  for (Index j = 0; j < asked; ++j) {
    const auto column = C.col(j).head(asked);
    modes[static_cast<size_t>(j)].figures.coupling.assign(column.begin(), column.end());
  }
  if (!(C.cwiseAbs().maxCoeff() > 1e-12 * std::sqrt(fastest))) return {};

  const auto first_of = [&](const Listed& all) {
    return std::vector(all.modes.begin(), all.modes.begin() + std::min(std::ssize(all.modes), std::ssize(rows)));
  };
  /// Poles that creep, beside the modes of the list and slower than the last of it.
  const auto others_of = [&](const Poles& now, const Listed& all) {
    std::vector<size_t> out = all.alone;
    const auto first = first_of(all);
    for (size_t k = first.size(); k < all.modes.size(); ++k)
      if (all.modes[k].size() == 2) out.push_back(all.modes[k].front());
    const double last = first.empty() ? 0 : std::sqrt(std::abs(stiffness_of(now, first.back())));
    std::erase_if(out, [&](size_t i) { return std::abs(now.value[i]) > last; });
    return out;
  };
  const Poles poles = span.settle([&](const Poles& now) {
    const Listed all = listed(now, zero);
    std::vector<size_t> out = others_of(now, all);
    for (const Mode& mode : first_of(all)) out.insert(out.end(), mode.begin(), mode.end());
    return out;
  });
  const Listed all = listed(poles, zero);
  std::vector<Mode> first = first_of(all);
  for (Mode& mode : first)
    if (mode.size() == 2 && !(poles.error[mode.back()] < most_error)) mode.pop_back();  // it is too fast for these modes
  const auto found = beside(rows, poles, first);
  // what a sum over these modes alone, as a response is, would make of it
  const Poles few = span.of_modes(asked);
  const Listed all_few = listed(few, zero);
  const auto found_few = beside(rows, few, all_few.modes);
  std::vector<std::string> notes;
  double worst = 0;
  std::string what;
  for (size_t k = 0; k < rows.size(); ++k) {
    NaturalMode& f = modes[rows[k]].figures;
    if (!found[k]) {
      f.error = 1;
      continue;
    }
    std::tie(f.pole2, f.damping) = figures_of(poles, *found[k]);
    for (const size_t i : *found[k]) f.error = std::max(f.error, poles.error[i]);
    if (!found_few[k] || f.damping == 1) continue;
    const double there = figures_of(few, *found_few[k]).second, off = std::abs(there - f.damping);
    if (off > worst && off > 1e-3 && off > 0.05 * f.damping)
      worst = off, what = fmt::format(
                       "mode {} has the damping ratio {:.3g}; what sums these modes alone, as hilo-post response does, sees {:.3g}: "
                       "ask for more modes, or run it in time",
                       rows[k] + 1, f.damping, there);
  }
  if (worst > 0) notes.push_back(std::move(what));
  std::string creep;
  for (const size_t i : others_of(poles, all))
    if (poles.error[i] < most_error) creep += fmt::format("{}{:.6g}", creep.empty() ? "" : ", ", poles.value[i].real());
  if (!creep.empty()) notes.push_back("beside the modes listed there are motions that creep, with the poles " + creep + " 1/s");
  return notes;
}

}  // namespace hilo
