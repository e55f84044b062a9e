// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-import --subcase all: a scene for each SUBCASE, one mesh with the sets of all; each is what --subcase N makes.
// Of temperatures that no subcase takes nothing is left out.
#include <fmt/format.h>

#include "import_case.hpp"

namespace hilo::test::import_bdf_subcases_test {
namespace {

/// A cube of 1 m with three load cases: pushed along x at grid 7, along z at two grids with another support, and pressed.
const std::string cases =
    "SOL 101\nCEND\nTITLE = cube\nSUBCASE 1\n LABEL = push\n SPC = 1\n LOAD = 2\nSUBCASE 4\n SUBTITLE = lift\n SPC = 5\n LOAD = 3\n"
    "SUBCASE 9\n SPC = 1\n LOAD = 6\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\n"
    "GRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,1.+9,,0.,1000.\n"
    "SPC1,1,123,1,2,3,4\nSPC1,5,123,1,4,5,8\nFORCE,2,7,,4.,1.,0.,0.\nFORCE,3,7,,5.,0.,0.,1.\nFORCE,3,6,,5.,0.,0.,1.\nPLOAD4,6,1,100.,,,,5,"
    "7\n"
    "FORCE,77,7,,4.,1.,0.,0.\nTEMP,6,7,4.\nENDDATA\n";

class ImportBdfSubcases : public test::Import {};

TEST_F(ImportBdfSubcases, EachRunsAsTheOneTakenAlone) {
  imported_deck("a.bdf", cases, "--subcase all --scene-out s.toml");
  EXPECT_FALSE(std::filesystem::exists(place / "s.toml"));
  for (const char* row : {"1        s_1.toml      1        1         0  ", "4        s_4.toml      1        1         0  ",
                          "9        s_9.toml      1        1         0  "})
    EXPECT_NE(out.find(row), std::string::npos) << out;
  expect_said("not read: loads of a set that no subcase uses (1, a.bdf:34)");  // set 77
  EXPECT_EQ(err.find("not read: SUBCASE"), std::string::npos) << err;
  EXPECT_EQ(err.find("not read: PLOAD"), std::string::npos) << err;
  const std::vector<double> forces[] = {{-4, 0, 0}, {0, 0, -10}, {0, 0, 100}};
  for (const auto& [number, i] : {std::pair{1, 0}, {4, 1}, {9, 2}}) {
    SCOPED_TRACE(number);
    const auto all = succeeded(place.run(fmt::format("hilo-solve --quiet --accept-left-out s_{}.toml -o all.h5", number)));
    const std::string motion = Store::open(place / "all.h5").list("/history/motion").at(0);
    const auto F = Store::open(place / "all.h5").read<double>("/history/motion/" + motion);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(F[F.size() - 6 + k], forces[i][k], 1e-5) << k;
    ASSERT_EQ(place.run(fmt::format("hilo-import --quiet a.bdf -o one.h5 --subcase {} --scene-out one.toml", number)).exit, 0);
    ASSERT_EQ(place.run("hilo-solve --quiet --accept-left-out one.toml -o one_run.h5").exit, 0);
    const auto field = [&](const char* file) {
      const Store s = Store::open(place / file);
      return s.read<double>("/field/" + s.list("/field").back() + "/displacement");
    };
    const auto a = field("all.h5"), b = field("one_run.h5");
    ASSERT_EQ(a.size(), b.size());
    for (size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-15);
  }
}

TEST_F(ImportBdfSubcases, MistakesAreNamed) {
  refused_deck("a.bdf", cases, "-o b.h5 --subcase each", 1, "--subcase each: a number, or all (see hilo-import --help)");
  refused("a.bdf -o b.h5 --subcase all --thicken", 1,
          "--subcase all beside --thicken: the pairs of nodes depend on the supports (--subcase N, one after the other)");
  std::string text = cases;
  text.replace(text.find("SUBCASE 9"), 9, "SUBCASE 4");
  refused_deck("a.bdf", text, "-o b.h5 --subcase all", 2,
               "a.bdf:12: SUBCASE 4 is given twice (number each once, or take the first by --subcase)");
  refused_deck("a.bdf", cases.substr(cases.find("GRID,1")), "-o b.h5 --subcase all", 1,
               "--subcase all: a.bdf has no SUBCASE (leave --subcase away)");
  text = "SOL 101\nCEND\n";
  for (int i = 1; i <= 1001; ++i) text += fmt::format("SUBCASE {}\n", i);
  refused_deck("a.bdf", text + cases.substr(cases.find("BEGIN BULK")), "-o b.h5 --subcase all", 2,
               "a.bdf:1003: more than 1000 subcases (take some of them by --subcase N)");
}

}  // namespace
}  // namespace hilo::test::import_bdf_subcases_test
