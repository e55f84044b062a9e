// SPDX-License-Identifier: GPL-3.0-or-later
// The arc element of a beam: two sections, and the strains of the one helix through them.
//
// Measures of degree two (i j k cyclic), of sections A and B with origin c and directors d1 d2 across, d3 along:
//   a_i = (d_kA.d_jB - d_jA.d_kB)/2,   t = sum d_iA.d_iB,   p_i = d_iA.(c_B - c_A)
// With c = (t - 1)/2 = cos(th), f = th/sin(th) and k = (1 - f (1 + c)/2)/(1 - c^2) the strains are the logarithm of the relative motion,
//   K = f a / L,   Gamma = (p - f/2 a x p + k a x (a x p)) / L,   eps = (Gamma, K)
// exact where they are constant.  Fibres along the beam have strains h of second degree in eps (`fibre_strain`), and W = L/2 (h - h_ref)
// C* (h - h_ref): axial forces resist or drive a twist, as do moments of sections without symmetry.  C* = (mean of (1 - s Z)^T C(s)^-1 (1 -
// s Z))^-1, s from the middle, has the compliance of resultants that vary along the element, (n, m)' = -Z (n, m) with Z = [K0x 0; e3x K0x],
// and of a section that does.  The forces s = L D^T H^T C* (mean h - h_ref), D (e1 - e0) = eps1 - eps0 and H (eps1 - eps0) = h1 - h0 to
// round-off, keep energy and momenta.
#pragma once
#include <array>

#include "physics/beam_strain.hpp"
#include "physics/force_law.hpp"

namespace hilo {

/// L times the strains [m, 1].
using ArcStrain = Eigen::Matrix<double, 6, 1>;
ArcStrain arc_strain(const arc::Measures<double>& e);
/// Their rates where the measures change at the rates de.
ArcStrain arc_rate(const arc::Measures<double>& e, const arc::Measures<double>& de);
/// Places along an element, 0 at section A and 1 at B, and weights that sum to 1: Gauss, 4 points.
struct AlongArc {
  double t, weight;
};
inline constexpr std::array<AlongArc, 4> along_arc{{{0.0694318442029737, 0.1739274225687269},
                                                    {0.3300094782075719, 0.3260725774312731},
                                                    {0.6699905217924281, 0.3260725774312731},
                                                    {0.9305681557970263, 0.1739274225687269}}};
/// What half the square of a twist does to fibres that it inclines: the stretch and the bending about 1 and 2 that it counts as [m^2, m],
/// and what it meets beside these [N m^4].
struct TwistedFibres {
  bool known = false;  // otherwise nothing is inclined
  Vec3 counts_as = Vec3::Zero();
  double stiffness = 0;
};
/// Without strain at the measures e.  C at the places along the element (6 x 6) [N, N m, N m^2] by shear along 1 and 2, stretch, bending
/// about 1 and 2, twist.
arc::ArcStiffness<double> arc_stiffness(const arc::Measures<double>& e, const std::array<Mat6, 4>& C, const TwistedFibres& fibres);
/// Slopes of forces and moments by the strains, where nothing is stressed: C*, with what a twist as drawn adds (6 x 6).
Mat6 arc_tangent(const arc::ArcStiffness<double>& of, const ArcStrain& x);
/// Of L times the strains [J].
double arc_energy(const arc::ArcStiffness<double>& of, const ArcStrain& x);
/// What C* (eps1 - eps0 - recalled/L) takes, of L times the strains [J]; without what is recalled it never pays in.
double arc_taken(const arc::ArcStiffness<double>& of, const ArcStrain& x0, const ArcStrain& x1, const ArcStrain& recalled);

class ArcLaw final : public SpringLaw {
 public:
  static constexpr int n_measures = arc::n_measures;  // a, t, p
  static constexpr double largest_turn = 2.5;         // of an element [rad]; at pi the helix is not one
  /// beta [s].
  ArcLaw(const arc::ArcStiffness<double>& of, double beta) : of_(of), beta_(beta) {}
  void elastic(const Values& e0, const Values& e1, Response& out) const override;
  void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const override;
  bool conserves() const override { return beta_ == 0; }
  /// Turn of section B against A [rad]; beyond pi it comes back.
  static double turn(const arc::Measures<double>& e);

 private:
  void add(const Values& e0, const Values& e1, double elastic, double rate, Response& out) const;
  const arc::ArcStiffness<double>& of_;
  double beta_;
};

/// The measures of the arc, of sections at `at` with directors by columns, of a connector whose ends are joined.  Entities are the origins
/// of A and of B, then of each director that of A and that of B.
void add_arc_measures(Connector& c, const Config& q, const Vec3& at_a, const Mat3& frame_a, const Vec3& at_b, const Mat3& frame_b);

}  // namespace hilo
