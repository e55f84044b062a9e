// SPDX-License-Identifier: GPL-3.0-or-later
// [[quantity]]: values that closed forms know, through hilo-solve and hilo-post; and what a scene may not ask.
#include <cmath>
#include <map>
#include <sstream>

#include "sample_run.hpp"
#include "scene_parts.hpp"
#include "succeeded.hpp"

namespace hilo::test::quantity_test {
namespace {

const std::string bodies = body("held", 2, Vec3::Zero(), {1, 1, 1}) + body("flies", 1, {3, 4, 0}, {1, 1, 1}) +
                           joint("fixed", "root", "ground", "held", Vec3::Zero()) +
                           force("push", "held", {0, 0, 100}, "history = {t = [0, 0.05, 0.1], value = [0, 1, 0]}") +
                           initial("flies", "velocity = [0.6, 0.8, 0]") + probe("here", "held") + probe("there", "flies") + R"([[sensor]]
name = "seat"
on = "held"
)";
const std::string times = "[time]\nend = 0.1\nstep = 5e-4\n";

std::string quantity(const std::string& name, const std::string& rest) { return "[[quantity]]\nname = \"" + name + "\"\n" + rest + "\n"; }

/// The value of each quantity in the JSON of hilo-post or run.json.
std::map<std::string, double> values(const std::string& json) {
  std::map<std::string, double> out;
  std::istringstream lines(json);
  for (std::string line; std::getline(lines, line);) {
    const auto name = line.find("\"quantity\": \""), value = line.find("\"value\": ");
    if (name == line.npos || value == line.npos) continue;
    const std::string number = line.substr(value + 9, line.find_first_of(",}", value) - value - 9);
    out[line.substr(name + 13, line.find('"', name + 13) - name - 13)] = number == "null" ? NAN : std::stod(number);
  }
  return out;
}

// Truth: a mass on a spring, cos(10 t) m/s, over two periods of 12 steps each: 1/sqrt(2) m/s.
TEST(Quantity, rms_of_a_vibration_in_few_rows) {
  const Workplace place;
  place.write("scene.toml",
              body("b", 2, Vec3::Zero(), {1, 1, 1}) + joint("prismatic", "j", "ground", "b", Vec3::Zero(), "axis = [1, 0, 0]\n") +
                  spring("axial", "k", "ground", "b", "at_a = [-1, 0, 0]\nat_b = [0, 0, 0]\nstiffness = 200") +
                  initial("b", "velocity = [1, 0, 0]") + probe("p", "b") + quantity("v", "kind = \"rms\"\nformula = \"v = probe.p.vx\"") +
                  "[time]\nend = 1.2566370614359172\nstep = 0.05235987755982988\nintegrator = \"gauss\"\n");
  succeeded(place.run("hilo-solve scene.toml -o run.h5"));
  EXPECT_NEAR(values(succeeded(place.run("hilo-post quantity run.h5 --json")).out)["v"], std::sqrt(0.5), 1e-3);
}

TEST(Quantity, meets_closed_forms_and_run_json_has_it) {
  const Workplace place;
  place.write("scene.toml",
              bodies + times + quantity("peak", "kind = \"peak\"\njoint = \"root\"\ntolerance = \"2%\"") +
                  quantity("up", "kind = \"peak\"\njoint = \"root\"\ncomponent = \"Fz\"\ntolerance = \"0.5 kN\"") +
                  quantity("then", "kind = \"at\"\nt = 0.025\njoint = \"root\"") + quantity("mean", "kind = \"rms\"\njoint = \"root\"") +
                  quantity("apart", "kind = \"peak\"\nbetween = [\"here\", \"there\"]\ntolerance = \"1 mm\"") +
                  quantity("half", "kind = \"peak\"\nformula = \"half [kN] = joint.root.Fz/2e3\"\ntolerance = \"1 N\"") +
                  quantity("speed", "kind = \"peak\"\nformula = \"speed [m/s] = d(probe.there.x)\"") +
                  quantity("felt", "kind = \"peak\"\nsensor = \"seat\"\ncfc = 60") + quantity("pitch", "kind = \"frequency\"\nmode = 1"));
  const Ran solved = succeeded(place.run("hilo-solve scene.toml -o run.h5"));
  EXPECT_NE(solved.out.find("joint root: force"), std::string::npos) << solved.out;  // every run prints them
  EXPECT_NE(solved.err.find("quantity \"pitch\": the run is no analysis of modes"), std::string::npos) << solved.err;
  const Ran ran = succeeded(place.run("hilo-post quantity run.h5 --json"));
  auto v = values(ran.out);
  ASSERT_EQ(v.size(), 9u) << ran.out;
  EXPECT_NEAR(v["peak"], 100, 0.51);  // of the mean over a step of 1/100 of the ramp
  EXPECT_NEAR(std::abs(v["up"]), 100, 0.51);
  EXPECT_NEAR(v["then"], 50, 0.51);
  EXPECT_NEAR(v["mean"], 100 / std::sqrt(3), 0.01 * 57.7);
  EXPECT_NEAR(v["apart"], 0.1, 1e-9);  // away along the line between them, 1 m/s
  EXPECT_NEAR(std::abs(v["half"]), 0.05, 0.0003);
  EXPECT_NEAR(v["speed"], 0.6, 1e-9) << "a rate has values at the ends too";
  EXPECT_NEAR(v["felt"], 0, 1e-6);
  EXPECT_TRUE(std::isnan(v["pitch"]));
  EXPECT_NE(ran.out.find("\"allowed\": 500"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("\"allowed\": 0.001"), std::string::npos) << ran.out;
  const auto in_json = values(text_of(place / "run.json"));
  ASSERT_EQ(in_json.size(), v.size());
  for (const char* name : {"peak", "up", "then", "mean", "apart", "half"}) EXPECT_EQ(in_json.at(name), v[name]) << name;
  expect_end(place.run("hilo-post quantity run.h5 paek"), 2, "did you mean \"peak\"");
}

TEST(Quantity, frequency_is_that_of_a_mass_on_a_spring) {
  const Workplace place;
  place.write("scene.toml",
              "[[body]]\nname = \"m\"\nmass = 2\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[[joint]]\nkind = \"prismatic\"\nname = "
              "\"way\"\na = \"ground\"\nb = \"m\"\nat = [0, 0, 0]\naxis = [1, 0, 0]\n[[spring]]\nkind = \"axial\"\nname = \"k\"\na "
              "= \"ground\"\nb = \"m\"\nat_a = [-1, 0, 0]\nat_b = [0, 0, 0]\nstiffness = 5000\n[time]\nanalysis = \"modes\"\n" +
                  quantity("first", "kind = \"frequency\"\nmode = 1\ntolerance = \"1 Hz\""));
  ASSERT_EQ(place.run("hilo-solve scene.toml -o run.h5").exit, 0);
  EXPECT_NEAR(values(place.run("hilo-post quantity run.h5 --json").out)["first"], std::sqrt(5000. / 2) / (2 * M_PI), 1e-6);
}

TEST(Quantity, what_cannot_be_asked_is_told_with_its_place) {
  const Workplace place;
  const std::pair<const char*, const char*> wrong[] = {
      {"kind = \"peak\"\njoint = \"rot\"", "no joint \"rot\" (did you mean \"root\"?)"},
      {"kind = \"peak\"\nsensor = \"saet\"", "no sensor \"saet\" (did you mean \"seat\"?)"},
      {"kind = \"peak\"\nbetween = [\"here\", \"their\"]", "no probe \"their\""},
      {"kind = \"peak\"\nbetween = [\"here\"]", "1 probes"},
      {"kind = \"peak\"\njoint = \"root\"\nsensor = \"seat\"", "one of joint, sensor"},
      {"kind = \"peak\"", "of what?"},
      {"kind = \"peak\"\njoint = \"root\"\ncomponent = \"Fw\"", "no component \"Fw\""},
      {"kind = \"peak\"\njoint = \"root\"\ncfc = 60", "only what sensors felt is filtered"},
      {"kind = \"peak\"\njoint = \"root\"\ntolerance = \"2 mm\"", "tolerance \"2 mm\" is in mm"},
      {"kind = \"peak\"\njoint = \"root\"\ntolerance = \"2\"", "has no unit"},
      {"kind = \"peak\"\njoint = \"root\"\ntolerance = \"-2%\"", "is no positive number"},
      {"kind = \"peak\"\njoint = \"root\"\ntolerance = \"nan%\"", "is no positive number"},
      {"kind = \"at\"\njoint = \"root\"\nt = 2", "2 s is after the end"},
      {"kind = \"peek\"\njoint = \"root\"", "did you mean \"peak\""},
      {"kind = \"peak\"\nformula = \"joint.root.Fz\"", "no = in it"}};
  for (const auto& [rest, message] : wrong) {
    place.write("scene.toml", bodies + times + quantity("q", rest));
    const Ran ran = place.run("hilo-solve --dry-run scene.toml");
    EXPECT_EQ(ran.exit, 2) << rest << ran.err;
    EXPECT_NE(ran.err.find(message), std::string::npos) << rest << "\n" << ran.err;
    EXPECT_NE(ran.err.find("scene.toml:"), std::string::npos) << ran.err;
  }
}

TEST(Quantity, stress_is_the_peak_of_hilo_post_and_of_rigid_regions_there_is_none) {
  const Workplace place;
  sample::write_run(place.path(), sample::machine(), 5);
  place.write("ask.toml", quantity("barrel", "kind = \"peak\"\nstress = \"barrel\"\ntolerance = \"10 MPa\"") +
                              quantity("hull", "kind = \"peak\"\nstress = \"hull\"") +
                              quantity("none", "kind = \"peak\"\nstress = \"barel\""));
  const Ran ran = succeeded(place.run("hilo-post quantity run.h5 --scene ask.toml --json"));
  auto v = values(ran.out);
  EXPECT_NEAR(v["barrel"], 200e6, 1e3);  // the sample's stress at the front at the end
  EXPECT_TRUE(std::isnan(v["hull"]));
  EXPECT_NE(ran.out.find("\"allowed\": 10000000"), std::string::npos) << ran.out;
  EXPECT_NE(ran.err.find("\"hull\" is rigid in this run"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("did you mean \"barrel\""), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::quantity_test
