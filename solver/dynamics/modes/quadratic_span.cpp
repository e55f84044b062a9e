// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/quadratic_span.hpp"

#include <algorithm>

#include "linear/eigen_pairs.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;

/// The root of m s^2 + c s + k next to s: off by the square of what the shapes are off; s itself where it is of another kind.
Complex polished(Complex m, Complex c, Complex k, Complex s) {
  const Complex root = std::sqrt(c * c - 4.0 * m * k), far = -(c + (std::real(std::conj(c) * root) < 0 ? -root : root)) / 2.0;
  Complex best = s;
  double least = 1e-3 * std::abs(s);
  for (const Complex& r : {far / m, k / far})
    if (std::abs(r - s) < least && (r.imag() == 0) == (s.imag() == 0)) best = r, least = std::abs(r - s);
  return best;
}

void add_column(Eigen::MatrixXd& to, const Eigen::VectorXd& v) {
  to.conservativeResize(v.size(), to.cols() + 1);
  to.rightCols(1) = v;
}

}  // namespace

// With s = u (1 + 1/t), u = sqrt(shift), t^2 (u^2 M + u C + K) + t u (C + 2 u M) + u^2 M is as good where M is singular: its infinite poles
// have t = 0.
Poles poles_of(Eigen::MatrixXd M, Eigen::MatrixXd C, const Eigen::MatrixXd& K, double shift) {
  const Index n = M.rows();
  const double u = std::sqrt(shift);
  const Eigen::PartialPivLU<Eigen::MatrixXd> first(shift * M + u * C + K);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -first.solve(shift * M), A.bottomRightCorner(n, n) = -first.solve(u * C + 2 * shift * M);
  A = (A.array().abs() < 1e-15).select(0, A);  // what is rounding beside one would be scaled up where there is no mass
  const EigenPairs all = eigen_pairs(std::move(A));
  const bool is_symmetric = (C - C.transpose()).isZero(0) && (K - K.transpose()).isZero(0);
  Eigen::MatrixXcd left;
  if (!is_symmetric) left = first.inverse().transpose() * all.vectors.fullPivLu().inverse().rightCols(n).transpose();
  Poles out;
  out.shape.resize(n, 2 * n), out.left.resize(n, 2 * n);
  for (Index i = 0; i < 2 * n; ++i) {
    const Complex t = all.values[i];
    if (t.imag() > 0 || std::abs(t) < (t.imag() == 0 ? 1e-11 : 1e-7)) continue;
    const Eigen::VectorXcd y = all.vectors.col(i).head(n).normalized(), z = is_symmetric ? y : left.col(i).normalized();
    const auto with = [&](const Eigen::MatrixXd& of) { return (z.transpose() * (of * y)).value(); };
    const auto at = static_cast<Index>(out.value.size());
    out.shape.col(at) = y, out.left.col(at) = z;
    out.value.push_back(polished(with(M), with(C), with(K), u * (1.0 + 1.0 / t)));
  }
  out.shape.conservativeResize(n, static_cast<Index>(out.value.size())), out.left.conservativeResize(n, out.shape.cols());
  out.error.assign(out.value.size(), 0);
  out.M = std::move(M), out.C = std::move(C);
  return out;
}

QuadraticSpan::QuadraticSpan(const Linearized& at, double shift, const std::vector<FoundMode>& modes, Forces forces)
    : at_(at),
      shift_(shift),
      forces_(std::move(forces)),
      m_(std::ssize(modes)),
      V_(at.n(), m_),
      SV_(at.n(), m_),
      MV_(at.n(), m_),
      CV_(at.n(), m_),
      of_modes_(m_),
      sign_(m_) {
  for (Index j = 0; j < m_; ++j) {
    const FoundMode& mode = modes[static_cast<size_t>(j)];
    const double omega2 = mode.is_rigid ? 0 : mode.figures.omega2, size = omega2 + shift, unit = 1 / std::sqrt(std::abs(size));
    sign_[j] = std::copysign(1, size), of_modes_[j] = unit * unit;
    V_.col(j) = unit * Eigen::Map<const Vector>(mode.x.data(), at.n());
    MV_.col(j) = at.mass(V_.col(j)), SV_.col(j) = size * MV_.col(j);
    add_column(mu_, unit * Eigen::Map<const Vector>(mode.mu.data(), std::ssize(mode.mu)));
    const auto [Cv, Dv] = forces_(V_.col(j));
    CV_.col(j) = Cv, add_column(DV_, Dv);
  }
}

