// SPDX-License-Identifier: GPL-3.0-or-later
// Strains of the second degree in the modes of a linear region: the energy is that of its cells, the force its discrete gradient.
#include "system/quadratic_strain.hpp"

#include <gtest/gtest.h>

#include "linear/shared_cholesky.hpp"
#include "system/reduction/reduction.hpp"
#include "system/strain_rates.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test::quadratic_strain_test {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// A bar of cells that are bent a little, with one face an interface.
class StiffeningBar : public testing::TestWithParam<Shape> {
 protected:
  StiffeningBar() {
    const Mesh mesh = block_mesh({.shape = GetParam(), .n = {3, 1, 1}, .high = {1, 0.2, 0.3}, .map = [](const Vec3& x) {
                                    return Vec3(x + 0.02 * Vec3(0, std::sin(3 * x[0]), 0));
                                  }});
    in.X = mesh.X;
    SolidBatch b;
    b.beta = 0.01;
    b.shape = GetParam(), b.material = StVenantKirchhoff{{1.2e7, 0.7e7}}, b.density = 1000, b.region = 0;
    b.kernel = solid_kernel(b.shape, law_index(b.material));
    for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
      for (const std::int64_t node : mesh.cell(e)) b.nodes.push_back(static_cast<int>(node));
    in.cells = {b};
    in.rigid.emplace_back();
    for (size_t i = 0; i < in.X.size(); ++i)
      if (in.X[i][0] < 1e-9) in.rigid[0].push_back(static_cast<int>(i));
    in.centre = Vec3(0.5, 0.1, 0.15), in.n_vibrations = 3, in.stiffening = true;
    SharedCholesky factor(Comm::world());
    found = reduced(in, factor);
    eta[0] = Vector::Zero(found.omega2.size()), eta[1] = eta[0];
    for (Eigen::Index j = 0; j < eta[0].size(); ++j)
      for (int k = 0; k < 2; ++k) eta[k][j] = 0.3 * scatter(7 * static_cast<int>(j) + k) / found.shapes.col(j).cwiseAbs().maxCoeff();
  }

  /// Truth: what the kernels of the cells say, displaced by the modes.
  double energy_of_cells(const Vector& amplitudes) const { return of_cells(amplitudes, nullptr); }
  /// What rates of strain between two states take, times the time between.
  double taken_by_cells(const Vector& from, const Vector& to) const { return of_cells(to, &from); }
  double of_cells(const Vector& amplitudes, const Vector* from) const {
    const Vector u = found.shapes * amplitudes, u0 = found.shapes * (from ? *from : amplitudes);
    const SolidBatch& b = in.cells[0];
    const auto n = static_cast<size_t>(info(b.shape).n_nodes), w = static_cast<size_t>(b.kernel.width);
    struct alignas(64) Line {
      double value[8];
    };
    std::vector<Line> X(3 * n), x(3 * n), x0(3 * n), energy(1);
    double sum = 0;
    for (size_t first = 0; first < b.nodes.size(); first += n) {
      for (size_t i = 0; i < 3 * n; ++i)
        for (size_t l = 0; l < w; ++l) {
          const int node = b.nodes[first + i / 3];
          X[0].value[i * w + l] = in.X[node][i % 3], x[0].value[i * w + l] = in.X[node][i % 3] + u[3 * node + i % 3];
          x0[0].value[i * w + l] = in.X[node][i % 3] + u0[3 * node + i % 3];
        }
      KernelCall call{X[0].value, x0[0].value, x[0].value, from ? 0.0 : 1.0, from ? b.beta : 0.0, parameters(b.material), nullptr,
                      nullptr,    nullptr,     nullptr,    nullptr};
      (from ? call.dissipated : call.energy) = energy[0].value, call.weight = 0.5;
      b.kernel.call(call);
      sum += energy[0].value[0];
    }
    return sum;
  }

  ReductionInput in;
  Reduction found;
  Vector eta[2];
};

