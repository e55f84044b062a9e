// SPDX-License-Identifier: GPL-3.0-or-later
// A polynomial through the stresses at the points of a patch of cells, by least squares [zienkiewicz-zhu-1992].
//
//   p(X) = c + k.(b(eta) - b_mean),   eta = G (X - X_mean),   b = eta, its squares and its cubes, each weighted so that the
//                                                              sum over a degree does not depend on the axes
//
// G makes the patch round: it is the inverse root of the second moments of its cells.  A patch one cell deep, or of one cell, does not
// determine all of k.  Each degree is made orthogonal to those below it over the points, and only eigenvectors of what is left that stand
// well above zero are used: constant and linear stress come out exactly from any patch, and nothing is divided by a small number.  What a
// linear fit leaves open is filled by a slope given from elsewhere (the assumed strains of the one-point hexahedron).
//
// What is above linear is taken by its trust, 1 - 8 r (cubics 1 - 2 r) but not below 0, with r the share of the squared deviation from the
// linear fit that squares and cubes leave.  Where cells resolve the stress r falls with their size; where they do not, or where the data
// are rough, a curvature means nothing and would only be carried to the surface.
#pragma once
#include "base/math.hpp"

namespace hilo {

class PatchFit {
 public:
  static int n_terms(int degree) { return degree == 3 ? 19 : degree == 2 ? 9 : 3; }  // of b
  // Filled in three passes over the points of a patch, y = X - X_v; each pass may be summed over ranks before the next begins.
  static constexpr int n_shape = 14;  // samples: n, sum y; points everywhere: sum w, sum w y, sum w y y^T
  static int n_moments(int degree) { return n_terms(degree) * (n_terms(degree) + 3) / 2; }  // sum b, sum b b^T
  static int n_sums(int degree) {
    return 6 + 6 * n_terms(degree) + (degree == 1 ? 18 : 1);
  }                                                              // sum s, sum b s, sum s^2; of degree 1 sum slope
  static int n_rows(int degree) { return 1 + n_terms(degree); }  // of the polynomial, of six stresses each

  static void add_sample(const Vec3& y, double* shape);
  static void add_extent(const Vec3& y, double w, double* shape);
  PatchFit(int degree, const double* shape);
  void add_moments(const Vec3& y, double* moments) const;
  void finish(const double* moments);
  void add_stress(const Vec3& y, const Vec6& s, double* sums) const;
  static void add_slope(const Eigen::Matrix<double, 6, 3>& slope, double* sums);
  /// The polynomial: c - k.b_mean, then k.  Returns the trust.
  double solve(const double* sums, double* polynomial) const;
  /// Adds weight p(X_v + y).
  void add_at(const double* polynomial, const Vec3& y, double weight, Vec6& to) const;
  /// How many of its coefficients the patch determines: 4, 10 or 20 where it is complete.
  int rank() const { return 1 + static_cast<int>(orthonormal_.rows()); }
  /// How far X_v lies from the middle of the patch, squared, where the patch is round: near 0 inside a region, 2 to 3 on a face of it.
  double off_centre2() const { return (G_ * mean_).squaredNorm(); }

 private:
  using Terms = Eigen::Matrix<double, 19, 1>;
  Terms basis(const Vec3& y) const;
  int degree_, n_linear_ = 0;  // rows of orthonormal_ of degree 1
  double n_;
  Vec3 mean_;
  Mat3 G_, A_;                   // A: moments of eta
  Eigen::VectorXd b_mean_;       // (terms)
  Eigen::MatrixXd orthonormal_;  // (rank - 1 x terms): combinations of b - b_mean that are orthonormal over the points
};

}  // namespace hilo
