// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/extrapolation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hilo {
namespace {

struct Rule {
  int n;               // steps it takes
  double weight[6]{};  // of the last step, the one before, ...
};
constexpr Rule rules[] = {{0},
                          {1, {1}},
                          {2, {2, -1}},
                          {3, {1, 1, -1}},
                          {3, {3, -3, 1}},
                          {4, {2, 0, -2, 1}},
                          {4, {4, -6, 4, -1}},
                          {5, {3, -2, -2, 3, -1}},
                          {6, {4, -5, 0, 5, -4, 1}}};

double square(double x) { return x * x; }

/// What rule r makes of the last values, the last one first.
template <int r>
double value(const double* x) {
  double sum = 0;
  for (int k = 0; k < rules[r].n; ++k) sum += rules[r].weight[k] * x[k];
  return sum;
}

}  // namespace

std::span<const double> Extrapolation::increments(const System& system, double h) {
  if (past_.empty()) return {};
  if (std::abs(h - h_) > 1e-6 * h_) {  // an error of second order in the step
    past_.resize(1);
    for (double& x : past_[0].missed) x *= square(h / h_);
    h_ = h, rule_ = std::min(rule_, 1), lambda_rule_ = 1;
  }
  if (rules[rule_].n == 0) return {};
  increments_.assign(3 * system.n_blocks(), 0.0);
  for (int k = 0; k < rules[rule_].n; ++k)
    if (const double w = rules[rule_].weight[k]; w != 0)
      for (size_t i = 0; i < past_[k].missed.size(); ++i) increments_[i] += w * past_[k].missed[i];
  return increments_;
}

std::vector<double> Extrapolation::multipliers(const std::vector<double>& last) const {
  if (past_.empty() || rules[lambda_rule_].n < 2) return last;
  std::vector<double> out(last.size(), 0.0);
  for (int k = 0; k < rules[lambda_rule_].n; ++k)
    for (size_t i = 0; i < out.size(); ++i) out[i] += rules[lambda_rule_].weight[k] * past_[k].lambda[i];
  return out;
}

void Extrapolation::accept(const System& s, double h, std::vector<double> missed, std::vector<double> lambda) {
  static_assert(std::size(rules) == n_rules && std::ranges::max(rules, {}, &Rule::n).n == most && std::size(Rule{}.weight) == most);
  if (!past_.empty() && std::abs(h - h_) > 1e-6 * h_) clear();
  h_ = h;
  // errors that the rules would have made, of positions and of multipliers
  std::array<double, 2 * n_rules> error{};
  const int n_past = static_cast<int>(past_.size());
  const double* at[most] = {};
  const auto add = [&](double* sum, const double* now, int i, double weight) {
    double x[most] = {};
    for (int k = 0; k < n_past; ++k) x[k] = at[k][i];
    [&]<int... r>(std::integer_sequence<int, r...>) { ((sum[r] += weight * square(now[i] - value<r>(x))), ...); }
    (std::make_integer_sequence<int, n_rules>());
  };
  for (int k = 0; k < n_past; ++k) at[k] = past_[k].missed.data();
  for (const UnknownField& f : s.unknowns)
    for (size_t i = 0; i < f.size(); ++i)
      for (int k = 0; k < 3 && s.owns(f.block(i)); ++k) add(error.data(), missed.data(), 3 * f.block(i) + k, square(f.scale(i)));
  for (int k = 0; k < n_past; ++k) at[k] = past_[k].lambda.data();
  for (size_t i = 0; i < lambda.size() && s.comm->rank == 0; ++i) add(error.data() + n_rules, lambda.data(), static_cast<int>(i), 1);
  s.comm->sum(error);
  rule_ = 0, lambda_rule_ = 1;
  for (int r = 0; r < n_rules && rules[r].n <= static_cast<int>(past_.size()); ++r) {
    if (error[r] < error[rule_]) rule_ = r;
    if (r > 0 && error[n_rules + r] < error[n_rules + lambda_rule_]) lambda_rule_ = r;
  }
  if (past_.empty()) rule_ = 1;
  past_.push_front({std::move(missed), std::move(lambda)});
  if (past_.size() > most) past_.pop_back();
}

}  // namespace hilo
