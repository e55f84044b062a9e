// SPDX-License-Identifier: GPL-3.0-or-later
// Cells in vectors of 2, 4 and 8 give what one cell at a time gives.
#include "physics/cells.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo {
KernelFunction kernel_lanes2(Shape, size_t);
KernelFunction kernel_lanes4(Shape, size_t);
KernelFunction kernel_lanes8(Shape, size_t);
}  // namespace hilo

namespace hilo::test::lanes_test {
namespace {

template <class S>
class Lanes : public testing::Test {};
struct Name {
  template <class S>
  static std::string GetName(int) {
    return std::string(info(ShapeOf<S>::shape).name);
  }
};
using AllShapes = testing::Types<Tet4, Tet10, Wedge6, Wedge15, Hex8, Hex20, Hex20R, Shell8>;
TYPED_TEST_SUITE(Lanes, AllShapes, Name);

bool can_run(int width) {
#ifdef __x86_64__
  if (width == 4) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (width == 8) return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#endif
  return true;
}

void expect_close(const std::vector<double>& one, const double* many, int width, int lane, const char* what) {
  const double scale = largest(one);
  for (size_t i = 0; i < one.size(); ++i)
    ASSERT_NEAR(many[i * width + lane], one[i], 1e-13 * scale) << what << " entry " << i << " lane " << lane;
}

// Truth: lanes hold different cells and do not touch each other; only the order of rounding (fused multiply-add) may differ.
TYPED_TEST(Lanes, EveryLaneIsTheCellAlone) {
  using S = TypeParam;
  constexpr int n3 = 3 * S::n;
  for (const Material& law : both_laws)
    for (const auto& [width, function] : {std::pair{2, &kernel_lanes2}, {4, &kernel_lanes4}, {8, &kernel_lanes8}}) {
      if (!can_run(width)) continue;
      struct alignas(64) Block {
        double v[8];
      };
      std::vector<Block> X(n3), x0(n3), x1(n3), a(n3), f(n3), K(n3 * n3), scalars(3);
      const auto lane_of = [&](std::vector<Block>& b) { return reinterpret_cast<double*>(b.data()); };
      std::vector<Evaluated<double>> alone;
      const Wish wish{.elastic = 1, .viscous = 0.4, .density = 900, .mass_slope = 50};
      for (int l = 0; l < width; ++l) {
        const auto cell = some_cell<S>(0.05, 100 * l);
        const auto X_ = flat(cell), x0_ = flat(bent(cell, 0.1 * l, 0.1, l)), x1_ = flat(bent(cell, 0.3 + 0.2 * l, 0.1, 7 * l));
        const auto a_ = flat(bent(cell, 1, 0.5, 3 * l));
        for (int i = 0; i < n3; ++i)
          lane_of(X)[i * width + l] = X_[i], lane_of(x0)[i * width + l] = x0_[i], lane_of(x1)[i * width + l] = x1_[i],
                                 lane_of(a)[i * width + l] = a_[i];
        alone.push_back(std::holds_alternative<StVenantKirchhoff>(law)
                            ? evaluate_cell<S, StVenantKirchhoff>(rubber, X_, x0_, x1_, wish, &a_)
                            : evaluate_cell<S, NeoHookean>(rubber, X_, x0_, x1_, wish, &a_));
      }
      KernelCall call{};
      call.X = lane_of(X), call.x0 = lane_of(x0), call.x1 = lane_of(x1), call.a = lane_of(a);
      call.elastic = wish.elastic, call.viscous = wish.viscous, call.law = parameters(law), call.density = wish.density,
      call.mass_slope = wish.mass_slope;
      call.f = lane_of(f), call.K = lane_of(K);
      alignas(64) double energy[8], dissipated[8], det[8];
      call.energy = energy, call.dissipated = dissipated, call.least_det = det;
      function(ShapeOf<S>::shape, law.index())(call);
      for (int l = 0; l < width; ++l) {
        expect_close(alone[l].f, lane_of(f), width, l, "force");
        expect_close(alone[l].K, lane_of(K), width, l, "tangent");
        EXPECT_NEAR(energy[l], alone[l].energy, 1e-13 * std::abs(alone[l].energy));
        EXPECT_NEAR(dissipated[l], alone[l].dissipated, 1e-13 * alone[l].dissipated);
        EXPECT_NEAR(det[l], alone[l].least_det, 1e-13);
      }
    }
}

TEST(LaneWidth, IsOneThisProcessorCanRun) {
  EXPECT_TRUE(lanes() == 2 || lanes() == 4 || lanes() == 8);
  EXPECT_TRUE(can_run(lanes()));
}

}  // namespace
}  // namespace hilo::test::lanes_test
