// SPDX-License-Identifier: GPL-3.0-or-later
// What acts on a region as a whole, or is measured there, means the same at every fidelity and on every mesh.

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::whole_region_test {
namespace {

constexpr double rho = 8000, end = 0.01;
const Vec3 size(0.3, 0.1, 0.1);

/// Cells that are far smaller at x = 0, so that the mean of the nodes is far from the centre; two regions that share nodes.
Mesh graded() {
  return block_mesh({.n = {6, 2, 2},
                     .high = size,
                     .map = [](const Vec3& x) { return Vec3(x[0] * x[0] / size[0], x[1], x[2]); },
                     .regions = {"left", "right"},
                     .region_of = [](const Vec3& x) { return x[0] < 0.2 ? 0 : 1; }});
}
const double border = 0.2 * 0.2 / 0.3;  // of the regions, after the map
const Vec3 centre_left(border / 2, 0.05, 0.05);
const double mass = rho * 0.3 * 0.01, mass_left = rho * border * 0.01;

class WholeRegion : public testing::TestWithParam<std::tuple<Fidelity, int>> {
 protected:
  void SetUp() override {
    write_mesh(work / "mesh.h5", graded(), {"test"});
    write_tags(work / "tags.h5", work / "mesh.h5", {std::get<0>(GetParam()), std::get<0>(GetParam())}, {"test"});
  }
  Results solved(const std::string& entry) {
    work.write("scene.toml", "[material.m]\nE = 2e12\nnu = 0.3\ndensity = 8000\n[region.\"*\"]\nmaterial = \"m\"\n" + entry +
                                 "[time]\nend = 0.01\nstep = 1e-3\n");
    const std::string command = "hilo-solve --quiet scene.toml tags.h5 -o run.h5";
    const int ranks = std::get<1>(GetParam());
    const Ran ran = ranks > 1 ? mpirun(ranks, command, work.path()) : work.run(command);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    return Results(work / "run.h5");
  }
  /// Momentum and angular momentum about the origin that a constant force at a point gives.
  static Eigen::Matrix<double, 6, 1> impulse(const Vec3& at, const Vec3& force) {
    Eigen::Matrix<double, 6, 1> p;
    p << force * end, at.cross(force) * end;
    return p;
  }
  void expect_momentum(const Results& r, const Eigen::Matrix<double, 6, 1>& truth) {
    const Eigen::MatrixXd p = r.history("momentum");
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(p(p.rows() - 1, k) - p(0, k), truth[k], 2e-4 * truth.norm()) << k;  // points move a little
  }
  Workplace work;
};

// Truth: F t and r x F t with r the centre of the region; the probe is there.
TEST_P(WholeRegion, AForceActsAtItsCentreOfMass) {
  const Vec3 force(0, 30, -20);
  const Results r =
      solved("[[load]]\nkind = \"force\"\nname = \"f\"\non = \"left\"\nforce = [0, 30, -20]\n[[probe]]\nname = \"p\"\non = \"left\"\n");
  expect_momentum(r, impulse(centre_left, force));
  const Eigen::MatrixXd p = r.history("probe/p");
  EXPECT_LT((p.row(0).head<3>().transpose() - centre_left).norm(), 1e-12);
}

// Truth: m a t, with the mass of the region named, not of the body that two rigid ones are.
TEST_P(WholeRegion, AnAccelerationActsOnItsOwnMass) {
  const Results r = solved("[[load]]\nkind = \"acceleration\"\nname = \"a\"\non = \"left\"\nacceleration = [0, 3, -2]\n");
  expect_momentum(r, impulse(centre_left, mass_left * Vec3(0, 3, -2)));
}

// Truth: m w^2 r_c t away from the axis.
TEST_P(WholeRegion, ACentrifugalForceIsThatOfItsMass) {
  const Results r =
      solved("[[load]]\nkind = \"centrifugal\"\nname = \"c\"\non = \"left\"\nat = [-0.5, 0, 0]\naxis = [0, 0, 1]\nspeed = 3\n");
  expect_momentum(r, impulse(centre_left, mass_left * 9 * Vec3(centre_left[0] + 0.5, centre_left[1], 0)));
}

// Truth: the momenta of a region that is denser by the mass added, translating and spinning.
TEST_P(WholeRegion, AMassIsSpreadAsItsOwn) {
  const double more = 5;
  const std::string moves = "[[initial]]\non = [\"left\", \"right\"]\nvelocity = [0, 2, 0]\nspin = [0, 0, 4]\nabout = [0, 0, 0]\n";
  const Results with = solved(moves + fmt::format("[[point_mass]]\nname = \"m\"\non = \"left\"\nmass = {}\n", more)),
                without = solved(moves);
  const Eigen::VectorXd change = (with.history("momentum").row(0) - without.history("momentum").row(0)).transpose();
  const Vec3 v = Vec3(0, 2, 0) + 4 * Vec3::UnitZ().cross(centre_left), p = more * v;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(change[k], p[k], 1e-9 * p.norm());
  // of masses at the nodes, which are as much as the cells around each: their moment of inertia is a little more than that of the cells
  const double moment = centre_left.cross(more * v)[2] + 4 * more * (border * border + 0.01) / 12;
  EXPECT_NEAR(change[5], moment, 0.05 * moment);
  EXPECT_GT(change[5], moment);
}

INSTANTIATE_TEST_SUITE_P(EveryFidelity, WholeRegion,
                         testing::Combine(testing::Values(Fidelity::rigid, Fidelity::linear, Fidelity::nonlinear), testing::Values(1, 2)),
                         [](const auto& info) { return fmt::format("{}_{}", word(std::get<0>(info.param)), std::get<1>(info.param)); });

// A mass as large as the region makes it twice as dense.  Corners of cells with mid-side nodes had masses below zero, and modes that fall.
TEST(WholeRegionMass, OfQuadraticCellsIsNowhereNegative) {
  for (const Shape shape : {Shape::hex20r, Shape::wedge15, Shape::tet10})
    for (const Fidelity fidelity : {Fidelity::linear, Fidelity::nonlinear}) {
      double first[2];
      for (const bool more : {false, true}) {
        SceneCase c(solid(2e11, 0.3, 7800, "block") + held("xmin") +
                    (more ? "[[point_mass]]\nname = \"m\"\non = \"block\"\nmass = 78\n" : "") +
                    "[time]\nanalysis = \"modes\"\nmodes = 4\n");
        c.use(block_mesh({.shape = shape, .n = {10, 1, 1}, .high = {1, 0.1, 0.1}}), {fidelity});
        first[more] = c.solved().history("mode")(1, 0);
      }
      EXPECT_NEAR(first[1] / first[0], std::sqrt(0.5), 0.01) << info(shape).name << ", " << word(fidelity);
    }
}

// Truth: there is no such point on a flexible region, so it is refused.
TEST(WholeRegionRefused, AMassAtAPointOfAFlexibleRegion) {
  Workplace work;
  write_mesh(work / "mesh.h5", graded(), {"test"});
  write_tags(work / "tags.h5", work / "mesh.h5", {Fidelity::nonlinear, Fidelity::linear}, {"test"});
  for (const char* on : {"left", "right"}) {
    work.write("scene.toml",
               fmt::format("[material.m]\nE = 2e12\nnu = 0.3\ndensity = 8000\n[region.\"*\"]\nmaterial = \"m\"\n[[point_mass]]\n"
                           "name = \"m\"\non = \"{}\"\nmass = 5\nat = [0.1, 0.05, 0.05]\n[time]\nend = 0.01\nstep = 1e-3\n",
                           on));
    const Ran ran = work.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5");
    expect_end(ran, 2, "scene.toml:11:1");
    EXPECT_NE(ran.err.find("is flexible, its nodes share the mass"), std::string::npos) << ran.err;
  }
}

}  // namespace
}  // namespace hilo::test::whole_region_test
