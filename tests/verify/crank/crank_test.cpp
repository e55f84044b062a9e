// SPDX-License-Identifier: GPL-3.0-or-later
// The rigid run of data/crank against the closed form of a slider-crank: kinematics differentiated by hand, then the equations of motion of
// piston and rod give every bearing force (data/crank/truth.py).  Masses, centres and moments are those of the run; the area of the crown
// is that of the mesh.
//
// The reactions of a Radau run are of second order, so the error falls by four with half the step, and (4 r(h/2) - r(h))/3 is left with
// the next order: 3e-7 of the peak.
#include "verify/truth.hpp"

namespace hilo::test::crank_test {
namespace {

/// Side thrust; big end along and across the crank; small end along z and x; main bearing along z and x [kN]; torque [N m].
using Forces = Eigen::Matrix<double, 8, 1>;

TEST(Crank, BearingForcesOfTheRigidDriveAreTheClosedForm) {
  Case c("crank");
  const std::string data = std::string(HILO_SOURCE) + "/data/crank/";
  succeeded(c.run("mkdir out && '" + data + "truth.py' gas > out/gas.csv && cp '" + data + "scene.toml' . && hilo-import --quiet '" + data +
                  "crank.geo' -o mesh.h5 && hilo-tag --quiet mesh.h5 '" + data + "tags-rigid.toml' -o tags.h5"));
  std::vector<Results> runs;
  for (const char* step : {"2.7777777777777778e-5", "1.3888888888888889e-5"}) {  // pressure is linear between degrees: 1 and 1/2
    const std::string name = "run" + std::to_string(runs.size()) + ".h5";
    succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 --set 'time.integrator=\"radau\"' --set time.end=0.0155 --set time.step=" +
                    std::string(step) + " --set output.interval=0.01 -o " + name));
    runs.push_back(c.results(name));
  }
  const Eigen::MatrixXd truth =
      truth_table(c, "hilo-show --json run0.h5 > bodies.json && '" + data + "truth.py' forces bodies.json out/gas.csv");

  std::vector<Eigen::MatrixXd> joints[2];
  for (int k = 0; k < 2; ++k)
    for (const char* name : {"liner", "big_end", "small_end", "main"}) joints[k].push_back(runs[k].history(std::string("joint/") + name));
  const auto forces = [&](int k, Eigen::Index i) {
    const auto& j = joints[k];
    Forces f;
    f << j[0](i, 0), j[1](i, 0), j[1](i, 1), j[2](i, 0), j[2](i, 1), j[3](i, 0), j[3](i, 1), 1e3 * j[3](i, 5);
    return Forces(f / 1e3);
  };

  Forces peak = Forces::Zero(), coarse = peak, fine = peak, extrapolated = peak;
  int rows = 0;
  for (; rows < truth.rows(); ++rows) {
    const double t = 0.010 + (truth(rows, 0) + 180) / (360 * 100);  // from the crank angle, 0 at the firing top
    if (t > 0.0155 - 1e-9) break;
    const Forces exact = truth.row(rows).tail<8>(), f0 = forces(0, runs[0].index(t)), f1 = forces(1, runs[1].index(t));
    peak = peak.cwiseMax(exact.cwiseAbs());
    coarse = coarse.cwiseMax((f0 - exact).cwiseAbs()), fine = fine.cwiseMax((f1 - exact).cwiseAbs());
    extrapolated = extrapolated.cwiseMax(((4 * f1 - f0) / 3 - exact).cwiseAbs());
  }
  ASSERT_EQ(rows, 198);
  for (int i = 0; i < 8; ++i) {
    EXPECT_LT(fine[i], 0.26 * coarse[i]) << i;
    EXPECT_LT(fine[i], 2e-5 * peak[i]) << i;
    EXPECT_LT(extrapolated[i], 3e-7 * peak[i]) << i;
  }
}

}  // namespace
}  // namespace hilo::test::crank_test
