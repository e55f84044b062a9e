// SPDX-License-Identifier: GPL-3.0-or-later
// Bad scenes: hilo-solve says in one line what is wrong and where, on any number of ranks, and leaves nothing behind.
#include <algorithm>

#include "faults.hpp"

using namespace hilo::test;

namespace {

constexpr int input = 2, resources = 4;

/// A mistake made in the scene that runs: `from` replaced by `to`.
struct Mistake {
  const char* name;
  std::string from, to, message;
};

const std::vector<Mistake> mistakes = {
    {"a syntax error", "end = 2e-3", "end = 2e-3e", "scene.toml:3:..."},
    {"an unknown key at the top", "gravity", "gravty", "scene.toml:1:1: unknown key \"gravty\" (did you mean \"gravity\"?)"},
    {"an unknown key", "step =", "stepp =", "scene.toml:4:1: time: unknown key \"stepp\" (did you mean \"step\"?)"},
    {"an unknown section", "[[joint]]", "[[joints]]", "scene.toml:13:3: unknown section \"joints\" (did you mean \"joint\"?)"},
    {"an unknown kind", "\"revolute\"", "\"revolut\"",
     "scene.toml:14:1: joint \"hinge\": unknown kind \"revolut\" (did you mean \"revolute\"?)"},
    {"a wrong type", "E = 2e11", "E = \"200 GPa\"",
     "scene.toml:6:5: material \"steel\": E is text, not a number (in Pa of the system m-kg-s, without the unit)"},
    {"a negative density", "density = 7850", "density = -7850", "scene.toml:8:11: material \"steel\": density = -7850 is not > 0"},
    {"Poisson's ratio one half", "nu = 0.3", "nu = 0.5", "scene.toml:7:6: material \"steel\": nu = 0.5 is not in (-1, 0.5)"},
    {"an axis of length zero", "axis = [0, 1, 0]", "axis = [0, 0, 0]",
     "scene.toml:19:1: joint \"hinge\": axis has length zero (a direction, as in [0, 0, 1])"},
    {"a joint to a region that does not exist", "b = \"hull\"", "b = \"hul\"", "scene.toml:17:1: ...\"hul\" (did you mean \"hull\"?)"},
    {"a load on a set that does not exist", "on = \"top\"", "on = \"tip\"", "scene.toml:23:1: ...\"tip\" (did you mean \"top\"?)"},
    {"a region that does not exist", "[region.mast]", "[region.masts]", "scene.toml:11:9: ...\"masts\" (did you mean \"mast\"?)"},
    {"a material that does not exist", "material = \"steel\"", "material = \"steal\"",
     "scene.toml:10:1: region \"hull\": no material \"steal\" (did you mean \"steel\"?)"},
    {"a history that does not exist", "history = \"pulse\"", "history = \"puls\"",
     "scene.toml:25:1: load \"push\": no history \"puls\" (did you mean \"pulse\"?)"},
    {"a load table that does not exist", "\"pulse.csv\"", "\"plus.csv\"",
     "scene.toml:27:1: no file plus.csv (paths in a scene are relative to the scene's folder)"},
    {"a name given twice", "[history.pulse]",
     "[[load]]\nkind = \"torque\"\nname = \"push\"\non = \"hull\"\ntorque = [1, 0, 0]\n[history.pulse]",
     "scene.toml:28:1: load \"push\" is given twice (first at scene.toml:22:1)"},
    {"no end of the run", "end = 2e-3\n", "", "scene.toml:2:...end..."},
};

class BadScene : public Faults {
 protected:
  void SetUp() override {
    Faults::SetUp();
    make_tags();
  }
  void put_scene(const std::string& from, const std::string& to) const {
    std::string text = scene;
    ASSERT_NE(text.find(from), text.npos) << from;
    put("scene.toml", text.replace(text.find(from), from.size(), to));
  }
};

}  // namespace

TEST_F(BadScene, IsMadeFromOneThatRuns) {
  for (const int ranks : {1, 2}) {
    const std::string command = "timeout 60 hilo-solve scene.toml tags.h5 --quiet -o run" + std::to_string(ranks) + ".h5";
    const auto o = ranks == 1 ? work.run(command) : mpirun(ranks, command, folder);
    EXPECT_EQ(o.exit, 0) << o.err;
    EXPECT_EQ(o.err, "");
  }
}

