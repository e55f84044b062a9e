// SPDX-License-Identifier: GPL-3.0-or-later
// Modes about spinning states whose parts hang on joints that turn along, and of rotors in any place and direction, against closed forms.
#include "verify/natural_modes/natural_modes.hpp"

namespace hilo::test::whirl_test {
namespace {

const Vec3 zero = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();

class Whirl : public NaturalModes {
 protected:
  Ran try_modes(const std::string& scene) {
    work.write("scene.toml", scene + "[time]\nanalysis = \"modes\"\n");
    return work.run("hilo-solve scene.toml -o run.h5");
  }
};

/// Seen from a shaft that turns at W, a mass on its radial guide has k - m W^2; the bearing lets it spin, or holds it to a law.
TEST_F(Whirl, OfAMassOnAGuideThatTurns) {
  const double k = 2000, W = 30;
  const std::string mass = body("mass", 1, zero, {1e-3, 1e-3, 1e-3}) + axial("prismatic", "guide", "shaft", "mass", zero, x) +
                           spring("bushing", "s", "shaft", "mass", "at = [0, 0, 0]\nstiffness = " + list({k, k, k})),
                    shaft = body("shaft", 1, zero, {1, 1, 1}), course = fmt::format("history = {{t = [0, 1], value = [0, {}]}}\n", W);
  const auto bearing = [](const std::string& more) { return axial("revolute", "d", "ground", "shaft", zero, z, more); };
  for (const std::string& how :
       {bearing("") + initial("*", "spin = [0, 0, 30]\nabout = [0, 0, 0]"), bearing("spin = 30\n"), bearing("angle = 1\n" + course),
        motion("rotation", "d", "shaft", "at = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 1\n" + course)}) {
    const auto f = frequencies(shaft + mass + how, 4);
    ASSERT_EQ(f.size(), 1) << how;
    EXPECT_NEAR(f[0] * 2 * pi / std::sqrt(k - W * W), 1, 1e-6) << how;
    EXPECT_NE(ran.err.find("joint \"guide\" turns with what spins"), std::string::npos) << ran.err;
  }
}

/// A pendulum below a vertical shaft falls outward where m l^2 W^2 is above m g l, about any axes.
TEST_F(Whirl, OfAPendulumThatAShaftCarries) {
  const double g = 9.81, l = 0.5, I = 0.02;
  const auto scene = [&](const Vec3& down, const Vec3& hinge, const Vec3& at, double W) {
    return "gravity = " + list(g * down) + "\n" + body("shaft", 1, at, {1, 1, 1}) + body("bob", 1, at + l * down, {I, I, I}) +
           axial("revolute", "d", "ground", "shaft", at, down, fmt::format("spin = {}\n", W)) +
           axial("revolute", "h", "shaft", "bob", at, hinge);
  };
  const Vec3 down = Vec3(0.3, -0.5, 0.7).normalized(), hinge = down.cross(Vec3(1, 0.2, 0)).normalized();
  for (const double W : {3., 60.}) {
    const double k = (g * l - l * l * W * W) / (l * l + I), truth = std::copysign(std::sqrt(std::abs(k)), k);
    EXPECT_NEAR(frequencies(scene(-z, y, zero, W), 2)[0] * 2 * pi / truth, 1, 1e-6);
    EXPECT_NEAR(frequencies(scene(down, hinge, {100, -70, 40}, W), 2)[0] * 2 * pi / truth, 1, 1e-5);
  }
}

/// A housing on springs that are alike across the axis carries a shaft with a mass on a radial guide.  Seen from the shaft, by
/// T = M/2 ((x' - W y)^2 + (y' + W x)^2) + m/2 ((x' + u' - W y)^2 + (y' + W (x + u))^2): poles of a problem of three coordinates.
TEST_F(Whirl, OfAMassOnAGuideWhoseBearingGivesWay) {
  const auto scene = [](double across) {
    return body("house", 3, zero, {0.4, 0.4, 0.5}) + body("shaft", 1, zero, {0.2, 0.2, 0.3}) + body("mass", 1, zero, {0.02, 0.02, 1e-3}) +
           axial("revolute", "d", "house", "shaft", zero, z) + axial("prismatic", "guide", "shaft", "mass", zero, x) +
           spring("bushing", "s", "shaft", "mass", "at = [0, 0, 0]\nstiffness = [2000, 2000, 2000]") +
           spring("bushing", "g", "ground", "house",
                  "at = [0, 0, 0]\naxis = [0, 0, 1]\nx = [1, 0, 0]\nangular_stiffness = [200, 200, 300]\nstiffness = " +
                      list({3000, across, 5000})) +
           "[[initial]]\non = [\"shaft\", \"mass\"]\nspin = [0, 0, 30]\nabout = [0, 0, 0]\n";
  };
  const double W = 30;
  Eigen::Matrix3d M, J, K;
  M << 5, 0, 1, 0, 5, 0, 1, 0, 1;
  J << 0, -5, 0, 5, 0, 1, 0, -1, 0;
  K = Vec3(3000, 3000, 2000).asDiagonal();
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  A.topRightCorner<3, 3>().setIdentity();
  A.bottomLeftCorner<3, 3>() = -M.inverse() * (K - W * W * M), A.bottomRightCorner<3, 3>() = -2 * W * M.inverse() * J;
  const auto f = frequencies(scene(3000), 12);
  for (const auto& s : A.eigenvalues()) EXPECT_LT((f.array() * 2 * pi / std::abs(s.imag()) - 1).abs().minCoeff(), 1e-6) << s << "\n" << f;
  // 0.62 w^2 -+ 9.03 w = 200 of the tilting, and what turns about the axis
  const double H = 9.03, w = (H + std::sqrt(H * H + 4 * 0.62 * 200)) / 1.24;
  for (const double truth : {w - W, 200 / 0.62 / w + W, std::sqrt(300 / 0.5)})
    EXPECT_LT((f.array() * 2 * pi / std::abs(truth) - 1).abs().minCoeff(), 1e-6) << truth << "\n" << f;
  expect_end(try_modes(scene(3500)), 2, "joint \"guide\" turns with what spins, and what stands is not the same all around");
}

/// A platform at rest on a spherical joint and unlike springs, with two rotors that turn against each other: gyroscopic by 500 Jp in sum.
TEST_F(Whirl, OfTwoRotorsInAPlatformInAnyDirection) {
  const Mat3 turned = Eigen::AngleAxisd(1.4, Vec3(0.7, -1.1, 0.4).normalized()).toRotationMatrix();
  for (const Mat3& Q : {Mat3(Mat3::Identity()), turned}) {
    const auto inertia = [&](const Vec3& of) {
      const Mat3 J = Q * of.asDiagonal() * Q.transpose();
      return fmt::format("inertia = [{}, {}, {}, {}, {}, {}]\n", J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2));
    };
    const auto part = [&](const std::string& name, double mass, const Vec3& at, const Vec3& J) {
      return fmt::format("[[body]]\nname = \"{}\"\nmass = {}\ncom = {}\n", name, mass, list(at)) + inertia(J);
    };
    const Vec3 a = Q * Vec3(0.2, 0, 0), axis = Q * z;
    const Vec3 found =
        frequencies(part("p", 5, zero, {0.3, 0.4, 0.5}) + part("a", 2, a, {0.01, 0.01, 0.02}) + part("b", 2, -a, {0.01, 0.01, 0.02}) +
                        axial("revolute", "ja", "p", "a", a, axis) + axial("revolute", "jb", "p", "b", -a, axis) +
                        joint("spherical", "pp", "ground", "p", zero) +
                        spring("bushing", "s", "ground", "p",
                               "at = [0, 0, 0]\nangular_stiffness = [300, 500, 700]\naxis = " + list(axis) + "\nx = " + list(Q * x)) +
                        initial("a", "spin = " + list(800 * axis)) + initial("b", "spin = " + list(-300 * axis)),
                    6);
    // (300 - 0.32 w^2)(500 - 0.58 w^2) = (0.02 500 w)^2, and 0.66 w^2 = 700
    const double p = (300 * 0.58 + 500 * 0.32 + 100) / 2, q = std::sqrt(p * p - 300 * 500 * 0.32 * 0.58);
    const Vec3 truth(std::sqrt((p - q) / (0.32 * 0.58)), std::sqrt(700 / 0.66), std::sqrt((p + q) / (0.32 * 0.58)));
    EXPECT_LT((found * 2 * pi - truth).cwiseAbs().maxCoeff(), 1e-6 * truth[2]) << found << "\n" << truth;
  }
}

/// Round-off of what holds a light housing a kilometre away is no motion of it.
TEST_F(Whirl, OfARotorInALightHousingFarAway) {
  const Mat3 Q = Eigen::AngleAxisd(1.4, Vec3(0.7, -1.1, 0.4).normalized()).toRotationMatrix();
  const Vec3 at = Vec3(1000, -700, 400) + Q * Vec3(0, 0, 0.12), axis = Q * z;
  const Mat3 J = Q * Vec3(0.22, 0.22, 0.36).asDiagonal() * Q.transpose();
  std::string scene = fmt::format("[[body]]\nname = \"rotor\"\nmass = 12\ncom = {}\ninertia = [{}, {}, {}, {}, {}, {}]\n", list(at),
                                  J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2)) +
                      body("h", 1e-3, at, {1e-6, 1e-6, 1e-6}) + axial("revolute", "d", "h", "rotor", at, axis) +
                      spring("torsion", "t", "ground", "h", "axis = " + list(axis) + "\nstiffness = 1e7") +
                      initial("rotor", "spin = " + list(300 * axis));
  for (const double along : {-0.3, 0.3})
    scene += spring("bushing", along < 0 ? "r" : "f", "ground", "h",
                    "at = " + list(at + along * axis) + "\nstiffness = [2e6, 2e6, 2e6]\naxis = " + list(axis));
  const auto f = frequencies(scene, 6);  // 0.22 w^2 -+ 300 0.36 w = 4e6 0.09
  const double root = std::sqrt(108. * 108 + 4 * 0.22 * 3.6e5);
  for (const double w : {(root - 108) / 0.44, (root + 108) / 0.44})
    EXPECT_LT((f.array() * 2 * pi / w - 1).abs().minCoeff(), 1e-4) << w / (2 * pi) << "\n" << f;
}

}  // namespace
}  // namespace hilo::test::whirl_test
