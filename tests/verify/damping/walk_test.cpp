// SPDX-License-Identifier: GPL-3.0-or-later
// Every key of damping at every fidelity in every analysis, each against the closed form of one freedom, m x'' + c x' + k x = p:
// the ratio c/(2 sqrt(k m)) and frequency sqrt(k/m) of modes, the amplitude 1/|k - m w^2 + i w c| of a response, the logarithmic decrement
// of a run in time.
#include <complex>
#include <numbers>
#include <sstream>

#include "verify/linear_region/bars.hpp"

namespace hilo::test::walk_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A freedom: what moves, on what, and with what damper.
struct One {
  std::string name, scene;
  double m = 0, k = 0, c = 0;
  bool turns = false;         // it is an angle: there is no force to push it with
  std::string fidelity = "";  // of all that there are, or of these
};

/// A stiff block of 10 kg, 0.2 m wide, on springs to the ground at its face xmin.
constexpr double m = 10, k = 1000, J = 10 * 0.2 * 0.2 / 6, kt = 400;
const std::string stiff = "[material.m]\nE = 2e11\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = \"m\"\nmass = 10\n";
const std::string others = "angular_stiffness = [400, 3000, 3000]\n";
const std::string at = "at = [-0.1, 0, 0]\n", on = "b = \"xmin\"\n";
std::string bushing(const std::string& more) {
  return "[[spring]]\nkind = \"bushing\"\nname = \"s\"\n" + on + at + "stiffness = [1000, 9000, 9000]\n" + more;
}

/// A bar of one cell, which is stretched: k = E A/L, of its mass a third moves, consistent with linear displacements.
const std::string bar = "[material.m]\nE = 1e6\nnu = 0\ndensity = 3000\n[region.block]\nmaterial = \"m\"\n";
const std::string wall = "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n";

std::vector<One> all_of_them() {
  const double c = 20, ct = 2;
  std::vector<One> out{
      {"mass_damping of what moves", stiff + "mass_damping = 2\n" + bushing(others), m, k, 2 * m},
      {"damping of a bushing", stiff + bushing("damping = [20, 0, 0]\n" + others), m, k, c},
      {"angular_damping of a bushing", stiff + bushing("angular_damping = [2, 0, 0]\n" + others), J, kt, ct, true},
      {"damping of an axial spring",
       stiff + "[[spring]]\nkind = \"bushing\"\nname = \"s\"\n" + on + at + "stiffness = [0, 9000, 9000]\n" + others +
           "[[spring]]\nkind = \"axial\"\nname = \"a\"\n" + on +
           "at_a = [-1.1, 0, 0]\nat_b = [-0.1, 0, 0]\nstiffness = 1000\ndamping = 20\n",
       m, k, c},
      {"damping of a torsion spring",
       stiff + "[[joint]]\nkind = \"revolute\"\nname = \"pin\"\n" + on + at +
           "axis = [1, 0, 0]\n[[spring]]\nkind = \"torsion\"\nname = \"t\"\n" + on + "axis = [1, 0, 0]\nstiffness = 400\ndamping = 2\n",
       J, kt, ct, true},
      {"damping of a compliant joint",
       stiff + "[[joint]]\nkind = \"fixed\"\nname = \"mount\"\n" + on + at + "stiffness = [1000, 9000, 9000]\n" + others +
           "damping = [20, 0, 0]\n",
       m, k, c},
      {"angular_damping of a compliant joint",
       stiff + "[[joint]]\nkind = \"fixed\"\nname = \"mount\"\n" + on + at + "stiffness = [1000, 9000, 9000]\n" + others +
           "angular_damping = [2, 0, 0]\n",
       J, kt, ct, true},
      {"tangential_damping of a support",
       stiff + "[[spring]]\nkind = \"bushing\"\nname = \"s\"\n" + on + at + "stiffness = [0, 9000, 9000]\n" + others +
           "[[spring]]\nkind = \"support\"\nname = \"u\"\n" + on + at +
           "axis = [0, 0, 1]\nx = [1, 0, 0]\nstiffness = 1e3\nclearance = 1\ntangential_stiffness = [1000, 0]\ntangential_damping = [20, "
           "0]\n",
       m, k, c}};
  const double E = 1e6, mass = 3000 / 3., omega = std::sqrt(E / mass);
  out.push_back({"damping of what strains", bar + "damping = 3e-3\n" + wall, mass, E, 3e-3 * E, false, "flexible"});
  out.push_back({"mass_damping of what strains", bar + "mass_damping = 3\n" + wall, mass, E, 3 * mass, false, "flexible"});
  out.push_back(
      {"modal_damping of what strains", bar + "modal_damping = 0.05\n" + wall, mass, E, 2 * 0.05 * omega * mass, false, "linear"});
  return out;
}

