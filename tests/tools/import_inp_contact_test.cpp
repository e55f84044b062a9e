// SPDX-License-Identifier: GPL-3.0-or-later
// *CONTACT PAIR, *SURFACE INTERACTION, *FRICTION and *CONTACT of .inp decks.  Truth: two cubes on each other, by hand.
#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_contact_test {
namespace {

/// Cubes of 1 m on each other with a gap of 1 mm, E = 1e9 Pa; the lower is held at its foot.
const std::string cubes =
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1\n"
    "11, 0, 0, 1.001\n12, 1, 0, 1.001\n13, 1, 1, 1.001\n14, 0, 1, 1.001\n15, 0, 0, 2.001\n16, 1, 0, 2.001\n17, 1, 1, 2.001\n18, 0, 1, "
    "2.001\n"
    "*ELEMENT, TYPE=C3D8, ELSET=low\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*ELEMENT, TYPE=C3D8, ELSET=up\n2, 11, 12, 13, 14, 15, 16, 17, 18\n"
    "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n15, 18\n*NSET, NSET=sole, GENERATE\n11, 14\n"
    "*SURFACE, NAME=table\n1, S2\n*SURFACE, NAME=under\n2, S1\n*SURFACE, NAME=points, TYPE=NODE\nsole,\n"
    "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*SOLID SECTION, ELSET=low, MATERIAL=m\n*SOLID SECTION, ELSET=up, MATERIAL=m\n"
    "*BOUNDARY\nfoot, 1, 3\nhead, 2, 2\n";
const std::string press = "*STEP, NLGEOM\n*STATIC\n.5, 1.\n*BOUNDARY\nhead, 1, 1\nhead, 3, 3, -3e-3\n*END STEP\n",
                  push = "*STEP, NLGEOM\n*STATIC\n.5, 1.\n*BOUNDARY\nhead, 1, 1, .02\nhead, 3, 3, -3e-3\n*END STEP\n";
constexpr double force = 1e9 * 2e-3 / 2.02;  // of what remains of 3 mm, over two cubes and a layer of 1/100 of each

class ImportInpContact : public test::Import {
 protected:
  std::vector<double> last_of_contact(const std::string& text, const std::string& name = "contact") {
    solve(text);
    return last("contact/" + name, 8);  // force on b, depth, its share, slip, work, pressing
  }
};

TEST_F(ImportInpContact, APairIsPressedAndSlides) {
  const std::string surface[] = {"under", "points"},
                    interaction = "*SURFACE INTERACTION, NAME=dry\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n";
  for (const auto& b : surface) {
    const std::string deck = cubes + "*CONTACT PAIR, INTERACTION=Dry, TYPE=SURFACE TO SURFACE\n" + b + ", table\n" + interaction;
    const auto pressed = last_of_contact(deck + press);
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
    EXPECT_NEAR(pressed[2], force, 2e-3 * force) << b;  // strain 1e-3
    const auto slid = last_of_contact(deck + "*FRICTION\n.1, 1e9\n" + press + push);
    EXPECT_NEAR(slid[0], -.1 * slid[7], 1e-3 * force) << b;
    EXPECT_NEAR(slid[2], slid[7], 2e-3 * force) << b;
  }
}

TEST_F(ImportInpContact, GeneralContactIsOfAll) {
  const auto pressed = last_of_contact(
      cubes + "*SURFACE INTERACTION, NAME=dry\n*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n , , dry\n" +
          press,
      "contact_low_up");
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  EXPECT_NEAR(std::abs(pressed[2]), force, 2e-3 * force);
}

TEST_F(ImportInpContact, LawsOfOtherProgramsAreTold) {
  const auto scene = [&](const std::string& cards) {
    imported_deck("a.inp", cubes + cards + press, "--scene-out s.toml");
    return test::text_of(place / "s.toml");
  };
  const std::string pair = "*CONTACT PAIR, INTERACTION=dry\nunder, table\n*SURFACE INTERACTION, NAME=dry\n";
  EXPECT_NE(scene(pair + "*FRICTION, ROUGH\n").find("friction = 5"), std::string::npos);
  expect_said("becomes 5");
  EXPECT_NE(scene(pair + "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e7\n").find("loss = \"other\""), std::string::npos)
      << "the run says so too";
  expect_said("hilo's own");
  EXPECT_NE(scene("*CONTACT PAIR, ADJUST=.1, INTERACTION=dry\nunder, table\n*SURFACE INTERACTION, NAME=dry\n").find("loss = \"other\""),
            std::string::npos);
  EXPECT_NE(scene(pair + "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e7\n").find("[[tie]]"), std::string::npos);
  const std::string both = scene("*CONTACT PAIR, INTERACTION=dry\nunder, table\ntable, under\n*SURFACE INTERACTION, NAME=dry\n");
  EXPECT_EQ(both.find("[[contact]]"), both.rfind("[[contact]]")) << "points of both meet the other anyhow";
  expect_said("a contact has these two surfaces already");
  expect_words(scene("*CONTACT PAIR, INTERACTION=dry\nunder,\n*SURFACE INTERACTION, NAME=dry\n"), "a = \"under\"\nb = \"under\"");
  for (const char* odd : {"*FRICTION, USER\n", "*FRICTION, EXPONENTIAL DECAY\n.3, .2, 1.\n", "*SURFACE BEHAVIOR, NO SEPARATION\n"}) {
    EXPECT_NE(scene(pair + odd).find("loss = \"tie\""), std::string::npos) << odd;
    EXPECT_EQ(place.run("hilo-solve --quiet s.toml -o run.h5").exit, 2) << odd;
  }
}

TEST_F(ImportInpContact, MistakesAreToldWithTheirPlace) {
  const auto refused = [&](const std::string& cards, const std::string& expected) {
    place.write("a.inp", cubes + cards + press);
    expect_end(place.run("hilo-import a.inp -o out.h5 --scene-out s.toml"), 2, expected);
  };
  refused("*CONTACT PAIR, INTERACTION=wet\nunder, table\n*SURFACE INTERACTION, NAME=wat\n", "did you mean \"wat\"?");
  refused("*SURFACE INTERACTION, NAME=a\n*SURFACE INTERACTION, NAME=A\n", "is given twice");
  refused("*SURFACE INTERACTION, NAME=a\n*FRICTION\n-1\n", "a coefficient of -1");
}

}  // namespace
}  // namespace hilo::test::import_inp_contact_test
