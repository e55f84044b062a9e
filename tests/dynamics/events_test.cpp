// SPDX-License-Identifier: GPL-3.0-or-later
// Every jump and kink of every history is an instant at which steps end.  The first test walks the schema, so that a key of type history
// that is added to it, and is not known here, fails.
#include <sstream>

#include "dynamics/error/step_control.hpp"
#include "model/local_mesh.hpp"
#include "verify/verify.hpp"

namespace hilo::test::events_test {
namespace {

constexpr double odd = 0.0153, end_of_run = 0.05, step = 0.01;

/// A block with a facet set and two bodies, the joint "axle" between them for what acts along one.
const std::string surroundings = R"(material.m = {E = 1e7, nu = 0.3, density = 1000}
region.block = {material = "m"}
body = [{name = "wheel", mass = 1, com = [0, 0, 2], inertia = [1, 1, 1]},
  {name = "other", mass = 1, com = [3, 0, 2], inertia = [1, 1, 1]}]
)";

std::string axle(const std::string& kind) {
  return "[[joint]]\nkind = \"" + kind + "\"\nname = \"axle\"\nb = \"wheel\"\nat = [0, 0, 2]\naxis = [0, 0, 1]\n";
}

const std::string whip =
    "[section.s]\nkind = \"matrix\"\nstiffness = [1, 1, 1]\nbending = [1, 1, 1]\nline_mass = 1\ninertia = [1, 1]\n"
    "[beam.whip]\npoints = [[5, 0, 0], [6, 0, 0]]\ncells = [1]\nsection = \"s\"\n";

const std::set<std::string_view> driving{"angle", "spin", "displacement", "velocity"};

/// The entry of a kind with what it must have; of the optional keys `also` alone.
std::string entry(const KindSchema& kind, std::string_view history_key, std::string_view also) {
  std::ostringstream out;
  out << "[[" << kind.section << "]]\n";
  if (!kind.kind.empty()) out << "kind = \"" << kind.kind << "\"\n";
  for (const Param& p : kind.params) {
    if (p.key == "kind" || (p.fallback != "!" && p.key != also && p.key != history_key)) continue;
    const bool facets = p.key == "on" && (kind.kind == "traction" || kind.kind == "pressure");
    const bool cells = p.key == "on" && (kind.kind == "acceleration" || kind.kind == "centrifugal");
    out << p.key << " = ";
    if (p.type == Type::history)
      out << (also == "angle" || also == "displacement" || kind.section == "motion"
                  ? "{t = [0, 0.0153, 1], value = [0, 0, 1]}\n"               // positions may have kinks
                  : "{t = [0, 0.0153, 0.0153, 1], value = [0, 0, 1, 1]}\n");  // all else may jump
    else if (p.key == "name")
      out << "\"entry\"\n";
    else if (p.key == "joint")
      out << "\"axle\"\n";
    else if (p.type == Type::text)
      out << (kind.kind == "line" ? "\"whip\"\n"
              : facets            ? "\"xmax\"\n"
              : cells             ? "\"block\"\n"
              : p.key == "b"      ? "\"other\"\n"
                                  : "\"wheel\"\n");
    else if (p.type == Type::vector3)
      out << "[0, 0, 1]\n";
    else if (p.type == Type::numbers)
      out << "[1]\n";
    else
      out << "1\n";
  }
  return out.str();
}

struct Found {
  std::vector<Event> all;
  bool at(double t, bool jump) const {
    return std::any_of(all.begin(), all.end(), [&](const Event& e) { return std::abs(e.t - t) < 1e-12 && e.jump == jump; });
  }
};

class HistoryEvents : public testing::Test {
 protected:
  HistoryEvents() {
    write_mesh(place / "mesh.h5", block_mesh({}), {"test"});
    local = read_local_mesh(place / "mesh.h5", Comm::world());
  }
  Found of(const std::string& text, double h = step) {
    const Scene scene = Scene::parse(text, "scene.toml");
    return {events(*build_system(scene, &local, Comm::world()), end_of_run, h)};
  }
  Workplace place;
  LocalMesh local;
};

TEST_F(HistoryEvents, FollowEveryHistoryOfTheSchema) {
  int tried = 0;
  for (const KindSchema& kind : scene_schema())
    for (const Param& key : kind.params) {
      if (key.type != Type::history) continue;
      std::vector<std::string_view> ways;
      for (const Param& p : kind.params)
        if (kind.section == "joint" && driving.contains(p.key)) ways.push_back(p.key);
      if (ways.empty()) ways.push_back("");
      for (const std::string_view way : ways) {
        const std::string drawn = surroundings + (kind.kind == "line" ? whip : "") +
                                  (kind.section == "motor" ? axle(kind.kind == "rotary" ? "revolute" : "prismatic") : "") +
                                  entry(kind, key.key, way);
        SCOPED_TRACE(drawn);
        EXPECT_TRUE(of(drawn).at(odd, true)) << kind.section << " " << kind.kind << " " << key.key << " " << way;
        ++tried;
      }
    }
  EXPECT_GE(tried, 18);
}

// Truth: forces follow the value of a load, the slope of a prescribed rate, the curvature of a prescribed position.
TEST_F(HistoryEvents, AreJumpsWhereForcesOrVelocitiesJumpAndKinksWhereTheirSlopesDo) {
  const std::string load = surroundings + "[[load]]\nkind = \"force\"\nname = \"f\"\non = \"wheel\"\nforce = [1, 0, 0]\nhistory = ";
  const std::string motion =
      surroundings + "[[motion]]\nkind = \"translation\"\nname = \"m\"\non = \"wheel\"\ndisplacement = [1, 0, 0]\nhistory = ";
  const std::string drive = surroundings + axle("revolute") + "spin = 1\nhistory = ";
  const std::string jump = "{t = [0, 0.0153, 0.0153, 1], value = [0, 0, 1, 1]}\n", kink = "{t = [0, 0.0153, 1], value = [0, 0, 1]}\n",
                    smooth = "{t = [0.0153, 1], value = [0, 1], interpolation = \"smooth\"}\n",
                    smoother = "{t = [0.0153, 1], value = [0, 1], interpolation = \"smoother\"}\n";
  EXPECT_TRUE(of(load + jump).at(odd, true));
  EXPECT_TRUE(of(load + kink).at(odd, false));
  EXPECT_TRUE(of(load + smooth).all.empty());
  EXPECT_TRUE(of(drive + jump).at(odd, true)) << "velocities jump";
  EXPECT_TRUE(of(drive + kink).at(odd, true)) << "accelerations jump";
  EXPECT_TRUE(of(drive + smooth).at(odd, false));
  EXPECT_TRUE(of(motion + kink).at(odd, true)) << "velocities jump";
  EXPECT_TRUE(of(motion + smooth).at(odd, true)) << "accelerations jump";
  EXPECT_TRUE(of(motion + smoother).all.empty());
}

TEST_F(HistoryEvents, LeaveOutTheKinksOfAMeasuredTableAndKeepItsBlows) {
  std::ostringstream table;
  for (int i = 0; i < 50; ++i) table << (i ? ", " : "") << i * 1.07e-3;
  std::ostringstream values;
  for (int i = 0; i < 50; ++i) values << (i ? ", " : "") << (i % 3) * 0.1;
  const std::string history = "{t = [" + table.str() + "], value = [" + values.str() + "]}\n";
  EXPECT_TRUE(
      of(surroundings + "[[load]]\nkind = \"force\"\nname = \"f\"\non = \"wheel\"\nforce = [1, 0, 0]\nhistory = " + history).all.empty());
  EXPECT_GE(
      of(surroundings + "[[motion]]\nkind = \"translation\"\nname = \"m\"\non = \"wheel\"\ndisplacement = [1, 0, 0]\nhistory = " + history)
          .all.size(),
      30u);
}

}  // namespace
}  // namespace hilo::test::events_test
