// SPDX-License-Identifier: GPL-3.0-or-later
// Bad files and command lines: every tool says in one line what is wrong, ends with the documented code, and leaves nothing behind.
#include "faults.hpp"

using namespace hilo::test;

namespace {
constexpr int usage = 1, input = 2, resources = 4;
/// Writing fails after so many KiB, as on a full disk; the signal that would kill the writer is ignored.
std::string full_disk(int size) { return "trap '' XFSZ; ulimit -f " + std::to_string(size) + "; "; }
}  // namespace

TEST_F(Faults, TheModelTheyAreMadeFromIsSound) {
  make_tags();
  const auto shown = work.run("hilo-show --check two.h5 tags.h5");
  EXPECT_EQ(shown.exit, 0) << shown.err;
}

TEST_F(Faults, AMissingFileIsNamed) {
  refused("hilo-import absent.inp -o mesh.h5", input, "absent.inp: no such file");
  refused("hilo-tag absent.h5 -o tags.h5", input, "absent.h5: no such file");
  refused("hilo-part absent.h5 -n 2 -o parts.h5", input, "absent.h5: no such file");
  refused("hilo-show absent.h5", input, "absent.h5: no such file");
  make_mesh();
  refused("hilo-tag two.h5 absent.toml -o tags.h5", input, "absent.toml: no such file");
}

TEST_F(Faults, AFolderIsNotAFile) {
  std::filesystem::create_directory(folder / "sub.h5");
  std::filesystem::create_directory(folder / "sub.inp");
  refused("hilo-import sub.inp -o mesh.h5", input, "sub.inp: a folder, not a file");
  refused("hilo-tag sub.h5 -o tags.h5", input, "sub.h5: is a folder, not a file");
  refused("hilo-show sub.h5", input, "sub.h5: is a folder, not a file");
}

TEST_F(Faults, AFileOfTheWrongTypeIsNamed) {
  make_tags();
  put("text.h5", "not at all\n");
  put("text.msh", "not at all\n");
  put("text.vtu", "not at all\n");
  refused("hilo-import scene.toml -o mesh.h5", input, "scene.toml: no reader for \".toml\" files...");
  refused("hilo-import text.msh -o mesh.h5", input,
          "text.msh:1: not a mesh of gmsh: it does not begin with $MeshFormat (a script is read from a file named .geo)");
  refused("hilo-import text.vtu -o mesh.h5", input, "text.vtu:1: not a VTK file: no \"# vtk DataFile Version\"");
  refused("hilo-tag text.h5 -o out.h5", input, "text.h5: not an HDF5 file");
  refused("hilo-tag two.inp -o out.h5", input, "two.inp: not an HDF5 file");
  refused("hilo-part text.h5 -n 2 -o out.h5", input, "text.h5: not an HDF5 file");
  refused("hilo-show text.h5", input, "text.h5: not an HDF5 file");
}

TEST_F(Faults, ATruncatedFileIsNamed) {
  make_tags();
  const std::string mesh = bytes("two.h5");
  for (const size_t part : {size_t{100}, mesh.size() / 2, mesh.size() - 1}) {
    put("cut.h5", mesh.substr(0, part));
    refused("hilo-tag cut.h5 --rigid hull mast -o out.h5", input, "cut.h5: truncated file");
    refused("hilo-part cut.h5 -n 2 -o out.h5", input, "cut.h5: truncated file");
  }
  put("empty.h5", "");
  refused("hilo-tag empty.h5 --rigid hull mast -o out.h5", input, "empty.h5: empty file");
  put("cut.inp", deck.substr(0, deck.find("2, 5, 6, 7, 8") + 12));
  refused("hilo-import cut.inp -o mesh.h5", input, "cut.inp:17:1: element 2 has 3 of its 8 nodes");
  put("two.h5", mesh.substr(0, mesh.size() / 2));  // the mesh behind tags.h5
  refused("hilo-part tags.h5 -n 2 -o out.h5", input, "two.h5: truncated file");
}

