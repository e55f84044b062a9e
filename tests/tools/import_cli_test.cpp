// SPDX-License-Identifier: GPL-3.0-or-later
// The command itself: options, tables, exit codes, and a damaged CAD file.
#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_cli_test {
namespace {

class ImportCommand : public test::Import {
 protected:
  void SetUp() override {
    place.write("bar.inp", test::text_of(deck("loads.inp")));
    place.write("loads_mesh.inp", test::text_of(deck("loads_mesh.inp")));
  }
};

TEST_F(ImportCommand, TheTableNamesRegionsAndSetsWithFigures) {
  imported("bar.inp", "--units mm-t-s --quiet");
  EXPECT_EQ(out, "");
  for (size_t at = 0; at < err.size(); at = err.find('\n', at) + 1) EXPECT_EQ(err.find("hilo-import: not read: ", at), at) << err;
  imported("bar.inp", "--units mm-t-s");
  EXPECT_EQ(out,
            "region  cells  volume [m^3]  x from [m]    to  y from    to  z from    to  quality min   mean  shapes\n"
            "bar         4         4e-06           0  0.04       0  0.01       0  0.01        1.000  1.000  4 hex8\n"
            "1 regions, 4 cells, 20 nodes, volume 4e-06 m^3 (quality: scaled Jacobian, 1 for a regular cell)\n"
            "\n"
            "set         of      count\n"
            "last        cells       1\n"
            "last_P2     facets      1\n"
            "pressure_1  facets      1\n"
            "ends        nodes       8\n"
            "force_1     nodes       2\n"
            "left        nodes       4\n"
            "right       nodes       4\n");
}

TEST_F(ImportCommand, JsonHoldsTheSameFigures) {
  imported("bar.inp", "--units mm-t-s --json");
  for (const char* part :
       {"\"mesh\": \"out.h5\"", "\"nodes\": 20", "\"cells\": 4", "{\"name\": \"bar\", \"cells\": 4, \"shapes\": {\"hex8\": 4}",
        "{\"name\": \"left\", \"kind\": \"nodes\", \"count\": 4}", "{\"what\": \"*TEMPERATURE\", \"count\": 1, "})
    EXPECT_NE(out.find(part), std::string::npos) << part << '\n' << out;
  place.write("said.json", out);
  EXPECT_EQ(place.run("/usr/bin/python3 -m json.tool said.json > /dev/null").exit, 0) << out;
}

TEST_F(ImportCommand, TheSceneFindsItsMeshFromItsOwnFolder) {
  std::filesystem::create_directories(place.path() / "scenes");
  std::filesystem::create_directories(place.path() / "meshes");
  succeeded(place.run("hilo-import bar.inp -o meshes/bar.h5 --units mm-t-s --scene-out scenes/bar.toml"));
  const Scene s = Scene::load(place / "scenes/bar.toml");
  EXPECT_EQ(s.table("scene").text("mesh"), "../meshes/bar.h5");
  const Mesh m = read_mesh_file(place / "meshes/bar.h5").mesh;
  for (const char* section : {"motion", "load"})
    for (const auto& e : s.entries(section)) EXPECT_FALSE(m.nodes_of(e.text("on"), e.where("on")).empty());
  EXPECT_NE(test::text_of(place / "scenes/bar.toml").find(m.deck_scene), std::string::npos) << "the mesh carries the same lines";
}

TEST_F(ImportCommand, TheMeshRemembersTheCommandLine) {
  imported("bar.inp", "--units mm-t-s");
  const auto lines = read_mesh_file(place / "out.h5").provenance;
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("hilo-import bar.inp -o out.h5 --units mm-t-s"), std::string::npos) << lines[0];
}

TEST_F(ImportCommand, TheSameInputGivesTheSameBytes) {
  ASSERT_EQ(place.run("for f in a b; do mkdir $f; cd $f; hilo-import ../bar.inp -o mesh.h5; cd ..; done").exit, 0);
  EXPECT_EQ(test::text_of(place / "a/mesh.h5"), test::text_of(place / "b/mesh.h5"));
}

TEST_F(ImportCommand, WrongCommandLinesAreUsageErrors) {
  refused("bar.inp -o a.h5 --unit mm-t-s", 1, "unknown option --unit (did you mean \"--units\"?)");
  refused("bar.inp -o a.h5 --units mm-t", 1, "--units: unknown unit system \"mm-t\" (did you mean \"mm-t-s\"?)");
  refused("bar.inp -o a.h5 --scale 0", 1, "--scale must be positive (see hilo-import --help)");
  refused("bar.inp -o a.h5 --order 3", 1, "--order is 1 or 2 (see hilo-import --help)");
  refused("bar.inp -o a.h5 --define SIZE", 1, "--define SIZE: expected NAME=NUMBER (see hilo-import --help)");
  refused("bar.inp -o bar.inp", 1, "bar.inp: would overwrite the file it reads (give another -o)");
  refused("bar.inp -o a.h5 --scene-out a.h5", 1, "--scene-out and --output name the same file (see hilo-import --help)");
}

TEST_F(ImportCommand, AMeshThatCannotBeWrittenIsAResourceErrorAndLeavesNothing) {
  const auto before = place.files();
  const auto ran = place.run("hilo-import bar.inp -o absent/a.h5");
  EXPECT_EQ(ran.exit, 4) << ran.err;
  EXPECT_EQ(ran.err.rfind("hilo-import: absent/a.h5", 0), 0u) << ran.err;
  EXPECT_EQ(ran.out, "");
  const auto scene = place.run("hilo-import bar.inp -o a.h5 --scene-out absent/a.toml");
  EXPECT_EQ(scene.exit, 4) << scene.err;
  EXPECT_EQ(place.files(), before) << "no mesh without its scene";
}

TEST_F(ImportCommand, ADamagedStepFileIsBadInputEvenWhereTheReaderCrashes) {
  place.write("box.geo", "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\nSave \"box.step\";\n");
  ASSERT_EQ(place.run("hilo-import box.geo --trust -o box.h5").exit, 0);
  std::string step = test::text_of(place / "box.step");
  ASSERT_GT(step.size(), 1000u) << "the script writes the geometry";
  for (size_t at = 0; (at = step.find("DIRECTION(", at)) != std::string::npos;) step.replace(at, 10, "DIRECTIO(");
  place.write("box.step", step);
  const auto before = place.files();
  const auto ran = place.run("hilo-import box.step -o a.h5");
  EXPECT_EQ(ran.exit, 2) << ran.err;
  EXPECT_EQ(ran.err.rfind("hilo-import: box.step: ", 0), 0u) << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(place.files(), before);
}

TEST_F(ImportCommand, HelpEndsWithAnExample) {
  const auto ran = succeeded(place.run("hilo-import --help"));
  EXPECT_NE(ran.out.find("Example:\n  hilo-import "), std::string::npos);
}

}  // namespace
}  // namespace hilo::test::import_cli_test
