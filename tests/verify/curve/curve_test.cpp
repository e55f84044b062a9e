// SPDX-License-Identifier: GPL-3.0-or-later
// A point on a curve: the tautochrone, momentum and energy of a bead on a moving track, and what happens at the end of a curve.
#include "verify/verify.hpp"

namespace hilo::test::curve_test {
namespace {

// Exact: on x = r (p + sin p), z = r (1 - cos p) the arc is s = 4 r sin(p/2) = s0 cos(omega t) with omega^2 = g/(4 r).
TEST(PointOnCurve, SwingsOnACycloidWithoutRegardToAmplitude) {
  for (const double p0 : {1.2, 2.3}) {
    const Case c("curve");
    const double r = 0.5, omega = std::sqrt(9.81 / (4 * r)), s0 = 4 * r * std::sin(p0 / 2);
    const double x = r * (p0 + std::sin(p0)), z = r * (1 - std::cos(p0));
    char place[200];
    std::snprintf(place, sizeof place, "--set 'body.bead.com=[%.17g, 0, %.17g]' --set 'joint.wire.at=[%.17g, 0, %.17g]'", x, z, x, z);
    const Results results = c.solved(place);
    const auto bead = results.history("probe/bead");
    double worst = 0;
    for (Eigen::Index i = 0; i < bead.rows(); ++i) {
      const double p = 2 * std::asin(s0 * std::cos(omega * results.t()[i]) / (4 * r));
      worst = std::max(worst, (bead.row(i).head<3>().transpose() - Vec3(r * (p + std::sin(p)), 0, r * (1 - std::cos(p)))).norm());
    }
    const double phase = 2 * M_PI * std::pow(omega * 2e-3, 2) / 12;  // of the mid-point rule after a period
    EXPECT_LT(worst, 1.5 * s0 * phase) << p0;
    EXPECT_LT(c.reported("energy_balance"), 1e-12);
    EXPECT_LT(c.reported("constraint_violation"), 1e-13);
  }
}

// Truth: the reactions of bead and track are opposite and do no work: momentum, angular momentum and energy stay, through many rounds.
TEST(PointOnCurve, OfAMovingTrackKeepsEnergyAndMomentum) {
  const Case c("curve");
  const Results r = c.solved("", "run.h5", "track");
  const auto m = r.history("momentum");
  for (Eigen::Index i = 0; i < m.rows(); ++i) ASSERT_LT((m.row(i) - m.row(0)).norm(), 1e-12 * (1 + r.t()[i])) << "t = " << r.t()[i];
  EXPECT_LT(c.reported("energy_balance"), 1e-11);
  EXPECT_LT(c.reported("constraint_violation"), 1e-13);
}

TEST(PointOnCurve, StopsTheRunWhereTheCurveEnds) {
  const Case c("curve");
  const Ran ran = c.solve("--quiet --set 'initial=[{on = [\"bead\"], velocity = [6, 0, 3]}]'", "run.h5", 3);
  EXPECT_NE(ran.err.find("joint \"wire\" ran off the end of its curve"), std::string::npos) << ran.err;
  const Results r = c.results();
  EXPECT_FALSE(r.complete());
  const Vec3 last = r.history("probe/bead").bottomRows(1).leftCols(3).transpose();
  const double p = 0.8 * M_PI;  // the end of the cycloid of the file
  EXPECT_LT((last - Vec3(p + std::sin(p), 0, 1 - std::cos(p)) / 2).norm(), 1e-4) << "the run is kept up to the end of the curve";
}

TEST(PointOnCurve, StopsAStaticRunWhereTheCurveEnds) {
  const Case c("curve");
  c.write("cycloid.csv", text_of(c.source("cycloid.csv")));
  const std::string at = "[1.0660195429836131, 0, 0.3188211227616633]\n";
  c.write("scene.toml", "[[body]]\nname = \"bead\"\nmass = 1\ninertia = [1, 1, 1]\ncom = " + at +
                            "[[joint]]\nkind = \"point-on-curve\"\nname = \"wire\"\nb = \"bead\"\nfile = \"cycloid.csv\"\nat = " + at +
                            "[[spring]]\nkind = \"bushing\"\nname = \"hold\"\nb = \"bead\"\nstiffness = [100, 100, 100]\nangular_stiffness "
                            "= [10, 10, 10]\nat = " +
                            at +
                            "[[load]]\nkind = \"force\"\nname = \"pull\"\non = \"bead\"\nforce = [200, 0, 200]\n"
                            "[[probe]]\nname = \"bead\"\non = \"bead\"\n[time]\nanalysis = \"static\"\nsteps = 10\n");
  expect_end(c.run("hilo-solve --quiet scene.toml -o run.h5"), 3, "joint \"wire\" ran off the end of its curve");
  const Vec3 last = c.results().history("probe/bead").bottomRows(1).leftCols(3).transpose();
  const double p = 0.8 * M_PI;  // the end of the cycloid of the file; a load step is a tenth of the way
  EXPECT_LT((last - Vec3(p + std::sin(p), 0, 1 - std::cos(p)) / 2).norm(), 0.01) << "the run is kept up to the end of the curve";
}

TEST(PointOnCurve, SaysWhatIsWrongWithItsPoints) {
  const Case c("curve");
  const std::string scene = text_of(c.source("scene.toml"));
  const auto refusal = [&](const std::string& instead, const std::string& csv) {
    std::string text = scene;
    text.replace(text.find("file = \"cycloid.csv\""), 20, instead);
    c.write("scene.toml", text);
    c.write("curve.csv", csv);
    const Ran ran = c.run("hilo-solve --quiet scene.toml -o run.h5");
    EXPECT_EQ(ran.exit, 2) << instead;
    return ran.err;
  };
  const auto expect = [&](const std::string& err, const std::string& part) { EXPECT_NE(err.find(part), std::string::npos) << err; };
  expect(refusal("closed = true", ""), "joint \"wire\": neither points nor a file");
  expect(refusal("points = [[0, 0, 0]]", ""), "1 points do not make a curve");
  expect(refusal("points = [[0, 0, 0], [1, 0]]", ""), "a point of 2 numbers, not 3");
  expect(refusal("points = [[0, 0, 0], [0, 0, 0], [1, 0, 0]]", ""), "points 1 and 2 are the same");
  expect(refusal("file = \"none.csv\"", ""), "no file");
  expect(refusal("file = \"curve.csv\"", "0,0,0\n1,0,0\n"), "curve.csv:1:1: no header line");
  expect(refusal("file = \"curve.csv\"", "x,y,z\n0,0,0\n1,oops,0\n"), "curve.csv:3:3: \"oops\" is not a number");
  expect(refusal("file = \"curve.csv\"", "x,y,z\n0,0\n"), "curve.csv:2:1: 2 columns where three are expected");
}

}  // namespace
}  // namespace hilo::test::curve_test