TEST_F(BadScene, IsRefusedAtThePlaceOfTheMistake) {
  for (const auto& m : mistakes) {
    SCOPED_TRACE(m.name);
    put_scene(m.from, m.to);
    refused("hilo-solve scene.toml tags.h5 --quiet", input, m.message);
  }
}

TEST_F(BadScene, IsRefusedAlikeOnTwoRanks) {
  for (const auto& m : mistakes) {
    SCOPED_TRACE(m.name);
    put_scene(m.from, m.to);
    refused("hilo-solve scene.toml tags.h5 --quiet", input, m.message, 2);
  }
}

TEST_F(BadScene, WithALoadTableOutOfOrderIsRefusedAtTheLineOfTheTable) {
  put("pulse.csv", "t,factor\n0,0\n0.1,1\n0.05,0\n");
  for (const int ranks : {1, 2})
    refused("hilo-solve scene.toml tags.h5", input,
            "pulse.csv:4:1: time 0.05 comes after 0.1 (times must rise; two equal ones make a jump)", ranks);
}

TEST_F(BadScene, WithoutMassIsRefused) {
  put("scene.toml", "[time]\nend = 1\nstep = 0.1\n");
  for (const int ranks : {1, 2}) refused("hilo-solve scene.toml", input, "scene.toml: the scene has no mass...", ranks);
}

TEST_F(BadScene, WithAMeshThatIsMissingTruncatedOrNoMeshIsRefused) {
  const std::string mesh = bytes("two.h5");
  put("cut.h5", mesh.substr(0, mesh.size() / 2));
  for (const int ranks : {1, 2}) {
    refused("hilo-solve scene.toml absent.h5", input, "absent.h5: no such file", ranks);
    refused("hilo-solve scene.toml cut.h5", input, "cut.h5: truncated file", ranks);
    refused("hilo-solve scene.toml two.inp", input, "two.inp: not an HDF5 file", ranks);
    refused("hilo-solve absent.toml tags.h5", input, "absent.toml: no such file", ranks);
    refused("hilo-solve scene.toml", input, "scene.toml...", ranks);  // names a joint's region, but no mesh
  }
}

TEST_F(BadScene, OverriddenFromTheCommandLineIsRefusedAtTheOption) {
  for (const int ranks : {1, 2}) {
    refused("hilo-solve scene.toml tags.h5 --set material.steel.nu=0.5", input,
            "--set material.steel.nu=0.5: material \"steel\": nu = 0.5 is not in (-1, 0.5)", ranks);
    refused("hilo-solve scene.toml tags.h5 --set joint.hing.at=[0,0,0]", input,
            "--set joint.hing.at=[0,0,0]: no joint \"hing\" (did you mean \"hinge\"?)", ranks);
    refused("hilo-solve scene.toml tags.h5 --set time.step", 1, "--set time.step: no \"=\" (write SECTION.NAME.KEY=VALUE)", ranks);
  }
}

TEST_F(BadScene, FromStandardInputIsRefusedAtItsLine) {
  put_scene("nu = 0.3", "nu = 0.5");
  for (const int ranks : {1, 2})
    refused("hilo-solve - tags.h5 < scene.toml", input, "<stdin>:7:6: material \"steel\": nu = 0.5 is not in (-1, 0.5)", ranks);
}

TEST_F(BadScene, MadeGoodRunsFromStandardInputOnTwoRanksToo) {
  const auto o = mpirun(2, "timeout 60 hilo-solve - tags.h5 --quiet -o run.h5 < scene.toml", folder);
  EXPECT_EQ(o.exit, 0) << o.err;
}

