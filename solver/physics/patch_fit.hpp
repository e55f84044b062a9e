// SPDX-License-Identifier: GPL-3.0-or-later
// A polynomial through the stresses at the points of a patch of cells, by least squares [zienkiewicz-zhu-1992].
//
//   p(X) = c + l.eta + k q.(Q(eta) - Q_mean),   eta = G (X - X_mean),   Q = (e1^2, e2^2, e3^2, sqrt2 e2 e3, sqrt2 e1 e3, sqrt2 e1 e2)
//
// G makes the patch round: it is the inverse root of the second moments of its cells.  A patch one cell deep, or of one cell, does not
// determine all of l and q.  Q is made orthogonal to 1 and eta over the points, and only eigenvectors of what is left that stand well above
// zero are used, of l first, then of q: constant and linear stress come out exactly from any patch, and nothing is divided by a small
// number.  What l leaves open is filled by a slope given from elsewhere (the assumed strains of the one-point hexahedron).
//
// k is the trust in the curvature, 1 - 8 r but not below 0, with r the share of the squared deviation from the linear fit that the
// quadratic one leaves.  Where cells resolve the stress r falls with the square of their size; where they do not, or where the data are
// rough, the curvature means nothing and would only be carried to the surface.
#pragma once
#include <memory>

#include "base/math.hpp"

namespace hilo {

using Row6 = Eigen::Matrix<double, 1, 6>;

/// p(X_v + y) of the six stresses:  row 0: value, rows 1-3: gradient, rows 4-9: K xx yy zz yz xz xy, p = value + gradient.y + y^T K y.
template <class M>
Vec6 polynomial_at(const M& p, const Vec3& y) {
  Row6 v = p.row(0) + y[0] * p.row(1) + y[1] * p.row(2) + y[2] * p.row(3);
  if (p.rows() > 4)
    v += y[0] * y[0] * p.row(4) + y[1] * y[1] * p.row(5) + y[2] * y[2] * p.row(6) +
         2 * (y[1] * y[2] * p.row(7) + y[0] * y[2] * p.row(8) + y[0] * y[1] * p.row(9));
  return v.transpose();
}

class PatchFit {
 public:
  // Filled in three passes over the points of a patch, y = X - X_v; each pass may be summed over ranks before the next begins.
  static constexpr int n_shape = 14;                               // samples: n, sum y; points everywhere: sum w, sum w y, sum w y y^T
  static int n_moments(int order) { return order == 2 ? 54 : 9; }  // sum b, sum b b^T, b = (eta, Q)
  static int n_sums(int order) { return order == 2 ? 61 : 42; }    // sum s, sum b s, sum s^2; of order 1: sum s, sum eta s, sum slope
  static int n_rows(int order) { return order == 2 ? 10 : 4; }     // of the polynomial

  static void add_sample(const Vec3& y, double* shape);
  static void add_extent(const Vec3& y, double w, double* shape);
  PatchFit(int order, const double* shape);
  void add_moments(const Vec3& y, double* moments) const;
  void finish(const double* moments);
  void add_stress(const Vec3& y, const Vec6& s, double* sums) const;
  static void add_slope(const Eigen::Matrix<double, 6, 3>& slope, double* sums);
  /// The polynomial about X_v.
  void solve(const double* sums, double* polynomial) const;
  /// How many of its coefficients the patch determines: 4 or 10 where it is complete.
  int rank() const { return rank_; }
  /// How far X_v lies from the middle of the patch, squared, where the patch is round: near 0 inside a region, 2 to 3 on a face of it.
  double off_centre2() const { return (G_ * mean_).squaredNorm(); }

 private:
  Eigen::Matrix<double, 9, 1> basis(const Vec3& y) const;
  int order_, rank_ = 1;
  double n_;
  Vec3 mean_;
  Mat3 G_;
  Mat3 A_, Ai_;  // moments of eta, and their inverse where they stand above zero
  struct Quadratic {
    Eigen::Matrix<double, 6, 3> B;  // moments of Q with eta
    Mat6 Ci;                        // inverse moments of what of Q is not in 1 and eta
    Vec6 mean;
  };
  std::unique_ptr<Quadratic> quadratic_;  // of order 2
};

}  // namespace hilo
