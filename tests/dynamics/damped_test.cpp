// SPDX-License-Identifier: GPL-3.0-or-later
// Damping: what the matrix of Newton forgets costs iterations, and what the balance forgets looks like energy from nowhere.
#include "dynamics/scenes.hpp"
#include "model/scene.hpp"
#include "succeeded.hpp"

namespace hilo::test {
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
  BlockOptions o;
  o.n[0] = 4;
  o.high = Vec3(1, 0.2, 0.2);
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
  BlockOptions o;
  o.high = Vec3(1, 0.2, 0.2);
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

}  // namespace
}  // namespace hilo::test
