// SPDX-License-Identifier: GPL-3.0-or-later
// Orthotropic elasticity: moduli in any direction, and one that is isotropic after all.
#include "physics/cells.hpp"

namespace hilo::test::orthotropic_test {
namespace {

/// Spruce, roughly.
constexpr double E1 = 11e9, E2 = 0.9e9, E3 = 0.5e9, nu12 = 0.37, nu13 = 0.42, nu23 = 0.47, G12 = 0.7e9, G13 = 0.6e9, G23 = 0.04e9;

MaterialValues values(std::map<std::string, double> v, const Vec3& one, const Vec3& two) {
  const auto list = [one, two](std::string_view key) {
    const Vec3& a = key == "axis_1" ? one : two;
    return std::vector<double>{a[0], a[1], a[2]};
  };
  return {[](std::string_view) { return true; }, [v](std::string_view key) { return v.at(std::string(key)); }, list,
          [](std::string_view key, const std::string& why) { throw std::runtime_error(std::string(key) + ": " + why); }};
}
const std::map<std::string, double> spruce{{"E1", E1},     {"E2", E2},   {"E3", E3},   {"nu12", nu12}, {"nu13", nu13},
                                           {"nu23", nu23}, {"G12", G12}, {"G13", G13}, {"G23", G23}};
Orthotropic wood(const Vec3& one, const Vec3& two) { return Orthotropic::make(values(spruce, one, two)); }

/// Strain of a pull of 1 Pa along x.
Vec6 pulled(const Orthotropic& law) {
  const Mat6 C = Eigen::Map<const Mat6>(law.moduli.C[0]);
  return C.inverse().col(0);
}

// Truth: 1/E of a direction at angle t in the plane 1-2 is c^4/E1 + (1/G12 - 2 nu12/E1) s^2 c^2 + s^4/E2.
TEST(Orthotropic, StiffnessAtAnAngleIsThatOfTheClosedForm) {
  for (const double t : {0.0, 0.3, 0.8, M_PI / 2}) {
    const double c = std::cos(t), s = std::sin(t),
                 exact = c * c * c * c / E1 + (1 / G12 - 2 * nu12 / E1) * s * s * c * c + s * s * s * s / E2;
    const Vec6 e = pulled(wood(Vec3(c, s, 0), Vec3(-s, c, 0.0)));
    EXPECT_NEAR(e[0], exact, 1e-12 / E2);
    // axis 2 need not be normal to axis 1, nor of unit length
    EXPECT_NEAR(pulled(wood(Vec3(3 * c, 3 * s, 0), Vec3(-s + 2 * c, c + 2 * s, 0)))[0], exact, 1e-12 / E2);
  }
  EXPECT_NEAR(pulled(wood(Vec3::UnitX(), Vec3::UnitY()))[1], -nu12 / E1, 1e-12 / E1);
  EXPECT_NEAR(pulled(wood(Vec3::UnitX(), Vec3::UnitZ()))[1], -nu13 / E1, 1e-12 / E1);
  EXPECT_NEAR(pulled(wood(Vec3::UnitZ(), Vec3::UnitX()))[2], -nu12 / E1, 1e-12 / E1);
}

// Truth: ratios that give a material which yields energy are refused, and so are axes that span no plane.
TEST(Orthotropic, WhatIsNoElasticMaterialIsRefused) {
  for (const auto& [key, value] : {std::pair{"nu12", 4.0}, {"nu13", -5.0}, {"nu23", 1.5}}) {
    auto odd = spruce;
    odd[key] = value;
    EXPECT_THROW(Orthotropic::make(values(odd, Vec3::UnitX(), Vec3::UnitY())), std::runtime_error);
  }
  EXPECT_THROW(wood(Vec3::UnitX(), Vec3(2, 0, 0)), std::runtime_error);
}

// Truth: with the moduli of an isotropic material it is the St. Venant-Kirchhoff solid, whatever its axes, in the hexahedron's bending too.
TEST(Orthotropic, WithIsotropicModuliIsTheIsotropicLaw) {
  const double E = 2.5e6, nu = 0.3, G = E / (2 * (1 + nu));
  const std::map<std::string, double> same{{"E1", E},    {"E2", E},  {"E3", E},  {"nu12", nu}, {"nu13", nu},
                                           {"nu23", nu}, {"G12", G}, {"G13", G}, {"G23", G}};
  const Orthotropic law = Orthotropic::make(values(same, Vec3(1, 2, 3), Vec3(-1, 1, 4)));
  const auto X = some_cell<Hex8>(0.08), x0 = bent(X, 0.4, 0.1, 1), x1 = bent(X, 1.2, 0.15, 2);
  const auto X_ = flat(X), x0_ = flat(x0), x1_ = flat(x1);
  const Wish wish{.viscous = 0.3};
  const auto isotropic = evaluate_cell<Hex8, StVenantKirchhoff>(lame(E, nu), X_, x0_, x1_, wish);
  std::vector<double> f(24, 0.0), K(576, 0.0);
  double energy = 0, dissipated = 0, det = 1e300;
  const SolidCall<double> call{X_.data(),   x0_.data(), x1_.data(), 1,       0.3, law.linear(), f.data(), K.data(), &energy,
                               &dissipated, &det,       0,          nullptr, 0,   0.5};
  evaluate_strain<Hex8>(law, call);
  for (size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(f[i], isotropic.f[i], 1e-12 * largest(isotropic.f));
  for (size_t i = 0; i < K.size(); ++i) EXPECT_NEAR(K[i], isotropic.K[i], 1e-12 * largest(isotropic.K));
  EXPECT_NEAR(energy, isotropic.energy, 1e-12 * energy);
  EXPECT_NEAR(dissipated, isotropic.dissipated, 1e-12 * dissipated);
}

}  // namespace
}  // namespace hilo::test::orthotropic_test
