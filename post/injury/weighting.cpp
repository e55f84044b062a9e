// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/weighting.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

namespace hilo {
namespace {

/// (b0 s^2 + b1 s + b2)/(s^2 + a1 s + a2)
struct Section {
  double b0, b1, b2, a1, a2;
};

std::vector<Section> sections(const FrequencyWeighting& w) {
  const auto omega = [](double f) { return 2 * std::numbers::pi * f; };
  const double root = std::numbers::sqrt2, w1 = omega(w.f1), w2 = omega(w.f2), w3 = omega(w.f3), w4 = omega(w.f4);
  std::vector<Section> all{
      {1, 0, 0, root * w1, w1 * w1}, {0, 0, w2 * w2, root * w2, w2 * w2}, {0, w4 * w4 / w3, w4 * w4, w4 / w.Q4, w4 * w4}};
  if (w.f5 > 0) {  // numerator and denominator times w6^2; the gain (w5/w6)^2 leaves 1 at high frequency
    const double w5 = omega(w.f5), w6 = omega(w.f6);
    all.push_back({1, w5 / w.Q5, w5 * w5, w6 / w.Q6, w6 * w6});
  }
  return all;
}

/// x' = A x + b u, y = c x + d u of the chain: two states for each section.
struct StateSpace {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
  Eigen::RowVectorXd c;
  double d = 1;
};

StateSpace chain(const std::vector<Section>& all) {
  const auto n = static_cast<Eigen::Index>(2 * all.size());
  StateSpace s{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::RowVectorXd::Zero(n)};
  for (size_t k = 0; k < all.size(); ++k) {  // the input of a section is the output of those before it
    const auto [b0, b1, b2, a1, a2] = all[k];
    const auto i = static_cast<Eigen::Index>(2 * k);
    s.A(i, i + 1) = 1, s.A(i + 1, i) = -a2, s.A(i + 1, i + 1) = -a1;
    s.A.row(i + 1) += s.c, s.b[i + 1] = s.d;
    s.c *= b0, s.d *= b0;
    s.c[i] += b2 - b0 * a2, s.c[i + 1] += b1 - b0 * a1;
  }
  return s;
}

}  // namespace

double weighting_factor(const FrequencyWeighting& w, double frequency) {
  const std::complex<double> s(0, 2 * std::numbers::pi * frequency);
  std::complex<double> H = 1;
  for (const Section& k : sections(w)) H *= (k.b0 * s * s + k.b1 * s + k.b2) / (s * s + k.a1 * s + k.a2);
  return std::abs(H);
}

std::vector<double> weighted(const FrequencyWeighting& w, std::span<const double> t, std::span<const double> a) {
  const StateSpace s = chain(sections(w));
  const Eigen::Index n = s.b.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd step;  // exp of [A b 0; 0 0 1; 0 0 0] h moves (x, u, u' h) over a step
  double h_of_step = -1;
  std::vector<double> y;
  y.reserve(t.size());
  for (size_t i = 0; i < t.size(); ++i) {
    const double h = i > 0 ? t[i] - t[i - 1] : 0;
    if (h > 0) {
      if (std::abs(h - h_of_step) > 1e-12 * h) {
        Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + 2, n + 2);
        M.topLeftCorner(n, n) = s.A * h, M.block(0, n, n, 1) = s.b * h, M(n, n + 1) = 1;
        step = M.exp(), h_of_step = h;
      }
      x = (step.topLeftCorner(n, n) * x + step.block(0, n, n, 1) * a[i - 1] + step.block(0, n + 1, n, 1) * (a[i] - a[i - 1])).eval();
    }
    y.push_back(s.c * x + s.d * a[i]);
  }
  return y;
}

Vibration vibration(std::span<const double> t, std::span<const double> weighted, double window) {
  // integrals of powers of a line between samples, exact
  std::vector<double> square{0};
  double fourth = 0;
  for (size_t i = 1; i < t.size(); ++i) {
    const double h = t[i] - t[i - 1], p = weighted[i - 1], q = weighted[i];
    square.push_back(square.back() + h * (p * p + p * q + q * q) / 3);
    fourth += h * (p * p * p * p + p * p * p * q + p * p * q * q + p * q * q * q + q * q * q * q) / 5;
  }
  Vibration v;
  const double whole = t.empty() ? 0 : t.back() - t.front();
  if (!(whole > 0)) return v;
  v.rms = std::sqrt(square.back() / whole), v.dose = std::pow(fourth, 0.25);
  for (size_t i = 1, first = 0; i < t.size(); ++i) {  // windows that end at a sample and begin at one
    while (t[i] - t[first] > window * (1 + 1e-9)) ++first;
    v.running = std::max(v.running, std::sqrt((square[i] - square[first]) / window));
  }
  return v;
}

}  // namespace hilo
