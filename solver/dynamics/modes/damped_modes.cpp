// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/damped_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "linear/eigen_pairs.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Complex = std::complex<double>;

/// Vectors orthonormal in M, with what K, M and C make of them; K up to forces of joints, which do no work on any of them.
struct Span {
  Matrix V, MV, KV, CV;
  /// What of w is beside the span joins it; (K + shift M) w = f.
  void extend(const Linearized& at, double shift, Vector w, const Vector& f) {
    Vector Mw = at.mass(w);
    const double before = w.dot(Mw);
    Vector Kw = f - shift * Mw;
    for (int twice = 0; twice < 2; ++twice) {
      const Vector share = MV.transpose() * w;
      w -= V * share, Mw -= MV * share, Kw -= KV * share;
    }
    const double size = w.dot(Mw);
    if (!(size > 1e-16 * before) || !(before > 0)) return;
    const double unit = 1 / std::sqrt(size);
    const auto add = [](Matrix& to, const Vector& v) {
      to.conservativeResize(Eigen::NoChange, to.cols() + 1);
      to.rightCols(1) = v;
    };
    add(V, unit * w), add(MV, unit * Mw), add(KV, unit * Kw), add(CV, at.damping(unit * w));
  }
};

/// Poles with their shapes in the span, those that swing with the one of each pair above the axis.
struct Poles {
  std::vector<Complex> pole;
  Eigen::MatrixXcd shape;  // unit columns
  bool swings(size_t i) const { return pole[i].imag() > 0; }
};
Poles poles_of(const Matrix& K, const Matrix& C) {
  const Index n = K.rows();
  const double unit = std::sqrt(std::max(K.cwiseAbs().maxCoeff(), 1e-300));  // of time, so that all entries are of one size
  Matrix A = Matrix::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -K / (unit * unit), A.bottomRightCorner(n, n) = -C / unit;
  const EigenPairs all = eigen_pairs(std::move(A));
  Poles out;
  out.shape.resize(n, 2 * n);
  for (Index i = 0; i < 2 * n; ++i) {
    const Complex p = unit * all.values[i];
    if (p.imag() < 0) continue;
    out.shape.col(static_cast<Index>(out.pole.size())) = all.vectors.col(i).head(n).normalized();
    out.pole.push_back(p);
  }
  out.shape.conservativeResize(Eigen::NoChange, static_cast<Index>(out.pole.size()));
  return out;
}

/// The poles of each mode: one that swings or two real ones, those that have most of it; none of modes that are rigid motions.
std::vector<std::vector<size_t>> match(const Poles& poles, const std::vector<char>& is_rigid) {
  std::vector<std::tuple<double, size_t, size_t>> order;  // share, mode, pole
  for (size_t k = 0; k < is_rigid.size(); ++k)
    for (size_t i = 0; i < poles.pole.size(); ++i)
      order.emplace_back(-std::abs(poles.shape(static_cast<Index>(k), static_cast<Index>(i))), k, i);
  std::sort(order.begin(), order.end());
  std::vector<std::vector<size_t>> out(is_rigid.size());
  std::vector<char> taken(poles.pole.size(), 0);
  for (const auto& [share, k, i] : order) {
    auto& of = out[k];
    if (taken[i] || of.size() == 2 || (!of.empty() && (poles.swings(i) || poles.swings(of[0])))) continue;
    of.push_back(i), taken[i] = 1;
  }
  for (size_t k = 0; k < out.size(); ++k)
    if (is_rigid[k] || (out[k].size() == 1 && !poles.swings(out[k][0]))) out[k].clear();
  return out;
}

/// Product of the pair, or minus the square of the one that grows; ratio to the critical damping.
std::pair<double, double> figures_of(const Poles& poles, const std::vector<size_t>& pair) {
  const Complex a = poles.pole[pair.front()], b = pair.size() == 2 ? poles.pole[pair.back()] : std::conj(a);
  const double product = (a * b).real(), sum = (a + b).real();
  if (product > 0) return {product, -sum / (2 * std::sqrt(product))};
  const double grows = std::max(a.real(), b.real());
  return {-grows * grows, 0};
}

}  // namespace

