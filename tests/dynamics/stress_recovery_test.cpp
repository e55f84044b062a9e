// SPDX-License-Identifier: GPL-3.0-or-later
// Recovered stress of deformations that are known everywhere, on bent meshes of every shape: no equation is solved here.
#include "dynamics/stress_recovery.hpp"

#include <gtest/gtest.h>

#include "folder.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test::stress_recovery_test {
namespace {

constexpr double E = 2e11, nu = 0.3, k = 1e-6;

struct Model {
  explicit Model(const BlockOptions& options, const std::string& more = "") {
    const Mesh m = block_mesh(options);
    write_mesh(place / "mesh.h5", m, {"test"});
    local = read_local_mesh(place / "mesh.h5", Comm::world());
    std::string text = "[material.steel]\nE = 2e11\nnu = 0.3\ndensity = 7800\n" + more;
    for (size_t r = 0; r < options.regions.size(); ++r)
      text += "[region." + options.regions[r] + "]\nmaterial = \"" + (r && !more.empty() ? "soft" : "steel") + "\"\n";
    scene = Scene::parse(text + "[time]\nend = 1\nstep = 1\n", "scene.toml", {});
    system = build_system(scene, &local, Comm::world());
  }
  std::vector<Vec3> moved(const std::function<Vec3(const Vec3&)>& to) const {
    std::vector<Vec3> x;
    for (const Vec3& X : system->X) x.push_back(to(X));
    return x;
  }
  StressRecovery::Result recovered(const std::function<Vec3(const Vec3&)>& to) {
    const StressRecovery recovery(*system);
    X.clear(), region.clear();
    for (const auto& site : recovery.sites()) X.push_back(system->X[site.node]), region.push_back(site.region / 2);
    Config q = system->start;
    q.x = moved(to);
    return recovery.recover(q);
  }
  std::vector<Vec3> X;  // of the sites
  std::vector<int> region;
  Folder place;
  LocalMesh local;
  Scene scene;
  std::unique_ptr<System> system;
};

/// Pure bending about z: u_x = -k x y, u_y = k x^2/2 + nu k (y^2 - z^2)/2, u_z = nu k y z has sigma_xx = -E k y alone.
Vec3 bent(const Vec3& X) { return X + k * Vec3(-X[0] * X[1], X[0] * X[0] / 2 + nu * (X[1] * X[1] - X[2] * X[2]) / 2, nu * X[1] * X[2]); }
Vec6 bending(const Vec3& X) {
  Vec6 s = Vec6::Zero();
  s[0] = -E * k * X[1];
  return s;
}

/// Corners off their places inside the block and on its surface alike; edges stay straight.
Vec3 perturbed(const Vec3& X) {
  const int seed = static_cast<int>(std::lround(37 * X[0] + 11 * X[1] + 5 * X[2]));
  return X + 0.15 * Vec3(scatter(seed), scatter(seed + 100), scatter(seed + 200));
}

class RecoveryOf : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(EveryShape, RecoveryOf,
                         testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

// Truth: one strain everywhere is one stress everywhere, at corners, edges and surfaces too, and there is no error.
TEST_P(RecoveryOf, OfAUniformStrainIsUniformAndWithoutError) {
  for (const int thick : {1, 3}) {
    const BlockOptions o{.shape = GetParam(), .n = {4, 3, thick}, .high = Vec3(4, 3, thick), .map = perturbed};
    Mat3 F;
    F << 1.2, 0.1, -0.05, 0.2, 0.9, 0.1, -0.1, 0.05, 1.1;
    const auto r = Model(o).recovered([&](const Vec3& X) { return Vec3(F * X); });
    const Vec6 exact = r.stress[0];
    EXPECT_GT(von_mises(exact), 0.1 * E);
    for (const Vec6& at : r.stress) EXPECT_LT((at - exact).norm(), 1e-11 * E);
    for (const double error : r.error) EXPECT_LT(error, 1e-11 * E);
    for (const double vm : r.cell) EXPECT_NEAR(vm, von_mises(exact), 1e-11 * E);
  }
}

// Truth: a stress linear in space is exact on quadratic cells of any straight form, one cell thick or more, on the surface too.
TEST(Recovery, OfALinearStressIsExactOnQuadraticCells) {
  for (const Shape shape : {Shape::tet10, Shape::wedge15, Shape::hex20})
    for (const auto& n : {std::array{4, 3, 3}, {4, 1, 1}, {1, 1, 1}, {3, 3, 1}, {2, 2, 2}}) {
      if (shape != Shape::tet10 && n[1] > 1) continue;  // the others hold a quadratic displacement on parallelepipeds alone
      BlockOptions o{.shape = shape, .high = Vec3(n[0], n[1], n[2])};
      for (int i = 0; i < 3; ++i) o.n[i] = n[i];
      o.map = shape == Shape::tet10 ? perturbed : [](const Vec3& X) { return Vec3(X[0] + 0.3 * X[1], X[1] + 0.2 * X[2], X[2]); };
      Model m(o);
      const auto r = m.recovered(bent);
      double worst = 0, error = 0;
      for (size_t a = 0; a < r.stress.size(); ++a) {
        worst = std::max(worst, (r.stress[a] - bending(m.X[a])).norm());
        error = std::max(error, r.error[a]);
      }
      EXPECT_LT(worst, 1e-4 * E * k) << info(shape).name << " " << n[0] << n[1] << n[2] << ": strains of 1e-6 squared are left";
      EXPECT_LT(error, 1e-4 * E * k);
    }
}

// Truth: bending is there over one layer of one-point hexahedra, from their assumed strains, and over several, from their means.
TEST(Recovery, OfBendingIsExactOnOneLayerAndOnManyOfHexahedra) {
  for (const int layers : {1, 2, 4}) {
    const BlockOptions o{.shape = Shape::hex8, .n = {6, layers, 2}, .low = {0, -0.5, 0}, .high = {6, 0.5, 2}};
    Model m(o);
    const auto r = m.recovered(bent);
    for (size_t a = 0; a < r.stress.size(); ++a) EXPECT_NEAR(r.stress[a][0], bending(m.X[a])[0], 2e-4 * E * k) << layers << " layers";
  }
}

// Truth: turning a deformed body turns its stress and changes neither its von Mises stress nor the error.
TEST_P(RecoveryOf, TurnsWithTheBody) {
  const BlockOptions o{.shape = GetParam(), .n = {3, 2, 2}, .high = {3, 2, 2}, .map = perturbed};
  Model m(o);
  const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto deformed = [](const Vec3& X) { return Vec3(X + 0.05 * Vec3(X[0] * X[1], std::sin(X[2] + X[0]), X[1] * X[1] * X[2])); };
  const auto still = m.recovered(deformed), turned = m.recovered([&](const Vec3&X) { return Vec3(R * deformed(X) + Vec3(5, 6, 7)); });
  for (size_t a = 0; a < still.stress.size(); ++a) {
    const Vec6 s = still.stress[a], t = turned.stress[a];
    Mat3 S, T;
    S << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    T << t[0], t[5], t[4], t[5], t[1], t[3], t[4], t[3], t[2];
    EXPECT_LT((T - R * S * R.transpose()).norm(), 1e-10 * E);
    EXPECT_NEAR(still.error[a], turned.error[a], 1e-10 * E);
  }
}

// Truth: a slender bar bent into half a circle, x = (R - y) sin(X/R) ..., carries S_XX = E E_XX along itself: the same at every place along
// it.
TEST(Recovery, OfABeamBentIntoHalfACircleIsTheSameAllAlong) {
  const double radius = 10 / 3.14159265358979, half = 0.1;
  const BlockOptions o{.shape = Shape::hex20, .n = {20, 2, 1}, .low = Vec3(0, -half, -half), .high = Vec3(10, half, half)};
  Model m(o);
  const auto r = m.recovered([&](const Vec3& X) {
    return Vec3((radius - X[1]) * std::sin(X[0] / radius), radius - (radius - X[1]) * std::cos(X[0] / radius), X[2]);
  });
  for (size_t a = 0; a < r.stress.size(); ++a) {
    const Vec3& X = m.X[a];
    const double stretch = 1 - X[1] / radius, strain = (stretch * stretch - 1) / 2;  // plane, no change across: S_XX = (lambda + 2 mu) E_XX
    const double sigma = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * strain * stretch, side = sigma * nu / (1 - nu) / (stretch * stretch);
    Vec6 exact = Vec6::Zero();
    const double c = std::cos(X[0] / radius), s = std::sin(X[0] / radius);
    exact << sigma * c * c + side * s * s, sigma * s * s + side * c * c, side * 1.0, 0, 0, (sigma - side) * c * s;
    EXPECT_LT((r.stress[a] - exact).norm(), 0.02 * E * half / radius) << "at " << X.transpose();
  }
}

// Truth: two materials stretched side by side carry stresses in the ratio of their moduli; neither sees the other's.
TEST(Recovery, NeverLooksAcrossARegion) {
  for (const Shape shape : {Shape::hex8, Shape::hex20, Shape::tet10}) {
    const BlockOptions o{.shape = shape, .n = {3, 4, 2}, .high = {3, 4, 2}, .regions = {"hard", "soft"}, .region_of = [](const Vec3& X) {
                           return X[1] > 2 ? 1 : 0;
                         }};
    Model m(o, "[material.soft]\nE = 2e9\nnu = 0.3\ndensity = 1000\n");
    const auto r = m.recovered([](const Vec3& X) { return Vec3(X[0] * (1 + 1e-6), X[1] * (1 - 0.3e-6), X[2] * (1 - 0.3e-6)); });
    for (size_t a = 0; a < r.stress.size(); ++a) {
      const double modulus = m.region[a] == 1 ? 2e9 : 2e11;
      EXPECT_NEAR(r.stress[a][0], modulus * 1e-6, 1e-4 * modulus * 1e-6);
      EXPECT_LT(r.error[a], 1e-8 * modulus * 1e-6);
    }
  }
}

}  // namespace
}  // namespace hilo::test::stress_recovery_test
