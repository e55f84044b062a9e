// SPDX-License-Identifier: GPL-3.0-or-later
// Orthotropic elasticity in the axes of the material, which turn with the body: W = E:C:E/2, S = C:E of the Green-Lagrange strain.
//
//   compliance in its axes:  E11 = S11/E1 - nu12/E1 S22 - nu13/E1 S33, ...,   2 E23 = S23/G23, 2 E13 = S13/G13, 2 E12 = S12/G12
//
// nu12 is the contraction along 2 of a pull along 1; nu21 = nu12 E2/E1.  Like the St. Venant-Kirchhoff law, a law of small or moderate
// strain.  A step takes the mean strain, so its work is the change of W.
#pragma once
#include "physics/anisotropic.hpp"
#include "physics/material/dilatation.hpp"
#include "physics/material/material.hpp"
#include "physics/material/voigt.hpp"

namespace hilo {

struct Orthotropic {
  static constexpr std::string_view name = "orthotropic",
                                    meaning = "orthotropic: wood, laminates; small or moderate strain, large rotation";
  static std::vector<Param> keys();
  static Orthotropic make(const MaterialValues& v);
  using Bulk = NoBulk;
  static constexpr double soft_below = 0.58;
  static constexpr std::string_view soft_because = "an orthotropic material softens and turns inside out without resistance";

  Anisotropic moduli;  // in the axes of the model
  Lame mean;           // isotropic moduli near to them

  /// Scale of what is judged by a stiffness; the stress of rates and bending take the moduli.
  Lame linear() const { return mean; }

  template <class T>
  T energy(const T e[6]) const {
    T s[6];
    moduli.stress(e, s);
    T w = 0 * e[0];
    for (int i = 0; i < 6; ++i) w += s[i] * e[i] / 2;
    return w;
  }
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T mean_strain[6];
    for (int i = 0; i < 6; ++i) mean_strain[i] = (e0[i] + e1[i]) / 2;
    moduli.stress(mean_strain, s);
    if (D) moduli.add_tangent(0.5, D);
  }
};

inline std::vector<Param> Orthotropic::keys() {
  const auto modulus = [](const char* key, const char* of) { return Param{key, Type::number, "Pa", "!", of, above(0)}; };
  const auto ratio = [](const char* key, const char* of) { return Param{key, Type::number, "1", "!", of}; };
  return {modulus("E1", "Young's modulus along axis 1"),
          modulus("E2", "along axis 2"),
          modulus("E3", "along axis 3"),
          ratio("nu12", "contraction along 2 of a pull along 1; nu21 = nu12 E2/E1"),
          ratio("nu13", "along 3 of a pull along 1"),
          ratio("nu23", "along 3 of a pull along 2"),
          modulus("G12", "shear modulus of the plane 1-2"),
          modulus("G13", "of the plane 1-3"),
          modulus("G23", "of the plane 2-3"),
          {"axis_1", Type::numbers, "1", "[1, 0, 0]", "direction of axis 1; need not be of unit length"},
          {"axis_2", Type::numbers, "1", "[0, 1, 0]", "a direction in the plane of axes 1 and 2, made normal to axis 1"}};
}

inline Orthotropic Orthotropic::make(const MaterialValues& v) {
  const double E[3] = {v.number("E1"), v.number("E2"), v.number("E3")};
  const double nu12 = v.number("nu12"), nu13 = v.number("nu13"), nu23 = v.number("nu23");
  Mat6 compliance = Mat6::Zero();
  for (int i = 0; i < 3; ++i) compliance(i, i) = 1 / E[i];
  compliance(0, 1) = compliance(1, 0) = -nu12 / E[0];
  compliance(0, 2) = compliance(2, 0) = -nu13 / E[0];
  compliance(1, 2) = compliance(2, 1) = -nu23 / E[1];
  compliance(3, 3) = 1 / v.number("G23"), compliance(4, 4) = 1 / v.number("G13"), compliance(5, 5) = 1 / v.number("G12");
  const double det = compliance.topLeftCorner<3, 3>().determinant() * E[0] * E[1] * E[2];
  if (!(std::abs(nu12) < std::sqrt(E[0] / E[1]) && std::abs(nu13) < std::sqrt(E[0] / E[2]) && std::abs(nu23) < std::sqrt(E[1] / E[2]) &&
        det > 0))
    v.refuse("nu12",
             "these Poisson's ratios give a material that yields energy: |nu12| < sqrt(E1/E2) and so on, and a determinant above 0");
  Vec3 axis[2];
  for (const auto& [key, at] : {std::pair{"axis_1", 0}, {"axis_2", 1}}) {
    const std::vector<double> a = v.numbers(key);
    if (a.size() != 3) v.refuse(key, std::string(key) + " has three numbers");
    axis[at] = Vec3(a[0], a[1], a[2]);
  }
  if (!(axis[0].cross(axis[1]).norm() > 1e-9 * axis[0].norm() * axis[1].norm())) v.refuse("axis_2", "axis_1 and axis_2 span no plane");
  Mat3 R;
  R.col(0) = axis[0].normalized(), R.col(2) = axis[0].cross(axis[1]).normalized(), R.col(1) = R.col(2).cross(R.col(0));
  Orthotropic out;
  out.moduli = Anisotropic(compliance, R);
  out.mean = out.moduli.near_isotropic();
  return out;
}

}  // namespace hilo
