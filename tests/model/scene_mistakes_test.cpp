// SPDX-License-Identifier: GPL-3.0-or-later
// A scene is refused with file:line:column, what is wrong, and what to write instead; what is implausible is told.
#include "scene_text.hpp"
#include "succeeded.hpp"

namespace hilo::test::scene_mistakes_test {
namespace {

using Mistake = SceneText;
using Warning = SceneText;

TEST_F(Mistake, InTheTomlIsReportedWhereTheParserStopped) {
  const std::string message = refusal("title = \"gun\"\n[time\nend = 1\n");
  EXPECT_EQ(message.substr(0, 13), "scene.toml:2:");
  EXPECT_NE(message.find("table header"), message.npos) << message;
  EXPECT_NE(refusal("title = \"gun\"\ntitle = \"sun\"\n").find("scene.toml:2:"), message.npos) << "a key written twice";
  EXPECT_NE(refusal("[material.a]\nE = 1e9\n[material.a]\nE = 2e9\n").find("scene.toml:3:"), message.npos) << "a table written twice";
}

TEST_F(Mistake, AMissingFileIsNamed) {
  try {
    Scene::load((folder / "absent.toml").string());
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit, Exit::input);
    EXPECT_NE(std::string(e.what()).find("absent.toml"), std::string::npos);
  }
}

TEST_F(Mistake, IsSaidInOneLineWhateverTheKeyHolds) {
  EXPECT_EQ(refusal("[time]\n\"a\\nb\" = 1\n").substr(0, 46), "scene.toml:2:1: time: unknown key \"a b\" (keys:");
}

TEST_F(Mistake, UnknownSection) {
  EXPECT_EQ(refusal("\n[[joints]]\nname = \"a\"\n"), "scene.toml:2:3: unknown section \"joints\" (did you mean \"joint\"?)");
  EXPECT_EQ(refusal("[materials.steel]\nE = 1\n"), "scene.toml:1:2: unknown section \"materials\" (did you mean \"material\"?)");
}

TEST_F(Mistake, UnknownKey) {
  EXPECT_EQ(refusal("gravty = [0, 0, -9.81]\n"), "scene.toml:1:1: unknown key \"gravty\" (did you mean \"gravity\"?)");
  EXPECT_EQ(refusal("[time]\nend = 1\n  stepp = 2\n"), "scene.toml:3:3: time: unknown key \"stepp\" (did you mean \"step\"?)");
  EXPECT_EQ(
      refusal(hinge + "weight = 2\n"),
      "scene.toml:9:1: joint \"trunnion\": unknown key \"weight\" (keys: kind, name, a, b, at, axis, x, angle, spin, history, stiffness, "
      "angular_stiffness, damping, angular_damping, reactions)");
}

// A spherical joint holds no turn on a spring.
TEST_F(Mistake, ASpringWhereTheJointIsFree) {
  const std::string found = refusal(
      "[[joint]]\nkind = \"spherical\"\nname = \"ball\"\nb = \"barrel\"\nat = [0, 0, 0]\nstiffness = 1e5\nangular_stiffness = 200\n");
  EXPECT_TRUE(found.find("unknown key \"angular_stiffness\"") != found.npos) << found;
}

// The tables that have the key are named where they are few: other sections, or other kinds of the same one.
TEST_F(Mistake, KeyOfAnotherTable) {
  const std::string steel = "[material.steel]\nkind = \"stvk\"\nE = 2e11\nnu = 0.3\ndensity = 7800\n";
  expect_words(refusal(steel + "damping = 1e-4\n"),
               ":6:1: material \"steel\": unknown key \"damping\" (it is a key of [region.NAME], [beam.NAME], [[joint]] and "
               "[[spring]]; keys: ");
  EXPECT_NE(refusal(hinge + "pitch = 0.01\n").find("(it is a key of [[joint]] of kind \"screw\"; keys: kind, "), std::string::npos);
  expect_words(refusal("integrator = \"gauss\"\n"), "unknown key \"integrator\" (it is a key of [time]; keys at the top of a scene: ");
  EXPECT_NE(refusal(hinge + "axes = [0, 0, 1]\n").find("(did you mean \"axis\"? \"axes\" is a key of [[body]])"), std::string::npos);
  EXPECT_NE(refusal("[output]\nname = \"a\"\n").find("unknown key \"name\" (keys: "), std::string::npos);  // too many have it
}

TEST_F(Mistake, UnknownKind) {
  EXPECT_EQ(refusal("[[joint]]\nkind = \"revolut\"\nname = \"j\"\n"),
            "scene.toml:2:1: joint \"j\": unknown kind \"revolut\" (did you mean \"revolute\"?)");
  EXPECT_EQ(refusal("[[joint]]\nname = \"j\"\n").substr(0, 64), "scene.toml:1:1: joint \"j\": \"kind\" is missing (one of: fixed, sph");
  EXPECT_EQ(refusal("[material.m]\nkind = \"neohookean\"\n"),
            "scene.toml:2:1: material \"m\": unknown kind \"neohookean\" (did you mean \"neo-hookean\"?)");
}

TEST_F(Mistake, UnknownWord) {
  EXPECT_EQ(refusal("[time]\nstart = \"equilibrum\"\n"),
            "scene.toml:2:9: time: start = \"equilibrum\" is not known (did you mean \"equilibrium\"?)");
  EXPECT_EQ(refusal("units = \"imperial\"\n"),
            "scene.toml:1:9: units = \"imperial\" is not known (one of: ft-lbf-s, in-lbf-s, m-kg-s, mm-kg-ms, mm-t-s)");
  EXPECT_EQ(refusal("[output]\nfields = [\"stress\", \"velocty\"]\n"),
            "scene.toml:2:21: output: fields = \"velocty\" is not known (did you mean \"velocity\"?)");
}

TEST_F(Mistake, WrongType) {
  EXPECT_EQ(refusal("[material.steel]\nE = \"210 GPa\"\n"),
            "scene.toml:2:5: material \"steel\": E is text, not a number (in Pa of the system m-kg-s, without the unit)");
  EXPECT_EQ(refusal("gravity = -9.81\n"),
            "scene.toml:1:11: gravity is a number, not a list of 3 numbers (in m/s^2 of the system m-kg-s, without the unit)");
  EXPECT_EQ(refusal("gravity = [0, -9.81]\n"), "scene.toml:1:1: gravity has 2 numbers, not 3 (acceleration of free fall)");
  EXPECT_EQ(refusal("gravity = [0, 0, \"down\"]\n").substr(0, 58), "scene.toml:1:18: gravity is text, not a number (in m/s^2 o");
  EXPECT_EQ(refusal("title = 3\n"), "scene.toml:1:9: title is a number, not text (one line, shown in pictures)");
  EXPECT_EQ(refusal(pull + "per_node = \"yes\"\n").substr(0, 72),
            "scene.toml:7:12: load \"pull\": per_node is text, not true or false (the f");
  EXPECT_EQ(refusal("[solver]\niterations = 2.5\n"), "scene.toml:2:14: solver: iterations = 2.5 is not a whole number");
  EXPECT_EQ(refusal("[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 2, 3, 4]\n").substr(0, 63),
            "scene.toml:5:1: body \"b\": inertia has 4 numbers, not 3 or 6 (ab");
}

TEST_F(Mistake, WrongFormOfASection) {
  EXPECT_EQ(refusal("[joint]\nname = \"j\"\n"), "scene.toml:1:2: joint is a table, not a list of tables (write [[joint]])");
  EXPECT_EQ(refusal("[[time]]\nend = 1\n"), "scene.toml:1:3: time is a list, not a table (write [time])");
  EXPECT_EQ(refusal("[material]\nE = 1e9\n"), "scene.toml:2:1: material: E is a number, not a table (write [material.NAME])");
}

TEST_F(Mistake, OutOfRange) {
  EXPECT_EQ(refusal("[material.steel]\nnu = 0.5\n"), "scene.toml:2:6: material \"steel\": nu = 0.5 is not in (-1, 0.5)");
  EXPECT_EQ(refusal("[material.steel]\ndensity = -7850\n"), "scene.toml:2:11: material \"steel\": density = -7850 is not > 0");
  EXPECT_EQ(refusal("[time]\nstep = 0\n"), "scene.toml:2:8: time: step = 0 is not > 0");
  EXPECT_EQ(refusal("[time]\nend = nan\n"), "scene.toml:2:7: time: end = nan is not finite");
}

TEST_F(Mistake, MissingKey) {
  EXPECT_EQ(refusal("\n[[body]]\nname = \"b\"\ncom = [0, 0, 0]\n"), "scene.toml:2:1: body \"b\": \"mass\" is missing (mass)");
  EXPECT_EQ(refusal("[[probe]]\non = \"tip\"\n"), "scene.toml:1:1: probe: \"name\" is missing (name, unique within the section)");
}

// Truth: hooke_joint turns both shafts alike with the cross between them alone; any other cross jams or idles.
TEST_F(Mistake, AUniversalJointWithoutItsSecondArm) {
  std::string text = hinge;
  text.replace(text.find("revolute"), 8, "universal");
  EXPECT_EQ(refusal(text),
            "scene.toml:2:1: joint \"trunnion\": \"x\" is missing (arm of the cross that turns in b, made normal to `axis`: the vector "
            "product of `axis` and the shaft of b)");
  EXPECT_EQ(load(text + "x = [1, 0, 0]\n").entries("joint").size(), 1u);
}

TEST_F(Mistake, NameGivenTwice) {
  EXPECT_EQ(refusal(pull + pull), "scene.toml:10:1: load \"pull\" is given twice (first at scene.toml:4:1)");
  EXPECT_EQ(refusal("[region.box]\ndamping = 0\n[[body]]\nname = \"box\"\nmass = 1\ncom = [0, 0, 0]\n"),
            "scene.toml:4:1: body \"box\": a region has the same name (first at scene.toml:1:9)");
  EXPECT_EQ(refusal("[[body]]\nname = \"ground\"\nmass = 1\ncom = [0, 0, 0]\n"),
            "scene.toml:2:1: body \"ground\": \"ground\" is the inertial frame (give the body another name)");
}

TEST_F(Mistake, NameThatCannotBeAPath) {
  EXPECT_EQ(refusal("[[probe]]\nname = \"a/b\"\non = \"tip\"\n"), "scene.toml:2:1: probe \"a/b\": a name may not hold \"/\" nor be a dot");
  EXPECT_EQ(refusal("[material.\"a/b\"]\nE = 1e9\n"), "scene.toml:1:11: material \"a/b\": a name may not hold \"/\" nor be a dot");
  EXPECT_EQ(refusal("[[probe]]\nname = \"\"\non = \"tip\"\n"), "scene.toml:2:1: probe: empty name");
}

TEST_F(Mistake, DirectionWithoutLengthOrParallelToAnother) {
  std::string text = hinge;
  text.replace(text.find("[0, 1, 0]"), 9, "[0, 0, 0]");
  EXPECT_EQ(refusal(text), "scene.toml:8:1: joint \"trunnion\": axis has length zero (a direction, as in [0, 0, 1])");
  EXPECT_EQ(refusal(hinge + "x = [0, -2, 0]\n"),
            "scene.toml:9:1: joint \"trunnion\": x is parallel to axis (x must differ from it in direction)");
}

TEST_F(Mistake, EndsThatAreTheSame) {
  std::string text = hinge;
  text.replace(text.find("turret"), 6, "cradle");
  EXPECT_EQ(refusal(text), "scene.toml:6:1: joint \"trunnion\": both ends are \"cradle\"");
  EXPECT_EQ(refusal("[[joint]]\nkind = \"distance\"\nname = \"d\"\nb = \"box\"\nat_a = [1, 2, 3]\nat_b = [1, 2, 3]\n"),
            "scene.toml:6:1: joint \"d\": at_a and at_b are the same point (the direction is the line between them)");
}

TEST_F(Mistake, UnknownMaterialOfARegion) {
  EXPECT_EQ(refusal("[material.steel]\nE = 2e11\n[region.hull]\nmaterial = \"stele\"\n"),
            "scene.toml:4:1: region \"hull\": no material \"stele\" (did you mean \"steel\"?)");
  EXPECT_EQ(refusal("[region.hull]\nmaterial = \"steel\"\n"),
            "scene.toml:2:1: region \"hull\": no material \"steel\" (write [material.steel])");
}

TEST_F(Mistake, InAHistory) {
  EXPECT_EQ(refusal(pull + "history = \"shot\"\n"), "scene.toml:7:1: load \"pull\": no history \"shot\" (write [history.shot])");
  EXPECT_EQ(refusal("[history.shoot]\nt = [0, 1]\nvalue = [0, 1]\n" + pull + "history = \"shot\"\n"),
            "scene.toml:10:1: load \"pull\": no history \"shot\" (did you mean \"shoot\"?)");
  EXPECT_EQ(refusal("[history.h]\nt = [0, 2, 1]\nvalue = [0, 1, 2]\n"),
            "scene.toml:2:1: history \"h\": time 1 comes after 2 (times must rise; two equal ones make a jump)");
  EXPECT_EQ(refusal("[history.h]\nt = [0, 1, 1, 1]\nvalue = [0, 1, 2, 3]\n"),
            "scene.toml:2:1: history \"h\": time 1 stands three times (times must rise; two equal ones make a jump)");
  EXPECT_EQ(refusal("[history.h]\nt = [0, 1]\nvalue = [0, 1, 2]\n"), "scene.toml:3:1: history \"h\": 2 times but 3 values");
  EXPECT_EQ(refusal("[history.h]\nt = [0, 1]\n"),
            "scene.toml:1:10: history \"h\": neither a file nor t and value (write file = \"load.csv\", or t = [...] and value = [...])");
  EXPECT_EQ(refusal(pull + "history = {t = [0, 1], values = [0, 1]}\n"),
            "scene.toml:7:24: load \"pull\": history: unknown key \"values\" (did you mean \"value\"?)");
}

TEST_F(Mistake, InACsvFileIsReportedInThatFile) {
  const auto csv = [&](const std::string& text) {
    put("load.csv", text);
    return refusal("[history.h]\nfile = \"load.csv\"\n");
  };
  EXPECT_EQ(csv("t,F\n0,0\n2,1\n1,2\n"), "load.csv:4:1: time 1 comes after 2 (times must rise; two equal ones make a jump)");
  EXPECT_EQ(csv("t,F\n0,0\n0,1\n0,2\n"), "load.csv:4:1: time 0 stands three times (times must rise; two equal ones make a jump)");
  EXPECT_EQ(csv("t,F\n0,0\n1, a lot\n"), "load.csv:3:4: \"a lot\" is not a number");
  EXPECT_EQ(csv("t,F\n0,0\n1;\n"), "load.csv:3:3: \"\" is not a number");
  EXPECT_EQ(csv("t,F\n0,0\n1\n"), "load.csv:3:1: 1 column where two are expected: time and value");
  EXPECT_EQ(csv("t,F\n0,0,0\n"), "load.csv:2:5: 3 columns where two are expected: time and value");
  EXPECT_EQ(csv("0,0\n1,1\n"), "load.csv:1:1: no header line (write \"t,value\" above the first numbers)");
  EXPECT_EQ(csv("t,F\n"), "load.csv:1:1: no times and values (a header line, then lines \"t,value\")");
  EXPECT_EQ(csv(""), "load.csv:1:1: no times and values (a header line, then lines \"t,value\")");
  EXPECT_EQ(csv("t [steps],F\n0,0\n1,1\n"), "load.csv:1:1: \"steps\" is no unit of time (s, ms, us, min or h)");
  EXPECT_EQ(csv("t [ms], F [kN]\n0,0\n1,1\n"), "load.csv:1:9: values in kN, not in N of m-kg-s (scale = 1000 beside `file` converts them)");
  EXPECT_EQ(csv("t (s), F (stone)\n0,0\n1,1\n"),
            "load.csv:1:8: the unit \"stone\" is not known (take it out of the heading, or give `scale`, what one of it is in the units of "
            "the scene)");
  EXPECT_EQ(csv("t,time [s]\n0,0\n1,1\n"), "load.csv:1:3: both columns are named as times (write \"t,value\" above the numbers)");
  EXPECT_EQ(csv("F,t [m]\n0,0\n1,1\n"), "load.csv:1:3: \"m\" is no unit of time (s, ms, us, min or h)");
  EXPECT_EQ(refusal("[history.h]\nfile = \"lod.csv\"\n"),
            "scene.toml:2:1: no file lod.csv (paths in a scene are relative to the scene's folder)");
}

TEST_F(Warning, NamesImplausibleMaterials) {
  const auto warnings = [&](const std::string& keys) {
    std::vector<std::string> lines;
    for (const auto& w : load("[material.m]\n" + keys + "[region.r]\nmaterial = \"m\"\n").warnings) lines.push_back(without_folder(w));
    return lines;
  };
  EXPECT_EQ(warnings("density = 7.8\n"),
            std::vector<std::string>{"scene.toml:2:1: material \"m\": a density of 7.8 kg/m^3; do the numbers fit `units`?"});
  EXPECT_EQ(warnings("E = 210\n"),
            std::vector<std::string>{"scene.toml:2:1: material \"m\": a Young's modulus of 210 Pa; do the numbers fit `units`?"});
  EXPECT_EQ(warnings("E = 1e12\ndensity = 20\n"),
            std::vector<std::string>{"scene.toml:2:1: material \"m\": waves of 2.236e+05 m/s in a bar; do the numbers fit `units`?"});
  EXPECT_TRUE(warnings("E = 210e9\ndensity = 7850\nnu = 0.3\n").empty());
}

TEST_F(Warning, NamesAStepThatIsLongForTheLoadButNotASampledOneThatIsShort) {
  const std::string time = "[time]\nend = 1\nstep = 2e-3\n";
  auto w = load(time + pull + "history = {t = [0, 5e-3, 10e-3], value = [0, 1, 0]}\n").warnings;
  ASSERT_EQ(w.size(), 1u);
  EXPECT_EQ(without_folder(w[0]),
            "scene.toml:3:1: time: a step of 0.002 s is long for load \"pull\", whose history rises or falls within 0.005 s");
  w = load(time + pull + "history = {t = [0, 0.01, 0.02, 0.03, 0.2], value = [0, 1, 2, 3, 0]}\n").warnings;
  EXPECT_TRUE(w.empty()) << "finely sampled, but rising for 0.03 s";
  w = load("[time]\nend = 1\nstep = 2\n").warnings;
  ASSERT_EQ(w.size(), 1u);
  EXPECT_NE(w[0].find("longer than the run"), std::string::npos);
}

// Truth: the force of friction is of the speed, which statics has not.
TEST_F(Warning, NamesFrictionOfJointsThatHasNoForce) {
  const auto warnings = [&](const std::string& time) {
    return load(hinge + "[[friction]]\nname = \"rub\"\njoint = \"trunnion\"\ncoefficient = 0.3\nradius = 0.1\n[time]\n" + time).warnings;
  };
  const auto expected = [](const std::string& where) {
    return "scene.toml:9:1: friction \"rub\": it has no force in " + where +
           ": what it would hold gives way there (a fixed joint holds it)";
  };
  for (const std::string analysis : {"static", "path", "buckling"}) {
    const auto w = warnings("analysis = \"" + analysis + "\"\n");
    ASSERT_EQ(w.size(), 1u) << analysis;
    EXPECT_EQ(without_folder(w[0]), expected("analysis = \"" + analysis + "\""));
  }
  for (const std::string analysis : {"modes", "dynamic"}) {
    EXPECT_TRUE(warnings("analysis = \"" + analysis + "\"\n").empty());
    const auto w = warnings("start = \"equilibrium\"\nanalysis = \"" + analysis + "\"\n");
    ASSERT_EQ(w.size(), 1u) << analysis;
    EXPECT_EQ(without_folder(w[0]), expected("start = \"equilibrium\""));
  }
}

TEST_F(Warning, NamesGravityDampingAndWhatIsNotUsed) {
  const auto one = [&](const std::string& text) {
    const auto w = load(text).warnings;
    return w.size() == 1 ? without_folder(w[0]) : std::to_string(w.size()) + " warnings";
  };
  EXPECT_EQ(one("gravity = [0, 0, -9810]\n"), "scene.toml:1:1: a gravity of 9810 m/s^2; do the numbers fit `units`?");
  EXPECT_EQ(one("[region.r]\nmass_damping = 2\n"), "scene.toml:2:1: region \"r\": brakes rigid motion too; `damping` does not");
  EXPECT_EQ(one("[material.m]\nE = 2e11\n"), "scene.toml:1:11: material \"m\": nothing uses it");
  EXPECT_EQ(one("[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 3]\n").substr(0, 62),
            "scene.toml:5:1: body \"b\": no body has these moments: 3 is more");
}

}  // namespace
}  // namespace hilo::test::scene_mistakes_test