// Rank 1 is killed by the number it wrote.
TEST_F(BadScene, MadeGoodEndsInSecondsWithAMessageWhereARankIsKilledOnTheWay) {
  const auto o = mpirun(2,
                        "bash -c 'echo $$ > rank$OMPI_COMM_WORLD_RANK; exec timeout 60 hilo-solve scene.toml tags.h5 -o run.h5 --set "
                        "time.end=1000' > progress 2>&1 &\n"
                        "for k in $(seq 300); do grep -q ^solver progress && break; sleep 0.1; done; sleep 1\n"
                        "grep -q ^solver progress || exit 90\n"
                        "pkill -9 -P $(cat rank1)\n"
                        "start=$SECONDS; wait $!; code=$?\n"
                        "echo $((SECONDS - start)); cat progress; exit $((code > 0 ? 91 : 0))",
                        folder);
  EXPECT_EQ(o.exit, 91) << o.out << o.err;
  EXPECT_LE(std::atoi(o.out.c_str()), 5);
  std::string on_a_line = o.out;  // Open MPI 5 breaks it
  std::ranges::replace(on_a_line, '\n', ' ');
  EXPECT_NE(on_a_line.find("exited on signal 9"), o.out.npos) << o.out;
}

TEST_F(BadScene, WithResultsThatCannotBeWrittenLeavesNothingBehind) {
  for (const int ranks : {1, 2}) {
    refused("hilo-solve scene.toml tags.h5 --quiet -o two.inp/run.h5", resources, "two.inp/run.h5: ...", ranks);
    refused("hilo-solve scene.toml tags.h5 --quiet -o absent/run.h5", resources, "absent/run.h5: no such folder (mkdir -p absent)", ranks);
  }
}

// A former result stays until the new one has rows; from then on the new one is sound up to its last commit.
TEST_F(BadScene, OnADiskThatFillsKeepsWhatIsWritten) {
  const std::string command = "hilo-solve scene.toml tags.h5 --quiet --set time.end=0.03 -o ";
  ASSERT_EQ(work.run(command + "run.h5").exit, 0);
  const std::string former = bytes("run.h5"), former_json = bytes("run.json");
  const auto size = static_cast<int>(former.size() / 1024);
  int kept = 0, grown = 0;
  const auto look = [&](const Ran& o, const std::string& file, const std::string& what) {
    SCOPED_TRACE(what);
    EXPECT_EQ(o.exit, resources) << o.err;
    int said = 0;
    for (const auto& text : lines(o.err)) said += text.starts_with("hilo-solve: " + file);
    EXPECT_GE(said, 1) << o.err;  // on a busy machine a second rank says the same before the job is down
    if (bytes(file) == former) {
      ++kept;
      EXPECT_EQ(bytes(file.substr(0, file.size() - 2) + "json"), former_json);
    } else {
      ++grown;
      const auto checked = work.run("hilo-show --check " + file);
      EXPECT_EQ(checked.exit, 0) << checked.err;
      const bool whole = checked.out.find(": ok") != checked.out.npos;  // the sidecar alone had no room
      EXPECT_TRUE(whole || checked.out.find("incomplete, sound up to") != checked.out.npos) << checked.out;
      EXPECT_FALSE(std::filesystem::exists(folder / (file.substr(0, file.size() - 2) + "json"))) << "it told of the former results";
    }
    for (const auto& [name, content] : snapshot()) EXPECT_TRUE(!name.ends_with(".new") && !name.ends_with(".journal")) << name;
    put(file, former), put(file.substr(0, file.size() - 2) + "json", former_json);
  };
  for (int limit = 1; limit < size; limit += std::max(1, size / 12))
    look(work.run("trap '' XFSZ; ulimit -f " + std::to_string(limit) + "; " + command + "run.h5"), "run.h5", std::to_string(limit) + " kB");
  EXPECT_GT(kept, 0);
  EXPECT_GT(grown, 0);

  // A real small disk, for several ranks too: only root may mount one.
  std::filesystem::create_directory(folder / "disk");
  for (const int more : {8, size / 8, size / 4}) {
    for (const int ranks : {1, 2}) {
      if (work.run("mount -t tmpfs -o size=" + std::to_string((size + more) / 4 * 4) + "k tmpfs disk").exit != 0)
        GTEST_SKIP() << "cannot mount a small disk here";
      put("disk/run.h5", former), put("disk/run.json", former_json);
      const std::string line = "timeout 200 " + command + "disk/run.h5";
      look(ranks == 1 ? work.run(line) : mpirun(ranks, line, folder), "disk/run.h5",
           std::to_string(more) + " kB more, ranks " + std::to_string(ranks));
      ASSERT_EQ(work.run("umount -l disk").exit, 0);
    }
  }
}
