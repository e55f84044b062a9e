// SPDX-License-Identifier: GPL-3.0-or-later
// The ladder frame of data/frame: what its tyres carry at rest, its energy over the bump, and modes of a joint of it.
#include <sstream>

#include "verify/verify.hpp"

namespace hilo::test::beams_frame_test {
namespace {

const std::string data = std::string(HILO_SOURCE) + "/data/frame/";

// Weights and moments about the front axle, by hand, say what each axle carries; frame and wheels are alike on the left and on the right.
TEST(LadderFrame, TyresCarryTheWeight) {
  const Workplace work;
  succeeded(work.run("hilo-solve --quiet " + data + "scene.toml -o run.h5 --set time.end=0.3"));
  const Results r(work / "run.h5");
  const double rail = 7850 * (0.08 * 0.16 - 0.068 * 0.148) * 5, cross = 7850 * M_PI / 4 * (0.09 * 0.09 - 0.08 * 0.08) * 0.696,
               plates = 2 * 1.85;
  double mass = 0, moment = 0;  // about the front axle
  for (const auto& [m, x] : {std::pair{900., 0.3}, {450., 1.3}, {1800., -1.95}, {2 * rail, -0.1}, {120., 1.5}, {120., -2.1}})
    mass += m, moment += m * (1.5 - x);
  for (const double x : {1.5, 0.6, -0.3, -1.2, -2.1}) mass += cross + plates, moment += (cross + plates) * (1.5 - x);
  const auto tyre = [&](const std::string& end, const std::string& side) { return r.history("spring/tyre_" + end + "_" + side)(0, 2); };
  const double g = 9.80665, rear = tyre("rear", "left") + tyre("rear", "right"), front = tyre("front", "left") + tyre("front", "right");
  EXPECT_NEAR(front + rear, mass * g, 1e-6 * mass * g);
  EXPECT_NEAR(rear, moment * g / 3.6, 2e-3 * mass * g) << "springs give by centimetres";
  EXPECT_NEAR(tyre("front", "left"), tyre("front", "right"), 1e-4 * mass * g);
  const Eigen::MatrixXd energy = r.history("energy");
  EXPECT_GT(energy.col(0).maxCoeff(), 100) << "the bump was met";
  EXPECT_LT(energy.col(5).cwiseAbs().maxCoeff(), 1e-6 * energy.col(0).maxCoeff());
}

// The joint of data/frame: fore and aft, up and down, as its table says; bolted, whose give is that of the solid, and without give.
TEST(LadderFrame, AJointOfItVibratesAsItsTableSays) {
  const Workplace work;
  const std::string bolted = text_of(data + "joint.toml");
  std::string rigid;
  std::istringstream lines(bolted);
  for (std::string line; std::getline(lines, line);)
    if (line.find("stiffness = ") == line.npos) rigid += line + "\n";
  for (const auto& [scene, first, second] : {std::tuple{bolted, 299., 560.}, std::tuple{rigid, 485., 847.}}) {
    work.write("scene.toml", scene);
    succeeded(work.run("hilo-solve --quiet scene.toml -o run.h5"));
    const Eigen::VectorXd f = Results(work / "run.h5").history("mode").col(0);
    ASSERT_GE(f.size(), 9);  // the state of rest, six rigid motions
    EXPECT_LT(f.segment<6>(1).cwiseAbs().maxCoeff(), 1);
    EXPECT_NEAR(f[7], first, 1);
    EXPECT_NEAR(f[8], second, 1);
  }
}

}  // namespace
}  // namespace hilo::test::beams_frame_test
