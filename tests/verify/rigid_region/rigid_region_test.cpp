// SPDX-License-Identifier: GPL-3.0-or-later
// The mass of a rigid region is collapsed from its cells, M_r = sum N^T M_e N: mass, centre and inertia against closed forms to 1e-12.
#include <Eigen/Eigenvalues>

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::rigid_region_test {
namespace {

const std::string steel = solid(2e11, 0.3, 7800) + in_time(0.01, 0.01);

/// Mass, centre, principal moments.
struct Collapsed {
  double mass;
  Vec3 centre, moments;
};
Collapsed read(const Results& r, Eigen::Index body = 0) {
  return {r.table("/body/mass")(body, 0), r.table("/body/points").row(body).head<3>().transpose(),
          r.table("/body/inertia").row(body).transpose()};
}
Vec3 principal(const Mat3& second) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(Mat3(second.trace() * Mat3::Identity() - second)).eigenvalues();
}

class RigidRegion : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(EveryShape, RigidRegion,
                         testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

// Truth: for a sheared box x = A s, s in the unit cube about its centre: m = rho det A, second moment = m A A^T/12.
TEST_P(RigidRegion, OfABoxHasTheMassCentreAndInertiaOfTheBox) {
  SceneCase c(steel);
  Mat3 A;
  A << 0.9, 0.2, 0.1, -0.1, 0.5, 0.05, 0.15, -0.05, 0.3;
  const Vec3 at(3, -2, 7);
  c.use(block_mesh({.shape = GetParam(),
                    .n = {3, 2, 2},
                    .low = Vec3::Constant(-0.5),
                    .high = Vec3::Constant(0.5),
                    .map = [&](const Vec3& s) { return Vec3(A * s + at); }}),
        {Fidelity::rigid});
  const Collapsed got = read(c.solved());
  const double m = 7800 * A.determinant();
  EXPECT_NEAR(got.mass, m, 1e-12 * m);
  EXPECT_LT((got.centre - at).norm(), 1e-12 * at.norm());
  const Vec3 exact = principal(m / 12 * A * A.transpose());
  EXPECT_LT((got.moments - exact).norm(), 1e-12 * exact.norm());
}

/// A bar of 1 x 0.2 x 0.3 m that turns about the z axis at its corner, 60 kg, pushed by 300 Pa on its side of 1 x 0.3 m, seen for a second.
struct PushedBar : SceneCase {
  PushedBar(const std::string& push, Shape shape)
      : SceneCase(solid(2e11, 0.3, 1000) + axial("revolute", "hinge", "ground", "block", Vec3::Zero(), Vec3::UnitZ()) + push +
                  in_time(1, 1e-3) + solved_to(1e-12)) {
    use(block_mesh({.shape = shape, .n = {4, 2, 2}, .high = {1, 0.2, 0.3}}), {Fidelity::rigid});
  }
  static constexpr double moment = 300 * 0.3 * 0.5, inertia = 60 * (1 + 0.04) / 3;  // at the start  [N m], [kg m^2]
};

// Truth: a pressure turns with what it pushes, so that the moment stays: angle = M t^2/(2 J).
TEST_P(RigidRegion, IsTurnedByAPressureThatTurnsWithIt) {
  const PushedBar c(load("pressure", "air", "ymin", "pressure = 300"), GetParam());
  const Results r = c.solved();
  const double angle = c.moment / c.inertia / 2;
  EXPECT_NEAR(r.history("coordinate/hinge").bottomRows(1)(0, 1), angle, 1e-6 * angle);
  EXPECT_NEAR(r.history("energy").bottomRows(1)(0, 0), c.moment * angle, 1e-6 * c.moment * angle);
}

// Truth: the direction of a traction, or of a force on a set, stays: J w^2/2 = M sin(angle).
TEST_P(RigidRegion, IsTurnedByForcesWhoseDirectionStays) {
  for (const std::string& push :
       {load("traction", "wind", "ymin", "traction = [0, 300, 0]"), force("push", "ymin", {0, 90, 0}), load("force", "nodes", "edge", R"(
force = [0, 45, 0]
[set.edge]
kind = "box"
low = [0.999, -1, -1]
high = [1.001, 0.001, 1])")}) {
    const PushedBar c(push, GetParam());
    const Results r = c.solved();
    const double angle = r.history("coordinate/hinge").bottomRows(1)(0, 1);
    EXPECT_GT(angle, 0.9);
    EXPECT_NEAR(r.history("energy").bottomRows(1)(0, 0), c.moment * std::sin(angle), 1e-9 * c.moment) << push;
  }
}

// Truth: a tetrahedron's second moment is V/20 (sum x_i x_i^T + (sum x_i)(sum x_i)^T); here of bent blocks of tetrahedra.
TEST(RigidRegionOfTetrahedra, HasTheMassCentreAndInertiaOfItsCells) {
  for (const Shape shape : {Shape::tet4, Shape::tet10}) {
    SceneCase c(steel);
    const Mesh m = block_mesh({.shape = shape, .n = {3, 2, 2}, .high = {1.5, 0.8, 0.6}, .map = [](const Vec3& x) {
                                 return Vec3(x + 0.07 * Vec3(scatter(std::lround(10 * x[0] + 31 * x[1] + 57 * x[2])),
                                                             scatter(std::lround(11 * x[0] + 37 * x[1] + 50 * x[2])),
                                                             scatter(std::lround(13 * x[0] + 30 * x[1] + 59 * x[2]))));
                               }});
    c.use(m, {Fidelity::rigid});
    double volume = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (std::int64_t e = 0; e < m.n_cells(); ++e) {
      Vec3 sum = Vec3::Zero();
      Mat3 squares = Mat3::Zero(), J;
      for (int a = 0; a < 4; ++a) sum += m.X[m.cell(e)[a]], squares += m.X[m.cell(e)[a]] * m.X[m.cell(e)[a]].transpose();
      for (int i = 0; i < 3; ++i) J.col(i) = m.X[m.cell(e)[i + 1]] - m.X[m.cell(e)[0]];
      const double V = J.determinant() / 6;
      volume += V, first += V / 4 * sum, second += V / 20 * (squares + sum * sum.transpose());
    }
    const Collapsed got = read(c.solved());
    const Vec3 centre = first / volume, exact = principal(7800 * (second - volume * centre * centre.transpose()));
    EXPECT_NEAR(got.mass, 7800 * volume, 1e-12 * got.mass);
    EXPECT_LT((got.centre - centre).norm(), 1e-12);
    EXPECT_LT((got.moments - exact).norm(), 1e-12 * exact.norm());
  }
}

// Truth: bent bricks have the mass of their volume, and their consistent mass matrix, here from 2 x 2 x 2 Gauss points written out, is what
// collapses.
TEST(RigidRegionOfBentBricks, IsTheSumOfTheirConsistentMassMatrices) {
  SceneCase c(steel);
  const Mesh m = block_mesh({.n = {2, 2, 2}, .map = [](const Vec3& x) {
                               return Vec3(x + 0.1 * Vec3(scatter(std::lround(10 * x[0] + 31 * x[1] + 57 * x[2])),
                                                          scatter(std::lround(11 * x[0] + 37 * x[1] + 50 * x[2])),
                                                          scatter(std::lround(13 * x[0] + 30 * x[1] + 59 * x[2]))));
                             }});
  c.use(m, {Fidelity::rigid});
  double volume = 0, exact_volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  const double g = 1 / std::sqrt(3.0),
               corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  for (std::int64_t e = 0; e < m.n_cells(); ++e) {
    exact_volume += quality(m, e).volume;
    for (int p = 0; p < 8; ++p) {
      const Vec3 xi(g * corner[p][0], g * corner[p][1], g * corner[p][2]);
      Vec3 x = Vec3::Zero();
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < 8; ++a) {
        const double f[3] = {1 + corner[a][0] * xi[0], 1 + corner[a][1] * xi[1], 1 + corner[a][2] * xi[2]};
        const Vec3& X = m.X[m.cell(e)[a]];
        x += f[0] * f[1] * f[2] / 8 * X;
        J += X * Vec3(corner[a][0] * f[1] * f[2], corner[a][1] * f[0] * f[2], corner[a][2] * f[0] * f[1]).transpose() / 8;
      }
      volume += J.determinant(), first += J.determinant() * x, second += J.determinant() * x * x.transpose();
    }
  }
  const Collapsed got = read(c.solved());
  const Vec3 centre = first / volume, moments = principal(7800 * (second - volume * centre * centre.transpose()));
  EXPECT_NEAR(got.mass, 7800 * exact_volume, 1e-12 * got.mass);
  EXPECT_NEAR(got.mass, 7800 * volume, 1e-12 * got.mass);
  EXPECT_LT((got.centre - centre).norm(), 1e-12);
  EXPECT_LT((got.moments - moments).norm(), 1e-12 * moments.norm());
}

// Truth: rigid regions that share nodes are one body, their union; a region apart is another.
TEST(RigidRegions, ThatTouchAreOneBodyAndThoseApartAreTwo) {
  SceneCase c(steel);
  const BlockOptions o{.n = {4, 1, 1}, .high = {4, 1, 1}, .regions = {"left", "middle", "right"}, .region_of = [](const Vec3& x) {
                         return x[0] < 1 ? 0 : x[0] < 2 ? 1 : 2;
                       }};
  c.use(block_mesh(o), {Fidelity::rigid, Fidelity::rigid, Fidelity::rigid});
  {
    const Results r = c.solved();
    ASSERT_EQ(r.file().read_strings("/body/name"), std::vector<std::string>{"left+middle+right"});
    const Collapsed got = read(r);
    EXPECT_NEAR(got.mass, 4 * 7800, 1e-9);
    const double m = 4 * 7800;
    EXPECT_LT((got.moments - m / 12 * Vec3(2, 17, 17)).norm(), 1e-12 * m);
  }
  c.use(block_mesh(o), {Fidelity::rigid, Fidelity::nonlinear, Fidelity::rigid});
  const Results r = c.solved("", "two.h5");
  ASSERT_EQ(r.file().read_strings("/body/name"), (std::vector<std::string>{"left", "right"}));
  EXPECT_NEAR(read(r, 0).mass, 7800, 1e-9);
  EXPECT_NEAR(read(r, 1).mass, 2 * 7800, 1e-9);
  // the nodes of the rigid cells, and only they, follow: x = c + R (X - Xc)
  const auto nodes = r.file().read<std::int64_t>("/body/follower_node");
  EXPECT_EQ(nodes.size(), 8u + 12u);
}

}  // namespace
}  // namespace hilo::test::rigid_region_test