class EveryDamping : public testing::TestWithParam<One> {
 protected:
  double omega() const { return std::sqrt(GetParam().k / GetParam().m); }
  double zeta() const { return GetParam().c / (2 * std::sqrt(GetParam().k * GetParam().m)); }
  std::string solve(const std::string& time, const std::string& fidelity) {
    const One& one = GetParam();
    const bool is_block = one.fidelity.empty();
    const BlockOptions o{.low = is_block ? Vec3(-0.1, -0.1, -0.1) : Vec3(0, -0.5, -0.5),
                         .high = is_block ? Vec3(0.1, 0.1, 0.1) : Vec3(1, 0.5, 0.5)};
    write_mesh(work / "mesh.h5", block_mesh(o), {"test"});
    work.run("hilo-tag --quiet mesh.h5 --" + fidelity + " block -o tags.h5");
    work.write(
        "scene.toml",
        one.scene + "[[probe]]\nname = \"p\"\non = \"xmax\"\n[[probe]]\nname = \"corner\"\non = \"block\"\nat = [0.1, 0.1, 0]\n" + time);
    const Ran ran = succeeded(work.run("hilo-solve scene.toml tags.h5 -o run.h5"));
    return ran.err;
  }
  Workplace work;
};

TEST_P(EveryDamping, IsThatOfOneFreedomAtEveryFidelity) {
  const One& one = GetParam();
  for (const std::string fidelity : {"rigid", "linear", "nonlinear"}) {
    if (one.fidelity == "linear" && fidelity != "linear") continue;
    if (one.fidelity == "flexible" && fidelity == "rigid") continue;
    SCOPED_TRACE(fidelity);
    // modes
    solve("[time]\nanalysis = \"modes\"\nmodes = 6\n", fidelity);
    const Eigen::MatrixXd modes = Results(work / "run.h5").history("mode");
    Eigen::Index which = 1;
    for (Eigen::Index j = 1; j < modes.rows(); ++j)
      if (std::abs(modes(j, 0) - omega() / (2 * pi)) < std::abs(modes(which, 0) - omega() / (2 * pi))) which = j;
    EXPECT_NEAR(modes(which, 0) * 2 * pi / omega(), 1, 1e-5);
    EXPECT_NEAR(modes(which, 1) / zeta(), 1, 1e-5);
    // response
    if (!one.turns) {
      const Ran ran = succeeded(work.run("hilo-post response run.h5 --force p.x --points 5 --from " +
                                         std::to_string(0.5 * omega() / (2 * pi)) + " --to " + std::to_string(1.5 * omega() / (2 * pi))));
      std::istringstream rows(ran.out);
      std::string line;
      std::getline(rows, line);
      for (double f, size, phase; std::getline(rows, line);) {
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &f, &size, &phase), 3) << line;
        const double w = 2 * pi * f;
        const std::complex<double> exact = 1.0 / std::complex<double>(one.k - one.m * w * w, w * one.c);
        EXPECT_NEAR(size / std::abs(exact), 1, 1e-4) << f;
        EXPECT_NEAR(phase, std::arg(exact) * 180 / pi, 1e-2) << f;
      }
    }
    // time: five periods, from the first turning point on
    const double damped = omega() * std::sqrt(1 - zeta() * zeta()), period = 2 * pi / damped, h = period / 200;
    const std::string start = one.turns ? "spin = [0.01, 0, 0]\nabout = [0, 0, 0]\n" : "velocity = [1e-4, 0, 0]\n";
    std::ostringstream time;
    time.precision(15);
    time << "[[initial]]\non = [\"block\"]\n"
         << start << "[time]\nend = " << 1060 * h << "\nstep = " << h << "\n[solver]\ntolerance = 1e-12\n";
    solve(time.str(), fidelity);
    const Eigen::MatrixXd x = Results(work / "run.h5").history(one.turns ? "probe/corner" : "probe/p");
    const Eigen::Index column = one.turns ? 2 : 0;
    const auto away = [&](Eigen::Index i) { return x(i, column) - x(0, column); };
    const double decrement = std::log(away(50) / away(1050)), exact = 5 * zeta() * omega() * period;
    EXPECT_NEAR(decrement / exact, 1, 2e-3);
  }
}

