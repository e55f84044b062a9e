// SPDX-License-Identifier: GPL-3.0-or-later
// Nastran decks whose modes or factors of buckling belong to the loads of another subcase, which STATSUB names.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "beam_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_bdf_statsub_test {
namespace {

using namespace beam_decks;

const double euler = pi * pi * E * 1e-9;  // of the column between hinges

class ImportStatsub : public ImportBeam {
 protected:
  /// A column of 1 m between hinges under one times (set 2) and a quarter of (set 3) Euler's load, as a pull.
  static std::string deck(const std::string& control) {
    std::string text = control + "BEGIN BULK\nEIGRL,9,,,2\nPBAR,5,1,1.-3,1.-9,4.-9,2.-9\n" + steel;
    for (int i = 0; i <= 8; ++i) text += fmt::format("GRID,{},,{},0.,0.\n", i + 1, i / 8.);
    for (int i = 1; i <= 8; ++i) text += fmt::format("CBAR,{},5,{},{},0.,1.,0.\n", i, i, i + 1);
    return text + fmt::format("SPC1,1,1234,1\nSPC1,1,23,9\nSPC1,4,123456,1\nFORCE,2,9,,{0:.8g},1.,0.,0.\nFORCE,3,9,,{1:.8g},1.,0.,0.\n",
                              euler, euler / 4);
  }
  Scene scene(const std::string& control, const std::string& options = "") {
    imported_deck("a.bdf", deck(control), "--scene-out a.toml " + options);
    return Scene::load(place / "a.toml");
  }
  /// The card is told, in the scene too, as a load that the model lacks.
  void expect_lost(const Scene& s, const std::string& card) {
    expect_said("not read: " + card);
    std::string loss;
    for (const Entry& left : s.entries("left_out"))
      if (left.text("card") == card) loss = left.text("loss");
    EXPECT_EQ(loss, "load") << card;
  }
};

// A pull of Euler's load raises the first frequency by sqrt(2), a quarter of it by sqrt(1.25).
TEST_F(ImportStatsub, ModesAreThoseUnderTheLoadsOfTheSubcaseItNames) {
  const double free = pi / 2 * std::sqrt(E * 1e-9 / 7.85);
  const std::string head = "SOL 103\nCEND\nSPC = 1\n";
  const auto first_is = [&](double factor, const std::string& control, const std::string& options = "") {
    solve(deck(control), "a.bdf", options);
    EXPECT_NEAR(frequency(1) / free, factor, 2e-3) << control;
    EXPECT_EQ(Scene::load(place / "a.toml").table("time").number("modes"), 2);
  };
  const double whole = std::sqrt(2.), quarter = std::sqrt(1.25);
  const std::string one = head + "SUBCASE 1\nLOAD = 2\nSUBCASE 2\nSTATSUB = 1\nMETHOD = 9\n";
  first_is(whole, one);
  EXPECT_EQ(told.find("SUBCASE"), std::string::npos) << told;
  first_is(whole, one, "--subcase 2");
  first_is(whole, head + "SUBCASE 1\nANALYSIS = STATICS\nLOAD = 2\nSUBCASE 2\nANALYSIS = MODES\nSTATSUB(PRELOAD) = 1\nMETHOD = 9\n");
  first_is(quarter, head + "METHOD = 9\nSUBCASE 1\nLOAD = 2\nSUBCASE 7\nLOAD = 3\nSUBCASE 8\nSTATSUB = 7\nSUBCASE 9\nSTATSUB = 1\n");
  expect_words(told, "import left out SUBCASE but 8 (2, a.bdf:5)");
  first_is(1, head + "METHOD = 9\n");
  EXPECT_EQ(scene(one, "--subcase 1").table("time").text("analysis"), "static") << "the pull itself";
}

TEST_F(ImportStatsub, WhatItNamesAndASceneCannotHaveIsALostLoad) {
  const std::string head = "SOL 103\nCEND\nMETHOD = 9\n", loads = "SUBCASE 1\nSPC = 4\nLOAD = 2\n";
  for (const auto& [control, card] :
       {std::pair<std::string, std::string>{head + loads + "SUBCASE 2\nSPC = 1\nSTATSUB = 1\n",
                                            "case control STATSUB of subcase 1, which has other supports, equations or contacts"},
        {head + loads + "SUBCASE 2\nSPC = 4\nSTATSUB = 5\n", "case control STATSUB = 5, of which there is none"},
        {"SOL 111\nCEND\n" + loads + "SUBCASE 2\nSPC = 4\nSTATSUB = 1\n", "case control STATSUB"}}) {
    const Scene s = scene(control);
    expect_lost(s, card);
    EXPECT_TRUE(s.entries("load").empty()) << control;
    EXPECT_NE(s.table("time").text("start"), "equilibrium") << control;
  }
}

TEST_F(ImportStatsub, FactorsOfBucklingAreThoseOfTheSubcaseItNames) {
  const std::string head = "SOL 105\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 2\nSUBCASE 2\nLOAD = 3\nSUBCASE 3\nMETHOD = 9\n";
  for (const auto& [words, factor] : {std::pair{"", -1.}, {"STATSUB = 1\n", -1.}, {"STATSUB(BUCKLE) = 2\n", -4.}}) {
    solve(deck(head + words));
    EXPECT_NEAR(frequency(1) / factor, 1, 2e-3) << words;
    EXPECT_EQ(Scene::load(place / "a.toml").table("time").number("modes"), 2);
  }
  solve(deck(head + "STATSUB = 2\n"), "a.bdf", "--subcase 3");
  EXPECT_NEAR(frequency(1), -4, 8e-3);
}

// A scene of buckling has no load that stands while others grow.
TEST_F(ImportStatsub, BucklingWithALoadThatWasLostIsRefused) {
  const std::string head = "SOL 105\nCEND\nSUBCASE 1\nSPC = 1\nLOAD = 2\nSUBCASE 2\nSPC = 1\nLOAD = 3\nSUBCASE 3\nMETHOD = 9\n";
  expect_lost(scene(head + "SPC = 1\nSTATSUB(PRELOAD) = 1\nSTATSUB(BUCKLE) = 2\n"), "case control STATSUB(PRELOAD)");
  const auto refused = place.run("hilo-solve a.toml -o run.h5");
  EXPECT_EQ(refused.exit, 2);
  expect_words(refused.err, "import left out case control STATSUB(PRELOAD) (1, a.bdf:12): factors would be those of other loads (");
  const auto accepted = succeeded(place.run("hilo-solve a.toml -o run.h5 --accept-left-out"));
  table = accepted.out;
  EXPECT_NEAR(frequency(1), -4, 8e-3);
  expect_lost(scene(head + "SPC = 4\n"), "case control STATSUB of subcase 1, which has other supports, equations or contacts");
  EXPECT_EQ(place.run("hilo-solve a.toml -o run.h5").exit, 2);
}

// G of a MAT1 is that of torsion and shear of beams; solids have E and NU alone.
TEST_F(ImportStatsub, AShearModulusOfItsOwnIsToldWhereSolidsHaveIt) {
  std::string bars = deck("SOL 101\nCEND\nSPC = 4\nLOAD = 3\n");
  bars.replace(bars.find("MAT1,1,2.1+11,"), 14, "MAT1,1,2.1+11,5.+10");
  imported_deck("a.bdf", bars, "--scene-out a.toml");
  EXPECT_EQ(err.find("MAT1: "), std::string::npos) << err;
  bars +=
      "GRID,21,,0.,0.,5.\nGRID,22,,1.,0.,5.\nGRID,23,,1.,1.,5.\nGRID,24,,0.,1.,5.\nGRID,25,,0.,0.,6.\nGRID,26,,1.,0.,6.\n"
      "GRID,27,,1.,1.,6.\nGRID,28,,0.,1.,6.\nCHEXA,50,6,21,22,23,24,25,26\n,27,28\nCHEXA,51,7,21,22,23,24,25,26\n,27,28\n"
      "PSOLID,6,1\nPSOLID,7,1\n";
  imported_deck("a.bdf", bars, "--scene-out a.toml");
  expect_said("not read: MAT1: a shear modulus that is not that of E and NU (1, a.bdf:");
}

TEST_F(ImportStatsub, AForceAtAPointOfABeamHasNoSecondValue) {
  const std::string bars = deck("SOL 101\nCEND\nSPC = 4\nLOAD = 6\n");
  for (const char* rest : {",,7.", ",.5,7.", ",.5", ""}) {
    imported_deck("a.bdf", bars + "PLOAD1,6,4,FY,FR,.5,3." + rest + "\n", "--scene-out a.toml");
    EXPECT_EQ(err.find("PLOAD1"), std::string::npos) << rest << err;
    EXPECT_EQ(Scene::load(place / "a.toml").entries("load")[0].vector3("force"), Vec3(0, 3, 0)) << rest;
  }
}

TEST_F(ImportStatsub, ARigidJointThatIsNotReadIsALostTie) {
  for (const std::string card : {"RJOINT,60,9,50,123", "RTRPLT1,60,9,8,7", "RSSCON,60,GRID,9,50", "CTRIAX,60,1,1,2,3"}) {
    imported_deck("a.bdf", deck("SOL 101\nCEND\nSPC = 4\nLOAD = 2\n") + card + "\n", "--scene-out a.toml");
    EXPECT_EQ(Scene::load(place / "a.toml").entries("left_out")[0].text("loss"), "tie") << card;
  }
}

}  // namespace
}  // namespace hilo::test::import_bdf_statsub_test