/// What is beside the modes in K + shift M is so in M.
Eigen::MatrixXd QuadraticSpan::mass() const {
  Matrix M = V_.transpose() * MV_;
  M = ((M + M.transpose()) / 2).eval();
  M.topRows(m_).setZero(), M.leftCols(m_).setZero();
  M.diagonal().head(m_) = of_modes_;
  return M;
}
Eigen::MatrixXd QuadraticSpan::damping() const {
  const Matrix C = V_.transpose() * CV_;
  return DV_.rows() > 0 ? C : Matrix((C + C.transpose()) / 2);
}
Eigen::MatrixXd QuadraticSpan::stiffness() const {
  Matrix K = -shift_ * mass();
  K.diagonal() += sign_;
  if (DV_.rows() > 0) K += V_.transpose() * DV_;
  return K;
}
Poles QuadraticSpan::of_modes(Index n) const {
  return poles_of(mass().topLeftCorner(n, n), damping().topLeftCorner(n, n), stiffness().topLeftCorner(n, n), shift_);
}

/// What of w is beside the span joins it.
void QuadraticSpan::extend(Vector w, Vector Sw, Vector mu) {
  const double before = std::abs(w.dot(Sw));
  for (int twice = 0; twice < 2; ++twice) {
    const Vector share = sign_.asDiagonal() * (SV_.transpose() * w);
    w -= V_ * share, Sw -= SV_ * share, mu -= mu_ * share;
  }
  const double size = w.dot(Sw);
  if (!(std::abs(size) > 1e-12 * before) || !(before > 0)) return;
  const double unit = 1 / std::sqrt(std::abs(size));
  w *= unit;
  const auto [Cw, Dw] = forces_(w);
  add_column(V_, w), add_column(SV_, unit * Sw), add_column(mu_, unit * mu), add_column(MV_, at_.mass(w));
  add_column(CV_, Cw), add_column(DV_, Dw);
  sign_.conservativeResize(V_.cols());
  sign_[V_.cols() - 1] = std::copysign(1, size);
}

Poles QuadraticSpan::settle(const std::function<std::vector<size_t>(const Poles&)>& wanted) {
  constexpr double enough = 2e-6;
  constexpr int passes = 12, most_stale = 3;
  constexpr Index most_more = 200;
  Poles best;
  double least = 0;
  for (int pass = 0, stale = 0;; ++pass) {
    const Matrix K = stiffness();
    Poles poles = poles_of(mass(), damping(), K, shift_);
    const Matrix &M = poles.M, &C = poles.C;
    struct Answer {
      Vector x, force;
      std::vector<double> mu;
    };
    std::vector<Answer> more;
    double digits = 0;  // that are missing, of all of them
    for (const size_t i : wanted(poles)) {
      const Complex p = poles.value[i];
      auto y = poles.shape.col(static_cast<Index>(i));
      const double whole = std::max({(p * p * (M * y)).norm(), (p * (C * y)).norm(), (K * y).norm()});
      const Eigen::MatrixXcd Q = p * p * M + p * C + K;
      if ((Q * y).norm() > 1e-2 * enough * whole) {  // strong dampers push on what hardly moves, which is to have all its digits
        const Eigen::VectorXcd again = Q.partialPivLu().solve(2.0 * p * (M * y) + C * y).normalized();
        if ((Q * again).norm() < (Q * y).norm()) y = again;
      }
      Eigen::VectorXcd left = MV_ * ((p * p - shift_) * y) + CV_ * (p * y) + SV_ * y;
      if (DV_.rows() > 0) left += DV_ * y;
      double size = 0;
      std::vector<Answer> of_pole;
      for (const bool imaginary : {false, true}) {
        if (imaginary && !poles.swings(i)) continue;
        Answer a{{}, imaginary ? Vector(left.imag()) : Vector(left.real()), {}};
        at_.solve(a.force, a.x, &a.mu);
        size += a.x.dot(a.force);
        of_pole.push_back(std::move(a));
      }
      const double off = poles.error[i] = std::sqrt(std::abs(size)) / whole;  // not a number remains one
      if (off < enough) continue;
      digits += std::isfinite(off) ? std::log10(off / enough) : 300;
      std::ranges::move(of_pole, std::back_inserter(more));
    }
    const bool is_better = pass == 0 || digits < least - 0.3;
    stale = is_better ? 0 : stale + 1;
    if (is_better) best = std::move(poles), least = digits;
    if (more.empty() || stale == most_stale || pass == passes || V_.cols() > m_ + most_more) return best;  // what does not fall is rounding
    const Index before = V_.cols();
    for (Answer& a : more) extend(std::move(a.x), std::move(a.force), Eigen::Map<const Vector>(a.mu.data(), std::ssize(a.mu)));
    if (V_.cols() == before) return best;
  }
}

}  // namespace hilo
