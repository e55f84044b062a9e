// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-reduce: modes on file serve as if they were found anew, or are refused by name.
#include "verify/linear_region/bars.hpp"

namespace hilo::test::reduced_file_test {
namespace {

using namespace soft_bars;

class ReducedFile : public testing::Test {
 protected:
  ReducedFile() {
    c.use(two_bars(5), {Fidelity::linear, Fidelity::linear});
    const Ran ran = reduce();
    EXPECT_EQ(ran.exit, 0) << ran.err;
  }
  Ran reduce(const std::string& options = "") const { return c.run("hilo-reduce " + c.source("scene.toml") + " tags.h5 " + options); }
  /// The run is refused for this reason, and leaves nothing.
  void expect_refused(const std::string& reason, const std::string& options, const std::string& scene = "scene") const {
    const Ran ran = c.solve("--modes reduced.h5 " + options, "refused.h5", 2, scene);
    EXPECT_NE(ran.err.find("reduced.h5 does not serve: " + reason), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("scene.toml:"), std::string::npos) << ran.err;
    EXPECT_FALSE(std::filesystem::exists(c / "refused.h5"));
  }
  /// Frequencies to 1e-8, and modes that span the same.
  void expect_same_modes(const std::string& other) const {
    const Store truth = Store::open(c / "reduced.h5"), file = Store::open(c / other);
    for (const std::string region : {"/reduced/left_block/", "/reduced/right_block/"}) {
      const auto a = truth.read<double>(region + "omega2"), b = file.read<double>(region + "omega2");
      ASSERT_EQ(a.size(), b.size());
      for (size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(b[k] / a[k], 1, 2e-8) << other << ", " << region << k;
      const auto m = static_cast<Eigen::Index>(a.size());
      const auto shapes = [&](const Store& store, std::vector<double>& values) {
        values = store.read<double>(region + "shapes");
        return Eigen::MatrixXd(
            Eigen::Map<const Eigen::MatrixXd>(values.data(), m, static_cast<Eigen::Index>(values.size()) / m).transpose());
      };
      std::vector<double> kept[2];
      const Eigen::MatrixXd A = shapes(truth, kept[0]), B = shapes(file, kept[1]);
      const Eigen::MatrixXd left = B - A * A.colPivHouseholderQr().solve(B);
      EXPECT_LT(left.norm(), 1e-6 * B.norm()) << other;
    }
  }
  SceneCase c{soft + hinge + force("push", "right_xmax", {0, 0, 3}) + thrown + in_time(0.08, 0.004)};
};

TEST_F(ReducedFile, GivesTheRunThatFindsThemBitByBit) {
  const auto found = c.solved("", "found.h5"), taken = c.solved("--modes reduced.h5", "taken.h5");
  for (const std::string name : {"energy", "momentum", "joint/hinge", "modes/left_block", "modes/right_block"})
    EXPECT_EQ(found.history(name), taken.history(name)) << name;
  EXPECT_EQ(found.field("displacement"), taken.field("displacement"));
  EXPECT_GT(taken.history("energy").col(1).maxCoeff(), 0);
}

TEST_F(ReducedFile, ServesOnRanks) {
  ASSERT_EQ(c.run("hilo-part --quiet tags.h5 " + c.source("scene.toml") + " -n 3 -o parts.h5").exit, 0);
  succeeded(mpirun(3, "hilo-solve --quiet " + c.source("scene.toml") + " parts.h5 --modes reduced.h5 -o ranks.h5", c.path()));
  const auto ranks = c.results("ranks.h5"), serial = c.solved("--modes reduced.h5", "serial.h5");
  EXPECT_LT((ranks.history("modes/left_block") - serial.history("modes/left_block")).cwiseAbs().maxCoeff(),
            1e-7 * serial.history("modes/left_block").cwiseAbs().maxCoeff());
}

// A run.h5 of the modes, to be drawn: each is the region displaced by its shape on file.
TEST_F(ReducedFile, DrawsItsModes) {
  const Ran ran = reduce("-o again.h5 --shapes shapes.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.out.find("left_block, mode 1: "), std::string::npos) << ran.out;
  const Results shown = c.results("shapes.h5");
  const Store file = Store::open(c / "again.h5");
  const auto omega2 = file.read<double>("/reduced/left_block/omega2"), shapes = file.read<double>("/reduced/left_block/shapes");
  const auto m = static_cast<Eigen::Index>(omega2.size());
  const Eigen::MatrixXd on_file = Eigen::Map<const Eigen::MatrixXd>(shapes.data(), m, static_cast<Eigen::Index>(shapes.size()) / m);
  const auto steps = shown.steps();
  ASSERT_GT(static_cast<Eigen::Index>(steps.size()), m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const auto u = shown.field("displacement", steps[static_cast<size_t>(j) + 1]);
    Eigen::VectorXd of_left(on_file.cols());
    for (Eigen::Index i = 0; i < on_file.cols() / 3; ++i) of_left.segment<3>(3 * i) = u[static_cast<size_t>(i)];
    const Eigen::VectorXd mode = on_file.row(j).transpose();
    EXPECT_GT(of_left.norm(), 0) << j;
    EXPECT_NEAR(of_left.dot(mode) / of_left.norm() / mode.norm(), 1, 1e-9) << "mode " << j + 1;
  }
  EXPECT_EQ(c.run("hilo-post render shapes.h5 --field von_mises --steps 1 --size 320x240 -o mode.png").exit, 0);
}

TEST_F(ReducedFile, IsKeptWhereNothingThatItDependsOnChanged) {
  const std::string before = text_of(c / "reduced.h5");
  EXPECT_NE(reduce("--set time.end=7 --set 'gravity=[0,0,-9]'").out.find("modes, as before\nright_block"), std::string::npos);
  const Ran other = reduce("--set material.soft.E=2e7");
  EXPECT_EQ(other.exit, 0);
  EXPECT_EQ(other.out.find("as before"), std::string::npos) << other.out;
  EXPECT_EQ(c.solve("--quiet --modes reduced.h5 --set material.soft.E=2e7").exit, 0);
}

/// Where the factor of a region finds no memory, its size is told before anything is done; with half of it, or a file, the modes are the
/// same.
TEST_F(ReducedFile, NeedsRoomForAFactorOrSaysHowMuch) {
  const Ran none = reduce("-o none.h5 --memory 0");
  expect_end(none, 4, "linear region \"left_block\": its stiffness has a factor of ");
  EXPECT_NE(none.err.find("--scratch"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(c / "none.h5"));
  const double size = std::stod(none.err.substr(none.err.find("factor of ") + 10));
  EXPECT_GT(size, 1e-6);
  std::filesystem::create_directory(c / "scratch");
  ASSERT_EQ(reduce("-o single.h5 --memory " + fmt::format("{:e}", 0.7 * size)).exit, 0);
  ASSERT_EQ(reduce("-o file.h5 --memory 0 --scratch scratch").exit, 0);
  EXPECT_TRUE(std::filesystem::is_empty(c / "scratch"));
  for (const char* other : {"single.h5", "file.h5"}) expect_same_modes(other);
}

TEST_F(ReducedFile, IsTheSameFromRanks) {
  for (const int ranks : {2, 3}) {
    succeeded(mpirun(ranks, "hilo-reduce " + c.source("scene.toml") + " tags.h5 -o ranks.h5 --shapes shapes.h5", c.path()));
    expect_same_modes("ranks.h5");
    EXPECT_EQ(c.solve("--quiet --modes ranks.h5").exit, 0);
    std::filesystem::remove(c / "ranks.h5");
  }
  const Ran none = mpirun(2, "hilo-reduce " + c.source("scene.toml") + " tags.h5 -o none.h5 --memory 0", c.path());
  expect_end(none, 4, "its stiffness has a factor of ");
  EXPECT_FALSE(std::filesystem::exists(c / "none.h5"));
}

TEST_F(ReducedFile, OfAnotherMaterialIsRefused) { expect_refused("it is of another material", "--set material.soft.E=2e7"); }
TEST_F(ReducedFile, OfAnotherDensityIsRefused) { expect_refused("it is of another material", "--set material.soft.density=999"); }
TEST_F(ReducedFile, OfOtherModesIsRefused) { expect_refused("it was made for other modes", "--set 'region.*.modes=3'"); }
TEST_F(ReducedFile, OfAnotherStepIsRefusedAsItsModesGoUpToAnotherFrequency) {
  expect_refused("it was made for other modes", "--set time.step=0.002");
}
TEST_F(ReducedFile, OfOtherLoadsIsRefused) { expect_refused("it is of other loads", "--set load.push.on=right_ymax"); }
TEST_F(ReducedFile, ThatLacksTheInterfaceOfAJointIsRefused) {
  expect_refused("it lacks the interface \"left_ymax\"", "--set joint.hinge.a=left_ymax");
}
TEST_F(ReducedFile, OfAnotherMeshIsRefused) {
  c.use(two_bars(6), {Fidelity::linear, Fidelity::linear});
  expect_refused("it is of another mesh", "");
}
TEST_F(ReducedFile, OfOneRegionIsRefusedForTwo) {
  c.use(two_bars(5), {Fidelity::rigid, Fidelity::linear});
  ASSERT_EQ(reduce().exit, 0);
  c.use(two_bars(5), {Fidelity::linear, Fidelity::linear});
  expect_refused("it lacks the region", "");
}
TEST_F(ReducedFile, WhoseInterfaceIsHeldIsRefusedWhereItsModesAreFree) {
  c.write("scene.toml", soft + in_time(0.1, 0.004));
  expect_end(c.run("hilo-solve scene.toml tags.h5 --modes reduced.h5 -o refused.h5"), 2,
             "its modes were found with the interface \"left_xmax\" held, and nothing holds it here");
}

TEST_F(ReducedFile, ThatIsNoneOrDamagedIsRefused) {
  EXPECT_NE(c.solve("--modes tags.h5", "refused.h5", 2).err.find("not a file of reduced regions"), std::string::npos);
  EXPECT_NE(c.solve("--modes nowhere.h5", "refused.h5", 2).err.find("no such file"), std::string::npos);
  const std::string whole = text_of(c / "reduced.h5");
  c.write("reduced.h5", whole.substr(0, whole.size() / 2));
  EXPECT_EQ(c.solve("--modes reduced.h5", "refused.h5", 2).exit, 2);
  EXPECT_EQ(reduce().exit, 2) << "nor is it written over";
}

/// Its held bar is a cantilever at both ends of its vibrations: what they carry of the mass is known.
TEST_F(ReducedFile, TellsTheMassThatVibrationsCarry) {
  const Ran ran = succeeded(c.run("hilo-show --json reduced.h5"));
  EXPECT_NE(ran.out.find("\"interfaces\": \"left_xmax\""), std::string::npos) << ran.out;
  const Store store = Store::open(c / "reduced.h5");
  const auto held = store.read<double>("/reduced/left_block/held");
  // first two bending modes of a clamped bar carry .613 of its mass [blevins-1979]; the first frequency, .1615 sqrt(E/rho) h/L^2
  EXPECT_NEAR(held[2] + held[3], 0.613, 0.01) << held[0];
  EXPECT_NEAR(held[6] + held[7], 0.613, 0.01);
  EXPECT_NEAR(held[0], 0.1615 * 100 * 0.1, 0.03 * 1.6);
}

}  // namespace
}  // namespace hilo::test::reduced_file_test
