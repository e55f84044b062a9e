// SPDX-License-Identifier: GPL-3.0-or-later
// The solid-shell by itself: what it resists, the patch tests of thin plates, energy and momenta over a step, its tangent.
#include <Eigen/Dense>

#include "physics/cells.hpp"
#include "physics/dual.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo::test::shell_test {
namespace {

/// One cell by a kernel, the same in all lanes.
struct Answer {
  Eigen::VectorXd f;
  Eigen::MatrixXd K;
  double energy, dissipated;
  std::vector<double> state;
};
Answer answer(const Material& law, const std::vector<Vec3>& X, const std::vector<Vec3>& x0, const std::vector<Vec3>& x1, double weight,
              std::vector<double> state = {}) {
  const SolidKernel kernel = solid_kernel(shell8, law_index(law));
  const auto W = static_cast<size_t>(kernel.width), n_state = static_cast<size_t>(kernel.n_state);
  struct alignas(64) Block {
    double v[8];
  };
  const auto lanes_of = [&](const std::vector<double>& from) {
    std::vector<Block> to(from.size() + 1);
    for (size_t i = 0; i < from.size() * W; ++i) to[0].v[i] = from[i / W];
    return to;
  };
  state.resize(n_state, 0.0);
  auto X_ = lanes_of(flat(X)), x0_ = lanes_of(flat(x0)), x1_ = lanes_of(flat(x1)), h0 = lanes_of(state), h1 = h0;
  std::vector<Block> f(24), K(576), scalars(3);
  KernelCall call{};
  call.X = X_[0].v, call.x0 = x0_[0].v, call.x1 = x1_[0].v, call.elastic = 1, call.law = parameters(law), call.weight = weight;
  call.f = f[0].v, call.K = K[0].v, call.energy = scalars[0].v, call.dissipated = scalars[1].v, call.h0 = h0[0].v, call.h1 = h1[0].v;
  call.elapsed = 1;
  kernel.call(call);
  Answer out{Eigen::VectorXd(24), Eigen::MatrixXd(24, 24), scalars[0].v[0], scalars[1].v[0], {}};
  for (size_t i = 0; i < 24; ++i) {
    out.f[static_cast<int>(i)] = f[0].v[i * W];
    for (size_t j = 0; j < 24; ++j) out.K(static_cast<int>(i), static_cast<int>(j)) = K[0].v[(24 * i + j) * W];
  }
  for (size_t i = 0; i < n_state; ++i) out.state.push_back(h1[0].v[i * W]);
  return out;
}

/// A warped cell of changing thickness.
std::vector<Vec3> warped() {
  const Vec3 P[4] = {{0, 0, 0}, {1, 0.1, 0.1}, {1.2, 0.9, 0}, {-0.1, 1, 0.05}};
  const Vec3 n[4] = {{0.1, 0, 1}, {0, 0.1, 1}, {-0.1, 0, 1}, {0.05, 0.05, 0.9}};
  std::vector<Vec3> X(8);
  for (int a = 0; a < 4; ++a) X[a] = P[a] - 0.1 * n[a], X[a + 4] = P[a] + 0.1 * n[a];
  return X;
}

TEST(Shell, ResistsAllButSixMotions) {
  const auto X = warped();
  const Answer at = answer(StVenantKirchhoff{lame(1, 0.3)}, X, X, X, 1);
  const Eigen::VectorXd w = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(at.K).eigenvalues();
  EXPECT_LT(w.head(6).cwiseAbs().maxCoeff(), 1e-13 * w[23]);
  EXPECT_GT(w[6], 1e-5 * w[23]);
}

// MacNeal and Harder's patch of five cells, L/h = 240: constant strain and constant curvature at its edge are those inside.
TEST(Shell, PassesThePatchTestsOfPlates) {
  const double P[8][2] = {{0, 0}, {.24, 0}, {.24, .12}, {0, .12}, {.04, .02}, {.18, .03}, {.16, .08}, {.08, .08}};
  const int cells[5][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
  const double h = 0.001, nu = 0.25;
  std::vector<Vec3> X(16);
  for (int i = 0; i < 16; ++i) X[i] = Vec3(P[i % 8][0], P[i % 8][1], i < 8 ? -h / 2 : h / 2);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(48, 48);
  for (const auto& cell : cells) {
    std::vector<int> nodes;
    for (int a = 0; a < 8; ++a) nodes.push_back(cell[a % 4] + (a < 4 ? 0 : 8));
    std::vector<Vec3> x;
    for (const int i : nodes) x.push_back(X[i]);
    const Answer at = answer(StVenantKirchhoff{lame(1e6, nu)}, x, x, x, 1);
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) K.block<3, 3>(3 * nodes[a], 3 * nodes[b]) += at.K.block<3, 3>(3 * a, 3 * b);
  }
  for (const bool bends : {false, true}) {
    Eigen::VectorXd u(48), inner(48);
    for (int i = 0; i < 16; ++i) {
      const double x = X[i][0], y = X[i][1], z = X[i][2], across = -nu / (1 - nu) * 2e-3;
      u.segment<3>(3 * i) =
          bends ? Vec3(-z * 1e-3 * (x + y / 2), -z * 1e-3 * (y + x / 2), 1e-3 * (x * x + x * y + y * y) / 2 - across * z * z / 2)
                : Vec3(1e-3 * (x + y / 2), 1e-3 * (y + x / 2), across * z);
    }
    std::vector<int> free;
    for (int i = 0; i < 48; ++i)
      if (i / 3 % 8 >= 4) free.push_back(i);
    Eigen::VectorXd outside = u;
    for (const int i : free) outside[i] = 0;
    const Eigen::VectorXd found = K(free, free).eval().partialPivLu().solve(-(K * outside)(free));
    const double off = (found - u(free)).cwiseAbs().maxCoeff() / u(free).cwiseAbs().maxCoeff();
    std::printf("%s: %.1e\n", bends ? "bending" : "membrane", off);
    EXPECT_LT(off, bends ? 1e-8 : 1e-9);
  }
}

// Truth: work over a step is the change of energy and what flow takes; forces have no sum and no moment about the middle of the step.
TEST(Shell, KeepsEnergyAndMomentaWithEveryLaw) {
  const Lame c = lame(1, 0.3);
  J2 metal{c, 0.01};
  metal.hardening = 0.1;
  const Material laws[] = {StVenantKirchhoff{c}, NeoHookean{c}, law_of<MooneyRivlin>(c), law_of<Orthotropic>(c), metal};
  const auto X = warped();
  for (const Material& law : laws) {
    const std::string name(kind_of(law).name);
    auto x = X;
    Answer before = answer(law, X, X, X, 0.5);
    double flow = 0;
    for (int step = 0; step < 6; ++step) {
      auto next = bent(X, 0.5 * step, 0.02, 17 * step);
      const Answer now = answer(law, X, x, next, 0.5, before.state);
      double work = 0;
      Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
      for (int a = 0; a < 8; ++a) {
        const Vec3 f = now.f.segment<3>(3 * a);
        work += f.dot(next[a] - x[a]), sum += f, moment += (x[a] + next[a]).cross(f) / 2;
      }
      EXPECT_NEAR(work, now.energy - before.energy + now.dissipated, 1e-14) << name;
      EXPECT_LT(sum.norm(), 1e-15) << name;
      EXPECT_LT(moment.norm(), 1e-14) << name;
      EXPECT_GT(now.energy, 1e-6) << name;
      EXPECT_GE(now.dissipated, 0) << name;
      flow += now.dissipated;
      before = now, x = next;
    }
    EXPECT_EQ(flow > 1e-6, name == "j2") << name << ' ' << flow;
  }
}

template <class M>
void expect_tangent(double weight) {
  const Lame c = lame(1, 0.3);
  const auto X = warped();
  const auto x0 = flat(bent(X, 0.3, 0.03, 5)), x1 = flat(bent(X, 0.8, 0.03, 50));
  const Wish wish{.elastic = 1, .viscous = 0.3, .weight = weight};
  const auto K = evaluate_cell<Shell8, M>(c, flat(X), x0, x1, wish).K;
  const auto dual = [](const std::vector<double>& v) { return std::vector<Dual>(v.begin(), v.end()); };
  Wish force = wish;
  force.tangent = false;
  for (int j = 0; j < 24; ++j) {
    auto x = dual(x1);
    x[j].d = 1;
    const auto f = evaluate_cell<Shell8, M>(c, dual(flat(X)), dual(x0), x, force).f;
    for (int i = 0; i < 24; ++i) EXPECT_NEAR(K[24 * i + j], f[i].d, 1e-11 * largest(K)) << i << ' ' << j;
  }
}
TEST(Shell, TangentIsTheDerivativeOfTheForce) {
  for (const double weight : {0.5, 0.7, 1.0}) expect_tangent<StVenantKirchhoff>(weight), expect_tangent<NeoHookean>(weight);
}

}  // namespace
}  // namespace hilo::test::shell_test
