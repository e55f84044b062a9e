// SPDX-License-Identifier: GPL-3.0-or-later
// What the modes of a linear region leave out, as the run tells it, against what they truly do.
#include <Eigen/QR>
#include <numbers>

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::left_out_test {
namespace {

// How much modes leave out, told by the run itself, against the true difference from a run with all modes: of a cantilever shaken between
// and above its first frequencies (8 and 50 Hz), in the norm of strain energy.
TEST(LinearRegion, TellsWhatItsModesLeaveOut) {
  const BlockOptions o{.n = {20, 1, 1}, .high = {1, 0.05, 0.05}};
  const std::string text = solid(1e9, 0.3, 1000, "block", "", "up_to = 1e5") + held("xmin") +
                           force("push", "xmax", {0, 0, 10}, "history = \"shake\"") + R"([history.shake]
file = "shake.csv"
)" + in_time(0.2, 1e-4) + R"([output]
interval = 0.2
fields = ["displacement"]
)";
  struct Run {
    Eigen::MatrixXd amplitudes, energies, shapes;
    Eigen::VectorXd omega2;
    double told = 0;
    std::string said;
  };
  for (const double hertz : {35.0, 70.0}) {
    Case c("linear_region");
    c.use(block_mesh(o), {Fidelity::linear});
    std::ofstream(c / "scene.toml") << text;
    std::ofstream course(c / "shake.csv");
    course << "t,value\n";
    for (int i = 0; i <= 2500; ++i)
      course << fmt::format("{},{}\n", 1e-4 * i, std::sin(2 * std::numbers::pi * hertz * 1e-4 * i) * std::min(1.0, 1e-4 * i * hertz / 3));
    course.close();
    const auto run = [&](int modes) {
      const std::string set = fmt::format(" --set region.block.modes={} ", modes);
      EXPECT_EQ(c.run("hilo-reduce --quiet scene.toml tags.h5 -o reduced.h5" + set).exit, 0);
      const Ran ran = succeeded(c.run("hilo-solve scene.toml tags.h5 --modes reduced.h5 -o run.h5" + set));
      const Results r = c.results();
      Run out{r.history("modes/block"), r.history("left_out/block"), {}, {}, c.reported("block"), ran.err};
      const Store reduced = Store::open(c / "reduced.h5");
      const auto omega2 = reduced.read<double>("/reduced/block/omega2"), shapes = reduced.read<double>("/reduced/block/shapes");
      const auto m = static_cast<Eigen::Index>(omega2.size());
      out.omega2 = Eigen::Map<const Eigen::VectorXd>(omega2.data(), m);
      out.shapes = Eigen::Map<const Eigen::MatrixXd>(shapes.data(), m, static_cast<Eigen::Index>(shapes.size()) / m).transpose();
      return out;
    };
    const Run all = run(60);
    EXPECT_LT(all.told, 0.02);
    EXPECT_EQ(all.said.find("its modes lack"), std::string::npos);
    const auto solver = all.shapes.colPivHouseholderQr();
    for (const int modes : {0, 2}) {  // the first two are a pair
      const Run few = run(modes);
      const Eigen::MatrixXd in_all = solver.solve(few.shapes), off = all.amplitudes - few.amplitudes * in_all.transpose();
      const double most = (all.amplitudes.cwiseAbs2() * all.omega2).maxCoeff(),
                   truth = std::sqrt((off.cwiseAbs2() * all.omega2).maxCoeff() / most);
      std::cout << hertz << " Hz, " << modes << " modes: " << truth << " left out, told " << few.told / truth << " of it\n";
      EXPECT_GT(few.told, 0.7 * truth) << hertz << " Hz, " << modes << " modes";
      EXPECT_LT(few.told, 1.2 * truth) << hertz << " Hz, " << modes << " modes";
      EXPECT_NEAR(few.told, std::sqrt(few.energies.col(1).maxCoeff() / few.energies.col(0).maxCoeff()), 5e-3 * few.told);
      EXPECT_EQ(few.said.find("block: its modes lack") != std::string::npos, few.told > 0.05) << few.said;
    }
  }
}

}  // namespace
}  // namespace hilo::test::left_out_test
