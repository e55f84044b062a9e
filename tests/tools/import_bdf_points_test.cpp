// SPDX-License-Identifier: GPL-3.0-or-later
// Nastran decks of grids without solids: masses, springs and what ties them.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_bdf_points_test {
namespace {

class ImportBdfPoints : public test::Import {
 protected:
  /// How far the body of a grid went, and its small turn.
  std::pair<Vec3, Vec3> moved(int grid) {
    const auto all = Store::open(place / "run.h5").read<double>(fmt::format("/history/body/grid_{}", grid));
    using Points = Eigen::Matrix<double, 3, 4>;  // its centre and one on each of its axes
    const auto axes = [](const Points& p) -> Mat3 { return p.rightCols(3).colwise() - p.col(0); };
    const Points first(all.data()), end(all.data() + all.size() - 12);
    const Mat3 R = axes(end) * axes(first).inverse();
    return {end.col(0) - first.col(0), Vec3(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)) / 2};
  }
};
const std::string statics = "SOL 101\nCEND\nSPC = 1\nMPC = 4\nLOAD = 2\nBEGIN BULK\n";
/// Springs of 1e6 on all six components of a grid, to the ground or to another.
std::string springs(int first, int grid, const std::string& to = "") {
  std::string s;
  for (int c = 1; c <= 6; ++c)
    s += fmt::format("CELAS2,{},1.+6,{},{}{}\n", first + c, grid, c, to.empty() ? "" : fmt::format(",{},{}", to, c));
  return s;
}

// Grids 2 m apart, each with a mass of no weight; scalar springs act at their grids, a CBUSH in the middle between them.
TEST_F(ImportBdfPoints, GridsThatAreApartStayApartWhereTheDeckHasNoElement) {
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCONM2,902,2,,1.\n,.1,,.1,,,.1\nCONM2,901,1,,1.\n,.1,,.1,,,.1\n";
  const std::string across = "FORCE,2,2,,20.,0.,1.,0.\n", along = "FORCE,2,2,,20.,1.,0.,0.\n";
  const struct {
    const char* name;
    std::string text;
    Vec3 way_1, way_2;
    double turn_2;  // about z
  } cases[] = {
      {"CELAS2 to the ground and between", springs(10, 1) + springs(20, 2, "1") + across, {0, 2e-5, 0}, {0, 4e-5, 0}, 0},
      {"MPC", springs(10, 1) + springs(20, 2) + "MPC,4,1,2,1.,2,2,-1.\n" + across, {0, 1e-5, 0}, {0, 1e-5, 0}, 0},
      {"CBUSH1D", "SPC1,1,123456,1\nSPC1,1,23456,2\nCBUSH1D,1,1,1,2\nPBUSH1D,1,1.+6\n" + along, {0, 0, 0}, {2e-5, 0, 0}, 0},
      {"CBUSH along", "SPC1,1,123456,1\nSPC1,1,23456,2\nCBUSH,1,1,1,2,0.,1.,0.\nPBUSH,1,K,1.+6\n" + along, {0, 0, 0}, {2e-5, 0, 0}, 0},
      {"CBUSH across",  // F/k + (F L/2)/k_turn L/2
       "SPC1,1,123456,1\nCBUSH,1,1,1,2,0.,1.,0.\nPBUSH,1,K,1.+6,1.+6,1.+6,1.+6,1.+6,1.+6\n" + across,
       {0, 0, 0},
       {0, 4e-5, 0},
       2e-5},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    solve(statics + grids + c.text, "a.bdf");
    const auto [way_1, turn_1] = moved(1);
    const auto [way_2, turn_2] = moved(2);
    EXPECT_LT((way_1 - c.way_1).norm(), 1e-8) << way_1.transpose();
    EXPECT_LT((way_2 - c.way_2).norm(), 1e-8) << way_2.transpose();
    EXPECT_LT(turn_1.norm(), 1e-8) << turn_1.transpose();
    EXPECT_LT((turn_2 - c.turn_2 * Vec3::UnitZ()).norm(), 1e-8) << turn_2.transpose();
  }
}

// A point mass beside its grid has no moment of inertia of its own: what remains of m r^2 - m r^2 is rounding.
TEST_F(ImportBdfPoints, AMassBesideItsGridHasNoInertiaButThatOfTheDeck) {
  const std::string arm =
      "SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,2\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.1,0.\n"
      "CBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,4.-3,8.-6,2.-6,3.-6\nMAT1,1,2.1+11,8.+10,,7850.\nSPC1,1,123456,1\n";
  for (const char* inertia : {"", "\n,0.,,.1,,,.1"}) {
    solve(arm + "CONM2,7,2,,3.,.1,.7,.2" + inertia + "\n", "a.bdf");
    const Scene s = Scene::load(place / "s.toml");
    for (const auto& b : s.entries("body")) {
      if (b.name != "grid_2") continue;
      EXPECT_NEAR(b.number("mass"), 3, 1e-12);
      const auto J = b.numbers("inertia");
      const std::vector<double> want = *inertia ? std::vector{0., .1, .1, 0., 0., 0.} : std::vector<double>(6, 0);
      for (size_t i = 0; i < J.size(); ++i) EXPECT_NEAR(J[i], want[i], 1e-12);
    }
  }
}

// Four posts of 1 m at the corners of a square of 1 m, whose tops share a moment about z: by w r^2 through their forces, and by w L^2
// through their own turns, of which each is half.  GJ = 2.4e5.
TEST_F(ImportBdfPoints, TurnsOfTheGridsOfAnRbe3TakeTheirShare) {
  std::string posts;
  const double x[] = {0, 1, 1, 0}, y[] = {0, 0, 1, 1};
  for (int i = 0; i < 4; ++i)
    posts += fmt::format("GRID,{0},,{2:.1f},{3:.1f},0.\nGRID,{1},,{2:.1f},{3:.1f},1.\nCBAR,{4},1,{0},{1},1.,0.,0.\n", 10 + i, 20 + i, x[i],
                         y[i], i + 1);
  posts +=
      "MAT1,1,2.1+11,8.+10,,7850.\nPBAR,1,1,4.-3,8.-6,2.-6,3.-6\nSPC1,1,123456,10,THRU,13\nGRID,99,,.5,.5,1.\nMOMENT,2,99,,100.,0.,0.,1.\n";
  for (const bool turns : {false, true}) {
    solve(statics + posts + "RBE3,98,,99,123456,1.," + (turns ? "123456" : "123") + ",20,21\n,22,23\n", "a.bdf");
    const auto [way, turn] = moved(20);
    EXPECT_NEAR(turn.z(), turns ? 12.5 / 2.4e5 : 0, 1e-8);
    const double F = (turns ? 25 : 50) / std::numbers::sqrt2 / std::numbers::sqrt2;  // along x and y
    EXPECT_NEAR(std::abs(way.x()), F / (3 * 2.1e11 * 8e-6), 1e-8);
    EXPECT_NEAR(std::abs(way.y()), F / (3 * 2.1e11 * 2e-6), 1e-8);
  }
}

}  // namespace
}  // namespace hilo::test::import_bdf_points_test
