// SPDX-License-Identifier: GPL-3.0-or-later
// --merge-nodes: what a deck puts on each of the nodes that become one acts there as often.
#include <fmt/format.h>

#include "import_case.hpp"

namespace hilo::test::import_merge_test {
namespace {

class ImportMerge : public test::Import {
 protected:
  /// Of all that holds.
  std::vector<double> reaction() { return last("motion/" + std::string(is_bdf ? "SPC_1" : "foot"), 6); }
  bool is_bdf = true;
};

/// Two cubes on each other whose nodes at z = 1 are double: 5 to 8 and 11 to 14.
const int numbers[] = {1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18};
std::string point(int i, const char* format) {
  const int x[] = {0, 1, 1, 0}, y[] = {0, 0, 1, 1}, z = i < 4 ? 0 : i < 12 ? 1 : 2;
  return fmt::format(fmt::runtime(format), numbers[i], x[i % 4], y[i % 4], z);
}

TEST_F(ImportMerge, ForcesAndMassesOfNodesThatBecomeOneAddUp) {
  std::string bdf = "SOL 101\nCEND\nSPC=1\nLOAD=2\nBEGIN BULK\n", inp = "*NODE\n";
  for (int i = 0; i < 16; ++i) bdf += point(i, "GRID,{},,{}.,{}.,{}.\n"), inp += point(i, "{}, {}, {}, {}\n");
  bdf += "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nCHEXA,2,1,11,12,13,14,15,16\n,17,18\nPSOLID,1,1\nMAT1,1,2.1+11,,.3\nSPC1,1,123,1,THRU,4\n";
  inp +=
      "*ELEMENT, TYPE=C3D8, ELSET=A\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 11, 12, 13, 14, 15, 16, 17, 18\n*NSET, NSET=F\n5, 6, 11, 15\n"
      "*NSET, NSET=foot\n1, 2, 3, 4\n*MATERIAL, NAME=S\n*ELASTIC\n2.1E11, 0.3\n*SOLID SECTION, ELSET=A, MATERIAL=S\n*BOUNDARY\nfoot, 1, 3\n"
      "*STEP\n*STATIC\n*CLOAD\nF, 1, 10.\n*END STEP\n";
  std::string forces, masses = "GRAV,2,,2.,1.,0.,0.\n";
  for (const int a : {5, 6, 11, 15})
    forces += fmt::format("FORCE,2,{},,10.,1.,0.,0.\n", a), masses += fmt::format("CONM2,{0},{1},,5.\n", 90 + a, a);
  const std::pair<const char*, std::string> decks[] = {{"a.bdf", bdf + forces}, {"b.bdf", bdf + masses}, {"a.inp", inp}};
  for (const auto& [file, text] : decks)
    for (const char* options : {"--merge-nodes 1e-6", "--merge-nodes 1e-6 --order 2"}) {
      SCOPED_TRACE(std::string(file) + " " + options);
      is_bdf = std::string_view(file).ends_with("bdf");
      solve(text, file, options);
      const auto r = reaction();
      EXPECT_NEAR(r[0], -40, 1e-4);
      EXPECT_NEAR(r[4], -50, 1e-3) << "about the origin of z, by where they act: three at 1 and one at 2";
    }
}

}  // namespace
}  // namespace hilo::test::import_merge_test
