// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/coordinates.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {

/// Forces along coordinates as forces along measures; `change`: of these forces by each measure at the end.
void OnCoordinates::spread(const RowLaw::Gradient& g, const Response& along, const Slopes& change, Response& out) const {
  out.energy += along.energy, out.dissipated += along.dissipated, out.supplied += along.supplied;
  for (int r = 0; r < coordinates_->n_rows(); ++r)
    for (int i = 0; i < max_measures; ++i) {
      const double d = g.d[r][i];
      out.s[i] += along.s[r] * d;
      out.by_load[i] += along.by_load[r] * d;
      for (int j = 0; j < max_measures; ++j) out.D[i][j] += along.s[r] * g.D[r][i][j] + d * change[r][j];
    }
}

/// D dx/de, added.
void OnCoordinates::add_change(const std::array<Values, max_measures>& D, const Slopes& coordinates_by_measures, Slopes& change) const {
  const int n = coordinates_->n_rows();
  for (int r = 0; r < n; ++r)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < max_measures; ++j) change[r][j] += D[r][k] * coordinates_by_measures[k][j];
}

void OnCoordinates::elastic(const Values& e0, const Values& e1, Response& out) const {
  Values x0{}, x1{};
  coordinates_->values(e0, x0.data()), coordinates_->values(e1, x1.data());
  Response along;
  law_->elastic(x0, x1, along);
  spread_step(e0, e1, along, out);
}

void OnCoordinates::spread_step(const Values& e0, const Values& e1, const Response& along, Response& out) const {
  RowLaw::Gradient g, at_end;
  coordinates_->gradient(e0, e1, g), coordinates_->gradient(e1, e1, at_end);
  Slopes change{};
  add_change(along.D, at_end.d, change);
  spread(g, along, change, out);
}

void OnCoordinates::viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const {
  Values x0{}, x1{};
  Response along;
  if (!step.is_instant) {
    coordinates_->values(r0, x0.data()), coordinates_->values(r1, x1.data());
    law_->viscous(x0, x1, step, along);
    return spread_step(r0, r1, along, out);
  }
  Values at{};
  for (int i = 0; i < max_measures; ++i) at[i] = (r0[i] + r1[i]) / 2;
  RowLaw::Gradient g;
  coordinates_->gradient(at, at, g);
  coordinates_->values(at, x0.data()), x1 = x0;
  Slopes turn{};  // of half the way of the coordinates, as their gradients turn
  for (int r = 0; r < coordinates_->n_rows(); ++r)
    for (int i = 0; i < max_measures; ++i) {
      const double way = r1[i] - r0[i];
      x0[r] -= g.d[r][i] * way / 2, x1[r] += g.d[r][i] * way / 2;
      for (int j = 0; j < max_measures; ++j) turn[r][j] += g.D[r][i][j] * way / 2;
    }
  Interval back = step;
  back.h = -step.h;
  Response other;  // D by x0
  law_->viscous(x0, x1, step, along), law_->viscous(x1, x0, back, other);
  Slopes change{};
  auto both = along.D;
  for (int r = 0; r < max_measures; ++r)
    for (int k = 0; k < max_measures; ++k) both[r][k] -= other.D[r][k];
  add_change(along.D, g.d, change), add_change(both, turn, change);
  spread(g, along, change, out);
}

void OnCoordinates::commit(const Values& e, const Values& rate) {
  coordinates_->commit(e);
  RowLaw::Gradient g;
  coordinates_->gradient(e, e, g);
  Values x{}, v{};
  coordinates_->values(e, x.data());
  for (int r = 0; r < coordinates_->n_rows(); ++r)
    for (int i = 0; i < max_measures; ++i) v[r] += g.d[r][i] * rate[i];
  law_->commit(x, v);
}

void Length::values(const Values& e, double* x) const { x[0] = std::sqrt(std::max(e[0], 0.0)); }

/// (l1 - l0)/(l1^2 - l0^2) = 1/(l0 + l1).
void Length::gradient(const Values& e0, const Values& e1, Gradient& out) const {
  const double l1 = std::sqrt(std::max(e1[0], 1e-300)), sum = std::sqrt(std::max(e0[0], 1e-300)) + l1;
  out.clear(n_rows());
  out.d[0][0] = 1 / sum;
  out.D[0][0][0] = -1 / (sum * sum) / (2 * l1);
}

namespace {

struct Linear final : SpringLaw {
  Values k{}, c{}, free{};
  size_t n;
  Linear(const std::vector<double>& k_, const std::vector<double>& c_, const std::vector<double>& free_) : n(k_.size()) {
    std::copy(k_.begin(), k_.end(), k.begin()), std::copy(c_.begin(), c_.end(), c.begin());
    std::copy(free_.begin(), free_.end(), free.begin());
  }
  void elastic(const Values& x0, const Values& x1, Response& out) const override {
    for (size_t i = 0; i < n; ++i) {
      out.s[i] += k[i] * ((x0[i] + x1[i]) / 2 - free[i]);
      out.D[i][i] += k[i] / 2;
      out.energy += k[i] / 2 * (x1[i] - free[i]) * (x1[i] - free[i]);
    }
  }
  void viscous(const Values& x0, const Values& x1, const Interval& step, Response& out) const override {
    for (size_t i = 0; i < n; ++i) {
      const double rate = (x1[i] - x0[i]) / step.h;
      out.s[i] += c[i] * rate;
      out.D[i][i] += c[i] / step.h;
      out.dissipated += c[i] * rate * rate * step.h;
    }
  }
  bool conserves() const override { return c == Values{}; }
  bool is_smooth() const override { return true; }
};

}  // namespace

std::unique_ptr<SpringLaw> make_linear(std::vector<double> k, std::vector<double> c, std::vector<double> free) {
  return std::make_unique<Linear>(k, c, free);
}

}  // namespace hilo