TEST_F(Faults, AMeshThatDoesNotHoldTogetherIsRefused) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = deck;
    text.replace(text.find(from), from.size(), to);
    put("bad.inp", text);
  };
  with("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 5, 6, 7, 8, 1, 2, 3, 4");
  refused("hilo-import bad.inp -o mesh.h5", input, "bad.inp: 1 of 2 cells are inverted (scaled Jacobian <= 0 at a corner): 1 (...)");
  with("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7, 99");
  refused("hilo-import bad.inp -o mesh.h5", input, "bad.inp:15: element 1 names node 99, which does not exist");
  with("12, 0, 1, 2\n", "12, 0, 1, 2\n12, 0, 1, 3\n");
  refused("hilo-import bad.inp -o mesh.h5", input, "bad.inp:14:1: node 12 is given twice, at two places (number each node once)");
  with("TYPE=C3D8, ELSET=hull", "TYPE=C3D9, ELSET=hull");
  refused("hilo-import bad.inp -o mesh.h5", input, "bad.inp:14:16: element type \"C3D9\": this solid is not read (supported: ...)");
}

TEST_F(Faults, AMistypedOptionIsCorrected) {
  make_mesh();
  refused("hilo-import two.inp --outptu mesh.h5", usage, "unknown option --outptu (did you mean \"--output\"?)");
  refused("hilo-tag two.h5 --rigd hull -o tags.h5", usage, "unknown option --rigd (did you mean \"--rigid\"?)");
  refused("hilo-import two.inp", usage, "--output is required (see hilo-import --help)");
  refused("hilo-import two.inp -o mesh.h5 --units mm-t", usage, "--units: unknown unit system \"mm-t\" (did you mean \"mm-t-s\"?)");
}

TEST_F(Faults, AnOutputThatWouldOverwriteItsInputIsRefused) {
  make_mesh();
  refused("hilo-import two.inp -o two.inp", usage, "two.inp: would overwrite the file it reads (give another -o)");
  refused("hilo-tag two.h5 --rigid hull mast -o two.h5", usage, "two.h5: would overwrite the file it reads (give another -o)");
}

TEST_F(Faults, TagsThatFitNoRegionOrContradictAreRefused) {
  make_mesh();
  refused("hilo-tag two.h5 --rigid hul -o tags.h5", input, "--rigid hul: no region \"hul\" (did you mean \"hull\"?)");
  refused("hilo-tag two.h5 --rigid hull --nonlinear hull -o tags.h5", input,
          "--nonlinear hull: region \"hull\" is tagged twice: nonlinear here, rigid at --rigid hull");
  refused("hilo-tag two.h5 --rest soft -o tags.h5", input, "--rest: unknown fidelity \"soft\" (rigid, linear or nonlinear)");
  put("tags.toml", "rigid = [\"hull\"]\nnonlinear = [\"mast\", \"h*\"]\n");
  refused("hilo-tag two.h5 tags.toml -o tags.h5", input,
          "tags.toml:2:22: region \"hull\" is tagged twice: nonlinear here, rigid at tags.toml:1:10");
  put("tags.toml", "rigd = [\"hull\"]\n");
  refused("hilo-tag two.h5 tags.toml -o tags.h5", input, "tags.toml:1:1: unknown key \"rigd\" (did you mean \"rigid\"?)");
  put("tags.toml", "rigid = [\"hull\"\n");
  refused("hilo-tag two.h5 tags.toml -o tags.h5", input, "tags.toml:1:17: Error while parsing array: encountered end-of-file");
}

TEST_F(Faults, APartitionThatCannotBeIsRefused) {
  make_tags();
  refused("hilo-part tags.h5 -n 0 -o parts.h5", usage, "--parts: Value 0 not in range 1 to 1048576 (see hilo-part --help)");
  refused("hilo-part tags.h5 -n 3 -o parts.h5", input, "tags.h5: 3 parts of 2 cells (at most 2)");
}