void add_damping(std::vector<FoundMode>& modes, const Linearized& at, double shift, size_t wanted) {
  constexpr double enough = 2e-6;
  constexpr int passes = 12;
  constexpr Index most_more = 200;
  const auto m = static_cast<Index>(modes.size()), asked = static_cast<Index>(wanted);
  Span span{Matrix(at.n(), m), Matrix(at.n(), m), Matrix(at.n(), m), Matrix(at.n(), m)};
  std::vector<char> is_rigid;
  double fastest = 0;
  for (const FoundMode& mode : modes) fastest = std::max(fastest, std::abs(mode.figures.omega2));
  for (Index j = 0; j < m; ++j) {
    const FoundMode& mode = modes[static_cast<size_t>(j)];
    span.V.col(j) = Eigen::Map<const Vector>(mode.x.data(), at.n());
    span.MV.col(j) = at.mass(span.V.col(j)), span.KV.col(j) = mode.figures.omega2 * span.MV.col(j),
    span.CV.col(j) = at.damping(span.V.col(j));
    is_rigid.push_back(std::abs(mode.figures.omega2) <= 1e-9 * shift);
  }
  const Matrix C = (span.V.transpose() * span.CV + span.CV.transpose() * span.V) / 2;
  for (Index j = 0; j < asked; ++j) {
    const auto column = C.col(j).head(asked);
    modes[static_cast<size_t>(j)].figures.coupling.assign(column.begin(), column.end());
  }
  if (!(C.cwiseAbs().maxCoeff() > 1e-12 * std::sqrt(fastest))) return;

  Poles best;
  std::vector<std::vector<size_t>> best_pairs;
  Vector least;
  for (int pass = 0, stale = 0;; ++pass) {
    const Matrix K = span.V.transpose() * span.KV;
    Poles poles = poles_of((K + K.transpose()) / 2, span.V.transpose() * span.CV);
    auto pairs = match(poles, is_rigid);
    Vector error(asked);
    std::vector<std::pair<Vector, Vector>> more;  // answers of K + shift M to what is left, and that
    error.setZero();
    for (Index j = 0; j < asked; ++j)
      for (const size_t i : pairs[static_cast<size_t>(j)]) {
        const Complex p = poles.pole[i];
        const Eigen::VectorXcd y = poles.shape.col(static_cast<Index>(i));
        const Eigen::VectorXcd left = span.MV * (p * p * y) + span.CV * (p * y) + span.KV * y;
        double size = 0;
        std::vector<std::pair<Vector, Vector>> of_pole;
        for (const Vector& part : {Vector(left.real()), Vector(left.imag())}) {
          Vector x;
          at.solve(part, x);
          size += x.dot(at.mass(x));
          of_pole.emplace_back(std::move(x), part);
        }
        const double off = std::sqrt(std::abs(size));  // not a number remains one
        if (!(off <= error[j])) error[j] = off;
        if (!(off < enough)) std::move(of_pole.begin(), of_pole.end(), std::back_inserter(more));
      }
    const bool is_better = pass == 0 || error.maxCoeff() < least.maxCoeff() / 2;
    stale = is_better ? 0 : stale + 1;
    if (is_better) best = std::move(poles), best_pairs = std::move(pairs), least = error;
    if (more.empty() || stale == 2 || pass == passes || span.V.cols() > m + most_more) break;  // what does not fall is rounding
    const Index before = span.V.cols();
    for (auto& [x, force] : more) span.extend(at, shift, std::move(x), force);
    if (span.V.cols() == before) break;
  }

  // what a sum over these modes alone, as a response is, would make of it
  Matrix K = Matrix::Zero(asked, asked);
  for (Index j = 0; j < asked; ++j) K(j, j) = modes[static_cast<size_t>(j)].figures.omega2;
  const Poles few = poles_of(K, C.topLeftCorner(asked, asked));
  is_rigid.resize(wanted);
  const auto few_pairs = match(few, is_rigid);
  double worst = 0, ratio_here = 0, ratio_there = 0;
  size_t who = 0;
  for (size_t j = 0; j < wanted; ++j) {
    if (best_pairs[j].empty()) continue;
    NaturalMode& f = modes[j].figures;
    std::tie(f.pole2, f.damping) = figures_of(best, best_pairs[j]);
    f.error = std::max(f.error, least[static_cast<Index>(j)]);
    if (few_pairs[j].empty()) continue;
    const double there = figures_of(few, few_pairs[j]).second, off = std::abs(there - f.damping);
    if (off > worst && off > 1e-3 && off > 0.05 * f.damping) worst = off, who = j + 1, ratio_here = f.damping, ratio_there = there;
  }
  if (who > 0)
    warn("modes", fmt::format("mode {} has the damping ratio {:.3g}; what sums these modes alone, as hilo-post response does, sees {:.3g}: "
                              "ask for more modes",
                              who, ratio_here, ratio_there));
}

}  // namespace hilo
