// SPDX-License-Identifier: GPL-3.0-or-later
// The stress that Newton's last correction foresaw: it changes the geometric part of a tangent, and nothing where there was no correction.
#include "physics/cells.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo::test::foreseen_test {
namespace {

/// A bar along x from 0 to 1 whose end moves across by 0.1: to first order unstrained, of second order stretched by 0.005.
TEST(Foreseen, ABarThatTurnsHasNoStressToFirstOrder) {
  const Material law = StVenantKirchhoff{lame(1e9, 0.3)};
  const double X[6] = {0, 0, 0, 1, 0, 0}, turned[6] = {0, 0, 0, 1, 0.1, 0}, along[6] = {0, 0, 0, 0, 0.1, 0};
  const double area = 1e-4, Y = 1e9;
  for (const double w : {0.5, 1.0}) {
    double f[6], plain[36], foreseen[36];
    KernelCall call{};
    call.X = call.x0 = X, call.x1 = turned, call.elastic = 1, call.law = parameters(law), call.area = area, call.weight = w, call.f = f;
    const SolidKernel bar = solid_kernel(Shape::bar2, law.index());
    call.K = plain, bar.call(call);
    call.before = X, call.along = along, call.K = foreseen, bar.call(call);
    const double material = w * area * Y * (w * 0.1) * 0.1, geometric = w * w * area * Y * 0.005;
    EXPECT_NEAR(plain[3 * 6 + 6 * 1 + 4], material + geometric, 1e-9 * material);
    EXPECT_NEAR(foreseen[3 * 6 + 6 * 1 + 4], material, 1e-9 * material);
    EXPECT_NEAR(f[4], area * Y * w * 0.005 * w * 0.1, 1e-9 * std::abs(f[4])) << "the force is that of the positions";
  }
}

/// A correction of nothing foresees the stress that is there: every shape and law, conserving steps and instants.
TEST(Foreseen, WithoutACorrectionTheTangentIsTheTangent) {
  const Material laws[] = {StVenantKirchhoff{lame(1e6, 0.49)}, NeoHookean{lame(1e6, 0.49)}, MooneyRivlin{1e5, 5e4, 1e8}};
  const auto check = [&]<class S>(S) {
    constexpr Shape shape = ShapeOf<S>::shape;
    constexpr int n3 = 3 * S::n;
    const auto cell = some_cell<S>(0.05, 3);
    const auto X = flat(cell), x0 = flat(bent(cell, 0.05, 0.02, 1)), x1 = flat(bent(cell, 0.2, 0.03, 7));
    for (const Material& law : laws)
      for (const double w : {0.5, 1.0}) {
        const SolidKernel kernel = solid_kernel(shape, law.index());
        const int W = kernel.width;
        struct alignas(64) Line {
          double v[8];
        };
        const auto wide = [&](const std::vector<double>& one) {
          std::vector<Line> out(n3 * W / 8 + 1);
          for (int i = 0; i < n3; ++i)
            for (int l = 0; l < W; ++l) out[0].v[i * W + l] = one[i];
          return out;
        };
        const auto X_ = wide(X), x0_ = wide(x0), x1_ = wide(x1), none = wide(std::vector<double>(n3, 0.0));
        std::vector<Line> f(n3), plain(n3 * n3), foreseen(n3 * n3);
        KernelCall call{};
        call.X = X_[0].v, call.x0 = w == 0.5 ? x0_[0].v : x1_[0].v, call.x1 = x1_[0].v, call.elastic = 1, call.viscous = 0.3;
        call.law = parameters(law), call.weight = w, call.f = f[0].v, call.K = plain[0].v;
        kernel.call(call);
        const std::vector<Line> force = f;
        call.before = x1_[0].v, call.along = none[0].v, call.K = foreseen[0].v;
        kernel.call(call);
        double most = 0;
        for (int i = 0; i < n3 * n3; ++i) most = std::max(most, std::abs(plain[0].v[i * W]));
        for (int i = 0; i < n3 * n3; ++i) ASSERT_NEAR(foreseen[0].v[i * W], plain[0].v[i * W], 1e-10 * most) << info(shape).name;
        for (int i = 0; i < n3; ++i) ASSERT_EQ(f[0].v[i * W], force[0].v[i * W]);
      }
  };
  check(Tet4{}), check(Tet10{}), check(Wedge6{}), check(Wedge15{}), check(Hex8{}), check(Hex20{}), check(Hex20R{});
}

}  // namespace
}  // namespace hilo::test::foreseen_test
