// SPDX-License-Identifier: GPL-3.0-or-later
// Motions of sets that begin away from the drawing: what hangs on them begins moved with them, as a rigid body, at every fidelity.
#include "verify/motions/motions.hpp"

namespace hilo::test::start_test {
namespace {

const std::string off_zero = "\nhistory = {t = [0, 1], value = [1, 1]}";
const std::string steel = solid(2e11, 0.3, 8000) + probe("tip", "xmax");

Mesh bar() { return block_mesh({.shape = Shape::hex20r, .n = {8, 1, 1}, .high = {1, 0.05, 0.05}}); }

// Exact: moved as a rigid body the bar rests without strain, and its tip is where the motion brings it.
TEST_F(Motions, ThatBeginAwayBeginWithTheirRegionOnRanksToo) {
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  ASSERT_EQ(run("hilo-part mesh.h5 -n 2 -o parts.h5").exit, 0);
  const auto shift = [](const std::string& on, const std::string& more = "") {
    return motion("translation", on, on, "displacement = [0, 0, 0.3]" + off_zero + more);
  };
  const Vec3 turned(std::cos(0.7) + 0.025 * std::sin(0.7), 0.025, 0.025 * std::cos(0.7) - std::sin(0.7)), up(1, 0.025, 0.325);
  const std::string turn = motion("rotation", "turn", "xmin", "at = [0, 0, 0]\naxis = [0, 1, 0]\nangle = 0.7" + off_zero);
  const std::string by_components = held("xmin", "xy") + shift("xmin", "\ncomponents = [\"z\"]");
  for (const auto& [moved, to] : {std::pair{turn, turned}, {shift("xmin"), up}, {shift("xmin") + shift("xmax"), up}, {by_components, up}})
    for (const std::string mesh : {"mesh.h5", "parts.h5"}) {
      write("scene.toml", steel + moved + in_time(2e-3, 1e-4));
      const std::string command = "hilo-solve scene.toml " + mesh + " -o run.h5";
      const Ran ran = mesh == "parts.h5" ? mpirun(2, command, path()) : run(command);
      ASSERT_EQ(ran.exit, 0) << ran.err;
      EXPECT_EQ(ran.err.find("warning"), std::string::npos) << ran.err;
      const Results r(*this / "run.h5");
      for (const double t : {0., 2e-3}) EXPECT_LT((r.at("probe/tip", t).head<3>() - to).norm(), 1e-11) << moved;
      EXPECT_LT(r.history("energy").leftCols(2).maxCoeff(), 1e-10) << "J; its first cells alone would have 1e3 J\n" << moved;
    }
}

TEST_F(Motions, ThatTearTheirRegionAtTheStartAreTold) {
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  const std::string said = "motion \"pull\" begins away from the drawing, and what else holds its region does not move with it";
  const std::string pull = motion("translation", "pull", "xmax", "displacement = [1e-4, 0, 0]" + off_zero);
  write("scene.toml", steel + held("xmin") + pull + in_time(1e-4, 1e-5));
  solved("", "mesh.h5");
  EXPECT_NE(err.find(said), std::string::npos) << err;
  solved("--set 'time.start=\"equilibrium\"'", "mesh.h5");
  EXPECT_EQ(err.find("begins away"), std::string::npos) << err;
  write("scene.toml", steel + held("xmin") +
                          motion("translation", "pull", "xmax", "displacement = [1e-4, 0, 0]\nhistory = {t = [0, 1], value = [0, 1]}") +
                          in_time(1e-4, 1e-5));
  solved("", "mesh.h5");
  EXPECT_EQ(err.find("begins away"), std::string::npos) << err;
}

// Exact: the region goes along, and nothing jumps.
TEST_F(Motions, ThatBeginAwayFromTheDrawingAreNoSnapThrough) {
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  for (const auto& [level, stiffens] : {std::pair{Fidelity::linear, false}, {Fidelity::linear, true}, {Fidelity::nonlinear, false}}) {
    write_tags(*this / "tags.h5", *this / "mesh.h5", {level}, {"test"});
    write("scene.toml", solid(2e11, 0.3, 8000, "*", "", stiffens ? "stiffening = true" : "") + probe("tip", "xmax") +
                            motion("translation", "drive", "xmin", "displacement = [0, 0, 0.001]" + off_zero) + in_steps(4));
    const Results r = solved("", "tags.h5");
    EXPECT_EQ(err.find("warning"), std::string::npos) << err;
    EXPECT_EQ(r.t().size(), 5);
    EXPECT_EQ(reported("cuts"), 0);
    EXPECT_NEAR(r.at("probe/tip", 1)[2], 0.026, 1e-10);
  }
}

}  // namespace
}  // namespace hilo::test::start_test
