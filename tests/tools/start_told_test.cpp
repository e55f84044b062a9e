// SPDX-License-Identifier: GPL-3.0-or-later
// What a start from equilibrium, and modes about it, say on stderr.
#include <cmath>

#include "model/store.hpp"
#include "scene_parts.hpp"
#include "succeeded.hpp"

namespace hilo::test::start_told_test {
namespace {

// Exact: a bob of 1 kg stretches a spring of 100 N/m by 0.0981 m; one on 1000 N/m by a tenth of that.
TEST(StartTold, HowFarWhatMovedIsTold) {
  const Workplace place;
  place.write("a.toml", "gravity = [0, 0, -9.81]\n" + body("stiff", 1, {1, 0, 0}, {1, 1, 1}) + body("bob", 1, Vec3::Zero(), {1, 1, 1}) +
                            axial("prismatic", "guide", "ground", "bob", Vec3::Zero(), {0, 0, 1}) +
                            axial("prismatic", "guide of stiff", "ground", "stiff", {1, 0, 0}, {0, 0, 1}) +
                            spring("axial", "soft spring", "ground", "bob", "at_a = [0, 0, 1]\nat_b = [0, 0, 0]\nstiffness = 100") +
                            spring("axial", "stiff spring", "ground", "stiff", "at_a = [1, 0, 1]\nat_b = [1, 0, 0]\nstiffness = 1000") +
                            in_time(0.01, 0.01, "start = \"equilibrium\""));
  const auto ran = succeeded(place.run("hilo-solve a.toml -o run.h5"));
  EXPECT_NE(ran.err.find("iterations; moved: \"bob\" 0.0981 m, \"stiff\" 0.00981 m\n"), std::string::npos) << ran.err;
}

// A strip that spins about an axis along its width, at Omega = 6 sqrt(EI/m)/L^2.  Across the plane of rotation the first frequency
// is 7.3604 in that unit, and within it the square is less by that of Omega (Wright, Smith, Thresher and Wang,
// J. Appl. Mech. 49, 1982): modes under such a load lack this.
TEST(StartTold, ThatModesOfAStripBladeLackSpinSoftening) {
  const Workplace place;
  const double E = 2.1e11, h = 0.002, unit = std::sqrt(E * h * h / 12 / 7850), speed = 6 * unit;
  place.write("blade.geo",
              "Point(1) = {0, 0, -.02}; Point(2) = {0, 0, .02}; Line(1) = {1, 2}; Transfinite Curve{1} = 3;\n"
              "s() = Extrude {1, 0, 0} { Curve{1}; Layers{40}; Recombine; };\n"
              "Physical Surface(\"blade\") = {s(1)}; Physical Curve(\"root\") = {1};\n");
  succeeded(place.run("hilo-import --quiet blade.geo --thickness 0.002 -o blade.h5"));
  place.write("a.toml", load("centrifugal", "spin", "blade", fmt::format("at = [0, 0, 0]\naxis = [0, 0, 1]\nspeed = {}", speed)) +
                            solid(E, 0, 7850) + held("root") + "[time]\nanalysis = \"modes\"\nmodes = 1\nstart = \"equilibrium\"\n");
  const auto ran = succeeded(place.run("hilo-solve a.toml blade.h5 -o run.h5"));
  EXPECT_NE(ran.err.find("warning: a.toml:1:1: load \"spin\": the model lacks spin softening"), std::string::npos) << ran.err;
  const double f = Store::open(place / "run.h5").read<double>("/history/mode")[10], too_much = speed / (2 * M_PI);
  std::printf("%.4f Hz, without what softens %.4f Hz\n", f, std::sqrt(f * f - too_much * too_much));
  EXPECT_NEAR(f / (7.3604 * unit / (2 * M_PI)), 1, 3e-3);
}

}  // namespace
}  // namespace hilo::test::start_told_test
