// SPDX-License-Identifier: GPL-3.0-or-later
// A patch of bent cells under a homogeneous state: every cell must have exactly that state, whatever its shape (Irons' patch test).
#include "physics/stress.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::patch_test {
namespace {

std::string block_of(const std::string& law) {
  return solid(2e11, 0.3, 7800, "block", "kind = \"" + law + "\"") + "[time]\nanalysis = \"static\"\n[output]\ninterval = 1\n";
}

class Patch : public testing::TestWithParam<Shape> {
 protected:
  /// 2 x 2 x 2 bricks of 0.5 m, the corners inside the block moved in space, those on a face within it.
  static Mesh mesh() {
    return block_mesh({.shape = GetParam(), .n = {2, 2, 2}, .map = [](const Vec3& x) {
                         Vec3 y = x;
                         for (int i = 0; i < 3; ++i)
                           if (std::abs(x[i] - 0.5) < 1e-9)
                             y[i] += 0.12 * scatter(static_cast<int>(std::lround(2 * x[0] + 6 * x[1] + 18 * x[2])) + 40 * i);
                         return y;
                       }});
  }
  static Vec6 voigt(const Mat3& s) {
    Vec6 v;
    v << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1);
    return v;
  }
};
INSTANTIATE_TEST_SUITE_P(EveryShape, Patch,
                         testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

// Truth: u = H X on the surface is in equilibrium inside (constant stress, no body force): every inner node must take H X too, to 1e-10 of
// it.
TEST_P(Patch, LinearDisplacementOfTheSurfaceIsTakenByEveryInnerNode) {
  Mesh m = mesh();
  Mat3 H;
  H << 0.8, 0.3, -0.5, -0.2, 1.0, 0.4, 0.6, -0.1, -0.7;
  H *= 1e-3;
  std::string surface_moves;
  const auto surface = m.nodes_of("surface", "");
  for (const std::int64_t a : surface) {
    const std::string name = "n" + std::to_string(a);
    m.node_sets[name] = {a};
    // two entries, for x y and for z, so that components and not a rigid patch are prescribed
    for (const char* components : {"\"x\", \"y\"", "\"z\""})
      surface_moves += motion("translation", name + components[1], name,
                              fmt::format("components = [{}]\ndisplacement = {}", components, list(H * m.X[a])));
  }
  for (const std::string law : {"stvk", "neo-hookean"}) {
    SceneCase c(block_of(law) + surface_moves);
    c.use(m);
    const Results r = c.solved();
    const auto u = r.field("displacement");
    double worst = 0;
    int inner = 0;
    for (std::int64_t a = 0; a < m.n_nodes(); ++a) {
      worst = std::max(worst, (u[a] - H * m.X[a]).cwiseAbs().maxCoeff());
      inner += !std::binary_search(surface.begin(), surface.end(), a);
    }
    EXPECT_GE(inner, 1);
    EXPECT_LT(worst, 1e-10 * H.norm()) << law;
    // and the stress is the law's at F = I + H, at every node
    const Mat3 F = Mat3::Identity() + H, E = (F.transpose() * F - Mat3::Identity()) / 2;
    const Lame k = lame(2e11, 0.3);
    const double J = F.determinant();
    const Mat3 sigma = law == "stvk"
                           ? Mat3(F * (k.lambda * E.trace() * Mat3::Identity() + 2 * k.mu * E) * F.transpose() / J)
                           : Mat3((k.mu * (F * F.transpose() - Mat3::Identity()) + k.lambda * std::log(J) * Mat3::Identity()) / J);
    const auto s = r.table("/field/" + r.steps().back() + "/stress");
    for (Eigen::Index a = 0; a < s.rows(); ++a) ASSERT_LT((s.row(a).transpose() - voigt(sigma)).norm(), 1e-9 * sigma.norm());
  }
}

// Truth: uniform tractions on the faces of a box on rollers stretch it by F = diag(l1, l2, l2) with S_yy = S_zz = 0: for St.
// Venant-Kirchhoff T = l1 E e1 with e1 = (l1^2 - 1)/2 and e2 = -nu e1, T the force per reference area.
TEST_P(Patch, UniformTractionStretchesTheBlockUniformly) {
  const Mesh m = mesh();
  const double E = 2e11, nu = 0.3, l1 = 1.05, e1 = (l1 * l1 - 1) / 2, T = l1 * E * e1, l2 = std::sqrt(1 - 2 * nu * e1);
  SceneCase c(block_of("stvk") + held("xmin", "x") + held("ymin", "y") + held("zmin", "z") +
              load("traction", "pull", "xmax", fmt::format("traction = [{:.17g}, 0, 0]", T)));
  c.use(m);
  const Results r = c.solved();
  const auto u = r.field("displacement");
  for (std::int64_t a = 0; a < m.n_nodes(); ++a) {
    const Vec3 exact((l1 - 1) * m.X[a][0], (l2 - 1) * m.X[a][1], (l2 - 1) * m.X[a][2]);
    ASSERT_LT((u[a] - exact).cwiseAbs().maxCoeff(), 1e-10) << "node " << a;
  }
  const auto von_mises_field = r.table("/field/" + r.steps().back() + "/von_mises");
  EXPECT_NEAR(von_mises_field.minCoeff(), T / (l2 * l2), 1e-8 * T);
  EXPECT_NEAR(von_mises_field.maxCoeff(), T / (l2 * l2), 1e-8 * T);
  // the rollers at xmin carry the whole pull
  EXPECT_NEAR(r.at("motion/xmin x", 1)[0], -T, 1e-8 * T);
}

}  // namespace
}  // namespace hilo::test::patch_test
