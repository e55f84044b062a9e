// The rigid run of data/crank against the closed form of a slider-crank: kinematics differentiated by hand, then the equations of motion of
// piston and rod give every bearing force.  Masses, centres and moments are those of the run; the area of the crown is that of the mesh.
//
// The reactions of a Radau run are of second order, so the error falls by four with half the step, and (4 r(h/2) - r(h))/3 is left with
// the next order: 3e-7 of the peak.
#include <sstream>

#include "verify/verify.hpp"

namespace hilo::test {
namespace {

constexpr double r = 0.045, l = 0.150, g = 9.80665, rate = 6000 * 2 * M_PI / 60, ramp = 0.010;

struct Body {
  double m = 0, J = 0, x = 0, z = 0;  // mass, moment about y, centre at the start
};

Body body(const Results& run, const std::string& part) {
  const auto names = run.file().read_strings("/body/name");
  for (size_t b = 0; b < names.size(); ++b) {
    if (names[b].find(part) == std::string::npos) continue;
    const auto points = run.file().read<double>("/body/points"), moment = run.file().read<double>("/body/inertia");
    const auto point = [&](size_t k) { return Vec3(&points[12 * b + 3 * k]); };
    Body found{run.file().read<double>("/body/mass")[b], 0, point(0).x(), point(0).z()};
    for (size_t k = 0; k < 3; ++k) found.J += moment[3 * b + k] * std::pow((point(k + 1) - point(0)).normalized().y(), 2);
    return found;
  }
  throw std::runtime_error("no body " + part);
}

/// Side thrust; big end along and across the crank; small end along z and x; main bearing along z and x [N]; torque [N m].
using Forces = Eigen::Matrix<double, 8, 1>;

Forces closed_form(double t, double gas, const Body& crank, const Body& rod, const Body& piston) {
  const double theta = rate * (t - ramp / 2), s = std::sin(theta), c = std::cos(theta), w = rate;  // after the smooth start
  // psi = -asin(r/l sin theta), its rate and acceleration; a vector d that turns about y at w gains w (d_z, -d_x)
  const double sp = -r / l * s, cp = std::sqrt(1 - sp * sp), wr = -r / l * c * w / cp, ar = (r / l * s * w * w + sp * wr * wr) / cp;
  const double bx = -r * s * w * w, bz = -r * c * w * w;
  const double ux = cp * rod.x + sp * (rod.z - r), uz = -sp * rod.x + cp * (rod.z - r), vx = sp * l, vz = cp * l;
  const double cx = bx + ar * uz - wr * wr * ux, cz = bz - ar * ux - wr * wr * uz, pz = bz - ar * vx - wr * wr * vz;
  const double Wz = piston.m * (pz + g) + gas, Bz = rod.m * (cz + g) + Wz;
  const double Wx = ((vx - ux) * Wz - rod.J * ar - uz * rod.m * cx + ux * Bz) / vz, Bx = rod.m * cx + Wx;
  const double kx = c * crank.x + s * crank.z, kz = -s * crank.x + c * crank.z;
  Forces f;
  f << -Wx, s * Bx + c * Bz, c * Bx - s * Bz, -Wz, -Wx, crank.m * (g - w * w * kz) + Bz, -crank.m * w * w * kx + Bx,
      r * (c * Bx - s * Bz) - kx * crank.m * g;
  return f;
}

TEST(Crank, BearingForcesOfTheRigidDriveAreTheClosedForm) {
  Case c("crank");
  const std::string data = std::string(HILO_SOURCE) + "/data/crank/";
  const Ran made =
      c.run("mkdir out && awk -f '" + data + "gas.awk' > out/gas.csv && cp '" + data + "scene.toml' . && hilo-import --quiet '" + data +
            "crank.geo' -o mesh.h5 && hilo-tag --quiet mesh.h5 '" + data + "tags-rigid.toml' -o tags.h5");
  ASSERT_EQ(made.exit, 0) << made.err;
  std::vector<Results> runs;
  for (const char* step : {"2.7777777777777778e-5", "1.3888888888888889e-5"}) {  // pressure is linear between degrees: 1 and 1/2
    const std::string name = "run" + std::to_string(runs.size()) + ".h5";
    const Ran ran = c.run("hilo-solve --quiet scene.toml tags.h5 --set 'time.integrator=\"radau\"' --set time.end=0.0155 --set time.step=" +
                          std::string(step) + " --set output.interval=0.01 -o " + name);
    ASSERT_EQ(ran.exit, 0) << ran.err;
    runs.push_back(c.results(name));
  }
  const Mesh mesh = read_mesh_file(c / "mesh.h5").mesh;
  double area = 0;
  for (const auto& f : mesh.facet_sets.at("crown")) area += facet_area(mesh, f).z();
  const Body crank = body(runs[0], "crank"), rod = body(runs[0], "rod"), piston = body(runs[0], "piston");

  std::vector<Eigen::MatrixXd> joints[2];
  for (int k = 0; k < 2; ++k)
    for (const char* name : {"liner", "big_end", "small_end", "main"}) joints[k].push_back(runs[k].history(std::string("joint/") + name));
  const auto forces = [&](int k, Eigen::Index i) {
    const auto& j = joints[k];
    Forces f;
    f << j[0](i, 0), j[1](i, 0), j[1](i, 1), j[2](i, 0), j[2](i, 1), j[3](i, 0), j[3](i, 1), j[3](i, 5);
    return f;
  };

  std::istringstream gas(text_of(c / "out/gas.csv"));
  std::string row;
  std::getline(gas, row);
  Forces peak = Forces::Zero(), coarse = peak, fine = peak, extrapolated = peak;
  int rows = 0;
  while (std::getline(gas, row)) {
    const double t = std::stod(row), p = std::stod(row.substr(row.find(',') + 1));
    if (t > 0.0155 - 1e-9) break;
    const Forces exact = closed_form(t, p * area, crank, rod, piston), f0 = forces(0, runs[0].index(t)), f1 = forces(1, runs[1].index(t));
    peak = peak.cwiseMax(exact.cwiseAbs());
    coarse = coarse.cwiseMax((f0 - exact).cwiseAbs()), fine = fine.cwiseMax((f1 - exact).cwiseAbs());
    extrapolated = extrapolated.cwiseMax(((4 * f1 - f0) / 3 - exact).cwiseAbs());
    ++rows;
  }
  ASSERT_EQ(rows, 198);
  for (int i = 0; i < 8; ++i) {
    EXPECT_LT(fine[i], 0.26 * coarse[i]) << i;
    EXPECT_LT(fine[i], 2e-5 * peak[i]) << i;
    EXPECT_LT(extrapolated[i], 3e-7 * peak[i]) << i;
  }
}

}  // namespace
}  // namespace hilo::test
