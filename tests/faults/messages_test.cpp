// SPDX-License-Identifier: GPL-3.0-or-later
// What is said: the right file, the right place, the part of the model that is meant, and nothing where quiet was asked for.
#include "faults.hpp"

using namespace hilo::test;

namespace {

constexpr int input = 2;

class Messages : public Faults {};

/// A pendulum, and what else there is.
std::string bodies(const std::string& more) {
  return R"([[body]]
name = "arm"
mass = 1
com = [0.5, 0, 0]
inertia = [0.01, 0.1, 0.1]
[[joint]]
kind = "revolute"
name = "hinge"
b = "arm"
at = [0, 0, 0]
axis = [0, 1, 0]
[time]
end = 0.1
step = 0.01
)" + more;
}

}  // namespace

TEST_F(Messages, NameTheDeckOfAnElementWhoseNodeIsMissing) {
  std::string text = deck;
  text.replace(text.find("1, 1, 2, 3, 4, 5, 6, 7, 8"), 25, "1, 1, 2, 3, 4, 5, 6, 7, 99");
  const std::string name = "a_deck_with_a_name_of_more_than_fifteen_characters.inp";
  put(name, text);
  refused("hilo-import " + name + " -o mesh.h5", input, name + ":15: element 1 names node 99, which does not exist");
}

TEST_F(Messages, OfAnInitialSpinOfASetNameTheEntry) {
  make_tags();
  put("scene.toml", scene + "[[initial]]\non = [\"top\"]\nspin = [1, 0, 0]\n");
  refused("hilo-solve --quiet scene.toml tags.h5", input, "scene.toml:...: initial: a spin of a set needs `about`");
}

TEST_F(Messages, OfADeviceSaySoInsteadOfReadingItForEver) {
  refused("hilo-solve /dev/zero", input, "/dev/zero: is a device, not a file");
  refused("hilo-solve scene.toml /dev/zero", input, "/dev/zero: is a device or pipe, not a file");
  refused("hilo-import /dev/zero -o mesh.h5", input, "/dev/zero: a device or pipe, not a file");
}

TEST_F(Messages, OfANumberThatNoRunCanTakeNameItsPlaceAndRange) {
  put("scene.toml", bodies("[solver]\ncuts = 63\n"));
  refused("hilo-solve scene.toml", input, "scene.toml:16:8: solver: cuts = 63 is not in [0, 30]");
  put("scene.toml", bodies("analysis = \"static\"\nsteps = 3e9\n"));
  refused("hilo-solve scene.toml", input, "scene.toml:16:9: time: steps = 3000000000 is not in [1, 1e+06]");
  put("scene.toml", bodies("[output]\ninterval = 1e-300\n"));
  refused("hilo-solve scene.toml", input,
          "scene.toml:16:12: output: interval = 1e-300 is beyond what can be computed with (sizes from 1e-30 to 1e+30 s, in SI units)");
  put("scene.toml", bodies(""));
  refused("hilo-solve scene.toml --set time.step=1e-300", input, "--set time.step=1e-300: time: step = 1e-300 is beyond ...");
  refused("hilo-solve scene.toml --set time.step=1e-12", input,
          "--set time.step=1e-12: time: 1e+11 steps to the end, at most 1e+09 are taken ...");
}

TEST_F(Messages, OfAKeyThatIsForOtherIntegratorsNameThem) {
  put("scene.toml", bodies("integrator = \"bathe\"\nrho = 0.5\n"));
  expect_end(run("hilo-solve scene.toml -o run.h5", folder), 0,
             "scene.toml:16:1: rho has no effect with bathe, it is for generalized-alpha, hht, wbz");
  put("scene.toml", bodies("integrator = \"hht\"\nrho = 0.5\n"));
  EXPECT_EQ(run("hilo-solve scene.toml -o run.h5", folder).err.find("says nothing"), std::string::npos);
}

// Truth: c/(2 sqrt(k I)) with c = mu N r^2/slip_velocity = 0.5 100 0.2^2/1e-3, k = 10, I = 0.1 + 0.5^2.
TEST_F(Messages, OfModesThatFrictionSticksSayHowItIsHeld) {
  put("scene.toml",
      bodies("analysis = \"modes\"\nmodes = 1\n[[spring]]\nkind = \"torsion\"\nname = \"wire\"\nb = \"arm\"\naxis = [0, 1, 0]\n"
             "stiffness = 10\n[[friction]]\nname = \"brake\"\njoint = \"hinge\"\ncoefficient = 0.5\nradius = 0.2\n"
             "preload = 100\nreaction = false\n"));
  expect_end(
      run("hilo-solve scene.toml -o run.h5", folder), 0,
      "scene.toml:23:1: friction \"brake\": at rest it is a damper of mu N r^2/slip_velocity, and mode 1 has the damping ratio 535: a "
      "joint that sticks is held by one of kind fixed in its place");
}

// Truth: an impact lasts about pi sqrt(I/k) = 19 ms, I = 0.1 + 0.5^2, k = 1e4: two steps of 10 ms.
TEST_F(Messages, OfAStopTellAnImpactThatStepsDoNotResolve) {
  const auto said = [&](const std::string& restitution, const std::string& step) {
    put("scene.toml",
        bodies("[[stop]]\nkind = \"angle\"\nname = \"buffer\"\njoint = \"hinge\"\nupper = 0.3\nstiffness = 1e4\nrestitution = " +
               restitution + "\n[[initial]]\non = [\"arm\"]\nspin = [0, 10, 0]\n"));
    return run("hilo-solve scene.toml -o run.h5 --set time.end=0.3 --set time.step=" + step, folder);
  };
  const std::string text = "stop \"buffer\": the shortest of 1 impacts lasted ";
  const Ran coarse = said("0.3", "1e-2");
  expect_end(coarse, 0, text), expect_end(coarse, 0, " steps: its force and its restitution are not resolved");
  EXPECT_EQ(said("0.3", "1e-3").err.find(text), std::string::npos);
  EXPECT_EQ(said("1", "1e-2").err.find(text), std::string::npos) << "energy is given back at any step";
}

TEST_F(Messages, OfASingularMatrixNameWhatIsFree) {
  // a bob without mass or inertia; it may turn about its joint as it likes
  put("scene.toml",
      bodies("[[body]]\nname = \"bob\"\nmass = 0\ncom = [1, 0, 0]\n[[joint]]\nkind = \"spherical\"\nname = \"eye\"\na = \"arm\"\nb = "
             "\"bob\"\nat = [1, 0, 0]\n"));
  expect_end(work.run("hilo-solve --quiet scene.toml"), 3, "the matrix is singular: body \"bob\" is not held, or has no mass");
}

TEST_F(Messages, AreNoneWhereQuietWasAskedFor) {
  for (const char* command : {"hilo-import two.inp -o two.h5", "hilo-tag two.h5 --rigid hull --nonlinear mast -o tags.h5",
                              "hilo-part tags.h5 -n 1 -o parts.h5", "hilo-solve scene.toml tags.h5 -o run.h5"}) {
    const Ran ran = work.run(std::string(command) + " --quiet");
    EXPECT_EQ(ran.exit, 0) << command << ": " << ran.err;
    EXPECT_EQ(ran.out, "") << command;
    EXPECT_EQ(ran.err, "") << command;
  }
  EXPECT_NE(work.run("hilo-tag two.h5 --rest rigid --dry-run --quiet").out, "");  // the table is what was asked for
  EXPECT_NE(work.run("hilo-tag two.h5 --rest rigid --json --quiet -o tags.h5").out, "");
}
