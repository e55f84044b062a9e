// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that are tied though their meshes do not match: patch tests, momenta in free flight, and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/integrators.hpp"
#include "verify/contact/collision.hpp"

namespace hilo::test::ties_test {
namespace {

using Map = std::function<Vec3(const Vec3&)>;

/// Two blocks of 1 x 1 x .5 m, one on the other.
Mesh stack(Shape a, Shape b, int n_a, int n_b, const Map& map_a = nullptr, const Map& map_b = nullptr) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"}, A.shape = a, B.shape = b, A.map = map_a, B.map = map_b;
  A.n[0] = A.n[1] = n_a, B.n[0] = B.n[1] = n_b, A.n[2] = B.n[2] = 2;
  A.high = Vec3(1, 1, 0.5), B.low = Vec3(0, 0, 0.5), B.high = Vec3(1, 1, 1);
  Mesh m = together(block_mesh(A), block_mesh(B));
  add_node_set(m, "side", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
  add_node_set(m, "back", [](const Vec3& x) { return std::abs(x[1]) < 1e-9; });
  return m;
}

/// Largest distance of the displacements from the linear field that fits them best, over the largest displacement; and its slope dz/dz.
std::pair<double, double> off_linear(const std::vector<Vec3>& X, const std::vector<Vec3>& u) {
  Eigen::MatrixXd A(X.size(), 4), B(X.size(), 3);
  for (size_t i = 0; i < X.size(); ++i)
    A.row(static_cast<Eigen::Index>(i)) << 1, X[i].transpose(), B.row(static_cast<Eigen::Index>(i)) = u[i].transpose();
  const Eigen::MatrixXd F = A.colPivHouseholderQr().solve(B);
  return {(A * F - B).cwiseAbs().maxCoeff() / B.cwiseAbs().maxCoeff(), F(3, 2)};
}

// Truth: uniform stress is a linear field, p/E along it.
TEST(Ties, PatchAcrossMeshesThatDoNotMatch) {
  using enum Shape;
  for (const auto& [a, b] : {std::pair{hex8, hex8}, {tet4, hex8}, {hex8, wedge6}, {hex20, tet10}, {tet10, wedge15}, {hex8, hex20}}) {
    Case c("ties");
    const Mesh mesh = stack(a, b, 2, 3);
    c.use(mesh);
    const auto [off, slope] = off_linear(mesh.X, c.solved("", "run.h5", "pull").field("displacement"));
    EXPECT_LT(off, 1e-9) << info(a).name << " " << info(b).name;
    EXPECT_NEAR(slope, 1e-5, 1e-9) << info(a).name << " " << info(b).name;
  }
}

}  // namespace
}  // namespace hilo::test::ties_test
