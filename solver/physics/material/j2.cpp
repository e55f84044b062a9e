// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/material/j2.hpp"

#include <algorithm>

#include "physics/material/log_strain.hpp"

namespace hilo {
namespace {

Mat3 tensor(const double v[6], double shear) {
  Mat3 m;
  m << v[0], shear * v[5], shear * v[4], shear * v[5], v[1], shear * v[3], shear * v[4], shear * v[3], v[2];
  return m;
}
Mat3 deviator(const Mat3& m) { return m - m.trace() / 3 * Mat3::Identity(); }
Mat3 sym(const Mat3& m) { return (m + m.transpose()) / 2; }
double dot(const Mat3& a, const Mat3& b) { return a.cwiseProduct(b).sum(); }
Mat3 hooke(const Lame& c, const Mat3& h) { return c.lambda * h.trace() * Mat3::Identity() + 2 * c.mu * h; }

/// What flows in a step, from the trial state.
struct Flow {
  double q_trial = 0, Dp = 0, total = 1;  // total: -d(residual)/dDp, so dDp = dq_trial/total
  Mat3 N = Mat3::Zero();                  // unit direction of dev T - X
  Mat3 Dh = Mat3::Zero();
};

Flow flow(const J2& m, const Mat3& trial, const Mat3& X, double p0, double elapsed) {
  Flow f;
  const Mat3 xi = deviator(trial) - X;
  const double size = xi.norm(), stiff = 3 * m.c.mu + m.kinematic;
  f.q_trial = std::sqrt(1.5) * size;
  double slope;
  if (!(elapsed > 0) || !(f.q_trial > m.hardened(p0, slope))) return f;
  f.N = xi / size;
  // r(Dp) = q_trial - stiff Dp - s(p0 + Dp) (1 + (Dp/(rate elapsed))^(1/exponent)) falls; Newton's method within its bracket
  double low = 0, high = f.q_trial / stiff;
  double Dp = 0;
  for (int it = 0; it < 200; ++it) {
    const double s = m.hardened(p0 + Dp, slope), x = Dp / (m.rate * elapsed);  // 0 where rates do not count
    const double v = x > 0 ? std::pow(x, 1 / m.exponent) : 0;
    const double r = f.q_trial - stiff * Dp - s * (1 + v);
    f.total = stiff + slope * (1 + v) + (x > 0 ? s * v / (m.exponent * Dp) : 0);
    (r > 0 ? low : high) = Dp;
    if (std::abs(r) <= 1e-16 * f.q_trial) break;
    double next = Dp + r / f.total;
    if (Dp == 0 && std::isfinite(m.rate) && std::isfinite(elapsed) && m.exponent > 1) next = high / 2;  // the slope at 0 is infinite
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (next == Dp || high - low <= 1e-16 * high) break;
    Dp = next;
  }
  f.Dp = Dp;
  f.Dh = std::sqrt(1.5) * Dp * f.N;
  return f;
}

}  // namespace

double J2::hardened(double p, double& slope) const {
  if (strain.empty()) {
    const double rest = (saturation - yield) * std::exp(-saturation_rate * p);
    slope = hardening + saturation_rate * rest;
    return saturation_rate > 0 ? saturation + hardening * p - rest : yield + hardening * p;
  }
  const size_t i = static_cast<size_t>(std::upper_bound(strain.begin(), strain.end(), p) - strain.begin());
  if (i == strain.size()) return slope = 0, stress.back();
  slope = (stress[i] - stress[i - 1]) / (strain[i] - strain[i - 1]);
  return stress[i - 1] + slope * (p - strain[i - 1]);
}

void J2::respond(PointStep& step) const {
  const Lame at_point{c.lambda - step.mean, c.mu};
  Mat3 g, I = Mat3::Identity();
  for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = step.h0[i];
  const Mat3 G = I + g, a0 = tensor(step.h0 + 9, 1), X = 2. / 3 * kinematic * a0, plastic = (g + g.transpose() + g.transpose() * g) / 2;
  const double p0 = step.h0[15];
  const auto strain_of = [&](const double* e) { return Mat3(sym(G.transpose() * tensor(e, 0.5) * G) + plastic); };
  const Mat3 E1 = strain_of(step.e1);
  const LogStrain at1(E1, step.D);
  const Mat3& h1 = at1.value();
  const Mat3 trial = hooke(at_point, h1);
  const Flow f = flow(*this, trial, X, p0, step.elapsed);
  const Mat3 he = h1 - f.Dh, a1 = a0 + f.Dh;
  step.energy = at_point.lambda / 2 * he.trace() * he.trace() + c.mu * he.squaredNorm() + kinematic / 3 * a1.squaredNorm();
  if (step.h1) {
    Mat3 G1 = g;
    if (f.Dp > 0) G1 = G * (at1.power(-1) * exponential(he)) - I;
    for (int i = 0; i < 9; ++i) step.h1[i] = G1(i / 3, i % 3);
    const double a[6] = {a1(0, 0), a1(1, 1), a1(2, 2), a1(1, 2), a1(0, 2), a1(0, 1)};
    std::copy(a, a + 6, step.h1 + 9);
    step.h1[15] = p0 + f.Dp;
  }
  if (!step.s && !(step.elapsed > 0)) return;
  const double mu = c.mu, six = std::sqrt(6.0) * mu;
  // d(2 mu Dh) = A[dh]
  const double along = f.Dp > 0 ? 3 * mu * 2 * mu / f.total : 0, across = f.Dp > 0 ? six * f.Dp * 2 * mu * std::sqrt(1.5) / f.q_trial : 0;
  const auto A = [&](const Mat3& y) {
    const double n = dot(f.N, y);
    return Mat3(across * (deviator(y) - n * f.N) + along * n * f.N);
  };
  const auto put = [&](const Mat3& S) {
    const Mat3 P = G * S * G.transpose();
    const double s[6] = {P(0, 0), P(1, 1), P(2, 2), (P(1, 2) + P(2, 1)) / 2, (P(0, 2) + P(2, 0)) / 2, (P(0, 1) + P(1, 0)) / 2};
    return Vec6(Eigen::Map<const Vec6>(s));
  };
  const auto tangent = [&](const auto& slope) {
    for (int k = 0; k < 6; ++k) {
      double unit[6] = {};
      unit[k] = 1;
      const Vec6 column = put(slope(Mat3(sym(G.transpose() * tensor(unit, 0.5) * G))));
      for (int i = 0; i < 6; ++i) step.D[6 * i + k] = column[i];
    }
  };
  const auto store = [&](const Mat3& S) {
    if (step.s) Eigen::Map<Vec6>(step.s) = put(S);
  };
  if (!step.conserving) {
    const Mat3 T = trial - 2 * mu * f.Dh;
    double slope;
    step.dissipated = (hardened(p0, slope) + f.q_trial - (3 * mu + kinematic) * f.Dp) / 2 * f.Dp;
    store(at1.Q(T));
    if (!step.D) return;
    const auto second = at1.second(T);
    return tangent([&](const Mat3& x) {
      const Mat3 y = at1.Q(x);
      return Mat3(at1.Q(hooke(at_point, y) - A(y)) + at1.L(second, x));
    });
  }
  const Mat3 E0 = strain_of(step.e0), dE = E1 - E0;
  const LogStrain at0(E0);
  double slope;
  const double q_start = std::max(std::sqrt(1.5) * (deviator(hooke(at_point, at0.value())) - X).norm(), hardened(p0, slope));
  step.dissipated = (q_start + f.q_trial - (3 * mu + kinematic) * f.Dp) / 2 * f.Dp;
  if (!step.s && !step.D) return;
  const LogStep elastic(at0, at1, at_point, step.D);
  if (!(f.Dp > 0)) {
    store(elastic.stress());
    if (step.D) tangent([&](const Mat3& x) { return elastic.slope(x); });
    return;
  }
  const double d2 = dE.squaredNorm();
  const Mat3 Q1dE = at1.Q(dE), muDh = mu * f.Dh, Q1muDh = at1.Q(muDh);
  const double flowing = (f.q_trial - q_start) / 2 * f.Dp - dot(muDh, Q1dE), k = d2 > 0 ? -flowing / d2 : 0;
  store(elastic.stress() - Q1muDh + k * dE);
  if (!step.D) return;
  const auto flow_1 = at1.second(muDh);
  Mat3 dk = Mat3::Zero();
  if (d2 > 0) {
    const double by_q = f.Dp / 2 + (f.q_trial - q_start) / (2 * f.total);
    const Mat3 by_flow = by_q * six * at1.Q(f.N) - at1.L(flow_1, dE) - Q1muDh - at1.Q(A(Q1dE)) / 2;
    dk = -(by_flow + 2 * k * dE) / d2;
  }
  tangent([&](const Mat3& x) { return Mat3(elastic.slope(x) - at1.L(flow_1, x) - at1.Q(A(at1.Q(x))) / 2 + k * x + dot(dk, x) * dE); });
}

}  // namespace hilo
