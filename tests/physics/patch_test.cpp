// SPDX-License-Identifier: GPL-3.0-or-later
// A homogeneous deformation of a bent patch of cells: the stress is constant, so nothing is left at the inner nodes.
#include "physics/cells.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo::test::patch_test {
namespace {

class Patch : public testing::TestWithParam<std::tuple<Shape, int, double>> {};  // and the amplitude of the displacement gradient

/// 3 x 3 x 3 bricks of that shape, every corner inside the block moved, so that no cell is a parallelepiped and no inner facet is plane.
Mesh bent_patch(Shape shape) {
  return block_mesh({.shape = shape, .n = {3, 3, 3}, .map = [](const Vec3& x) {
                       Vec3 y = x;
                       const bool inside = (x.array() > 1e-9).all() && (x.array() < 1 - 1e-9).all();
                       const int seed = static_cast<int>(std::lround(3 * x[0]) + 10 * std::lround(3 * x[1]) + 100 * std::lround(3 * x[2]));
                       if (inside)
                         for (int i = 0; i < 3; ++i) y[i] += 0.06 * scatter(seed + 1000 * i);
                       return y;
                     }});
}

// Truth: int grad N_a dV over the cells around an inner node is the surface integral of N_a n, which is zero; so a constant first
// Piola stress leaves no residual.  The rule of the cell must integrate grad N_a exactly for that, on any straight-sided mesh.
TEST_P(Patch, HomogeneousDeformationLeavesNoForceAtInnerNodes) {
  const auto [shape, law, amplitude] = GetParam();
  const Mesh m = bent_patch(shape);
  const auto surface = m.nodes_of("surface", "");
  Mat3 H;
  H << 0.8, 0.3, -0.5, -0.2, 1.0, 0.4, 0.6, -0.1, -0.7;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const Material material = law == place_of<StVenantKirchhoff> ? Material(StVenantKirchhoff{c}) : NeoHookean{c};
    const SolidKernel kernel = solid_kernel(shape, law);
    const int W = kernel.width, n3 = 3 * info(shape).n_nodes;
    std::vector<Vec3> residual(m.n_nodes(), Vec3::Zero());
    double scale = 0;
    for (std::int64_t e = 0; e < m.n_cells(); ++e) {
      alignas(64) double X[60 * 8], x[60 * 8], f[60 * 8];
      for (int i = 0; i < n3; ++i)
        for (int l = 0; l < W; ++l) {
          const Vec3& at = m.X[m.cell(e)[i / 3]];
          X[i * W + l] = at[i % 3], x[i * W + l] = at[i % 3] + amplitude * H.row(i % 3).dot(at);
        }
      KernelCall call{};
      call.X = X, call.x0 = call.x1 = x, call.elastic = 1, call.law = parameters(material), call.f = f;
      kernel.call(call);
      for (int i = 0; i < n3; ++i) residual[m.cell(e)[i / 3]][i % 3] += f[i * W], scale = std::max(scale, std::abs(f[i * W]));
    }
    double worst = 0;
    int inner = 0;
    for (std::int64_t a = 0; a < m.n_nodes(); ++a)
      if (!std::binary_search(surface.begin(), surface.end(), a)) worst = std::max(worst, residual[a].cwiseAbs().maxCoeff()), ++inner;
    EXPECT_GE(inner, 8);
    EXPECT_LT(worst, 1e-10 * scale);
  }
}

std::string name_of(const testing::TestParamInfo<Patch::ParamType>& p) {
  return std::string(info(std::get<0>(p.param)).name) + (std::get<1>(p.param) == place_of<StVenantKirchhoff> ? "_stvk" : "_neo_hookean") +
         (std::get<2>(p.param) < 0.01 ? "_small" : "_large");
}
INSTANTIATE_TEST_SUITE_P(EveryShape, Patch,
                         testing::Combine(testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8,
                                                          Shape::hex20, Shape::hex20r),
                                          testing::Values(place_of<StVenantKirchhoff>, place_of<NeoHookean>), testing::Values(1e-3, 0.3)),
                         name_of);

}  // namespace
}  // namespace hilo::test::patch_test
