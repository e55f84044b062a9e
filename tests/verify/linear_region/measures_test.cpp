// SPDX-License-Identifier: GPL-3.0-or-later
// What a linear region tells of its own strains: its share of the buckling load, strains of the second degree that its supports hold, and
// the band of what its modes leave out; each against a closed form and against what cells of finite strain do.
#include <numbers>

#include "verify/verify.hpp"

namespace hilo::test::measures_test {
namespace {

constexpr double pi = std::numbers::pi, E = 1e9, h = 0.05, L = 1, I = h * h * h * h / 12, A = h * h;

class LinearMeasures : public testing::Test {
 protected:
  LinearMeasures() : c("linear_region") {
    mesh = block_mesh({.n = {24, 2, 2}, .low = Vec3(0, -h / 2, -h / 2), .high = Vec3(L, h / 2, h / 2)});
  }
  /// Statics of the bar, linear or nonlinear.
  struct Answer {
    double sag, energy = 0, quadratic = 0, buckling = 0, growth = 0;
    std::string said;
  };
  Answer rest(const std::string& supports, Fidelity fidelity, const std::string& options = "") {
    c.use(mesh, {fidelity});
    std::ofstream(c / "scene.toml") << fmt::format("{}\n[material.m]\nE = {}\nnu = 0\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n",
                                                   sag_by, E)
                                    << supports << "[time]\nanalysis = \"static\"\n[output]\nfields = [\"displacement\"]\n";
    const Ran ran = succeeded(c.run("hilo-solve scene.toml tags.h5 -o run.h5 " + options));
    const Results r = c.results();
    Answer out{0, 0, 0, 0, 0, ran.err};
    for (const Vec3& u : r.field("displacement")) out.sag = std::max(out.sag, -u[2]);
    if (fidelity != Fidelity::linear) return out;
    const auto second = r.history("second_order/block");
    out.energy = r.history("left_out/block").bottomRows(1)(0, 0), out.quadratic = second.bottomRows(1)(0, 0),
    out.buckling = second.bottomRows(1)(0, 1), out.growth = second.bottomRows(1)(0, 2);
    EXPECT_NEAR(c.reported("block"), 0, 0.01) << "the first list is that of modes left out";
    return out;
  }
  Case c;
  Mesh mesh;
  std::string sag_by = "gravity = [0, 0, -1e-3]";
};

const std::string clamp = "[[motion]]\nkind = \"fixed\"\nname = \"clamp\"\non = \"xmin\"\n";
std::string joint(const std::string& kind, const std::string& on, double x) {
  return fmt::format("[[joint]]\nkind = \"{0}\"\nname = \"{1} {0}\"\nb = \"{1}\"\nat = [{2}, 0, 0]\n{3}", kind, on, x,
                     kind == "spherical" ? "" : "axis = [1, 0, 0]\n");
}
const std::string universal =  // free to turn about y and z
    "[[joint]]\nkind = \"universal\"\nname = \"left\"\nb = \"xmin\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\nx = [0, 1, 0]\n";
const std::string pins = universal + joint("in-line", "xmax", 1);
const std::string pins_that_stay = universal + joint("spherical", "xmax", 1);
std::string push(double force) {
  return fmt::format("[[load]]\nkind = \"force\"\nname = \"push\"\non = \"xmax\"\nforce = [{}, 0, 0]\n", -force);
}

// Euler's columns, with Engesser's correction for shear; and how many times as far cells of finite strain give way: 1/(1 - u), of the
// cantilever less, since the mean axes that turn bring most of it.
TEST_F(LinearMeasures, AColumnTellsItsShareOfEulersLoad) {
  const double shear = 5. / 6 * E / 2 * A;
  struct Column {
    std::string supports;
    double length;
  };
  for (const auto& [supports, length] : {Column{clamp, 2 * L}, Column{pins, L}, Column{clamp + joint("prismatic", "xmax", 1), L / 2}}) {
    const double euler = pi * pi * E * I / (length * length), load = euler / (1 + euler / shear);
    for (const double share : {0.05, 0.3, 0.6, -0.5}) {
      const Answer linear = rest(supports + push(share * load), Fidelity::linear);
      EXPECT_NEAR(linear.buckling, std::max(0.0, share), 0.03 * std::abs(share)) << length;
      EXPECT_EQ(linear.said.find("buckling load") != std::string::npos, linear.growth > 1.1) << linear.said;
      if (length <= L) {
        EXPECT_NEAR(linear.growth * (1 - std::max(0.0, share)), 1, 0.03) << "supports keep the mean axes from turning";
      }
      if (share < 0.2) continue;
      const Answer cells = rest(supports + push(share * load), Fidelity::nonlinear);
      EXPECT_NEAR(cells.sag / linear.sag / linear.growth, 1, 0.03) << length << " " << share;
      std::cout << length << " m: " << share << " told " << linear.buckling << ", cells sag " << cells.sag / linear.sag
                << " times as far, told " << linear.growth << "\n";
    }
  }
}

// A beam that sags between ends that cannot come nearer is stretched by w'^2/2; where one end can, and on a cantilever, nothing is.
TEST_F(LinearMeasures, StrainsOfTheSecondDegreeAreThoseThatSupportsHold) {
  const double weight = 1000 * A;  // per acceleration [N/m over m/s^2]
  for (const double sag : {0.05 * h, 0.2 * h}) {
    const double q = sag * 384 * E * I / 5, g = q / weight;
    sag_by = fmt::format("gravity = [0, 0, {}]", -g);
    const double bending = q * q / (240 * E * I), slopes = std::pow(q / (24 * E * I), 2) * 17 / 35,
                 stretching = E * A / 2 * std::pow(slopes / 2, 2);
    const Answer held = rest(pins_that_stay, Fidelity::linear);
    EXPECT_NEAR(held.sag / sag, 1, 0.02);
    EXPECT_NEAR(held.energy / bending, 1, 0.03);
    EXPECT_NEAR(std::sqrt(held.quadratic / held.energy), std::sqrt(stretching / bending), 0.05 * std::sqrt(stretching / bending));
    EXPECT_EQ(held.said.find("stretch it as it bends") != std::string::npos, stretching > 0.01 * bending) << held.said;
    const Answer cells = rest(pins_that_stay, Fidelity::nonlinear);
    std::cout << sag / h << " of the height: quadratic strain " << std::sqrt(held.quadratic / held.energy) << ", "
              << std::sqrt(stretching / bending) << " by the closed form; linear sags " << held.sag / cells.sag
              << " times as far as cells\n";
    const Answer roller = rest(pins, Fidelity::linear), bracket = rest(clamp, Fidelity::linear);
    std::cout << "  roller " << std::sqrt(roller.quadratic / roller.energy) << ", cantilever "
              << std::sqrt(bracket.quadratic / bracket.energy) << "\n";
    EXPECT_LT(std::sqrt(roller.quadratic / roller.energy), 0.01);
    EXPECT_LT(std::sqrt(bracket.quadratic / bracket.energy), 0.01);
  }
}

// A beam between pins, one of which can come nearer, is let go under gravity: a sine that swings by 1 - cos w t about delta = 4 g/(pi w^2)
// and shortens by pi^2 (delta (1 - cos w t))^2/(4 L), whose largest acceleration is 16 g^2/(w^2 L).  Cells push the pin by m/2 times it,
// the linear region does not push at all.  Products of the first and the third vibration, near the first one along the beam, add some.
TEST_F(LinearMeasures, ABeamThatBendsFastTellsWhatItsShorteningPulls) {
  const double w = pi * pi * std::sqrt(E * I / (1000 * A));
  for (const double g : {20., 80.}) {
    const double comes_nearer = 16 * g * g / (w * w * L);
    double along[2] = {0, 0};
    std::string said, json;
    for (const Fidelity fidelity : {Fidelity::linear, Fidelity::nonlinear}) {
      c.use(mesh, {fidelity});
      std::ofstream(c / "scene.toml") << fmt::format(
          "gravity = [0, 0, {}]\n[material.m]\nE = {}\nnu = 0\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n{}[time]\nend = {}\nstep "
          "= "
          "{}\n[output]\ninterval = 1\nfields = [\"displacement\"]\n",
          -g, E, pins, 2 * pi / w, 2 * pi / w / 100);
      const Ran ran = succeeded(c.run("hilo-solve scene.toml tags.h5 -o run.h5"));
      const auto force = c.results().history("joint/left");
      along[fidelity == Fidelity::nonlinear] = force.col(1).cwiseAbs().maxCoeff();
      if (fidelity == Fidelity::linear) said = ran.err, json = text_of(c / "run.json");
    }
    std::cout << g << " m/s^2: pushed by " << along[1] << " N with cells, " << along[0] << " N linear, " << 2.5 / 2 * comes_nearer
              << " N by the closed form\n";
    EXPECT_LT(along[0], 0.05 * along[1]);
    EXPECT_NEAR(along[1] / (2.5 / 2 * comes_nearer), 1, 0.2);
    const std::string before = "its ends come nearer with ";
    const size_t at = said.find(before);
    ASSERT_EQ(at != std::string::npos, g > 50) << said;
    if (at == std::string::npos) continue;
    EXPECT_NEAR(std::stod(said.substr(at + before.size())) / comes_nearer, 1, 0.25) << said;
    EXPECT_NE(json.find("\"beyond_linear\": [{\"region\": \"block\", \"measure\": \"shortening\""), std::string::npos) << json;
  }
}

// A beam that is pulled by the share p of Euler's load sags 1/(1 + p) times as far; linear strains leave this out and tell it.
TEST_F(LinearMeasures, WhatIsPulledWhileItBendsTellsThatItStiffens) {
  const double euler = pi * pi * E * I / (L * L);
  sag_by = "gravity = [0, 0, -1]";
  for (const double share : {0.02, 0.5}) {
    const Answer linear = rest(pins + push(-share * euler), Fidelity::linear),
                 cells = rest(pins + push(-share * euler), Fidelity::nonlinear);
    EXPECT_NEAR(linear.sag / cells.sag / (1 + share), 1, 0.03);
    EXPECT_EQ(linear.said.find("bends 1.5 times as far") != std::string::npos, share > 0.1) << linear.said;
  }
}

// A pinned beam under the share p of Euler's load rings with sqrt(1 + p) times its first frequency, p > 0 where it is pulled.  Cells and
// strains of the second degree have that; linear strains do not, and tell it.
TEST_F(LinearMeasures, ModesOfWhatIsPulledOrPressedTellThatTheyLackIt) {
  const double euler = pi * pi * E * I / (L * L);
  sag_by = "gravity = [0, 0, 0]";
  const auto first = [&](double share, bool stiffens, std::string& said) {
    c.use(mesh, {Fidelity::linear});
    std::ofstream(c / "scene.toml") << fmt::format(
                                           "[material.m]\nE = {}\nnu = 0\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n"
                                           "stiffening = {}\n",
                                           E, stiffens)
                                    << pins << push(-share * euler) << "[time]\nanalysis = \"modes\"\nmodes = 1\nstart = \"equilibrium\"\n";
    said = succeeded(c.run("hilo-solve scene.toml tags.h5 -o run.h5")).err;
    return c.results().history("mode")(1, 0);
  };
  std::string said;
  const double free = first(0, false, said);
  EXPECT_EQ(said.find("frequencies"), std::string::npos) << said;
  for (const double share : {0.005, 0.06, -0.06}) {
    first(share, false, said);
    const std::string word = share > 0 ? "frequencies are too low" : "frequencies are too high";
    EXPECT_EQ(said.find(word) != std::string::npos, std::abs(share) > 0.02) << said;
    EXPECT_NEAR(first(share, true, said) / free, std::sqrt(1 + share), 2e-3) << "by shear and the turn of sections";
    EXPECT_EQ(said.find("frequencies"), std::string::npos) << said;
  }
}

// Metal that is pulled by the stress s has s over its yield stress, linear or stiffening; what is elastic has none.
TEST_F(LinearMeasures, MetalTellsItsStressOverYield) {
  sag_by = "gravity = [0, 0, 0]";
  for (const bool stiffens : {false, true})
    for (const double share : {0.9, 1.2}) {
      const std::string metal =
          fmt::format("material.m.kind=\"j2\"' --set material.m.yield=1e6 --set 'region.block.stiffening={}", stiffens);
      const Answer pulled = rest(clamp + push(-share * 1e6 * A), Fidelity::linear, "--set '" + metal + "'");
      const std::string json = text_of(c / "run.json"), before = "\"stress_over_yield\": {\"block\": ";
      ASSERT_NE(json.find(before), std::string::npos) << json;
      EXPECT_NEAR(std::stod(json.substr(json.find(before) + before.size())), share, 0.01 * share);
      EXPECT_EQ(pulled.said.find("block: its von Mises stress is 1.2 of the yield stress") != std::string::npos, share > 1) << pulled.said;
      EXPECT_EQ(json.find("\"measure\": \"stress_over_yield\"") != std::string::npos, share > 1) << json;
    }
  rest(clamp + push(-1.2e6 * A), Fidelity::linear);
  EXPECT_NE(text_of(c / "run.json").find("\"stress_over_yield\": {\"block\": 0}"), std::string::npos);
}

}  // namespace
}  // namespace hilo::test::measures_test
