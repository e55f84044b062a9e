// SPDX-License-Identifier: GPL-3.0-or-later
#include "../model/block.hpp"
#include "model/scene.hpp"
#include "model/schema.hpp"
#include "model/store.hpp"
#include "succeeded.hpp"
#include "tool_case.hpp"

namespace hilo::test::show_test {
namespace {

using test::block;

class Show : public ToolCase {
 protected:
  void SetUp() override {
    Mesh m = block(4, 2, 1, {"hull", "barrel"}, [](int i) { return i == 3; });
    for (auto& x : m.X) x *= 0.5;
    m.region_data[0] = {7850, 2.1e11, 0.3};
    write_mesh(place / "mesh.h5", m, {"hilo-import bar.msh"});
    write_tags(place / "tags.h5", place / "mesh.h5", {Fidelity::rigid, Fidelity::nonlinear}, {"hilo-import bar.msh", "hilo-tag"});
    write_parts(place / "parts.h5", place / "tags.h5", 2, {0, 0, 0, 1, 0, 0, 0, 1}, {"hilo-import bar.msh", "hilo-tag", "hilo-part"});
  }
  /// A results file of three steps; `closed` sets complete = 1.
  void write_run(bool closed) {
    Store run = Store::create_growing(place / "run.h5");
    run.set("/", "format", "hilo run");
    run.set("/", "version", schema_version);
    run.set("/", "complete", std::int64_t{0});
    run.write_strings("/provenance", std::vector<std::string>{"hilo-solve scene.toml"});
    run.link("/mesh", place / "mesh.h5", "/mesh");
    run.write_strings("/body/name", std::vector<std::string>{"hull"});
    run.write<double>("/body/mass", std::vector<double>{12.5}, {1}, "kg");
    run.write<double>("/body/inertia", std::vector<double>{1, 2, 3.00000001}, {1, 3}, "kg m^2");
    run.write<double>("/body/points", std::vector<double>{0.5, 0.25, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 4, 3}, "m");
    run.write<std::int64_t>("/body/follower_node", std::vector<std::int64_t>{0, 1}, {2});
    run.write<std::int32_t>("/body/follower_body", std::vector<std::int32_t>{0, 0}, {2});
    run.start_rows<double>("/history/t", {}, "s");
    run.start_rows<double>("/history/joint/trunnion", {6}, "N, N m");
    for (int n = 0; n < 3; ++n) {
      run.append<double>("/history/t", std::vector<double>{0.5 * n});
      run.append<double>("/history/joint/trunnion", std::vector<double>{0, 0, n == 1 ? -700. : 1., 0, 0, 0});
    }
    run.write<double>("/field/000000/displacement", std::vector<double>(90, 0.), {30, 3}, "m");
    run.set("/field/000000", "t", 1.);
    if (closed) run.set("/", "complete", std::int64_t{1});
    run.flush();
  }
  /// The line of `text` that begins with `start`, blanks squeezed.
  static std::string line(const std::string& text, const std::string& start) {
    const auto at = ("\n" + text).find("\n" + start);
    if (at == std::string::npos) return "no line " + start + " in\n" + text;
    std::string out;
    for (const char c : text.substr(at, text.find('\n', at) - at))
      if (c != ' ' || out.empty() || out.back() != ' ') out += c;
    return out;
  }
};

TEST_F(Show, MeshShowsRegionsWithVolumeAndBoxAndSets) {
  const auto ran = succeeded(place.run("hilo-show mesh.h5"));
  EXPECT_EQ(line(ran.out, "hull "), "hull 6 0.75 7850 2.1e+11 0.3 [0, 0, 0] to [1.5, 1, 0.5]");
  EXPECT_EQ(line(ran.out, "barrel "), "barrel 2 0.25 - - - [1.5, 0, 0] to [2, 1, 0.5]");
  EXPECT_EQ(line(ran.out, "left "), "left nodes 6 - [0, 0, 0] to [0, 1, 0.5]");
  EXPECT_EQ(line(ran.out, "left face"), "left face facets 2 0.5 [0, 0, 0] to [0, 1, 0.5]");
  EXPECT_EQ(line(ran.out, "nodes "), "nodes 30");
  EXPECT_EQ(line(ran.out, "  hex8"), " hex8 8");
  EXPECT_EQ(line(ran.out, "hilo-import"), "hilo-import bar.msh");
}

TEST_F(Show, PartsShowWhatTheyLinkTo) {
  const auto ran = place.run("hilo-show parts.h5");
  EXPECT_EQ(line(ran.out, "mesh from"), "mesh from mesh.h5");
  EXPECT_EQ(line(ran.out, "tags from"), "tags from tags.h5");
  EXPECT_EQ(line(ran.out, "hull "), "hull rigid 6 0.75 7850 2.1e+11 0.3 [0, 0, 0] to [1.5, 1, 0.5]");
  EXPECT_NE(ran.out.find("part  cells  nonlinear\n   0      6          0\n   1      2          2\n"), std::string::npos) << ran.out;
}

TEST_F(Show, RunShowsBodiesFieldsAndTheLargestValueOfEachHistory) {
  write_run(true);
  const auto ran = succeeded(place.run("hilo-show run.h5"));
  EXPECT_EQ(line(ran.out, "complete"), "complete yes");
  expect_words(ran.out, "\nhull       12.5            1            2            3    0.5   0.25      0      2\n");
  EXPECT_NE(place.run("hilo-show --json run.h5").out.find("\"J3 [kg m^2]\": 3.00000001, \"x [m]\": 0.5"), std::string::npos);
  EXPECT_EQ(line(ran.out, "history ends"), "history ends at t [s] 1");
  EXPECT_EQ(line(ran.out, "joint trunnion"), "joint trunnion 3 6 700 N, N m");
  EXPECT_EQ(line(ran.out, "displacement"), "displacement 30 3 m");
  EXPECT_EQ(place.run("hilo-show --check run.h5").out, "run.h5: ok, 10 arrays\n");
}

TEST_F(Show, SceneShowsItsEntriesWithTheirPlaces) {
  place.write(
      "scene.toml",
      "[material.steel]\nE = 2e11\nnu = 0.3\ndensity = 7800\n[region.\"*\"]\nmaterial = \"steel\"\n"
      "[[joint]]\nkind = \"spherical\"\nname = \"pin\"\na = \"ground\"\nb = \"hull\"\nat = [0, 0, 0]\n[time]\nend = 1.0\nstep = 0.1\n");
  const auto ran = succeeded(place.run("hilo-show scene.toml"));
  EXPECT_EQ(line(ran.out, "joint "), "joint spherical pin ground - hull scene.toml:7:1");
  EXPECT_EQ(line(ran.out, "time.step"), "time.step [s] 0.1");
  EXPECT_EQ(place.run("hilo-show - < scene.toml").exit, 0);
  place.write("wrong.toml", "[tmie]\nend = 1\n");
  EXPECT_EQ(place.run("hilo-show wrong.toml").exit, 2);
}

TEST_F(Show, CheckPassesWholeFiles) {
  const auto ran = succeeded(place.run("hilo-show --check mesh.h5 tags.h5 parts.h5"));
  EXPECT_EQ(ran.out, "mesh.h5: ok, 16 arrays\ntags.h5: ok, 3 arrays\nparts.h5: ok, 2 arrays\n");
}

TEST_F(Show, CheckFindsEveryTruncation) {
  const auto size = std::filesystem::file_size(place / "mesh.h5");
  for (const auto kept : {size_t{1}, size_t{8}, size_t{100}, size_t{1000}, static_cast<size_t>(size / 2), static_cast<size_t>(size - 1)}) {
    const auto ran = place.run("head -c " + std::to_string(kept) + " mesh.h5 > cut.h5; hilo-show --check cut.h5");
    EXPECT_EQ(ran.exit, 2) << kept;
    EXPECT_EQ(ran.out, "") << kept;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
  }
}

TEST_F(Show, CheckFindsFilesThatAreIncompleteOrDoNotFit) {
  write_run(false);
  const auto on_its_way = succeeded(place.run("hilo-show --check run.h5"));
  EXPECT_TRUE(on_its_way.out.starts_with("run.h5: incomplete, sound up to t = ")) << on_its_way.out;
  EXPECT_EQ(place.run("hilo-show run.h5").exit, 0);  // it can be looked at all the same
  place.run("cp tags.h5 keep.h5; head -c 3000 tags.h5 > cut.h5; mv cut.h5 tags.h5");
  expect_refused("hilo-show --check parts.h5", 2, "tags.h5: truncated file");
  place.run("rm tags.h5");
  expect_refused("hilo-show --check parts.h5", 2, "parts.h5: tags is in tags.h5, which is missing");
  place.run("mv keep.h5 tags.h5");
  write_mesh(place / "mesh.h5", block(4, 2, 1, {"hull", "barrel"}, [](int i) { return i == 2; }), {});
  expect_refused("hilo-show --check tags.h5", 2, "tags.h5: mesh.h5 has changed since this file was made (make it again)");
}

TEST_F(Show, CheckOfSeveralFilesNamesEachWrongOne) {
  place.run("head -c 3000 mesh.h5 > a.h5; echo hello > b.h5");
  const auto ran = place.run("hilo-show --check a.h5 mesh.h5 b.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_EQ(ran.out, "mesh.h5: ok, 16 arrays\n");
  EXPECT_EQ(ran.err, "hilo-show: a.h5: truncated file\nhilo-show: b.h5: not an HDF5 file\n");
}

TEST_F(Show, JsonIsReadByPython) {
  write_run(true);
  const auto ran = place.run(
      "for f in mesh tags parts run; do hilo-show $f.h5 --json > $f.json || exit 9; done\n"
      "/usr/bin/python3 -c 'import json\n"
      "load = lambda name: json.load(open(name + \".json\"))\n"
      "for name in [\"mesh\", \"tags\", \"parts\", \"run\"]: assert load(name)[\"nodes\"] == 30\n"
      "assert load(\"mesh\")[\"regions\"][0][\"volume [m^3]\"] == 0.75\n"
      "assert load(\"mesh\")[\"regions\"][1][\"E [Pa]\"] is None\n"
      "assert load(\"run\")[\"histories\"][0] == {\"history\": \"joint trunnion\", \"rows\": 3, \"columns\": 6, \"largest\": 700, "
      "\"unit\": \"N, N m\"}'");
  EXPECT_EQ(ran.exit, 0) << ran.err;
}

TEST_F(Show, WrongRequestsHaveTheirExitCodes) {
  expect_refused("hilo-show", 1, "files are required (see hilo-show --help)");
  expect_refused("hilo-show --chek mesh.h5", 1, "unknown option --chek (did you mean \"--check\"?)");
  expect_refused("hilo-show none.h5", 2, "none.h5: no such file");
  expect_refused("hilo-show --check none.h5", 2, "none.h5: no such file");
  place.run("echo hello > text.h5");
  expect_refused("hilo-show text.h5", 2, "text.h5: not an HDF5 file");
}

TEST_F(Show, SchemaPageNamesEveryArrayAndEveryKey) {
  const auto page = place.run("hilo-show --schema").out;
  for (const auto& row : file_schema()) EXPECT_NE(page.find("| `" + std::string(row.path) + "` |"), std::string::npos) << row.path;
  for (const auto& kind : scene_schema()) {
    const auto at =
        page.find("\n### " + std::string(kind.section) + (kind.kind.empty() ? "\n" : " kind = \"" + std::string(kind.kind) + "\"\n"));
    ASSERT_NE(at, std::string::npos) << kind.section << " " << kind.kind;
    const auto section = page.substr(at, page.find("\n### ", at + 1) - at);
    for (const auto& p : kind.params)
      EXPECT_NE(section.find("| `" + std::string(p.key) + "` |"), std::string::npos) << kind.section << "." << p.key;
  }
}

TEST_F(Show, HelpEndsWithAnExampleThatRuns) {
  const auto help = place.run("hilo-show --help").out;
  ASSERT_NE(help.rfind("Example:\n"), std::string::npos);
  EXPECT_EQ(place.run(help.substr(help.rfind("Example:\n") + 9)).exit, 0);
}

}  // namespace
}  // namespace hilo::test::show_test
