// SPDX-License-Identifier: GPL-3.0-or-later
// Redundant rows of mechanisms too large for one dense matrix.
#include "dynamics/scenes.hpp"

namespace hilo::test::redundancy_test {
namespace {

// Truth: 2 n + 1 rods have 12 n + 6 degrees of freedom, 3 n + 1 revolutes 15 n + 5 rows, and the mechanism moves in one way.  The rank is
// 12 n + 5, which leaves 3 n rows too many; the rows kept hold the others.
TEST(Redundancy, EveryLoopOfALongRowOfFourBarsHasThreeRowsTooMany) {
  constexpr int n = 320;  // 1922 rows in the plane, 2883 out of it
  const Workplace w;
  std::string scene = "gravity = [0, -9.81, 0]\n[time]\nend = 0.02\nstep = 0.01\n";
  const auto pin = [&](const std::string& name, const std::string& a, const std::string& b, const Vec3& at) {
    scene += joint("revolute", name, a, b, at, "axis = [0, 0, 1]\n");
  };
  for (int i = 0; i <= n; ++i) {
    const std::string crank = "c" + std::to_string(i), rod = "k" + std::to_string(i), before = "c" + std::to_string(i - 1);
    scene += body(crank, 1, {1. * i, 0.5, 0}, {0.08, 1e-4, 0.08});
    scene += "[[initial]]\non = [\"" + crank + "\"]\nspin = [0, 0, -1]\nabout = [" + std::to_string(i) + ", 0, 0]\n";
    pin("A" + std::to_string(i), "ground", crank, {1. * i, 0, 0});
    if (i == 0) continue;
    scene += body(rod, 1, {i - 0.5, 1, 0}, {1e-4, 0.08, 0.08}) + "[[initial]]\non = [\"" + rod + "\"]\nvelocity = [1, 0, 0]\n";
    pin("L" + std::to_string(i), before, rod, {i - 1., 1, 0});
    pin("R" + std::to_string(i), crank, rod, {1. * i, 1, 0});
  }
  w.write("row.toml", scene);
  succeeded(w.run("hilo-solve --quiet row.toml -o run.h5"));
  const std::string json = text_of(w / "run.json");
  EXPECT_NE(json.find("\"joint_rows\": " + std::to_string(5 * (3 * n + 1))), std::string::npos);
  EXPECT_NE(json.find("\"redundant_rows\": " + std::to_string(3 * n) + ","), std::string::npos) << json;
  const Store run = Store::open(w / "run.h5");
  for (const double violation : run.read<double>("/history/constraint")) EXPECT_LT(violation, 1e-12);
  // Nothing pushes out of the plane, so shares of least norm have no force along z and no moment about x and y.
  double in_plane = 0, out_of_plane = 0;
  for (const std::string& pin : run.list("/history/joint")) {
    const std::vector<double> wrench = run.read<double>("/history/joint/" + pin);
    for (size_t k = 0; k < wrench.size(); ++k) {
      double& most = k % 6 == 0 || k % 6 == 1 || k % 6 == 5 ? in_plane : out_of_plane;
      most = std::max(most, std::abs(wrench[k]));
    }
  }
  EXPECT_EQ(run.list("/history/joint").size(), 3 * n + 1u);
  EXPECT_GT(in_plane, 1);  // [N], a rod weighs 9.81
  EXPECT_LT(out_of_plane, 1e-9);
}

// Truth: a net of m x m meshes has 2 m (m + 1) rods and a revolute less at each of its (m + 1)^2 crossings than rods meet there, one more
// where it hangs.  A mesh leaves three rows too many.  Internal forces sum to nothing: what hangs the net accelerates its mass.
TEST(Redundancy, EveryMeshOfANetHasThreeRowsTooMany) {
  constexpr int m = 12;
  const Workplace w;
  std::string scene = "gravity = [0, -9.81, 0]\n[time]\nend = 0.04\nstep = 0.002\n";
  std::map<std::pair<int, int>, std::vector<std::string>> meets;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= m; ++j)
      for (const int up : {0, 1}) {
        if (i + 1 - up > m || j + up > m) continue;
        const std::string rod = (up ? "v" : "h") + std::to_string(i) + "_" + std::to_string(j);
        scene += body(rod, 1, {i + (up ? 0 : 0.5), j + (up ? 0.5 : 0), 0}, {0.02, 0.03, 0.04});
        meets[{i, j}].push_back(rod), meets[{i + 1 - up, j + up}].push_back(rod);
      }
  int n_rods = 2 * m * (m + 1), n_pins = 0;
  for (auto& [at, rods] : meets) {
    if (at == std::pair{0, m}) rods.insert(rods.begin(), "ground");
    for (size_t k = 1; k < rods.size(); ++k)
      scene += joint("revolute", k == 1 && rods[0] == "ground" ? "nail" : "p" + std::to_string(n_pins), rods[k - 1], rods[k],
                     {1. * at.first, 1. * at.second, 0}, "axis = [0, 0, 1]\n"),
          ++n_pins;
  }
  w.write("net.toml", scene);
  succeeded(w.run("hilo-solve --quiet net.toml -o run.h5"));
  const std::string json = text_of(w / "run.json");
  EXPECT_NE(json.find("\"joint_rows\": " + std::to_string(5 * n_pins)), std::string::npos);
  EXPECT_NE(json.find("\"redundant_rows\": " + std::to_string(3 * m * m) + ","), std::string::npos) << json;
  const Store run = Store::open(w / "run.h5");
  for (const double violation : run.read<double>("/history/constraint")) EXPECT_LT(violation, 1e-11);
  // by the trapezoidal rule over the run, whose error at this step is far below a thousandth
  const std::vector<double> t = run.read<double>("/history/t"), p = run.read<double>("/history/momentum"),
                            nail = run.read<double>("/history/joint/nail");
  double impulse = 0;
  for (size_t k = 1; k < t.size(); ++k) impulse += (t[k] - t[k - 1]) * (nail[6 * k + 1] + nail[6 * k - 5]) / 2;
  const double wanted = p[6 * (t.size() - 1) + 1] - p[1] + n_rods * 9.81 * t.back();
  EXPECT_NEAR(impulse, wanted, 1e-3 * wanted);
  for (const std::string& pin : run.list("/history/joint"))
    EXPECT_LT(std::abs(run.read<double>("/history/joint/" + pin).at(2)), 1e-8 * n_rods) << pin;
}

}  // namespace
}  // namespace hilo::test::redundancy_test
