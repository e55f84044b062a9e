// SPDX-License-Identifier: GPL-3.0-or-later
// Damping: what the matrix of Newton forgets costs iterations, and what the balance forgets looks like energy from nowhere.
#include "dynamics/scenes.hpp"
#include "model/scene.hpp"

namespace hilo::test::damped_test {
namespace {

/// 3 kg on k = 8e5 N/m and c = 4e4 N s/m, 0.1 m off at rest: s1 = -20.02/s, s2 = -13 313/s.
const std::string damped = body("block", 3, {0, 0, 0}, {1, 1, 1}) +
                           "[[spring]]\nkind = \"bushing\"\nname = \"mount\"\nb = \"block\"\nat = [0, 0, 0]\nstiffness = [8e5, 8e5, 8e5]\n"
                           "damping = [4e4, 4e4, 4e4]\n[[load]]\nkind = \"force\"\nname = \"push\"\non = \"block\"\nforce = [8e4, 0, 0]\n"
                           "[[probe]]\nname = \"block\"\non = \"block\"\n[time]\nend = 0.1\nstep = 0.01\n";

double displacement(double t) {
  const double k = 8e5, c = 4e4, m = 3, root = std::sqrt(c * c / 4 - k * m), s1 = -k / (c / 2 + root), s2 = -(c / 2 + root) / m;
  return 0.1 * (1 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2));
}

TEST(Damped, RadauGoesThroughAStiffDamperInTheStepsAskedFor) {
  const Workplace w;
  w.write("scene.toml", damped);
  succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 " + integrator("radau")));
  EXPECT_EQ(number_of(w, "run.json", "steps"), 10);
  EXPECT_EQ(number_of(w, "run.json", "cuts"), 0);
  EXPECT_LT(number_of(w, "run.json", "newton_iterations"), 40) << "linear: a matrix and what its rounding leaves";
  EXPECT_NEAR(Results(w / "run.h5").at("probe/block", 0.1)[0], displacement(0.1), 1e-5);
}

TEST(Damped, RadauGoesThroughStiffnessProportionalDamping) {
  const Workplace w;
  const BlockOptions o{.n = {4, 1, 1}, .high = {1, 0.2, 0.2}};
  write_mesh(w / "beam.h5", block_mesh(o), {"test"});
  w.write("scene.toml",
          "mesh = \"beam.h5\"\ngravity = [0, 0, -9.81]\n[material.soft]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = "
          "\"soft\"\ndamping = 1e-3\n[[motion]]\nkind = \"fixed\"\nname = \"clamp\"\non = \"xmin\"\n[[probe]]\nname = \"tip\"\non = "
          "\"xmax\"\n[time]\nend = 0.2\nstep = 0.01\n");
  const auto tip = [&](const std::string& options) {
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 " + options));
    return Results(w / "run.h5").at("probe/tip", 0.2)[2];
  };
  const double radau = tip(integrator("radau"));
  EXPECT_EQ(number_of(w, "run.json", "cuts"), 0);
  EXPECT_LT(number_of(w, "run.json", "newton_iterations"), 20 * 12);
  const double fine = tip("--set time.step=2e-4");
  EXPECT_LT(std::abs(radau - fine), 1e-3 * std::abs(fine - 0.1)) << radau << " " << fine;
}

/// Work of the rate forces by each method's own quadrature: what the balance leaves falls with the step, and is not a multiple of the work.
void expect_balance(const Workplace& w, const std::string& scene, const std::string& method, const char* coarse_step,
                    const char* fine_step) {
  const auto balance = [&](const char* step) {
    succeeded(w.run("hilo-solve --quiet " + scene + " -o run.h5 " + integrator(method) + "--set time.step=" + step));
    return number_of(w, "run.json", "energy_balance");
  };
  const double coarse = balance(coarse_step), fine = balance(fine_step);
  EXPECT_LT(fine, std::max(0.7 * coarse, 1e-10)) << method << " " << coarse << " " << fine;
  EXPECT_LT(coarse, 0.1) << method;
}

TEST(Damped, WhatADamperTakesIsInTheBalanceOfEveryMethod) {
  const Workplace w;
  w.write("scene.toml", body("block", 3, {0, 0, 0}, {1, 1, 1}) +
                            "[[spring]]\nkind = \"bushing\"\nname = \"mount\"\nb = \"block\"\nat = [0, 0, 0]\nstiffness = [800, 800, 800]\n"
                            "damping = [10, 10, 10]\n[[initial]]\non = [\"block\"]\nvelocity = [1, 0, 0]\n[time]\nend = 1\n");
  for (const std::string& method : choices("time", "integrator")) expect_balance(w, "scene.toml", method, "4e-3", "1e-3");
}

TEST(Damped, WhatAFlexibleRegionTakesIsInTheBalanceOfEveryMethod) {
  const Workplace w;
  const BlockOptions o{.high = {1, 0.2, 0.2}};
  write_mesh(w / "beam.h5", block_mesh(o), {"test"});
  w.write("scene.toml",
          "[material.soft]\nE = 1e5\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = \"soft\"\ndamping = 4e-3\nmass_damping = 0.5\n"
          "[[motion]]\nkind = \"fixed\"\nname = \"clamp\"\non = \"xmin\"\n"
          "[[initial]]\non = [\"block\"]\nvelocity = [0, 0, 0.3]\n[time]\nend = 1\n");
  for (const char* level : {"nonlinear", "linear"}) {
    succeeded(w.run(std::string("hilo-tag --quiet beam.h5 --") + level + " block -o " + level + ".h5"));
    for (const std::string& method : choices("time", "integrator"))
      if (method != "gauss" || std::string(level) == "linear")
        expect_balance(w, std::string("scene.toml ") + level + ".h5", method, "4e-3", "1e-3");
  }
}

/// A rod on a hinge along y, with a torsion damper, a bushing and a damper between points, 1 m from the hinge and 1 m above it: turn and
/// rate by RK4.
struct BrakedRod {
  static constexpr double m = 2, L = 0.5, J = 0.2, k = 3, c = 0.4, k_bush = 2, c_bush = 0.3, k_line = 20, c_line = 6, free = 1.2;
  static double acceleration(double turn, double rate) {
    const double x = std::cos(turn), z = -std::sin(turn), length = std::hypot(x, z - 1), dx = z * rate, dz = -x * rate;
    const double pull = k_line * (length - free) + c_line * (x * dx + (z - 1) * dz) / length;
    const double moment = (z * -x - x * (1 - z)) / length * pull;  // z Fx - x Fz
    return (m * 9.81 * L * std::cos(turn) - (k + k_bush) * turn - (c + c_bush) * rate + moment) / (J + m * L * L);
  }
  static std::array<double, 2> at(double t, int n) {
    double turn = 0, rate = 0;
    const double h = t / n;
    for (int i = 0; i < n; ++i) {
      const double a1 = acceleration(turn, rate), r2 = rate + h / 2 * a1, a2 = acceleration(turn + h / 2 * rate, r2),
                   r3 = rate + h / 2 * a2, a3 = acceleration(turn + h / 2 * r2, r3), r4 = rate + h * a3,
                   a4 = acceleration(turn + h * r3, r4);
      turn += h / 6 * (rate + 2 * r2 + 2 * r3 + r4), rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return {turn, rate};
  }
  static std::string scene() {
    return "gravity = [0, 0, -9.81]\n" + body("rod", m, {L, 0, 0}, {J, J, J}) +
           joint("revolute", "hinge", "ground", "rod", Vec3::Zero(), "axis = [0, 1, 0]\n") +
           fmt::format(
               "[[spring]]\nkind = \"torsion\"\nname = \"brake\"\na = \"ground\"\nb = \"rod\"\naxis = [0, 1, 0]\nstiffness = {0}\n"
               "damping = {1}\n[[spring]]\nkind = \"bushing\"\nname = \"bush\"\nb = \"rod\"\nat = [0, 0, 0]\n"
               "angular_stiffness = [{2}, {2}, {2}]\nangular_damping = [{3}, {3}, {3}]\n[[spring]]\nkind = \"axial\"\n"
               "name = \"line\"\na = \"ground\"\nb = \"rod\"\nat_a = [0, 0, 1]\nat_b = [1, 0, 0]\nstiffness = {4}\ndamping = {5}\n"
               "length = {6}\n",
               k, c, k_bush, c_bush, k_line, c_line, free) +
           "[[probe]]\nname = \"tip\"\non = \"rod\"\nat = [1, 0, 0]\n[time]\nend = 0.8\nstep = 0.02\n";
  }
};

// A damper at an instant sees the rate of that instant, also where its measure is a length or an angle.
TEST(Damped, MethodsOfHighOrderKeepTheirOrder) {
  const Workplace w;
  w.write("scene.toml", BrakedRod::scene());
  const auto [turn, rate] = BrakedRod::at(0.8, 100000);
  const double acceleration = BrakedRod::acceleration(turn, rate);
  const Vec3 x(std::cos(turn), 0, -std::sin(turn)), across(-std::sin(turn), 0, -std::cos(turn));
  const auto off = [&](const std::string& method, const char* step) -> std::array<double, 3> {
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 --set solver.tolerance=1e-12 --set time.step=" + std::string(step) + " " +
                    integrator(method)));
    const auto tip = Results(w / "run.h5").at("probe/tip", 0.8);
    return {(tip.head<3>() - x).norm(), (tip.segment<3>(3) - rate * across).norm(),
            (tip.tail<3>() - acceleration * across + rate * rate * x).norm()};
  };
  const auto gauss = off("gauss", "0.08"), finer = off("gauss", "0.04");
  EXPECT_LT(gauss[0], 1e-8);
  for (const int k : {1, 2}) EXPECT_GT(std::log2(gauss[k] / finer[k]), 5.3) << k << ": " << gauss[k] << " " << finer[k];
  const double radau = off("radau", "0.04")[0], radau_finer = off("radau", "0.02")[0];
  EXPECT_GT(std::log2(radau / radau_finer), 4.5) << radau << " " << radau_finer;
}