std::string name_of(const testing::TestParamInfo<One>& info) {
  std::string out = info.param.name;
  std::replace_if(
      out.begin(), out.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return out;
}
INSTANTIATE_TEST_SUITE_P(Keys, EveryDamping, testing::ValuesIn(all_of_them()), name_of);

// The schema has no key of damping that the walk above leaves out, but those of contact (`damping` of a support acts while it is closed).
TEST(Damping, NoKeyIsLeftOutOfTheWalk) {
  const Workplace work;
  const Ran ran = succeeded(work.run("hilo-show --schema"));
  std::set<std::string> keys;
  for (size_t i = ran.out.find("damping` |"); i != ran.out.npos; i = ran.out.find("damping` |", i + 1)) {
    const size_t from = ran.out.rfind('`', i) + 1;
    if (ran.out[from] != '/') keys.insert(ran.out.substr(from, i + 7 - from));
  }
  EXPECT_EQ(keys, (std::set<std::string>{"damping", "angular_damping", "tangential_damping", "mass_damping", "modal_damping"}));
}

/// Ratios that modes have, modal_damping being .02.
class ModalDamping : public testing::Test {
 protected:
  std::vector<double> ratios(const std::string& scene, int wanted, const Vec3& size = {1, 0.03, 0.04}, bool two = false,
                             const std::string& keys = "") {
    const BlockOptions o{.shape = Shape::hex20r,
                         .n = {8, 1, 1},
                         .low = Vec3(0, -size[1] / 2, -size[2] / 2),
                         .high = Vec3(size[0], size[1] / 2, size[2] / 2)};
    Mesh mesh = block_mesh(o);
    if (two) {  // the same once more behind it, with nodes of its own
      BlockOptions p = o;
      p.low[0] += size[0], p.high[0] += size[0];
      const Mesh one = mesh, other = block_mesh(p);
      mesh = soft_bars::together({{&one, ""}, {&other, "second-"}});
    }
    write_mesh(work / "mesh.h5", mesh, {"test"});
    work.run("hilo-tag --quiet mesh.h5 --linear '*' -o tags.h5");
    work.write("scene.toml", "[material.m]\nE = 7e9\nnu = 0.3\ndensity = 2700\n[region.\"*\"]\nmaterial = \"m\"\nmodal_damping = 0.02\n" +
                                 keys + scene + "[time]\nanalysis = \"modes\"\nmodes = " + std::to_string(wanted) + "\n");
    succeeded(work.run("hilo-solve scene.toml tags.h5 -o run.h5"));
    const Eigen::MatrixXd modes = Results(work / "run.h5").history("mode");
    std::vector<double> out;
    for (Eigen::Index j = 1; j < modes.rows(); ++j)
      if (modes(j, 0) > 1e-3) out.push_back(modes(j, 1));
    return out;
  }
  Workplace work;
};

const std::string tip_mass =
    "[[body]]\nname = \"bob\"\nmass = 5\ncom = [1, 0, 0]\ninertia = [0.01, 0.01, 0.01]\n"
    "[[joint]]\nkind = \"fixed\"\nname = \"weld\"\na = \"xmax\"\nb = \"bob\"\nat = [1, 0, 0]\n";
const std::string hinge = "[[joint]]\nkind = \"revolute\"\nname = \"pin\"\nb = \"xmin\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
const std::string in_line = "[[joint]]\nkind = \"fixed\"\nname = \"seam\"\na = \"xmax\"\nb = \"second-xmin\"\nat = [1, 0, 0]\n";

TEST_F(ModalDamping, IsThatOfEveryModeHoweverTheRegionIsHeld) {
  for (const std::string& held : {std::string(), wall, hinge, wall + tip_mass, hinge + tip_mass}) {
    const auto found = ratios(held, 10);
    EXPECT_GE(found.size(), 4u) << held;
    for (const double zeta : found) EXPECT_NEAR(zeta, 0.02, 2e-5) << held;
  }
}
TEST_F(ModalDamping, IsThatOfTheModesThatTwoRegionsShare) {
  const auto found = ratios(wall + in_line, 6, {1, 0.03, 0.04}, true);
  EXPECT_EQ(found.size(), 6u);
  for (const double zeta : found) EXPECT_NEAR(zeta, 0.02, 2e-5);
}
TEST_F(ModalDamping, BrakesNoRigidMotion) {
  const Eigen::MatrixXd all = (ratios("", 8), Results(work / "run.h5").history("mode_damping"));
  EXPECT_LT(all.block(1, 0, 6, 6).cwiseAbs().maxCoeff(), 1e-6 * all(7, 6));
}

// With `stiffening` the default of `modes` gives way to the most that can stiffen; what is asked for is refused beyond it.
TEST_F(ModalDamping, OfAStripThatStiffensHasItsDefaultOfModes) {
  const auto found = ratios(wall, 4, {1, 0.03, 0.04}, false, "stiffening = true\n");
  EXPECT_EQ(found.size(), 4u);
  for (const double zeta : found) EXPECT_NEAR(zeta, 0.02, 2e-5);
  expect_end(work.run("hilo-solve scene.toml tags.h5 -o run.h5 --set 'region.*.modes=60'"), 2, "the most that can stiffen is 60");
}

// What nothing feels is told.
TEST(Damping, ThatSaysNothingIsTold) {
  const Workplace work;
  write_mesh(work / "mesh.h5", block_mesh({}), {"test"});
  const auto said = [&](const std::string& fidelity, const std::string& key) {
    work.run("hilo-tag --quiet mesh.h5 --" + fidelity + " block -o tags.h5");
    work.write("scene.toml", "[material.m]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n" + key +
                                 " = 0.01\n[time]\nend = 0.01\nstep = 0.01\n");
    return work.run("hilo-solve scene.toml tags.h5 -o run.h5").err.find("has no effect on \"block\"") != std::string::npos;
  };
  EXPECT_TRUE(said("rigid", "damping"));
  EXPECT_TRUE(said("rigid", "modal_damping"));
  EXPECT_TRUE(said("nonlinear", "modal_damping"));
  EXPECT_FALSE(said("linear", "modal_damping"));
  EXPECT_FALSE(said("nonlinear", "damping"));
  EXPECT_FALSE(said("rigid", "mass_damping"));
}

}  // namespace
}  // namespace hilo::test::walk_test