TEST_F(Faults, AFullDiskLeavesNothingBehind) {
  make_tags();
  for (const int size : {1, 3}) {
    refused("hilo-import two.inp -o mesh.h5", resources, "mesh.h5: cannot write: ...", 1, full_disk(size));
    refused("hilo-tag two.h5 --rigid hull mast -o out.h5", resources, "out.h5: cannot write: ...", 1, full_disk(size));
    refused("hilo-part tags.h5 -n 1 -o parts.h5", resources, "parts.h5: cannot write: ...", 1, full_disk(size));
  }
}

TEST_F(Faults, AFullDiskLeavesTheOlderFileAsItWas) {
  make_tags();
  refused("hilo-tag two.h5 --rigid hull mast -o tags.h5", resources, "tags.h5: cannot write: ...", 1, full_disk(2));
  EXPECT_EQ(work.run("hilo-show --check tags.h5").exit, 0);
}

TEST_F(Faults, APlaceThatCannotBeWrittenIsNamed) {
  make_tags();  // a path through a file cannot be written, not even by root
  refused("hilo-import two.inp -o two.inp/mesh.h5", resources, "two.inp/mesh.h5: cannot write: Not a directory");
  refused("hilo-import two.inp -o absent/mesh.h5", resources, "absent/mesh.h5: cannot write: No such file or directory");
  refused("hilo-tag two.h5 --rigid hull mast -o two.inp/tags.h5", resources, "two.inp/tags.h5: cannot write: Not a directory");
  refused("hilo-part tags.h5 -n 1 -o two.inp/parts.h5", resources, "two.inp/parts.h5: cannot write: Not a directory");
}

TEST_F(Faults, ALinkInPlaceOfTheOutputStaysAndWhatItNamesIsWritten) {
  make_tags();
  std::filesystem::create_directory(folder / "d");
  const auto written = [&](const std::string& name, const std::string& command, bool there) {
    std::filesystem::create_symlink("d/" + name, folder / name);
    if (there) put("d/" + name, "former");
    ASSERT_EQ(work.run(command).exit, 0) << command;
    EXPECT_TRUE(std::filesystem::is_symlink(folder / name)) << command;
    EXPECT_GT(std::filesystem::file_size(folder / "d" / name), 20u) << command;
  };
  for (const bool there : {true, false}) {
    written("linked.h5", "hilo-tag two.h5 --rigid hull mast -o linked.h5", there);
    EXPECT_EQ(work.run("hilo-show --check linked.h5").exit, 0);
    EXPECT_EQ(work.run("hilo-show --check d/linked.h5").exit, 0) << "its link to the mesh is seen from where it lies";
    written("run.h5", "hilo-solve scene.toml linked.h5 --quiet -o run.h5", there);
    EXPECT_EQ(work.run("hilo-show --check run.h5").exit, 0);
    EXPECT_EQ(work.run("hilo-show --check d/run.h5").exit, 0);
    written("all.csv", "hilo-post series run.h5 energy -o all.csv", there);
    for (const char* name : {"linked.h5", "run.h5", "all.csv"})
      std::filesystem::remove(folder / name), std::filesystem::remove(folder / "d" / name);
  }
  std::filesystem::create_symlink("pipe.csv", folder / "to_pipe.csv");
  ASSERT_EQ(::mkfifo((folder / "pipe.csv").c_str(), 0600), 0);
  refused("hilo-tag two.h5 --rigid hull mast -o to_pipe.csv", resources, "to_pipe.csv: cannot write: ...");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "to_pipe.csv"));
}

TEST_F(Faults, ADeviceOrPipeInPlaceOfTheOutputIsNotReplaced) {
  make_mesh();
  ASSERT_EQ(::mkfifo((folder / "pipe.h5").c_str(), 0600), 0);
  refused("hilo-import two.inp -o pipe.h5", resources, "pipe.h5: cannot write: ...");
  refused("hilo-tag two.h5 --rigid hull mast -o pipe.h5", resources, "pipe.h5: cannot write: ...");
}