// The same of a beam that bends by a third of its length.  Truth: the default, which takes mean rates, extrapolated from two small steps.
TEST(Damped, MethodsOfHighOrderKeepTheirOrderInBeams) {
  const Workplace w;
  w.write("scene.toml",
          "gravity = [0, 0.3, -9.81]\n[material.m]\nE = 1e6\nnu = 0.3\ndensity = 1000\n[section.s]\nkind = \"rectangle\"\nwidth = 0.1\n"
          "height = 0.1\n[beam.arm]\npoints = [[0, 0, 0], [1, 0, 0]]\ncells = [1]\nsection = \"s\"\nmaterial = \"m\"\na = \"ground\"\n"
          "damping = 0.02\n[[probe]]\nname = \"tip\"\non = \"arm.1\"\n[time]\nend = 0.4\n");
  const auto tip = [&](const std::string& method, double h) -> Vec3 {
    succeeded(w.run(
        fmt::format("hilo-solve --quiet scene.toml -o run.h5 --set solver.tolerance=1e-12 --set time.step={} {}", h, integrator(method))));
    return Results(w / "run.h5").at("probe/tip", 0.4).head<3>();
  };
  const Vec3 truth = (4 * tip("energy-momentum", 2e-4) - tip("energy-momentum", 4e-4)) / 3;
  EXPECT_GT((truth - Vec3::UnitX()).norm(), 0.3);
  const auto off = [&](const std::string& method, double h) { return (tip(method, h) - truth).norm(); };
  const double gauss = off("gauss", 0.02), finer = off("gauss", 0.01), radau = off("radau", 0.02), radau_finer = off("radau", 0.01);
  EXPECT_LT(finer, 1e-7);
  EXPECT_GT(std::log2(gauss / finer), 5.3) << gauss << " " << finer;
  EXPECT_GT(std::log2(radau / radau_finer), 4.3) << radau << " " << radau_finer;
}

}  // namespace
}  // namespace hilo::test::damped_test