TEST_P(StiffeningBar, HasTheEnergyOfItsCells) {
  for (const double share : {1e-3, 0.1, 1.0}) {
    const Vector at = share * eta[0];
    const double cells = energy_of_cells(at);
    EXPECT_NEAR(found.strain.energy(at), cells, 1e-9 * cells) << share;
  }
  const double linear = found.omega2.dot(eta[0].cwiseAbs2()) / 2;
  EXPECT_GT(std::abs(found.strain.energy(eta[0]) / linear - 1), 0.1) << "beyond small strain";
}

TEST_P(StiffeningBar, WorkOfItsForceIsTheChangeOfEnergy) {
  const double work = found.strain.force(eta[0], eta[1], 0.5, nullptr).dot(eta[1] - eta[0]);
  EXPECT_NEAR(work, found.strain.energy(eta[1]) - found.strain.energy(eta[0]), 1e-13 * found.strain.energy(eta[1]));
}

TEST_P(StiffeningBar, SlopeIsTheDerivativeOfItsForce) {
  const Eigen::Index m = eta[0].size();
  for (const double w : {0.5, 0.7, 1.0}) {
    Matrix slope(m, m), difference(m, m);
    found.strain.force(eta[0], eta[1], w, &slope);
    for (Eigen::Index j = 0; j < m; ++j) {  // of the third degree: two widths give it exactly
      const auto of = [&](double h) {
        Vector up = eta[1], down = eta[1];
        up[j] += h, down[j] -= h;
        return Vector((found.strain.force(eta[0], up, w, nullptr) - found.strain.force(eta[0], down, w, nullptr)) / (2 * h));
      };
      const double h = std::abs(eta[1][j]) + 1e-3;
      difference.col(j) = (4 * of(h) - of(2 * h)) / 3;
    }
    EXPECT_LT((slope - difference).norm(), 1e-11 * slope.norm()) << w;
  }
}

TEST_P(StiffeningBar, ItsDampingTakesWhatItsCellsTake) {
  for (const double share : {1e-3, 0.1, 1.0}) {
    const Vector from = share * eta[0], to = share * eta[1];
    const double cells = taken_by_cells(from, to);
    EXPECT_GT(cells, 0);
    EXPECT_NEAR(rate_force(found.viscous, from, to, 0, 0, nullptr).dot(to - from), cells, 1e-9 * cells) << share;
  }
  Eigen::SelfAdjointEigenSolver<Matrix> sizes(found.viscous);
  EXPECT_GT(sizes.eigenvalues()[0], -1e-12 * sizes.eigenvalues().maxCoeff()) << "never below zero, for any rates";
}

TEST_P(StiffeningBar, SlopesOfItsDampingAreItsDerivatives) {
  const Eigen::Index m = eta[0].size();
  const double c[2] = {-0.3, 0.8};
  Matrix slope, difference(m, m);
  rate_force(found.viscous, eta[0], eta[1], c[0], c[1], &slope);
  for (Eigen::Index j = 0; j < m; ++j) {  // of the third degree: two widths give it exactly
    const auto of = [&](double h) {
      Vector f = Vector::Zero(m);
      for (const double side : {-1, 1}) {
        Vector from = eta[0], to = eta[1];
        from[j] += side * c[0] * h, to[j] += side * c[1] * h;
        f += side * rate_force(found.viscous, from, to, 0, 0, nullptr) / (2 * h);
      }
      return f;
    };
    const double h = std::abs(eta[1][j]) + 1e-3;
    difference.col(j) = (4 * of(h) - of(2 * h)) / 3;
  }
  EXPECT_LT((slope - difference).norm(), 1e-11 * slope.norm());
}

INSTANTIATE_TEST_SUITE_P(Shapes, StiffeningBar, testing::Values(Shape::hex8, Shape::hex20r, Shape::tet10),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

}  // namespace
}  // namespace hilo::test::quadratic_strain_test
