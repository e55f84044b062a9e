// SPDX-License-Identifier: GPL-3.0-or-later
// The arc element of a beam: two sections, and the strains of the one helix through them.
//
// Measures of degree two (i j k cyclic), of sections A and B with origin c and directors d1 d2 across, d3 along:
//   a_i = (d_kA.d_jB - d_jA.d_kB)/2,   t = sum d_iA.d_iB,   p_i = d_iA.(c_B - c_A)
// With c = (t - 1)/2 = cos(th), f = th/sin(th) and k = (1 - f (1 + c)/2)/(1 - c^2) the strains are the logarithm of the relative motion,
//   K = f a / L,   Gamma = (p - f/2 a x p + k a x (a x p)) / L,   W = L/2 (eps - eps_ref) C* (eps - eps_ref),   eps = (Gamma, K)
// exact where they are constant.  C* = (C^-1 + L^2/12 Z^T C^-1 Z)^-1 adds the compliance of what varies of the resultants along the
// element, (n, m)' = -Z (n, m) with Z = [K0x 0; e3x K0x].  The forces s = L D^T C* (mean eps - eps_ref), D (e1 - e0) = eps1 - eps0 to
// round-off, keep energy and momenta.
#pragma once
#include "physics/force_law.hpp"

namespace hilo {

class ArcLaw final : public SpringLaw {
 public:
  static constexpr int n_measures = 7;         // a, t, p
  static constexpr double largest_turn = 2.5;  // of an element [rad]; at pi the helix is not one
  using Stiffness = Eigen::Matrix<double, 6, 6>;
  /// Without strain at the measures e.  C (6 x 6) [N, N m, N m^2] by shear along 1 and 2, stretch, bending about 1 and 2, twist; beta [s].
  ArcLaw(const Values& e, const Stiffness& C, double beta);
  double length() const { return L_; }
  void elastic(const Values& e0, const Values& e1, Response& out) const override;
  using Strain = Eigen::Matrix<double, 6, 1>;
  /// L eps [m, 1].
  static Strain strain(const Values& e);
  /// Adds `factor` C* (eps1 - eps0 - recalled/L); without what is recalled [m, 1] it never pays in.
  void resist(const Values& e0, const Values& e1, double factor, const Strain& recalled, Response& out) const;
  void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const override {
    if (beta_ > 0) resist(r0, r1, beta_ / step.h, Strain::Zero(), out);
  }
  bool conserves() const override { return beta_ == 0; }
  /// Turn of section B against A [rad]; beyond pi it comes back.
  static double turn(const Values& e);

 private:
  double L_, beta_;
  Stiffness C_;  // C*
  Eigen::Matrix<double, 6, 1> ref_;
};

/// The measures of the arc, of sections at `at` with directors by columns, of a connector whose ends are joined.
void add_arc_measures(Connector& c, const Config& q, const Vec3& at_a, const Mat3& frame_a, const Vec3& at_b, const Mat3& frame_b);

}  // namespace hilo
