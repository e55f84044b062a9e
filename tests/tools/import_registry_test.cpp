// SPDX-License-Identifier: GPL-3.0-or-later
// Readers, cards of .inp decks and entries of .bdf decks are rows of tables: a row made here works like those inside, and what is no row is
// told.
#include "base/error.hpp"
#include "import/bdf/card.hpp"
#include "import/inp/card.hpp"
#include "import_case.hpp"

namespace hilo::test::import_registry_test {
namespace {

using ImportRegistry = Import;

TEST_F(ImportRegistry, AnUnknownEndingIsToldAllThatAreKnown) {
  place.write("cube.xyz", "1");
  const auto ran = place.run("hilo-import cube.xyz -o out.h5");
  expect_end(ran, 2, "no reader for \".xyz\" files");
  for (const auto& f : mesh_formats())
    EXPECT_NE(ran.err.find(std::string(" ") + std::string(f.name)), std::string::npos) << f.name << ran.err;
}

/// A made-up format: the corners of a cube by the length of its edge.
Imported read_cube(const std::string& path, const ImportOptions&) {
  const double a = std::stod(text_of(path));
  Imported in;
  for (const auto& x :
       {Vec3(0, 0, 0), Vec3(a, 0, 0), Vec3(a, a, 0), Vec3(0, a, 0), Vec3(0, 0, a), Vec3(a, 0, a), Vec3(a, a, a), Vec3(0, a, a)})
    in.mesh.X.push_back(x), in.mesh.node_id.push_back(in.mesh.n_nodes());
  in.mesh.add_cell(Shape::hex8, std::array<std::int64_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}, -1, 1);
  return in;
}

TEST_F(ImportRegistry, AReaderFromOutsideIsOneRow) {
  place.write("two.cube", "2");
  auto formats = mesh_formats();
  formats.add({".cube", read_cube});
  EXPECT_DOUBLE_EQ(volume(read_any(place / "two.cube", {}, formats).mesh), 8);
  EXPECT_THROW(read_any(place / "two.cube", {}), Error);
}

/// A made-up card that sets the title of the deck to its data line.
void read_badge(InpReading& r) {
  DataLine l;
  if (r.lines.next_data(l)) r.deck.title = l.text(0);
}

TEST_F(ImportRegistry, ACardOfAnInpDeckFromOutsideIsOneRow) {
  place.write("deck.inp", "*NODE\n1, 0, 0, 0\n*BADGE\nseven\n*STEP\n*STEP\n*BADGE\neight\n");
  const auto title = [&](const InpCards& cards, Imported& in) {
    InpDeck deck;
    parse_inp(place / "deck.inp", deck, in, cards);
    return deck.title;
  };
  Imported without, with, first;
  EXPECT_EQ(title(inp_cards(), without), "");
  ASSERT_EQ(without.not_read.size(), 2u);
  EXPECT_EQ(without.not_read[0].what, "*BADGE");
  EXPECT_EQ(without.not_read[0].place, place / "deck.inp" + ":3");
  auto cards = inp_cards(), once = inp_cards();
  cards.add({"BADGE", read_badge});
  once.add({"BADGE", read_badge, true});
  EXPECT_EQ(title(cards, with), "eight");
  EXPECT_TRUE(with.not_read.empty());
  EXPECT_EQ(title(once, first), "seven");
  ASSERT_EQ(first.not_read.size(), 1u);
  EXPECT_EQ(first.not_read[0].what, "*BADGE in step 2 and later");
}

TEST_F(ImportRegistry, ASlipInACardIsToldWithTheCardMeant) {
  place.write("deck.inp", "*DENSITI\n*ELASITC\n*ELEMNT\n*NNODE\n*GASKET\n*TIE\n");
  Imported in;
  InpDeck deck;
  parse_inp(place / "deck.inp", deck, in, inp_cards());
  std::vector<std::string> hints;
  for (const auto& n : in.not_read) hints.push_back(n.hint);
  EXPECT_EQ(hints, (std::vector<std::string>{"did you mean *DENSITY?", "did you mean *ELASTIC?", "did you mean *ELEMENT?",
                                             "did you mean *NODE?", "", ""}));
  place.write("slip.inp", text_of(Import::deck("loads_mesh.inp")) + "*DENSITI\n");
  const auto ran = place.run("hilo-import slip.inp -o out.h5 --rest all");
  EXPECT_NE(ran.err.find("not read: *DENSITI (1, slip.inp:29); did you mean *DENSITY?\n"), std::string::npos) << ran.err;
}

TEST_F(ImportRegistry, AnEntryOfABdfDeckFromOutsideIsOneRow) {
  place.write("deck.bdf", "GRID,1,,0.,0.,0.\nTWIN,5,3.\n");
  const auto read = [&](const BdfCards& cards, BdfDeck& deck) {
    Imported in;
    BdfEntries entries(place / "deck.bdf");
    parse_bdf(entries, deck, in, cards);
    return in.not_read.size();
  };
  BdfDeck without, with;
  EXPECT_EQ(read(bdf_cards(), without), 1u);
  auto cards = bdf_cards();
  cards.add({"TWIN", [](const BdfEntry& e, BdfDeck& deck, Imported&) {
               deck.X.emplace_back(e.number(1), 0, 0);
               deck.node_id.push_back(e.integer(0));
             }});
  EXPECT_EQ(read(cards, with), 0u);
  ASSERT_EQ(with.X.size(), 2u);
  EXPECT_EQ(with.X[1].x(), 3);
}

}  // namespace
}  // namespace hilo::test::import_registry_test
