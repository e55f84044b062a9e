// SPDX-License-Identifier: GPL-3.0-or-later
// What a beam of a deck cannot carry is refused by its place or named as left out.
#include "beam_case.hpp"

namespace hilo::test::import_beam_refused_test {
namespace {

using namespace beam_decks;

TEST_F(ImportBeam, WhatABarOfBdfCannotCarryIsRefusedOrTold) {
  const std::string those =
      " (ROD, TUBE, TUBE2, BAR, BOX, BOX1, I, I1, H, CROSS, T, T1, T2, CHAN, CHAN1, CHAN2, L, Z, HAT and HAT1 are; write the others as "
      "PBAR)";
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\n" + steel;
  refused_deck("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,DBOX,,,,,+\n+,.2,.4\n", "-o b.h5", 2,
               "a.bdf:5:12: PBARL 5: TYPE DBOX is not read" + those);
  refused_deck("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,BOX,,,,,+\n+,.1,.2,.12,.06\n", "-o b.h5", 2,
               "a.bdf:5:12: PBARL 5: TYPE BOX with such walls is not read" + those);
  refused_deck("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,BOX1,,,,,+\n+,.1,.2,.02,.01,.02,.01\n", "-o b.h5", 2,
               "a.bdf:5:12: PBARL 5: TYPE BOX1 that is askew is not read" + those);
  refused_deck("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,HAT,,,,,+\n+,.2,.03,.05,.1\n", "-o b.h5", 2,
               "a.bdf:5:12: PBARL 5: TYPE HAT with such walls is not read" + those);
  for (const auto& [type, dims, blank] : {std::tuple{"TUBE", ".1", 2}, std::tuple{"I1", ",.1,.2,.3", 1}}) {
    refused_deck("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,," + type + ",,,,,+\n+," + dims + "\n", "-o b.h5", 2,
                 fmt::format("a.bdf:5:12: PBARL 5: TYPE {} without DIM{} is not read{}", type, blank, those));
  }
  refused_deck("b.bdf", grids + "CBAR,1,5,1,2,1.,0.,0.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n", "-o b.h5", 2,
               "b.bdf:4:6: beam 1: its orientation lies along it, or is none");
  refused_deck("c.bdf", grids + "CBAR,1,5,1,2,1.,0.,0.,GOG,+\n+,,,,1.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n", "-o b.h5", 2,
               "c.bdf:4:6: CBAR 1: OFFT GOG, and its orientation lies along the line of its grids, or is none");
  refused_deck("c.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.,OGG\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n", "-o b.h5", 2,
               "c.bdf:4:23: CBAR: OFFT OGG is not three of G, B, O, the first of them G or B");
  refused_deck("d.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,9,1.-3,4.-7,1.-7,2.-7\n", "-o b.h5", 2,
               "d.bdf:5: property 5 of beams has no material (MAT1)");
  imported_deck("f.bdf",
                grids +
                    "CBEAM,1,5,1,2,0.,1.,0.\nPBEAM,5,1,1.-3,4.-7,1.-7,,2.-7,,+\n+,,,,,,,,,+\n+,NO,.5,1.-3,4.-7,1.-7,,2.-7,,+\n+,NO,"
                    "1.,2.-3,8.-7,2.-7,,4.-7\n",
                "--scene-out f.toml");
  expect_said("not read: PBEAM with stations between its ends: it varies evenly from end to end");
  imported_deck("h.bdf",
                grids +
                    "CBEAM,1,5,1,2,0.,1.,0.\nPBEAM,5,1,1.-3,4.-7,1.-7,,2.-7,,+\n+,,,,,,,,,+\n+,NO,.5,,,,,,,+\n+,NO,1.,2.-3,8.-7,2.-7,,"
                    "4.-7\n",
                "--scene-out h.toml");
  EXPECT_EQ(err.find("not read"), err.npos) << "blank between the ends is what lies evenly between them\n" << err;
  imported_deck("g.bdf", grids + "CBEAM,1,5,1,2,0.,1.,0.\nPBEAML,5,1,,BAR,,,,,+\n+,.1,.1,0.,YES,.5,.1,.1,0.,+\n+,YES,1.,.05,.05,0.\n",
                "--scene-out g.toml");
  expect_said("not read: PBEAML with stations between its ends: it varies evenly from end to end");
}

TEST_F(ImportBeam, WhatABeamOfInpCannotCarryIsRefusedOrTold) {
  const std::string nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n";
  const std::string beam_section = "*MATERIAL,NAME=M\n*ELASTIC\n2e11,.3\n*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=";
  refused_deck("a.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2,7\n" + beam_section + "RECT\n.1,.2\n", "-o b.h5", 2,
               "a.inp:10:21: element 1 is turned towards node 7, which does not exist");
  refused_deck(
      "a.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2,3\n*ELGEN,ELSET=E\n1,2,1,1\n" + beam_section + "RECT\n.1,.2\n", "-o b.h5", 2,
      "a.inp:8:1: *ELGEN of element 1, which has a node of its orientation: that of its copies is not clear (write the elements out)");
  refused_deck(
      "a.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n" + beam_section + "L\n.1,.1,.01,.01\n", "-o b.h5", 2,
      "a.inp:10:42: *BEAM SECTION, SECTION=L is not read (RECT, CIRC, PIPE, BOX and I are; a T is an I with one flange of no width)");
  refused_deck("b.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n", "-o b.h5", 2,
               "b.inp:6:1: element 1 has no section (beams need *BEAM SECTION)");
  const std::string both = "*NODE\n1,0,0,0\n99,0,3,0\n" + block + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,11\n*ELSET,ELSET=ALL\n1,50\n" + section;
  place.write(
      "c.inp",
      both + "*INITIAL CONDITIONS,TYPE=VELOCITY\n11,3,2.\n12,3,2.\n*RELEASE\n1,S1,M1\n*STEP\n*STATIC\n*DLOAD\nALL,P1,5.\n*END STEP\n");
  imported("c.inp", "--scene-out c.toml");
  for (const char* lost :
       {"*INITIAL CONDITIONS, TYPE=VELOCITY on a node of a beam or a tie", "*RELEASE", "*DLOAD on elements that are no cells"})
    expect_said(lost);
  EXPECT_EQ(place.run("grep -c 'loss = \"tie\"' c.toml").out, "1\n");
  refused_deck("d.inp", both + "*SURFACE,NAME=U,TYPE=NODE\n99\n*COUPLING,CONSTRAINT NAME=C,REF NODE=1,SURFACE=U\n*KINEMATIC\n1,6\n",
               "-o d.h5", 2, "d.inp:29: *COUPLING: no node of surface \"U\" is of a cell or a beam");
}

}  // namespace
}  // namespace hilo::test::import_beam_refused_test
