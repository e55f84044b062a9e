// SPDX-License-Identifier: GPL-3.0-or-later
#include "../model/block.hpp"
#include "succeeded.hpp"
#include "tool_case.hpp"

namespace hilo::test::tag_test {
namespace {

using test::block;

/// Four cubes in a row; neighbours share four of 20 nodes.
Mesh row() {
  return block(4, 1, 1, {"hull", "wheel_1", "wheel_2", "barrel"}, [](int i) { return i; });
}

class Tag : public ToolCase {
 protected:
  void SetUp() override { write_mesh(place / "mesh.h5", row(), {"hilo-import row.msh"}); }
};

TEST_F(Tag, TableCountsThreeUnknownsPerFreeNodeAndSixPerBody) {
  const auto ran = succeeded(place.run("hilo-tag mesh.h5 --rigid hull wheel_1 --nonlinear wheel_2 barrel -o tags.h5"));
  EXPECT_EQ(ran.err, "");
  // 20 nodes; hull and wheel_1 share nodes, so one body; wheel_2 has 4 free nodes, barrel 4 more.
  EXPECT_EQ(ran.out,
            "region   cells  nodes  fidelity   body  before  after\n"
            "hull         1      8  rigid         1      24      6\n"
            "wheel_1      1      8  rigid         1      12      0\n"
            "wheel_2      1      8  nonlinear     -      12     12\n"
            "barrel       1      8  nonlinear     -      12     12\n"
            "\n"
            "unknowns: 60 if all were nonlinear, 30 as tagged (50.0 %); 1 rigid body\n");
  const MeshFile f = read_mesh_file(place / "tags.h5");
  EXPECT_EQ(f.fidelity, (std::vector<Fidelity>{Fidelity::rigid, Fidelity::rigid, Fidelity::nonlinear, Fidelity::nonlinear}));
  EXPECT_EQ(f.provenance, (std::vector<std::string>{"hilo-import row.msh",
                                                    "hilo-tag mesh.h5 --rigid hull wheel_1 --nonlinear wheel_2 barrel -o tags.h5"}));
}

TEST_F(Tag, FileAndOptionsSayTheSame) {
  place.write("tags.toml", "rigid = [\"wheel_*\", {box = [[1, 1, 1], [0, 0, 0]]}]\nnonlinear = [{set = \"barrel\"}]\n");
  const auto file = place.run("hilo-tag mesh.h5 tags.toml -o a.h5 --json");
  const auto options = place.run("hilo-tag mesh.h5 --rigid 'wheel_*' box:0,0,0,1,1,1 --nonlinear set:barrel -o a.h5 --json");
  EXPECT_EQ(file.exit, 0) << file.err;
  EXPECT_EQ(options.exit, 0) << options.err;
  EXPECT_EQ(file.out, options.out);
  EXPECT_NE(file.out.find("\"unknowns\": {\"before\": 60, \"after\": 18}"), std::string::npos) << file.out;
}

TEST_F(Tag, RestMakesAllButTheNamedRegionsRigid) {
  EXPECT_EQ(place.run("hilo-tag mesh.h5 --nonlinear barrel --rest rigid").exit, 0);
  using enum Fidelity;
  EXPECT_EQ(read_mesh_file(place / "tags.h5").fidelity, (std::vector{rigid, rigid, rigid, nonlinear}));
}

TEST_F(Tag, UntaggedRegionsAreNonlinearAndThatIsSaid) {
  const auto ran = place.run("hilo-tag mesh.h5 --rigid hull");
  EXPECT_EQ(ran.err, "hilo-tag: 3 of 4 regions not tagged, so nonlinear: wheel_1, wheel_2, barrel\n");
  EXPECT_EQ(place.run("hilo-tag mesh.h5 --rigid hull --quiet").err, "");
}

// Two cubes apart that a third region may join.
TEST_F(Tag, AFlexibleRegionInPiecesThatNothingHoldsTogetherIsTold) {
  write_mesh(place / "apart.h5", block(3, 1, 1, {"pads", "bridge"}, [](int i) { return i % 2; }), {"test"});
  const std::string told = "hilo-tag: warning: region \"pads\" is nonlinear and in 2 pieces that share no node: each moves by itself";
  EXPECT_EQ(place.run("hilo-tag apart.h5 --rigid bridge --nonlinear pads").err, "") << "the bridge joins them";
  Mesh without = block(3, 1, 1, {"pads", "bridge"}, [](int i) { return i % 2; });
  Mesh pads;
  pads.X = without.X, pads.node_id = without.node_id, pads.region_name = {"pads"}, pads.region_data.resize(1);
  for (const int c : {0, 2}) pads.add_cell(Shape::hex8, without.cell(c), 0, c);
  write_mesh(place / "apart.h5", pads, {"test"});
  EXPECT_NE(place.run("hilo-tag apart.h5 --nonlinear pads").err.find(told), std::string::npos);
  EXPECT_EQ(place.run("hilo-tag apart.h5 --nonlinear pads --quiet").err, "");
  EXPECT_EQ(place.run("hilo-tag apart.h5 --rigid pads").err, "") << "rigid, they are one body";
}

TEST_F(Tag, SameTagsGiveSameBytes) {
  place.run("hilo-tag mesh.h5 --rigid hull && mv tags.h5 first.h5");
  EXPECT_EQ(place.run("hilo-tag mesh.h5 --rigid hull && cmp tags.h5 first.h5").exit, 0);
}

TEST_F(Tag, DryRunWritesNothing) {
  EXPECT_EQ(place.run("hilo-tag mesh.h5 --rigid hull --dry-run").exit, 0);
  EXPECT_EQ(place.files(), std::set<std::string>{"mesh.h5"});
}

TEST_F(Tag, TaggingAnewKeepsTheMeshAndReplacesTheTags) {
  place.run("hilo-tag mesh.h5 --rest rigid -o one.h5; hilo-tag one.h5 --rest nonlinear -o two.h5; rm one.h5");
  EXPECT_EQ(read_mesh_file(place / "two.h5").fidelity, std::vector<Fidelity>(4, Fidelity::nonlinear));
}

TEST_F(Tag, WrongRulesAreNamedWithTheirPlace) {
  place.write("a.toml", "rigid = [\"hull\",\n  \"whele_1\"]\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:2:3: no region \"whele_1\" (did you mean \"wheel_1\"?)");
  place.write("a.toml", "rigid = [\"hull\"]\nnonlinear = [\"hul*\"]\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:2:14: region \"hull\" is tagged twice: nonlinear here, rigid at a.toml:1:10");
  place.write("a.toml", "rigd = [\"hull\"]\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:1:1: unknown key \"rigd\" (did you mean \"rigid\"?)");
  place.write("a.toml", "rest = \"stiff\"\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:1:8: unknown fidelity \"stiff\" (rigid, linear or nonlinear)");
  place.write("a.toml", "rigid = [{box = [[0, 0], [1, 1, 1]]}]\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:1:18: a corner of a box is three numbers (box = [[x, y, z], [x, y, z]])");
  place.write("a.toml", "rigid = [3]\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:1:10: wanted a name, {box = ...} or {set = ...}, not a number");
  EXPECT_EQ(place.run("hilo-tag mesh.h5 --rigid hull hull 'h*' --dry-run").exit, 0) << "the same word twice says the same";
  expect_refused("hilo-tag mesh.h5 --rigid box:-1,-1,-1,1,1,nan", 1, "--rigid box:-1,-1,-1,1,1,nan: wanted box:x,y,z,x,y,z");
  place.write("a.toml", "rigid = [{box = [[0, 0, 0], [1, inf, 1]]}]\n");
  expect_refused("hilo-tag mesh.h5 a.toml", 2, "a.toml:1:33: a corner of a box is three finite numbers");
  expect_refused("hilo-tag mesh.h5 --rigid set:hul", 2, "--rigid set:hul: no region or set \"hul\" in the mesh (did you mean \"hull\"?)");
  expect_refused("hilo-tag mesh.h5 --rigid box:0,0,0,.5,1,1", 2,
                 "--rigid box:0,0,0,.5,1,1: no region lies wholly inside the box [0, 0, 0] to [0.5, 1, 1]");
}

TEST_F(Tag, WrongFilesAndOptionsHaveTheirExitCodes) {
  expect_refused("hilo-tag", 1, "mesh is required (see hilo-tag --help)");
  expect_refused("hilo-tag mesh.h5 --rigdi hull", 1, "unknown option --rigdi (did you mean \"--rigid\"?)");
  expect_refused("hilo-tag mesh.h5 --rigid box:1,2", 1, "--rigid box:1,2: wanted box:x,y,z,x,y,z");
  expect_refused("hilo-tag mesh.h5 -o mesh.h5", 1, "mesh.h5: would overwrite the file it reads (give another -o)");
  expect_refused("hilo-tag none.h5", 2, "none.h5: no such file");
  expect_refused("hilo-tag mesh.h5 none.toml", 2, "none.toml: no such file");
  expect_refused("hilo-tag mesh.h5 --rest rigid -o nowhere/tags.h5", 4, "nowhere/tags.h5: cannot write: No such file or directory");
  place.run("head -c 3000 mesh.h5 > cut.h5");
  expect_refused("hilo-tag cut.h5", 2, "cut.h5: truncated file");
}

TEST_F(Tag, HelpEndsWithAnExampleThatRuns) {
  const auto help = place.run("hilo-tag --help").out;
  const auto at = help.rfind("Example:\n");
  ASSERT_NE(at, std::string::npos);
  write_mesh(place / "mesh.h5", row(), {});
  succeeded(place.run(help.substr(at + 9)));
}

TEST_F(Tag, CompletionAndManPageKnowEveryOption) {
  const auto completion =
      place.run("eval \"$(hilo-tag --completion)\"; COMP_WORDS=(hilo-tag --ri); COMP_CWORD=1; _hilo_tag; echo ${COMPREPLY[@]}");
  EXPECT_EQ(completion.out, "--rigid\n");
  const auto man = place.run("hilo-tag --man").out;
  EXPECT_EQ(man.find(".TH HILO-TAG 1"), 0u);
  for (const std::string option : {"rigid", "nonlinear", "linear", "rest", "json", "output"})
    EXPECT_NE(man.find("\\-\\-" + option), std::string::npos) << option;
}

}  // namespace
}  // namespace hilo::test::tag_test
