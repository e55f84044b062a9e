// SPDX-License-Identifier: GPL-3.0-or-later
// A scene is read whole, in SI units, with its defaults and what overrides say.
#include <fmt/format.h>

#include <iostream>
#include <sstream>

#include "scene_text.hpp"

namespace hilo::test::scene_test {
namespace {

using Override = SceneText;

TEST_F(SceneText, IsReadWithItsKindsNamesPlacesAndDefaults) {
  const Scene s = load("title = \"gun\"\ngravity = [0, 0, -9.81]\n" + hinge + "[time]\nend = 1\nstep = 1e-2\n");
  ASSERT_EQ(s.entries("joint").size(), 1u);
  const Entry& j = s.entries("joint")[0];
  EXPECT_EQ(j.kind, "revolute");
  EXPECT_EQ(j.name, "trunnion");
  EXPECT_EQ(j.text("a"), "turret");
  EXPECT_EQ(j.vector3("axis"), Vec3(0, 1, 0));
  EXPECT_FALSE(j.has("x"));
  EXPECT_EQ(without_folder(j.where("axis")), "scene.toml:10:1");
  EXPECT_EQ(without_folder(j.where("")), "scene.toml:4:1");
  EXPECT_EQ(j.label(), "joint \"trunnion\"");
  EXPECT_EQ(s.table("scene").vector3("gravity"), Vec3(0, 0, -9.81));
  EXPECT_EQ(s.table("time").number("step"), 1e-2);
  EXPECT_FALSE(s.table("time").given("integrator"));
  EXPECT_EQ(s.table("time").text("integrator"), "energy-momentum");
  EXPECT_EQ(s.table("solver").number("iterations"), 25) << "an absent section has its defaults";
  EXPECT_TRUE(s.entries("body").empty());
  EXPECT_TRUE(s.warnings.empty());
  EXPECT_EQ(s.folder, folder.string());
}

TEST_F(SceneText, KeepsEntriesInFileOrder) {
  const Scene s = load("[region.\"wheel_*\"]\ndamping = 1e-3\n[region.axle]\ndamping = 0\n[region.\"a*\"]\ndamping = 2e-3\n");
  std::vector<std::string> names;
  for (const auto& r : s.entries("region")) names.push_back(r.name);
  EXPECT_EQ(names, (std::vector<std::string>{"wheel_*", "axle", "a*"}));
}

TEST_F(SceneText, IsReadFromStandardInputForADash) {
  std::istringstream text("[time]\nendd = 1\n");
  auto* before = std::cin.rdbuf(text.rdbuf());
  std::string message;
  try {
    Scene::load("-");
  } catch (const Error& e) {
    message = e.what();
  }
  std::cin.rdbuf(before);
  EXPECT_EQ(message, "<stdin>:2:1: time: unknown key \"endd\" (did you mean \"end\"?)");
}

TEST_F(SceneText, FromMemoryIsTheSameAsFromAFile) {
  const std::string text = "units = \"mm-t-s\"\n" + hinge + pull;
  const std::string file = (folder / "scene.toml").string();
  EXPECT_EQ(Scene::parse(text, file).explain(), load(text).explain());
}

TEST_F(SceneText, IsConvertedToSIFromMillimetreTonneSecond) {
  const Scene s = load(R"(units = "mm-t-s"
gravity = [0, 0, -9810]
[material.steel]
E = 210e3
nu = 0.3
density = 7.85e-9
[region.hull]
material = "steel"
[[spring]]
kind = "axial"
name = "recoil"
b = "housing"
at_a = [0, 0, 0]
at_b = [100, 0, 0]
stiffness = 250
damping = 3
)");
  const Entry& m = s.entries("material")[0];
  EXPECT_NEAR(m.number("density"), 7850, 7850 * 1e-15);
  EXPECT_NEAR(m.number("E"), 210e9, 210e9 * 1e-15);
  EXPECT_NEAR(s.table("scene").vector3("gravity").z(), -9.81, 1e-14);
  const Entry& k = s.entries("spring")[0];
  EXPECT_NEAR(k.vector3("at_b").x(), 0.1, 1e-16);
  EXPECT_NEAR(k.number("stiffness"), 250e3, 1e-9) << "N/mm to N/m";
  EXPECT_NEAR(k.number("damping"), 3e3, 1e-11);
  EXPECT_EQ(s.table("time").number("rho"), 0.8) << "a default is not converted";
  EXPECT_TRUE(s.warnings.empty());
}

TEST_F(SceneText, IsConvertedToSIFromInchPoundSecond) {
  const Scene s =
      load("units = \"in-lbf-s\"\n[material.steel]\nE = 30e6\nnu = 0.3\ndensity = 7.345e-4\n[region.a]\nmaterial = \"steel\"\n");
  EXPECT_NEAR(s.entries("material")[0].number("E"), 206.8427e9, 1e5);    // 30e6 psi, 1 psi = 6894.757 Pa
  EXPECT_NEAR(s.entries("material")[0].number("density"), 7849.4, 0.5);  // 1 lbf s^2/in^4 = 1.068690e7 kg/m^3
}

// 500 "ms" were taken for 500 s.
TEST_F(SceneText, UnitsInTheHeaderOfALoadAreConvertedAndATableThatEndsEarlyIsTold) {
  const auto of = [&](const std::string& csv, const std::string& keys, const std::string& head = "") {
    put("load.csv", csv);
    return load(head + "[history.shot]\nfile = \"load.csv\"\n" + keys + "[time]\nend = 0.5\nstep = 1e-3\n" + pull + "history = \"shot\"\n");
  };
  const auto history = [](const Scene& s) { return s.entries("load")[0].history("history"); };
  EXPECT_DOUBLE_EQ(history(of("t [ms],f [N]\n0,0\n500,2\n", "")).t.back(), 0.5);
  EXPECT_DOUBLE_EQ(history(of("t,f\n0,0\n500,2\n", "", "units = \"mm-kg-ms\"\n")).t.back(), 0.5) << "the time of the system";
  EXPECT_DOUBLE_EQ(history(of("t [s],f [kN]\n0,0\n.5,2\n", "", "units = \"mm-kg-ms\"\n")).t.back(), 0.5) << "kg mm/ms^2 is kN";
  EXPECT_DOUBLE_EQ(history(of("t [s];f [kN]\n0;0\n.5;2\n", "scale = 1000\n")).value.back(), 2000);
  EXPECT_DOUBLE_EQ(history(of("t [ms],\"sensor.seat, \"\"left\"\".x [N]\"\n0,\"0\"\n500,2\n", "")).t.back(), 0.5)
      << "quotes as series writes them";
  for (const char* csv : {"F [N],t [ms]\n0,0\n2,500\n", "value,time (s)\n0,0\n2,0.5\n", "x,t\n0,0\n2,.5\n"}) {
    const History h = history(of(csv, ""));
    EXPECT_DOUBLE_EQ(h.t.back(), 0.5) << csv;
    EXPECT_DOUBLE_EQ(h.value.back(), 2) << csv;
  }
  for (const char* unit : {"Pa", "kg", "m/s", "s"})  // of a force
    EXPECT_THROW(of(fmt::format("t,x [{}]\n0,0\n.5,2\n", unit), ""), Error) << unit;
  EXPECT_THROW(load("[time]\nend = 0.5\nstep = 1e-3\n" + pull + "history = {file = \"load.csv\"}\n"), Error) << "in its own table";
  EXPECT_NO_THROW(of("t,x [1]\n0,0\n.5,2\n", ""));
  const auto ends = [&](const std::string& csv) {
    const Scene s = of(csv, "");
    return std::count_if(s.warnings.begin(), s.warnings.end(), [](const std::string& w) { return w.find("the table ends at") != w.npos; });
  };
  EXPECT_EQ(ends("t [ms],f\n0,0\n200,2\n"), 1);
  EXPECT_EQ(ends("t [ms],f\n0,0\n500,2\n"), 0);
  EXPECT_EQ(ends("t [ms],f\n0,0\n100,2\n200,0\n"), 0) << "no load is left";
}

TEST_F(SceneText, TakesHistoriesByNameAsTableAsNumberAndFromCsv) {
  put("load.csv", "# measured\nt,F\n0,0\n\n10,2\r\n");
  const Scene s = load("units = \"mm-kg-ms\"\n[history.shot]\nfile = \"load.csv\"\nscale = 3\n" + pull + "history = \"shot\"\n" + R"(
[[load]]
kind = "torque"
name = "twist"
on = "tip"
torque = [1, 0, 0]
history = {t = [0, 10, 10], value = [0, 1, 5], interpolation = "smooth"}
[[load]]
kind = "torque"
name = "half"
on = "tip"
torque = [1, 0, 0]
history = 0.5
)" + "[[load]]\nkind = \"torque\"\nname = \"whole\"\non = \"tip\"\ntorque = [1, 0, 0]\n");
  const auto loads = s.entries("load");
  EXPECT_EQ(loads[0].history("history").t, (std::vector<double>{0, 10e-3})) << "times are in the scene's units";
  EXPECT_EQ(loads[0].history("history").value, (std::vector<double>{0, 6}));
  EXPECT_EQ(loads[1].history("history").ramp, Ramp::smooth);
  const auto breaks = loads[1].history("history").breaks();
  ASSERT_FALSE(breaks.empty());
  EXPECT_EQ(breaks.back().t, 10e-3);
  EXPECT_EQ(breaks.back().order, 0);
  EXPECT_EQ(loads[2].history("history")(7), 0.5);
  EXPECT_EQ(loads[3].history("history")(7), 1.0);
  EXPECT_FALSE(loads[3].given("history"));
}

TEST_F(SceneText, ExplainsEveryValueInForce) {
  const std::string lines = without_folder(load("units = \"mm-t-s\"\n" + hinge).explain());
  EXPECT_NE(lines.find("joint.trunnion.at"), lines.npos);
  EXPECT_NE(lines.find("[0, 0, 0.001] [m]"), lines.npos) << lines;
  EXPECT_NE(lines.find("# given, scene.toml:8:1"), lines.npos) << lines;
  EXPECT_NE(lines.find("solver.iterations"), lines.npos);
  EXPECT_NE(lines.find("# default"), lines.npos);
  EXPECT_EQ(lines.find("joint.trunnion.x "), lines.npos) << "an absent key without default is not in force";
}

TEST_F(Override, ReplacesAddsAndCreates) {
  const Scene s = load(hinge + pull + "[material.steel]\nE = 1e9\n[region.\"wheel_*\"]\nmaterial = \"steel\"\n",
                       {"joint.trunnion.axis=[1, 0, 0]", "time.step=1e-3", "time.start=as given", "material.steel.E = 2e9",
                        "gravity=[0,0,-1]", "region.wheel_*.damping=1e-4", "load.pull.per_node=true", "units=mm-t-s"});
  EXPECT_EQ(s.entries("joint")[0].vector3("axis"), Vec3(1, 0, 0));
  EXPECT_EQ(s.table("time").number("step"), 1e-3);
  EXPECT_EQ(s.table("time").text("start"), "as given");
  EXPECT_NEAR(s.entries("material")[0].number("E"), 2e15, 1) << "in the units of the scene";
  EXPECT_NEAR(s.table("scene").vector3("gravity").z(), -1e-3, 1e-18);
  EXPECT_EQ(s.entries("region")[0].number("damping"), 1e-4);
  EXPECT_TRUE(s.entries("load")[0].boolean("per_node"));
  EXPECT_EQ(s.entries("joint")[0].where("axis"), "--set joint.trunnion.axis=[1, 0, 0]");
}

TEST_F(Override, TakesNumbersAsPeopleTypeThem) {
  const std::pair<const char*, double> typed[] = {{".001", 0.001}, {"1.", 1},        {"+2", 2},    {"1E3", 1000},
                                                  {"+.5", 0.5},    {"2.e-3", 0.002}, {"3.5", 3.5}, {"1e-3", 0.001}};
  for (const auto& [text, value] : typed)
    EXPECT_EQ(load("", {std::string("time.step=") + text}).table("time").number("step"), value) << text;
  EXPECT_EQ(load(hinge, {"joint.trunnion.axis=[-.5, 1., +2.]"}).entries("joint")[0].vector3("axis"), Vec3(-0.5, 1, 2));
  EXPECT_EQ(load("", {"scene.title=of 2. and .5"}).table("scene").text("title"), "of 2. and .5") << "a text stays as it is";
  EXPECT_EQ(load("", {"scene.title='.5'"}).table("scene").text("title"), ".5");
  EXPECT_EQ(load("", {"scene.title=K\xF6rper"}).table("scene").text("title"), "K\xC3\xB6rper") << "from a terminal in Latin-1";
}

TEST_F(Override, LeavesATextThatGivesTheSameScene) {
  const std::string text = hinge + pull + "[region.b]\ndamping = 0.1\n[region.\"*\"]\ndamping = 0.2\n[region.\"a.c\"]\ndamping = 0.3\n";
  const Scene once = load(text, {"joint.trunnion.at=[0.1, 1e-7, 3]", "region.\"a.c\".mass=7"});
  const Scene again = load(once.text);
  const auto values = [](const Scene& s) {  // without the places
    std::string lines = s.explain(), kept;
    for (std::istringstream in(lines); std::getline(in, lines);) kept += lines.substr(0, lines.find('#')) + "\n";
    return kept;
  };
  EXPECT_EQ(values(again), values(once));
  EXPECT_EQ(again.entries("region")[2].name, "a.c") << "the last match wins, so order matters";
  EXPECT_EQ(load(text).text, text) << "without overrides the text is the file";
}

TEST_F(Override, LeavesATextThatReadsAgainHoweverTablesAreWritten) {
  const Scene s = load("region.arm = {damping = 1e-3}\nregion.block = {damping = 2e-3}\nmaterial.steel = {E = 2e11, nu = 0.3}\n",
                       {"gravity=[0, 0, -9]"});
  const Scene again = load(s.text);
  ASSERT_EQ(again.entries("region").size(), 2u);
  EXPECT_EQ(again.entries("region")[1].name, "block");
  EXPECT_EQ(again.entries("region")[1].number("damping"), 2e-3);
  EXPECT_EQ(again.entries("material")[0].number("E"), 2e11);
  EXPECT_EQ(again.table("scene").vector3("gravity"), Vec3(0, 0, -9));
}

TEST_F(Override, OfSomethingThatIsNotThereNamesWhatIs) {
  EXPECT_EQ(refusal(hinge, {"joint.trunion.at=[0, 0, 0]"}),
            "--set joint.trunion.at=[0, 0, 0]: no joint \"trunion\" (did you mean \"trunnion\"?)");
  EXPECT_EQ(refusal(hinge, {"joint.elevator.at=[0, 0, 0]"}),
            "--set joint.elevator.at=[0, 0, 0]: no joint \"elevator\" (there are: trunnion)");
  EXPECT_EQ(refusal(hinge, {"joint.trunnion.axes=[0, 0, 1]"}),
            "--set joint.trunnion.axes=[0, 0, 1]: joint \"trunnion\": unknown key \"axes\" (did you mean \"axis\"? \"axes\" is a key of "
            "[[body]])");
  EXPECT_EQ(refusal(hinge, {"jint.trunnion.at=1"}), "--set jint.trunnion.at=1: no section \"jint\" (did you mean \"joint\"?)");
  EXPECT_EQ(refusal(hinge, {"material.steel.E=1"}), "--set material.steel.E=1: no material \"steel\" (the scene has no material)");
  EXPECT_EQ(refusal("[material.steel]\nE = 1e9\n", {"material.steel.nu=0.5"}),
            "--set material.steel.nu=0.5: material \"steel\": nu = 0.5 is not in (-1, 0.5)");
}

TEST_F(Override, ThatCannotBeReadIsAUsageError) {
  for (const char* option : {"time.step", "time..step=1", "=1", "gravity=[0, 0"}) {
    try {
      load("", {option});
      ADD_FAILURE() << option << " was accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.exit, Exit::usage) << e.what();
      EXPECT_EQ(e.where, std::string("--set ") + option);
    }
  }
}

// Truth: of the load all but `at` was asked for; nobody asked for the other one, or for the table of time.
TEST_F(SceneText, TellsWhichKeysNothingAskedFor) {
  const Scene s = load(
      "[[load]]\nkind = \"force\"\nname = \"f\"\non = \"wheel\"\nforce = [0, 0, 1]\nat = [0, 0, 0]\n"
      "[[load]]\nkind = \"force\"\nname = \"g\"\non = \"wheel\"\nforce = [0, 0, 1]\n[time]\nend = 1\nstep = 1e-2\n");
  const Entry copy = s.entries("load")[0];
  EXPECT_EQ(copy.text("on"), "wheel");
  EXPECT_EQ(copy.vector3("force"), Vec3(0, 0, 1));
  EXPECT_TRUE(copy.has("at")) << "this asks for no value";
  const std::vector<std::string> unread = s.unread();
  ASSERT_EQ(unread.size(), 1u);
  EXPECT_EQ(without_folder(unread[0]), "scene.toml:6:1: load \"f\": at has no effect here");
}

}  // namespace
}  // namespace hilo::test::scene_test
