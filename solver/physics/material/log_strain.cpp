#include "physics/material/log_strain.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

/// Eigenvectors (columns of V) and values of a symmetric matrix by Jacobi's rotations: small entries keep their digits.
void principal_axes(Mat3 A, Mat3& V, Vec3& e) {
  V.setIdentity();
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double off = A(0, 1) * A(0, 1) + A(0, 2) * A(0, 2) + A(1, 2) * A(1, 2), size = A.diagonal().squaredNorm();
    if (off <= 1e-34 * size || off < 1e-300) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (A(p, q) == 0) continue;
        const double theta = (A(q, q) - A(p, p)) / (2 * A(p, q));
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1)), c = 1 / std::sqrt(t * t + 1), s = t * c;
        const int r = 3 - p - q;
        const double apq = A(p, q), apr = A(p, r), aqr = A(q, r);
        A(p, p) -= t * apq, A(q, q) += t * apq, A(p, q) = A(q, p) = 0;
        A(p, r) = A(r, p) = c * apr - s * aqr, A(q, r) = A(r, q) = s * apr + c * aqr;
        const Vec3 vp = V.col(p), vq = V.col(q);
        V.col(p) = c * vp - s * vq, V.col(q) = s * vp + c * vq;
      }
  }
  e = A.diagonal();
}

/// phi[a, b] = ln((1 + 2b)/(1 + 2a))/(2 (b - a)) = ln(1 + r)/r/(1 + 2a), r = 2 (b - a)/(1 + 2a)
double first_difference(double a, double b) {
  if (a > b) std::swap(a, b);
  const double l = 1 + 2 * a, r = 2 * (b - a) / l;
  if (r > 1e-3) return std::log1p(r) / r / l;
  return (1 + r * (-1. / 2 + r * (1. / 3 + r * (-1. / 4 + r * (1. / 5 - r / 6))))) / l;
}

/// phi[a, b, c], about the mean m of the three where they are close: phi''(m)/2 (1 + terms of complete symmetric polynomials of x - m).
double second_difference(double a, double b, double c) {
  if (a > c) std::swap(a, c);
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  const double m = (a + b + c) / 3, l = 1 + 2 * m;
  if (c - a > 0.01 * l) return (first_difference(b, c) - first_difference(a, b)) / (c - a);
  const double u = 2 * (a - m) / l, v = 2 * (b - m) / l, w = 2 * (c - m) / l;  // of ln(1 + u): n-th coefficient (-1)^(n+1)/n
  double power[3] = {1, 1, 1}, h[8] = {1};                                     // h_n of (u), (u, v), (u, v, w)
  for (int n = 1; n < 8; ++n) power[0] *= u, power[1] = power[0] + v * power[1], power[2] = power[1] + w * power[2], h[n] = power[2];
  double sum = 0;
  for (int n = 7; n >= 0; --n) sum += h[n] * (n % 2 ? 1. : -1.) / (n + 2);
  return 2 * sum / (l * l);  // half of ln, (2/l)^2 of the arguments
}

}  // namespace

LogStrain::LogStrain(const Mat3& E) {
  principal_axes(E, V_, e_);
  value_.setZero();
  for (int i = 0; i < 3; ++i) {
    value_ += std::log1p(2 * e_[i]) / 2 * V_.col(i) * V_.col(i).transpose();
    for (int j = i; j < 3; ++j) {
      first_(i, j) = first_(j, i) = first_difference(e_[i], e_[j]);
      for (int k = j; k < 3; ++k) {
        const double f = second_difference(e_[i], e_[j], e_[k]);
        third_[i][j][k] = third_[i][k][j] = third_[j][i][k] = third_[j][k][i] = third_[k][i][j] = third_[k][j][i] = f;
      }
    }
  }
}

Mat3 LogStrain::Q(const Mat3& x) const {
  const Mat3 local = V_.transpose() * x * V_;
  return V_ * first_.cwiseProduct(local) * V_.transpose();
}

Mat3 LogStrain::L(const Second& T, const Mat3& x) const {
  const Mat3 local = V_.transpose() * x * V_;
  Mat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += third_[i][j][k] * (local(i, k) * T.T(k, j) + T.T(i, k) * local(k, j));
      out(i, j) = out(j, i) = sum;
    }
  return V_ * out * V_.transpose();
}

Mat3 LogStrain::power(double s) const {
  Mat3 out = Mat3::Zero();
  for (int i = 0; i < 3; ++i) out += std::pow(1 + 2 * e_[i], s / 2) * V_.col(i) * V_.col(i).transpose();
  return out;
}

Mat3 exponential(const Mat3& A) {
  Mat3 V, out = Mat3::Zero();
  Vec3 e;
  principal_axes(A, V, e);
  for (int i = 0; i < 3; ++i) out += std::exp(e[i]) * V.col(i) * V.col(i).transpose();
  return out;
}

}  // namespace hilo
