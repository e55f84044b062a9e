// SPDX-License-Identifier: GPL-3.0-or-later
// No command destroys what it was given, under whatever name; a run that is refused leaves the former result.
#include "faults.hpp"
#include "model/store.hpp"

using namespace hilo::test;
namespace fs = std::filesystem;

namespace {

constexpr int usage = 1, input = 2;

class Inputs : public Faults {
 protected:
  void SetUp() override {
    Faults::SetUp();
    make_tags();
    put("tags.toml", "rigid = [\"hull\"]\nnonlinear = [\"mast\"]\n");
    put("main.inp", "*INCLUDE, INPUT=two.inp\n");
    put("size.geo", "n = 1;\n");
    put("cube.geo",
        "SetFactory(\"OpenCASCADE\");\nInclude \"size.geo\";\nBox(1) = {0, 0, 0, n, n, n};\nPhysical Volume(\"cube\") = {1};\n");
    for (const char* command : {"hilo-part tags.h5 -n 1 -o parts.h5", "hilo-solve scene.toml parts.h5 --quiet -o run.h5"})
      ASSERT_EQ(work.run(command).exit, 0) << command;
  }
  /// `command`, its OUT replaced by every name of each of the files it reads, refuses and changes nothing.
  void spares(const std::string& command, const std::vector<std::string>& inputs, const std::string& ending = "") const {
    for (const auto& name : inputs) {
      const std::string soft = "soft" + (ending.empty() ? fs::path(name).extension().string() : ending), hard = "hard" + soft.substr(4);
      fs::create_symlink(name, folder / soft), fs::create_hard_link(folder / name, folder / hard);
      for (std::string out : {name, "./" + name, soft, hard}) {
        if (!ending.empty() && !out.ends_with(ending)) continue;
        std::string line = command;
        line.replace(line.find("OUT"), 3, out);
        refused(line, usage, out + ": would overwrite ...");
      }
      fs::remove(folder / soft), fs::remove(folder / hard);
    }
  }
};

}  // namespace

TEST_F(Inputs, OfImportAreNotReplaced) {
  spares("hilo-import --quiet main.inp -o OUT", {"main.inp", "two.inp"});
  spares("hilo-import --quiet main.inp -o mesh.h5 --scene-out OUT", {"main.inp", "two.inp"});
  spares("hilo-import --quiet cube.geo --size 1 -o OUT", {"cube.geo", "size.geo"});
}

TEST_F(Inputs, OfTagAndPartAreNotReplacedNorWhatTheyLinkTo) {
  spares("hilo-tag tags.h5 tags.toml -o OUT", {"tags.h5", "two.h5", "tags.toml"});
  spares("hilo-part tags.h5 scene.toml -n 1 -o OUT", {"tags.h5", "two.h5", "scene.toml", "pulse.csv"});
  spares("hilo-part tags.h5 scene.toml --table -n 2 -o OUT", {"tags.h5", "two.h5", "scene.toml", "pulse.csv"});
}

TEST_F(Inputs, OfSolveAreNotReplacedNorWhatTheyLinkTo) {
  spares("hilo-solve --quiet scene.toml parts.h5 -o OUT", {"parts.h5", "tags.h5", "two.h5", "scene.toml", "pulse.csv"}, ".h5");
  // what is written beside the results
  fs::rename(folder / "pulse.csv", folder / "other.json");
  refused("hilo-solve --quiet scene.toml parts.h5 --set 'history.pulse.file=\"other.json\"' -o other.h5", usage,
          "other.json: would overwrite ...");
  fs::rename(folder / "other.json", folder / "pulse.csv");
  fs::rename(folder / "scene.toml", folder / "other.xdmf");
  refused("hilo-solve --quiet other.xdmf parts.h5 -o other.h5", usage, "other.xdmf: would overwrite the file it reads (give another -o)");
}

TEST_F(Inputs, OfPostAreNotReplacedNorWhatTheyLinkTo) {
  spares("hilo-post series run.h5 energy -o OUT", {"run.h5", "two.h5"});
  spares("hilo-post series run.h5 energy --png OUT", {"run.h5"});
  spares("hilo-post export run.h5 -o OUT", {"run.h5", "two.h5"});
  ASSERT_EQ(work.run("hilo-post series run.h5 energy -o energy.csv").exit, 0);
  spares("hilo-post chart energy.csv -o OUT", {"energy.csv"});
  fs::copy(folder / "run.h5", folder / "run.png"), fs::copy(folder / "run.h5", folder / "run.mp4");
  spares("hilo-post render run.png --steps last --size 320x240 -o OUT", {"run.png"});
  spares("hilo-post mesh two.h5 --size 320x240 -o OUT", {"two.h5"});
  spares("hilo-post model scene.toml tags.h5 --size 320x240 -o OUT", {"scene.toml", "tags.h5"});
  spares("hilo-post movie run.mp4 --size 320x240 -o OUT", {"run.mp4"}, ".mp4");
}

TEST_F(Inputs, OfCommandsThatWriteElsewhereAreReadAsBefore) {
  for (const char* command : {"hilo-tag tags.h5 tags.toml -o tags-2.h5", "hilo-tag two.h5 tags.toml -o tags.h5",
                              "hilo-part tags.h5 scene.toml -n 1 -o parts.h5", "hilo-solve --quiet scene.toml parts.h5 -o run.h5"})
    EXPECT_EQ(work.run(command).exit, 0) << command;
}

TEST_F(Inputs, LinkedInACircleAreRefusedByName) {
  fs::copy(folder / "tags.h5", folder / "two.h5", fs::copy_options::overwrite_existing);  // its link now leads to itself
  const std::string hint = " (a file it was made from was replaced: make them again)";
  for (const char* command :
       {"hilo-show --check tags.h5", "hilo-show tags.h5", "hilo-part tags.h5 -n 1 -o out.h5", "hilo-solve scene.toml tags.h5 -o out.h5"})
    refused(command, input, "two.h5: its link /mesh leads in a circle, to two.h5" + hint);
  for (const auto& [one, other] : {std::pair("a.h5", "b.h5"), std::pair("b.h5", "a.h5")}) {
    auto store = hilo::Store::create(folder / one);
    store.set("/", "format", std::string("hilo tags"));
    store.set("/", "complete", std::int64_t{1});
    store.link("/mesh", folder / other, "/mesh");
    store.publish();
  }
  refused("hilo-show --check a.h5", input, "b.h5: its link /mesh leads in a circle, to a.h5" + hint);
}

TEST_F(Inputs, ARunThatIsRefusedBeforeItsFirstStepLeavesTheFormerResult) {
  refused("hilo-solve --quiet scene.toml parts.h5 --set time.stepp=1 -o run.h5", input,
          "--set time.stepp=1: ...unknown key \"stepp\" (did you mean \"step\"?)");
  put("scene.toml", scene + "[[joint]]\nkind = \"fixed\"\nname = \"weld\"\nb = \"hull\"\nat = [0, 0, 0]\n");
  refused("hilo-solve --quiet scene.toml parts.h5 --set joint.hinge.spin=1 -o run.h5", input,
          "scene.toml:13:1: joint \"hinge\" ...joint \"weld\" holds it still at t = 2e-06 s (...)");
  EXPECT_EQ(work.run("hilo-show --check run.h5").exit, 0);
}
