// SPDX-License-Identifier: GPL-3.0-or-later
// Cards of decks: a material said by Lame's moduli, lambda and mu.  What reads the card, and a row of inp_cards(); an entry of .bdf files
// likewise.
#include "import/bdf/card.hpp"
#include "import/inp/card.hpp"
#include "outside.hpp"

namespace outside {
namespace {

using namespace hilo;

void set_moduli(DeckMaterial& m, double lambda, double mu) {
  m.data.E = mu * (3 * lambda + 2 * mu) / (lambda + mu);
  m.data.nu = lambda / (2 * (lambda + mu));
}

/// *LAME, then "lambda, mu"
void read_lame(InpReading& r) {
  DataLine l;
  DeckMaterial& m = material_of(r, l, "lambda, mu");
  set_moduli(m, l.number(0), l.number(1));
}

/// MATLAME, number, lambda, mu, density
void read_matlame(const BdfEntry& e, BdfDeck& deck, Imported&) {
  DeckMaterial& m = material_of(e, deck);
  set_moduli(m, e.number(1), e.number(2));
  m.data.density = e.number(3);
}

}  // namespace

void add_deck_card() {
  inp_cards().add({"LAME", read_lame});
  bdf_cards().add({"MATLAME", read_matlame});
}

namespace {

const char* const inp = R"(*NODE
1, 0, 0, 0
2, 10, 0, 0
3, 10, 10, 0
4, 0, 10, 0
5, 0, 0, 10
6, 10, 0, 10
7, 10, 10, 10
8, 0, 10, 10
*ELEMENT, TYPE=C3D8, ELSET=cube
1, 1, 2, 3, 4, 5, 6, 7, 8
*SOLID SECTION, ELSET=cube, MATERIAL=alloy
*MATERIAL, NAME=alloy
*DENSITY
2.7e-9
*LAME
50000., 26000.
)";
const char* const bdf = R"(BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,10.,0.,0.
GRID,3,,0.,10.,0.
GRID,4,,0.,0.,10.
CTETRA,1,7,1,2,3,4
PSOLID,7,3
MATLAME,3,50000.,26000.,2.7e-9
ENDDATA
)";

Imported read(const test::Workplace& place, const std::string& file, const std::string& text) {
  place.write(file, text);
  ImportOptions options;
  options.units = "mm-t-s";
  Imported in = read_any(place / file, options);
  finish(in, place / file, options);
  return in;
}

// E = 26 (3 50 + 2 26)/(50 + 26) GPa, nu = 50/(2 (50 + 26)), in SI.
TEST(OutsideDeckCard, SaysTheMaterialOfTheMeshAndOfTheScene) {
  const test::Workplace place;
  for (const auto& [file, text] : {std::pair{"cube.inp", inp}, {"cell.bdf", bdf}}) {
    const Imported in = read(place, file, text);
    ASSERT_EQ(in.mesh.region_data.size(), 1u) << file;
    const RegionData& m = in.mesh.region_data[0];
    EXPECT_NEAR(m.E, 26e9 * 202 / 76, 1e-3) << file;
    EXPECT_NEAR(m.nu, 50. / 152, 1e-15) << file;
    EXPECT_NEAR(m.density, 2700, 1e-9) << file;
    EXPECT_TRUE(in.not_read.empty()) << file;
  }
  EXPECT_NE(read(place, "cube.inp", inp).mesh.deck_scene.find("[material.\"alloy\"]"), std::string::npos);
}

TEST(OutsideDeckCard, IsSuggestedForAMistypedOneAndKnowsItsPlace) {
  const test::Workplace place;
  std::string text = inp;
  text.replace(text.find("*LAME"), 5, "*LMAE");
  const Imported in = read(place, "cube.inp", text);
  ASSERT_EQ(in.not_read.size(), 2u) << "the card, and the material that has no law without it";
  EXPECT_EQ(in.not_read[0].what, "*LMAE");
  EXPECT_EQ(in.not_read[0].place, place / "cube.inp:16");
  EXPECT_EQ(in.not_read[0].hint, "did you mean *LAME?");
  EXPECT_EQ(in.not_read[1].place, place / "cube.inp:12:23");
  try {
    read(place, "early.inp", std::string("*LAME\n1., 1.\n") + inp);
    FAIL() << "was read";
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()), place / "early.inp:1:1: *LAME stands before any *MATERIAL");
  }
  EXPECT_THROW(add_deck_card(), Error) << "each card has one reader";
}

}  // namespace
}  // namespace outside
